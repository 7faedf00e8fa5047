// Every control of every view is reached by Tab, shows that it has the focus, and works by keys.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { CROWDED, field, service_tests } from "./harness.mjs";
import { assert_walkable, watch_listeners } from "./keyboard.mjs";

const tests = service_tests();
const { api, post_report } = tests;

/** A test whose pages know what listens to clicks. */
function walk_test(name, options, body) {
  tests.page_test(name, options, async (page) => {
    await watch_listeners(page);
    await body(page);
  });
}

async function open(page, address, there) {
  await page.goto("about:blank");
  await page.goto(`${tests.url()}/${address}`);
  await page.locator(there).first().waitFor({ state: "attached" });
}

async function finished(spec) {
  const report = await post_report(spec, { Prefer: "wait=60" });
  assert.equal(report.status, "done", JSON.stringify(report));
  return report;
}

/** What a summary opens; the browser does that for Enter and Space. */
const open_all = (page, selector) =>
  page.$$eval(selector, (all) => {
    for (const one of all) one.open = true;
  });

const SMALL = {
  image: { width: 16, height: 16 },
  scene: { type: "quads", count: 4, shading: "1-texture", texture: { size: 8 } },
  methods: ["b2f", "f2b", "unsorted"],
  baseline: "b2f",
  timing: { rounds: 1 },
};

walk_test("the walk finds what cannot be reached and what hides its focus", {}, async (page) => {
  await open(page, "#/nothing", "h1");
  await page.evaluate(() => {
    const span = document.querySelector("h1").appendChild(document.createElement("span"));
    span.textContent = "only for the mouse";
    span.addEventListener("click", () => {});
    const hidden = document.querySelector("main").appendChild(document.createElement("button"));
    hidden.textContent = "without a ring";
    hidden.style.outline = "none";
  });
  await assert.rejects(assert_walkable(page, "a spoilt page"), (error) =>
    ["“only for the mouse” listens to clicks", "“without a ring” does not show the focus"].every((text) =>
      error.message.includes(text),
    ),
  );
});

walk_test("the start page, the page of the API and one that is not there", {}, async (page) => {
  await open(page, "", ".start-card .chip");
  await assert_walkable(page, "the start page");
  await open(page, "api.html", "details.api-item");
  await page.locator("details#acceptReport > summary").press("Enter");
  await page.locator("details#acceptReport pre").last().waitFor();
  await assert_walkable(page, "the page of the API");
  await open(page, "#/nothing", "h1");
  await assert_walkable(page, "a page that is not there");
});

walk_test("the form, its optional parts and its JSON", { expected_statuses: [422] }, async (page) => {
  await open(page, "#/new", field("/title"));
  await page.getByRole("button", { name: "+ Add a check" }).press("Enter");
  await page.getByRole("button", { name: "+ Add a sweep" }).press("Space");
  await open_all(page, "main details");
  await assert_walkable(page, "the form");
  await page.getByRole("tab", { name: "Form" }).press("ArrowRight");
  assert.ok(await page.getByLabel("Spec as JSON").isVisible());
  await assert_walkable(page, "a spec as JSON");
  await page.getByRole("tab", { name: "Spec" }).press("ArrowLeft");
  assert.ok(await page.locator(field("/title")).isVisible());
});

walk_test("a report in each arrangement and with each kind of picture", {}, async (page) => {
  const report = `#/reports/${tests.report_id()}`;
  const kinds = ["color", "difference", "flip", "overdraw", "shaded"];
  for (const [index, kind] of kinds.entries()) {
    const layout = ["grid", "slider", "flip"][index % 3];
    await open(page, `${report}?mode=${kind}&layout=${layout}`, ".pane-view");
    await assert_walkable(page, `${kind} in ${layout}`);
  }
  await open(page, `${report}?pixel=${CROWDED.x},${CROWDED.y}`, ".pane-view");
  await open_all(page, "main details:not(.menu)");
  await page.locator(".pane-view").first().press("Enter");
  await page.locator("table.pixel-stack").waitFor();
  await open_all(page, "main details.menu");
  await assert_walkable(page, "a report with everything open");
  await page.locator("details.menu[open] > summary").first().press("Escape");
  assert.equal(await page.locator(".report-head details.menu[open]").count(), 0);
});

walk_test("the line between two pictures is moved by arrows", {}, async (page) => {
  await open(page, `#/reports/${tests.report_id()}?layout=slider`, ".divider");
  const divider = page.getByRole("slider", { name: "Line between the two pictures" });
  const keys = { ArrowRight: 51, PageDown: 41, Home: 0, End: 100, ArrowLeft: 99 };
  for (const [key, share] of Object.entries(keys)) {
    await divider.press(key);
    assert.equal(Number(await divider.getAttribute("aria-valuenow")), share, key);
  }
});

walk_test("a sweep: a point is chosen in a chart and in the grid", {}, async (page) => {
  const sweep = [
    { pointer: "/scene/count", values: [4, 16] },
    { pointer: "/image/width", values: [16, 32] },
  ];
  const report = await finished({ ...SMALL, sweep });
  await open(page, `#/reports/${report.id}`, ".charts path.line");
  await page.getByText("Values as a table").press("Enter");
  await page.locator("table.sweep td").first().waitFor();
  await assert_walkable(page, "a report of a sweep");
  const count = page.locator(".point-row").getByLabel("count");
  const plot = page.locator(".charts .plot").first();
  for (const [key, stop] of [
    ["ArrowLeft", "0"],
    ["ArrowRight", "1"],
  ]) {
    for (let i = 0; i < 2; ++i) await plot.press(key);
    assert.ok((await page.locator(".chart-readout:visible").count()) > 0);
    await plot.press("Enter");
    assert.equal(await count.inputValue(), stop);
  }
  const cell = page.locator("table.heat button[aria-pressed=false]").first();
  const value = await cell.getAttribute("data-value");
  await cell.press("Enter");
  assert.equal(await page.locator("table.heat [aria-pressed=true]").getAttribute("data-value"), value);
});

walk_test("the archive, a diff, a trend and the baselines", {}, async (page) => {
  const [first, second] = [await finished(SMALL), await finished(SMALL)];
  await open(page, "#/reports", ".entry");
  for (const { id } of [first, second]) await page.locator(`.entry[data-id="${id}"] input`).press("Space");
  await page.getByText("Two reports of the same spec are chosen.").waitFor();
  await page.getByRole("button", { name: "f2b", exact: true }).first().press("Enter");
  await page.getByRole("button", { name: "Remove the filter f2b" }).waitFor();
  await assert_walkable(page, "the archive");
  await page.getByRole("button", { name: "Compare", exact: true }).press("Enter");
  await page.locator("table.diff tbody tr").first().waitFor();
  await page.locator(".pane-view").first().waitFor();
  await assert_walkable(page, "a diff");
  await open(page, `#/trends/${second.spec_sha256}`, ".trend-mark");
  await assert_walkable(page, "a trend");
  await open(page, "#/baselines", "h1");
  await assert_walkable(page, "no baselines");
  await fetch(`${tests.url()}/api/v1/baselines/keys`, {
    method: "PUT",
    body: JSON.stringify({ report: first.id }),
    headers: { "Content-Type": "application/json" },
  });
  await open(page, "#/baselines", ".baseline");
  await assert_walkable(page, "the baselines");
  await open(page, `#/reports/${first.id}`, ".pane-view");
  await page.getByLabel("More").press("Enter");
  await page.getByRole("button", { name: "Accept as baseline…" }).press("Enter");
  await page.getByRole("dialog", { name: "Accept as baseline" }).waitFor();
  await assert_walkable(page, "the acceptance of a report");
  await page.keyboard.press("Escape");
  assert.equal(await page.getByRole("dialog").count(), 0);
  assert.equal((await api("/baselines")).baselines.length, 1);
});

walk_test(
  "the keys of the viewer, a report that fills the window, and the file",
  { origin: undefined },
  async (page) => {
    await open(page, `#/reports/${tests.report_id()}?layout=flip`, ".pane-view");
    await page.keyboard.press("?");
    const sheet = page.getByRole("dialog", { name: "Keys of the viewer" });
    await sheet.getByRole("button", { name: "Close" }).press("Enter");
    assert.equal(await sheet.isVisible(), false);
    const file = join(tests.folder(), "keyboard.html");
    writeFileSync(file, await (await fetch(`${tests.url()}/api/v1/reports/${tests.report_id()}/report.html`)).text());
    await page.goto(`file://${file}`);
    await page.locator(".pane-view").first().waitFor();
    await assert_walkable(page, "the self-contained file");
  },
);

// Last: from here on the service asks for a token.
walk_test("the question for a token", { expected_statuses: [401] }, async (page) => {
  const made = spawnSync(
    process.env.SHEER,
    ["token", "create", "me", "--scope", "submit", "--data", join(tests.folder(), "data")],
    { encoding: "utf8" },
  );
  assert.equal(made.status, 0);
  await page.goto(tests.url());
  const dialog = page.getByRole("dialog", { name: "This service asks for a token" });
  await dialog.getByLabel("Token").waitFor();
  await assert_walkable(page, "the question for a token");
  await dialog.getByLabel("Token").fill(made.stdout.trim());
  await page.keyboard.press("Enter");
  await page.locator(".start-card").first().waitFor();
});
