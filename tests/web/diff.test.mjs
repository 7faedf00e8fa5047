// The comparison of two reports, chosen in the archive.
import assert from "node:assert/strict";
import { assert_accessible, service_tests } from "./harness.mjs";

const tests = service_tests();
const { page_test, api, post_report } = tests;
const WAIT = { Prefer: "wait=60" };

/** The report of the harness again, with other rounds. */
async function again(change = {}) {
  const { spec } = await api(`/reports/${tests.report_id()}`);
  const report = await post_report({ ...spec, timing: { ...spec.timing, rounds: 9 }, ...change }, WAIT);
  assert.equal(report.status, "done", JSON.stringify(report));
  return report;
}

page_test("two reports chosen in the archive are compared", {}, async (page) => {
  const after = await again({ title: "After" });
  await page.goto(`${tests.url()}/#/reports`);
  const box = (id) => page.locator(`.entry[data-id="${id}"] input[type=checkbox]`);
  const compare = page.getByRole("button", { name: "Compare", exact: true });
  await box(after.id).check();
  assert.equal(await compare.isDisabled(), true);
  await box(tests.report_id()).focus();
  await page.keyboard.press("Space");
  await page.getByText("Two reports of the same spec are chosen.").waitFor();
  await assert_accessible(page, "the archive with two chosen");
  await compare.focus();
  await page.keyboard.press("Enter");
  await page.waitForURL(new RegExp(`#/diff/${tests.report_id()}/${after.id}$`));
  const row = page.locator("table.diff tbody tr[data-label='f2b']");
  await row.waitFor();
  assert.equal(await row.locator(".diff-word").first().textContent(), "identical");
  const fields = await page.locator("table.diff-fields tbody tr").allTextContents();
  assert.ok(fields.includes("/spec/timing/rounds89"), fields.join());
  const diff = await api(`/reports/${tests.report_id()}/diff?against=${after.id}`);
  const { time } = diff.runs[0].results.find((result) => result.label === "f2b");
  assert.equal(Number(await row.locator("td[data-value]").nth(4).getAttribute("data-value")), time.a.median);
  assert.equal(await row.locator(".diff-verdict .diff-word").textContent(), time.verdict);
  await assert_accessible(page, "a diff");
  await page.waitForFunction(() => document.querySelectorAll(".pane").length === 2);
  await row.getByRole("button", { name: "f2b" }).click();
  assert.equal(await page.locator("label:has-text('Pictures of') select option:checked").textContent(), "f2b");
  await page.getByRole("link", { name: "Swap A and B" }).click();
  await page.waitForURL(new RegExp(`#/diff/${after.id}/${tests.report_id()}$`));
});

page_test("for a picture that changed, it is shown where", {}, async (page) => {
  // The service never renders different pictures for one spec; here its answer claims that it did.
  const other = await again({ title: "Other" });
  const { runs } = await api(`/reports/${tests.report_id()}`);
  await page.route("**/diff?**", async (route) => {
    const response = await route.fetch();
    const diff = await response.json();
    const { picture } = diff.runs[0].results[1];
    Object.assign(picture, { verdict: "different", differing_pixels: 77, greatest_levels: 5, worst_pixel: [3, 4] });
    Object.assign(picture, { flip: { mean: 0.0123, max: 0.5 }, flip_picture: runs[0].results[1].images.flip });
    diff.summary.pictures = { identical: 4, different: 1, "not examined": 0 };
    await route.fulfill({ response, json: diff });
  });
  await page.goto(`${tests.url()}/#/diff/${tests.report_id()}/${other.id}`);
  const row = page.locator("table.diff tbody tr[data-label='f2b']");
  await row.waitFor();
  await page.getByText("1 picture differs").waitFor();
  assert.match(await row.textContent(), /different0\.01230\.5\d*775/);
  // The method that changed is the one that is shown.
  assert.equal(await page.locator("label:has-text('Pictures of') select option:checked").textContent(), "f2b");
  await page.getByRole("button", { name: "FLIP", exact: true }).click();
  await page.getByText("FLIP between the two pictures").waitFor();
  await row.getByRole("button", { name: "Show pixel 3, 4" }).click();
  await page.getByText("x 3, y 4").waitFor();
});

page_test("reports of different specs are refused field by field", { expected_statuses: [404, 422] }, async (page) => {
  const other = await again({ image: { width: 32, height: 32 } });
  await page.goto(`${tests.url()}/#/diff/${tests.report_id()}/${other.id}`);
  await page.getByText("These reports cannot be compared").waitFor();
  assert.match(await page.locator(".diff-errors").textContent(), /\/spec\/image\/width is 96 .* 32/);
  assert.equal(await page.getByText("Compare anyway").count(), 0, "pictures of two sizes cannot be compared");
  await assert_accessible(page, "a diff that is refused");
  await page.goto(`${tests.url()}/#/diff/${tests.report_id()}/nothing`);
  await page.getByText("No such report").waitFor();
});

page_test("reports are compared if their differences are allowed", { expected_statuses: [422] }, async (page) => {
  const { spec } = await api(`/reports/${tests.report_id()}`);
  const other = await again({ scene: { ...spec.scene, seed: spec.scene.seed + 1 } });
  await page.goto(`${tests.url()}/#/diff/${tests.report_id()}/${other.id}`);
  await page.getByText("These reports cannot be compared").waitFor();
  assert.match(await page.locator(".diff-errors").textContent(), /^\/spec\/scene\/seed is \d+ in one report/);
  await assert_accessible(page, "a diff that can be allowed");
  await page.getByRole("link", { name: "Compare anyway" }).focus();
  await page.keyboard.press("Enter");
  const row = page.locator("table.diff tbody tr[data-label='f2b']");
  await row.waitFor();
  assert.equal(await row.locator(".diff-word").first().textContent(), "different");
  await page.getByText("they differ in /spec/scene/seed.").waitFor();
  const fields = await page.locator("table.diff-fields tbody tr").allTextContents();
  assert.ok(fields.includes(`/spec/scene/seed (allowed)${spec.scene.seed}${spec.scene.seed + 1}`), fields.join());
  await page.getByRole("button", { name: "FLIP", exact: true }).waitFor();
  await assert_accessible(page, "a diff of different specs");
  // What is allowed is part of the address.
  await page.reload();
  await row.waitFor();
  await page.getByRole("link", { name: "Swap A and B" }).click();
  await page.getByText("they differ in /spec/scene/seed.").waitFor();
  assert.match(page.url(), new RegExp(`#/diff/${other.id}/${tests.report_id()}\\?allow=`));
});
