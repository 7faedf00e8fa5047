// Sweeps, the frontier and repeated tables: from the form to the report, with a real service.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { assert_accessible, at, field, service_tests } from "./harness.mjs";

const RENDER_MS = 90_000;
const tests = service_tests();
const { page_test, api, post_report } = tests;

const SPEC = {
  title: "Two counts",
  image: { width: 32, height: 32 },
  scene: { type: "quads", count: 4, shading: "1-texture", texture: { size: 16 } },
  methods: ["b2f", "f2b", { id: "f2bd", threshold: 0.2, label: "early" }],
  baseline: "b2f",
  timing: { rounds: 3 },
  sweep: [{ pointer: "/scene/count", values: [4, 64] }],
};

const json_of = async (page) => {
  await page.getByRole("tab", { name: "Spec" }).click();
  const spec = JSON.parse(await page.getByLabel("Spec as JSON").inputValue());
  await page.getByRole("tab", { name: "Form" }).click();
  return spec;
};

/** A chart is drawn once it has a width, shortly after it is added to the page. */
async function assert_lines(charts, count) {
  const lines = charts.locator("path.line");
  await lines.nth(count - 1).waitFor({ state: "attached" });
  assert.equal(await lines.count(), count);
}

page_test("a sweep is written in the form, run and shown", {}, async (page) => {
  await page.goto(`${tests.url()}/#/new`);
  await page.getByRole("tab", { name: "Spec" }).click();
  const { sweep, ...single } = SPEC;
  await page.getByLabel("Spec as JSON").fill(JSON.stringify(single));
  await page.getByRole("tab", { name: "Form" }).click();
  await page.getByRole("button", { name: "+ Add a sweep" }).click();
  assert.equal(await page.locator(`${field("/sweep/0/pointer")} select`).inputValue(), "/scene/count");
  await page.locator(`${field("/sweep/0/values")} input`).fill("4, 64");
  await page.getByText("The spec is valid.").waitFor();
  assert.deepEqual((await json_of(page)).sweep, sweep);
  await assert_accessible(page, "a form with a sweep");
  await page.getByRole("button", { name: "Run comparison" }).click();
  await page.locator("article.report").waitFor({ timeout: RENDER_MS });
  const report = await api(`/reports/${new URL(page.url()).hash.split("/").pop()}`);
  assert.deepEqual(
    report.runs.map((run) => run.point),
    [{ "/scene/count": 4 }, { "/scene/count": 64 }],
  );

  const point = page.getByLabel("count", { exact: true });
  assert.deepEqual(await point.locator("option").allTextContents(), ["count 4", "count 64"]);
  const submitted = () =>
    page.locator("table.fragments [data-path='fragments.submitted']").first().getAttribute("data-value");
  await point.selectOption({ label: "count 4" });
  assert.equal(Number(await submitted()), report.runs[0].results[0].fragments.submitted);
  await point.selectOption({ label: "count 64" });
  assert.equal(Number(await submitted()), report.runs[1].results[0].fragments.submitted);

  const speedup = page.locator("figure.chart", { hasText: "Speed-up" });
  await speedup.locator(".plot").focus();
  for (const key of ["ArrowRight", "ArrowLeft", "Enter"]) await page.keyboard.press(key);
  assert.equal(await point.inputValue(), "0", "Enter shows the point");
  await assert_lines(speedup, SPEC.methods.length);

  await page.getByText("Values as a table").click();
  for (const run of report.runs) {
    for (const result of run.results) {
      const row = `table.sweep tr[data-stop='${run.point["/scene/count"]}'][data-label='${result.label}']`;
      for (const path of ["speedup.value", "timing.median", "metrics.flip.mean", "fragments.shaded"]) {
        const shown = await page.locator(`${row} [data-path='${path}']`).getAttribute("data-value");
        assert.equal(Number(shown), at(result, path), `${row} ${path}`);
      }
    }
  }
  await assert_accessible(page, "a report of a sweep");
});

page_test("the chart draws the report's values at the right places", { origin: undefined }, async (page) => {
  const report = await post_report(SPEC, { Prefer: "wait=60" });
  assert.equal(report.status, "done", JSON.stringify(report));
  await page.goto(`${tests.url()}/#/reports/${report.id}?run=0`);
  await page.getByLabel("Metric of the chart").selectOption("fragments.submitted");
  const chart = page.locator("figure.chart", { has: page.getByLabel("Metric of the chart") });
  await chart.locator("path.marker").first().waitFor();
  const drawn = await chart.locator(".plot").evaluate((plot) => ({
    marks: [...plot.querySelectorAll("path.marker")].map((mark) =>
      /\(([\d.]+) ([\d.]+)\)/.exec(mark.getAttribute("transform")).slice(1).map(Number),
    ),
    ticks: [...plot.querySelectorAll("text[text-anchor=end]")].map((text) => [
      Number(text.textContent),
      Number(text.getAttribute("y")),
    ]),
  }));
  const [low, high] = [drawn.ticks[0], drawn.ticks.at(-1)];
  const counts = report.runs.map((run) => run.results[0].fragments.submitted);
  const is_log = Math.max(...counts) / Math.min(...counts) > 10;
  const map = is_log ? Math.log : (value) => value;
  const share = (value) => (map(value) - map(low[0])) / (map(high[0]) - map(low[0]));
  counts.forEach((count, index) => {
    const expected = low[1] + share(count) * (high[1] - low[1]);
    assert.ok(
      Math.abs(drawn.marks[index][1] - expected) < 0.01,
      `${count} at ${drawn.marks[index][1]}, not ${expected}`,
    );
  });
  assert.ok(drawn.marks[0][0] < drawn.marks[1][0], "more quads lie further right");

  const { frontier } = report.runs[0];
  const section = page.getByRole("region", { name: "Speed versus error" });
  await section.locator("path.marker").first().waitFor();
  assert.deepEqual(await section.locator("li").allTextContents(), frontier.sentences);
  const grey = await section.locator("text.name.grey").allTextContents();
  assert.deepEqual(grey.sort(), frontier.dominated.map((entry) => entry.method).sort());

  const file = join(tests.folder(), "sweep.html");
  writeFileSync(file, await (await fetch(`${tests.url()}/api/v1/reports/${report.id}/report.html`)).text());
  await page.context().setOffline(true);
  await page.goto(`file://${file}`);
  await page.getByLabel("count", { exact: true }).selectOption({ label: "count 64" });
  await assert_lines(page.locator("figure.chart"), 3 * SPEC.methods.length);
});

page_test("errors in a sweep are shown at their fields", { expected_statuses: [422] }, async (page) => {
  await page.goto(`${tests.url()}/#/new`);
  await page.getByRole("tab", { name: "Spec" }).click();
  const sweep = [
    { pointer: "/scene/nothing", values: [1] },
    { pointer: "/scene/count", values: [4, -1] },
  ];
  await page.getByLabel("Spec as JSON").fill(JSON.stringify({ ...SPEC, sweep }));
  await page.getByRole("tab", { name: "Form" }).click();
  const said = (pointer) => page.locator(`${field(pointer)} > .error-text:not([hidden])`);
  await said("/sweep/0/pointer").waitFor();
  assert.match(await said("/sweep/0/pointer").textContent(), /no such field/);
  await page.getByRole("button", { name: "Remove sweep 1" }).click();
  await said("/sweep/0").waitFor();
  assert.match(await said("/sweep/0").textContent(), /count/);
  await page.locator(`${field("/sweep/0/values")} input`).fill("");
  await said("/sweep/0/values").waitFor();
  await assert_accessible(page, "a form with a wrong sweep");
  await page.getByRole("button", { name: "Remove sweep 1" }).click();
  await page.getByText("The spec is valid.").waitFor();
  assert.equal((await json_of(page)).sweep, undefined);
});

page_test("a published table is repeated and shown beside the published figures", {}, async (page) => {
  await page.goto(`${tests.url()}/#/new`);
  const chooser = page.getByRole("group", { name: "Measure a suite" });
  await chooser.getByLabel("Measure a suite").selectOption("paper-table-4");
  await chooser.getByLabel("Image").selectOption("0.125");
  await chooser.getByRole("button", { name: "Fill in" }).click();
  await page.getByText("The spec is valid.").waitFor();
  const spec = await json_of(page);
  const suite = (await api("/suites")).find((one) => one.id === "paper-table-4");
  assert.deepEqual(spec, { ...suite.spec, image: { ...suite.spec.image, width: 64, height: 64 } });

  const small = { ...spec, image: { width: 16, height: 16 }, timing: { rounds: 2, max_seconds: 5 } };
  small.scene = { ...spec.scene, shading: "constant", texture: { size: 16 } };
  small.sweep = [{ pointer: "/scene/count", values: [1, 16] }];
  const report = await post_report(small, { Prefer: "wait=60" });
  assert.equal(report.status, "done", JSON.stringify(report));
  await page.goto(`${tests.url()}/#/reports/${report.id}`);
  const section = page.getByRole("region", { name: "Published figures" });
  await section.waitFor();
  assert.equal(await section.locator("table.suite-figures tbody tr").count(), report.suite.figures.length);
  assert.deepEqual(
    await section.locator(".trends .verdict").allTextContents(),
    report.suite.trends.map((trend) => trend.verdict),
  );
  const [first] = report.suite.figures;
  const cells = await section.locator("tbody tr").first().locator("td").allTextContents();
  assert.equal(cells[0], first.method);
  assert.equal(Number(cells[2]), first.published);
  assert.ok(Math.abs(Number(cells[3]) / first.measured - 1) < 0.005);
  await assert_accessible(page, "a report of a suite");
});
