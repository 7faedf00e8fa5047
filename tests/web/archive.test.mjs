// The list of reports, tested with a real service.
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
  // Behind one that takes long they wait, and are cancelled before anything is rendered.
  const long = { ...spec, image: { width: 512, height: 512 }, timing: { rounds: 1000, max_seconds: 600 } };
  const { id } = await post_report(long);
  const cancel = (of) => fetch(`${tests.url()}/api/v1/reports/${of}`, { method: "DELETE" });
  for (let index = 0; index < 102; ++index) await cancel((await post_report({ ...spec, title: `Many ${index}` })).id);
  await cancel(id);
  await page.goto(`${tests.url()}/#/reports`);
  const found = page.waitForResponse(/\?.*q=Many/);
  await page.getByLabel("Search reports").fill("Many");
  await found;
  await page.waitForFunction(() => document.querySelectorAll(".entry").length === 100);
  await page.getByRole("button", { name: "Load more" }).click();
  await page.waitForFunction(() => document.querySelectorAll(".entry").length === 102);
  await page.getByText("102 reports match").waitFor();
  const titles = await page.locator(".entry-title").allTextContents();
  assert.deepEqual(
    titles,
    Array.from({ length: 102 }, (_, index) => `Many ${101 - index}`),
  );
  assert.equal(await page.getByRole("button", { name: "Load more" }).isVisible(), false);
});

const refused = { expected_statuses: [422] };
page_test("the archive keeps filters and choice in the address, and follows what is running", refused, async (page) => {
  const spec = {
    scene: { type: "layers", layers: [{ depth: 0.5 }] },
    image: { width: 1, height: 1 },
    methods: ["b2f"],
    timing: { rounds: 1 },
  };
  const posted = [];
  for (const width of [1, 1, 2])
    posted.push(
      await post_report(
        { ...spec, title: "Twin", image: { width, height: 1 }, tags: { set: "address" } },
        { Prefer: "wait=60" },
      ),
    );
  const other = await post_report({ ...spec, title: "Stranger", methods: ["f2b"] }, { Prefer: "wait=60" });
  await page.goto(`${tests.url()}/#/reports?q=address`);
  await page.getByText("3 reports match").waitFor();
  const box = (id) => page.locator(`.entry[data-id="${id}"] input`);
  await box(posted[0].id).check();
  await box(posted[2].id).check();
  await page.getByText("/spec/image/width is 1 in one report and 2 in the other").waitFor();
  assert.equal(await page.getByRole("button", { name: "Compare" }).isDisabled(), true);
  await box(posted[2].id).uncheck();
  await box(posted[1].id).check();
  await page.getByText("Two reports of the same spec are chosen.").waitFor();
  await page.waitForURL((url) => posted.slice(0, 2).every(({ id }) => url.href.includes(id)));
  await page.reload();
  await page.getByText("Two reports of the same spec are chosen.").waitFor();
  await assert_accessible(page, "the archive with a choice");
  await page.getByRole("button", { name: "Compare" }).click();
  await page.waitForURL(new RegExp(`#/diff/${posted[0].id}/${posted[1].id}`));
  await page.goBack();
  await page.getByText("Two reports of the same spec are chosen.").waitFor();
  await page.getByRole("button", { name: "Remove the filter address" }).click();
  await page.getByLabel("Method").selectOption("f2b");
  await page.waitForURL(/method=f2b/);
  await page.locator(`.entry[data-id="${other.id}"]`).waitFor();
  await page.goto(`${tests.url()}/#/reports?q=Slow`);
  await page.getByText("No report matches.").waitFor();
  const slow = await post_report({
    ...spec,
    title: "Slow one",
    image: { width: 256, height: 256 },
    scene: { type: "quads", count: 64 },
    timing: { rounds: 1000, max_seconds: 4 },
  });
  await page.goto(`${tests.url()}/#/reports`);
  const row = page.locator(`.entry[data-id="${slow.id}"]`);
  await row.locator(".status").waitFor();
  await row.getByText("no checks").waitFor({ timeout: 60_000 });
});

page_test("the trend of a spec shows where it changed, and a click compares around that", {}, async (page) => {
  const spec = {
    title: "Trend",
    scene: { type: "layers", layers: [{ depth: 0.5 }] },
    image: { width: 1, height: 1 },
    methods: ["b2f"],
    timing: { rounds: 1 },
  };
  const first = await post_report(spec, { Prefer: "wait=60" });
  await page.goto(`${tests.url()}/#/trends/${first.spec_sha256}`);
  await page.getByText("A trend begins with the second report").waitFor();
  const second = await post_report(spec, { Prefer: "wait=60" });
  await page.goto(`${tests.url()}/#/reports/${second.id}`);
  await page.getByRole("link", { name: "Trend of this spec" }).click();
  await page.getByText("2 reports on").waitFor();
  await page.getByText("No change of its level was found.").waitFor();
  assert.equal(await page.locator(".trend-mark").count(), 2);
  await page.getByLabel("Metric").selectOption("fragments.shaded");
  await page.waitForURL(/metric=fragments.shaded/);
  // A change needs more reports than a test can render.
  await page.route(/\/api\/v1\/trends/, async (route) => {
    const trend = await (await route.fetch()).json();
    const level = (median) => ({ median, low: median, high: median, reports: 1 });
    trend.change_points = [
      { before: first.id, after: second.id, index: 1, level_before: level(2), level_after: level(3), p: 0.005 },
    ];
    await route.fulfill({ json: trend });
  });
  await page.reload();
  await page.locator(".trend-changes li").getByText("2 → 3 (× 1.5)").waitFor();
  await assert_accessible(page, "a trend");
  await page.locator(".trend-change").click();
  await page.waitForURL(new RegExp(`#/diff/${first.id}/${second.id}`));
});
