// The list of reports against a real service.
import assert from "node:assert/strict";
import { assert_accessible, service_tests } from "./harness.mjs";

const tests = service_tests();
const { page_test, api, post_report } = tests;

page_test("the archive finds, filters and deletes", { expected_statuses: [404] }, async (page) => {
  await page.goto(`${tests.url()}/#/reports`);
  const entry = page.locator(`.entry[data-id="${tests.report_id()}"]`);
  await entry.waitFor();
  await page.waitForFunction(() => document.querySelector(".thumb img")?.naturalWidth > 0);
  await assert_accessible(page, "the archive");
  await page.getByLabel("Search reports").fill("nothing has this title");
  await page.getByText("No report matches.").waitFor();
  await page.getByLabel("Search reports").fill("NEEDLE-7");
  await entry.waitFor();
  assert.equal(await page.locator(".entry").count(), 1);
  await page.getByLabel("Status").selectOption("failed");
  await page.getByText("No report matches.").waitFor();
  await page.getByLabel("Status").selectOption("");
  await entry.waitFor();
  page.once("dialog", (dialog) => dialog.dismiss());
  await entry.getByRole("button", { name: "Delete" }).click();
  assert.equal((await api(`/reports/${tests.report_id()}`)).status, "done", "nothing is deleted without consent");
  page.once("dialog", (dialog) => dialog.accept());
  await entry.getByRole("button", { name: "Delete" }).click();
  await entry.waitFor({ state: "detached" });
  assert.equal((await fetch(`${tests.url()}/api/v1/reports/${tests.report_id()}`)).status, 404);
  await page.goto(`${tests.url()}/#/reports/${tests.report_id()}`);
  await page.getByText("No such report").waitFor();
});

page_test("the archive loads more, page by page", {}, async (page) => {
  const spec = {
    scene: { type: "layers", layers: [{ depth: 0.5 }] },
    image: { width: 1, height: 1 },
    methods: ["b2f"],
    timing: { rounds: 1 },
  };
  for (let index = 0; index < 22; ++index) {
    await post_report({ ...spec, title: `Many ${index}` }, { Prefer: "wait=60" });
  }
  await page.goto(`${tests.url()}/#/reports`);
  const found = page.waitForResponse(/\?.*q=Many/);
  await page.getByLabel("Search reports").fill("Many");
  await found;
  await page.waitForFunction(() => document.querySelectorAll(".entry").length === 20);
  await page.getByRole("button", { name: "Load more" }).click();
  await page.waitForFunction(() => document.querySelectorAll(".entry").length === 22);
  const titles = await page.locator(".entry-title").allTextContents();
  assert.deepEqual(
    titles,
    Array.from({ length: 22 }, (_, index) => `Many ${21 - index}`),
  );
  assert.equal(await page.getByRole("button", { name: "Load more" }).isVisible(), false);
});
