// What a report says besides its numbers: notes, reasons, verdicts, and the files that it used.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { createHash } from "node:crypto";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { plain_png, png } from "../service/pictures.mjs";
import { assert_accessible, at, service_tests } from "./harness.mjs";

const tests = service_tests();
const { page_test, api, post_report } = tests;

const FOLIAGE = {
  image: { width: 48, height: 48 },
  scene: { type: "foliage", trees: 1, planes_per_tree: 20, texture: { size: 16 } },
};

async function finished(spec) {
  const report = await post_report(spec, { Prefer: "wait=60" });
  assert.equal(report.status, "done", JSON.stringify(report));
  return report;
}

async function open_report(page, report) {
  await page.goto("about:blank"); // otherwise the previous report stays until the new one has loaded
  await page.goto(`${tests.url()}/#/reports/${report.id}`);
  await page.locator("article.report").waitFor();
}

/** The self-contained file of a report, opened without a network. */
async function open_file(page, report) {
  const file = join(tests.folder(), `${report.id}.html`);
  writeFileSync(file, await (await fetch(`${tests.url()}/api/v1/reports/${report.id}/report.html`)).text());
  await page.context().setOffline(true);
  await page.goto(`file://${file}`);
  await page.locator("article.report").waitFor();
}

/** A picture with one row more than its header says, which becomes a note when it is read. */
const NOTED = png(2, 2, 2, Array(3).fill(Buffer.from([9, 8, 7, 6, 5, 4])));

async function upload(bytes, name) {
  const answer = await fetch(`${tests.url()}/api/v1/assets?name=${name}`, {
    method: "POST",
    headers: { "Content-Type": "image/png" },
    body: bytes,
  });
  assert.equal(answer.status, 201);
  return answer.json();
}

page_test("notes are shown near the top, on the page and in the file", { origin: undefined }, async (page) => {
  const { sha256 } = await upload(NOTED, "noted.png");
  const scene = { ...FOLIAGE.scene, texture: { image: sha256, size: 16 } };
  const report = await finished({ ...FOLIAGE, scene, methods: ["b2f"], timing: { rounds: 1 } });
  assert.ok(report.notes.length > 0);
  const look = async () => {
    const section = page.getByRole("region", { name: "Notes" });
    const shown = await section.locator("li").evaluateAll((all) =>
      all.map((one) => ({
        code: one.dataset.code,
        where: one.querySelector(".where")?.textContent ?? null,
        text: one.lastElementChild.textContent,
      })),
    );
    assert.deepEqual(
      shown,
      report.notes.map(({ code, text, where }) => ({ code, where, text })),
    );
    const [notes, pictures] = [await section.boundingBox(), await page.locator("figure.pane").first().boundingBox()];
    assert.ok(notes.y < pictures.y, "the notes come before the pictures");
  };
  await open_report(page, report);
  await look();
  await page.getByText("Details", { exact: true }).click();
  const file = await page.getByRole("list", { name: "Files" }).textContent();
  assert.ok(file.includes(createHash("sha256").update(NOTED).digest("hex")), file);
  await assert_accessible(page, "a report with notes", "section.notes, .report-details");
  await open_file(page, report);
  await look();
});

page_test("a report without notes has no section for them", {}, async (page) => {
  await page.goto(`${tests.url()}/#/reports/${tests.report_id()}`);
  await page.locator("article.report").waitFor();
  assert.deepEqual((await api(`/reports/${tests.report_id()}`)).notes, []);
  assert.equal(await page.getByRole("region", { name: "Notes" }).count(), 0);
});

page_test("a method that cannot run says why, and the others are shown", {}, async (page) => {
  const sorted = { id: "exact", form: "sorted", label: "lists in order" };
  const report = await finished({ ...FOLIAGE, methods: ["b2f", sorted], timing: { rounds: 1 } });
  const [, result] = report.runs[0].results;
  assert.equal(result.status, "unsupported");
  await open_report(page, report);
  assert.equal(await page.locator("figure.pane").count(), 2);
  for (const table of ["timings", "fragments", "differences"]) {
    const row = page.locator(`table.${table} tr`, { has: page.getByText("lists in order") });
    assert.match(await row.textContent(), /unsupported/);
    assert.ok((await row.textContent()).includes(result.reason), table);
  }
  assert.ok((await page.locator(".viewer").textContent()).includes(result.reason), "where its picture would be");
  await assert_accessible(page, "a report with a method that cannot run", ".viewer, table.results");
});

/** Values of the marked cells of a table: [{label, path}]. */
const marked = (page) =>
  page.$$eval("table.results td.best", (cells) =>
    cells.map((cell) => ({ label: cell.closest("tr").dataset.label, path: cell.dataset.path })),
  );

/** Labels of the methods whose names are bold in the chart of speed versus error. */
async function bold_names(page) {
  const chart = page.getByRole("region", { name: "Speed versus error" });
  await chart.locator("path.marker").first().waitFor();
  return chart
    .locator("text.name")
    .evaluateAll((all) =>
      all.filter((one) => Number(getComputedStyle(one).fontWeight) >= 600).map((one) => one.textContent),
    );
}

page_test("no unresolved time is marked", {}, async (page) => {
  const methods = ["b2f", "f2b", { id: "b2f", label: "the same" }, { id: "f2bd", threshold: 0.5 }, "unsorted"];
  const scene = { type: "quads", count: 64, shading: "4-textures", texture: { size: 64 } };
  for (const rounds of [1, 3, 12]) {
    const report = await finished({ image: { width: 64, height: 64 }, scene, methods, timing: { rounds } });
    await open_report(page, report);
    const { results } = report.runs[0];
    const times = (await marked(page)).filter(({ path }) => /^(timing|speedup)/.test(path));
    for (const { label, path } of times) {
      const { speedup } = results.find((result) => result.label === label);
      assert.equal(speedup.verdict, "faster", `${label} ${path} after ${rounds} rounds`);
      assert.ok(speedup.ci95[0] > 1);
    }
    const named = await bold_names(page);
    const of_table = times.filter(({ path }) => path === "timing.median").map(({ label }) => label);
    assert.deepEqual(named.sort(), of_table.sort(), "the chart and the table name the same");
    if (report.runs[0].frontier.fastest) assert.deepEqual(of_table, report.runs[0].frontier.fastest.toSorted());
    if (rounds < 8) {
      assert.deepEqual(times, [], "without intervals nothing is resolved");
      assert.match(await page.locator("table.timings").textContent(), /too few rounds/);
    }
    const words = page.locator("table.timings tr[data-label] .verdict-word.faster");
    const faster = results.filter(({ speedup }) => speedup.verdict === "faster").length;
    assert.ok((await words.count()) >= faster);
    if (faster === 0) assert.equal(await words.count(), 0);
  }
});

page_test("equal values of a column are all marked", {}, async (page) => {
  await page.goto(`${tests.url()}/#/reports/${tests.report_id()}`);
  await page.locator("article.report").waitFor();
  const columns = await page.$$eval("table.differences td[data-path]", (cells) => {
    const all = {};
    for (const cell of cells)
      (all[cell.dataset.path] ??= []).push({ text: cell.childNodes[0].textContent, best: cell.matches(".best") });
    return all;
  });
  assert.ok(Object.keys(columns).length > 5);
  for (const [path, cells] of Object.entries(columns)) {
    const best = new Set(cells.filter((cell) => cell.best).map(({ text }) => text.replace("−", "")));
    for (const { text, best: is_best } of cells)
      assert.equal(best.has(text.replace("−", "")), is_best, `${path}: ${text} is marked like its equals`);
    assert.ok(
      cells.some((cell) => !cell.best),
      `${path}: not everything is best`,
    );
  }
  const { results } = (await api(`/reports/${tests.report_id()}`)).runs[0];
  assert.ok(results.some((result) => at(result, "metrics.flip.mean") > 0));
});

page_test(
  "the finished parts of an interrupted comparison are shown, and how it ended",
  { origin: undefined },
  async (page) => {
    const folder = mkdtempSync(join(tests.folder(), "early-"));
    writeFileSync(join(folder, "a.png"), plain_png(2, [40, 160, 80]));
    const spec = {
      image: { width: 16, height: 16 },
      scene: { type: "quads", count: 4, shading: "1-texture", texture: { image: "a.png", size: 8 } },
      methods: ["b2f", "f2b"],
      timing: { rounds: 1 },
      sweep: [{ pointer: "/scene/texture/image", values: ["a.png", "missing.png"] }],
      checks: [{ metric: "flip.mean", method: "f2b", max: 1 }],
    };
    writeFileSync(join(folder, "spec.json"), JSON.stringify(spec));
    const run = spawnSync(process.env.SHEER, ["compare", "spec.json", "--out", "out"], { cwd: folder });
    assert.equal(run.status, 2, String(run.stderr));
    const report = JSON.parse(readFileSync(join(folder, "out", "report.json")));
    assert.deepEqual(report.points, { asked: 2, done: 1 });
    await page.goto(`file://${join(folder, "out", "report.html")}`);
    await page.locator("article.report").waitFor();
    assert.equal(await page.locator(".title-line .verdict").textContent(), "Failed", "its checks passed");
    assert.ok((await page.getByRole("alert").textContent()).includes(report.error.detail));
    assert.match(await page.getByRole("region", { name: "Notes" }).textContent(), /Only 1 of 2 points/);
    assert.match(await page.locator(".report-head").textContent(), /a\.png/);
    assert.equal(await page.locator("figure.pane").count(), 3);
    await assert_accessible(page, "a report that is not whole");
  },
);

page_test("what looks change and with which report it was compared is shown", { origin: undefined }, async (page) => {
  const layers = [{ rect: [0, 0, 1, 1], depth: 0.5, color: [1, 0, 0], alpha: 0.5 }];
  const spec = {
    image: { width: 16, height: 16 },
    scene: { type: "layers", layers },
    methods: ["b2f", { id: "b2f", label: "new", shading: { glsl: "return vec4(tint.rgb * 0.5, tint.a);" } }],
    timing: { rounds: 1 },
    against: "baseline:page",
    tolerance: { max_slowdown: 1000 },
  };
  const first = await finished(spec);
  await fetch(`${tests.url()}/api/v1/baselines/page`, {
    method: "PUT",
    body: JSON.stringify({ report: first.id }),
    headers: { "Content-Type": "application/json" },
  });
  const report = await finished(spec);
  await open_report(page, report);
  const changes = page.getByRole("region", { name: "Changes" });
  assert.match(
    await changes.locator("li").innerText(),
    /^b2f → new: the picture differs, mean FLIP 0\.\d+, 256 pixels; speed /,
  );
  const checks = page.getByRole("region", { name: "Checks" });
  assert.match(
    await checks.locator(".against").innerText(),
    new RegExp(`^compared with ${first.id} of page, accepted`),
  );
  await assert_accessible(page, "what looks change", "section.checks");
  await fetch(`${tests.url()}/api/v1/baselines/page`, { method: "DELETE" });
});

const COLORED = (glsl, more = {}) => ({
  title: "Colored",
  image: { width: 48, height: 48 },
  scene: { type: "quads", count: 4, shading: { glsl } },
  methods: ["b2f", "f2b"],
  timing: { rounds: 1 },
  ...more,
});

page_test(
  "a report is accepted, one compared with it opens on what changed, and it is forgotten",
  { expected_statuses: [422] },
  async (page) => {
    const accepted = await finished(COLORED("return tint;"));
    await open_report(page, accepted);
    await page.getByLabel("More").click();
    await page.getByRole("button", { name: "Accept as baseline…" }).click();
    const dialog = page.getByRole("dialog", { name: "Accept as baseline" });
    await dialog.getByLabel("Name").fill("a/b");
    await dialog.getByRole("button", { name: "Accept", exact: true }).click();
    await dialog.getByText("The name").waitFor();
    await dialog.getByLabel("Name").fill("web");
    await dialog.getByLabel("Why").fill("it is right");
    await dialog.getByRole("button", { name: "Accept", exact: true }).click();
    const section = page.locator(".baseline[data-name=web]");
    await section.getByText("it is right").waitFor();
    await assert_accessible(page, "the baselines");

    const against = { against: "baseline:web", under_test: ["/scene/shading/glsl"] };
    const same = await finished(COLORED("return tint;", against));
    await open_report(page, same);
    const panel = page.getByRole("region", { name: "What changed" });
    await panel.getByText("No picture changed").waitFor();
    const changed = await finished(COLORED("return vec4(tint.rgb * 0.5, tint.a);", against));
    await open_report(page, changed);
    await panel.getByText(/^b2f: another picture, mean FLIP 0\.\d+/).waitFor();
    const top = (locator) => locator.evaluate((node) => node.getBoundingClientRect().top);
    assert.ok((await top(panel)) < (await top(page.locator("article.report"))));
    assert.match(await panel.textContent(), /In the spec: \/scene\/shading\/glsl/);
    await assert_accessible(page, "a report compared with a baseline", ".changed-panel");
    await panel.getByRole("link").click();
    await page.locator("h1", { hasText: "Colored" }).or(page.getByText("FLIP mean")).first().waitFor();
    assert.match(page.url(), /#\/diff\/.*allow=/);

    await page.getByRole("link", { name: "Baselines" }).click();
    page.once("dialog", (question) => question.accept());
    await section.getByRole("button", { name: "Forget Colored" }).click();
    await page.getByText("No report is accepted yet.").waitFor();
    assert.deepEqual((await api("/baselines")).baselines, []);
  },
);
