// A service with tokens: the page asks for one, and then shows everything, pictures and events too.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { join } from "node:path";
import { assert_accessible, HOSTILE, service_tests } from "./harness.mjs";

const tests = service_tests();
const { page_test } = tests;

page_test(
  "the page asks for a token, refuses a wrong one, and shows everything with a right one",
  { expected_statuses: [401] },
  async (page) => {
    const { stdout, status } = spawnSync(
      process.env.SHEER,
      ["token", "create", "me", "--scope", "submit", "--data", join(tests.folder(), "data")],
      { encoding: "utf8" },
    );
    assert.equal(status, 0);
    await page.goto(tests.url());
    const dialog = page.getByRole("dialog", { name: "This service asks for a token" });
    await dialog.waitFor();
    await assert_accessible(page, "the question for a token");
    await dialog.getByLabel("Token").fill("sheer_wrong");
    await dialog.getByRole("button", { name: "Continue" }).click();
    await dialog.getByText("The service does not know this token.").waitFor();
    await dialog.getByLabel("Token").fill(`  ${stdout.trim()} `);
    await page.keyboard.press("Enter");
    await page.locator(".start-card").first().waitFor();
    assert.equal(await page.getByRole("dialog").count(), 0);

    await page.goto(`${tests.url()}/#/reports/${tests.report_id()}`);
    await page.getByRole("heading", { name: HOSTILE }).waitFor();
    await page.goto(`${tests.url()}/#/reports`);
    const picture = page.locator("table img").first();
    await picture.waitFor();
    assert.ok(
      await picture.evaluate((img) => img.decode().then(() => img.naturalWidth)),
      "pictures come with the cookie",
    );
  },
);
