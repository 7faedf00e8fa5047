// The page of a program with an additional method, scene and metric (tests/made_up): it shows them like all others.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { field, service_tests, table_values } from "./harness.mjs";

const tests = service_tests(process.env.SHEER_MADE_UP);
const spec = JSON.parse(readFileSync(fileURLToPath(new URL("../made_up/specs/made-up.json", import.meta.url)), "utf8"));

tests.page_test("a report has the metric's column in its place, with the best marked", {}, async (page) => {
  const { id } = await tests.post_report(spec, { Prefer: "wait=60" });
  await page.goto(`${tests.url()}/#/reports/${id}`);
  const table = page.locator("table.differences");
  await table.waitFor();
  const heads = await table.locator("thead th").allTextContents();
  assert.equal(heads.indexOf("Rednessreds"), heads.indexOf("Max Δlevels") + 1, heads.join());
  const values = await table_values(page, "differences");
  assert.deepEqual(
    Object.entries(values).map(([label, row]) => [label, row["metrics.made_up_metric"].shown]),
    [
      ["b2f", "102"],
      ["made_up_method", "51"],
    ],
  );
  const best = table.locator('td.best[data-path="metrics.made_up_metric"]');
  assert.deepEqual(await best.evaluateAll((cells) => cells.map((cell) => cell.dataset.value)), ["102"]);
});

// The thumbnail of a scene is made by ./dev gallery; this scene has none.
const without_picture = { expected_statuses: [404] };

tests.page_test("the form offers scene, method and metric with what they describe", without_picture, async (page) => {
  await page.goto(`${tests.url()}/#/new`);
  await page.locator(`${field("/scene/type")} select`).selectOption("made_up_scene");
  assert.equal(await page.locator(`${field("/scene/veil")} input`).inputValue(), "0.4");
  await page.getByRole("button", { name: "Add Made-up method" }).click();
  assert.equal(await page.locator('[data-pointer$="/whim"] input').inputValue(), "0.25");
  await page.getByRole("button", { name: "+ Add a check" }).click();
  await page
    .locator(`${field("/checks/0/metric")} select`)
    .last()
    .selectOption("made_up_metric");
});
