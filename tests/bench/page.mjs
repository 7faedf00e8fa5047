// Measures what docs/results/page.md says of the page's speed and weight, with a service and a browser of its own:
// SHEER=build/release/sheer node tests/bench/page.mjs [paint] [sweep] [weight] [file] [frames] [archive]
// For the last one ARCHIVE_LOAD must name the program that fills an archive; `./dev bench page` builds it.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { loadavg, tmpdir } from "node:os";
import { join } from "node:path";
import { gzipSync } from "node:zlib";
import { start_browser, start_service } from "../web/harness.mjs";
import { measure_frames } from "./page_frames.mjs";

const REPEATS = 9;
const SWEEP_POINTS = 100;
const ARCHIVE = 10_000;
const WITH_PICTURES = 20; // more than fit in the window
const WINDOW = { width: 1280, height: 860 };

const sorted = (values) => [...values].sort((a, b) => a - b);
const median = (values) => sorted(values)[Math.floor(values.length / 2)];
const spread = (values) => {
  const all = sorted(values).map(Math.round);
  return `${Math.round(median(values))} ms (${all[0]} to ${all.at(-1)})`;
};

const browser = await start_browser();

async function post(service, spec) {
  const answer = await fetch(`${service.url}/api/v1/reports`, {
    method: "POST",
    headers: { "Content-Type": "application/json", Prefer: "wait=300" },
    body: JSON.stringify(spec),
  });
  const report = await answer.json();
  assert.equal(report.status, "done", JSON.stringify(report.error ?? report));
  return report;
}

const quads = (size, count, methods, more = {}) => ({
  image: { width: size, height: size },
  scene: { type: "quads", count, shading: "1-texture", texture: { size: 256 } },
  methods,
  baseline: methods[0],
  timing: { warmup: 1, rounds: 1 },
  ...more,
});

/** A time in the page, in ms from the navigation, once what is there now has been drawn. */
const drawn_ms = (page) =>
  page.evaluate(
    () => new Promise((resolve) => requestAnimationFrame(() => setTimeout(() => resolve(performance.now())))),
  );

/**
 * Times of a page that is opened with nothing in its cache: first paint, when `selector` is there and drawn, and the processor
 * time of the page's main thread until then, which depends less on what else the machine does.
 */
async function opened(service, path, selector) {
  const times = { paint: [], usable: [], work: [] };
  for (let i = 0; i < REPEATS; ++i) {
    const context = await browser.newContext({ viewport: WINDOW });
    const page = await context.newPage();
    const client = await context.newCDPSession(page);
    await client.send("Performance.enable", { timeDomain: "threadTicks" });
    await page.goto(service.url + path, { waitUntil: "commit" });
    await page.locator(selector).first().waitFor({ state: "attached" });
    times.usable.push(await drawn_ms(page));
    const { metrics } = await client.send("Performance.getMetrics");
    times.work.push(1000 * metrics.find(({ name }) => name === "TaskDuration").value);
    times.paint.push(await page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0].startTime));
    await context.close();
  }
  return `first paint ${spread(times.paint)}, usable ${spread(times.usable)}, own work ${spread(times.work)}`;
}

async function paint(service) {
  const report = await post(service, quads(512, 64, ["b2f", "f2b", "f2bd", "unsorted"]));
  return opened(service, `/#/reports/${report.id}`, ".pane-view");
}

async function sweep(service) {
  const values = Array.from({ length: SWEEP_POINTS }, (_, i) => i + 1);
  const axes = [{ pointer: "/scene/count", values }];
  const report = await post(service, quads(16, 1, ["b2f", "f2b", "f2bd"], { sweep: axes }));
  return opened(service, `/#/reports/${report.id}`, ".pane-view");
}

async function weight(service) {
  const report = await post(service, quads(64, 16, ["b2f", "f2bd"]));
  const page = await browser.newPage({ viewport: WINDOW });
  const files = new Map();
  page.on("response", async (response) => {
    const type = response.headers()["content-type"] ?? "";
    if (!/^image\/(png|x-exr)/.test(type)) files.set(response.url(), await response.body());
  });
  await page.goto(`${service.url}/#/reports/${report.id}`);
  await page.locator(".pane-view").first().waitFor();
  await page.waitForLoadState("networkidle");
  await page.close();
  const bytes = [...files.values()].reduce((sum, body) => sum + gzipSync(body).length, 0);
  return `${(bytes / 1000).toFixed(0)} KB compressed in ${files.size} files without pictures`;
}

async function file(service) {
  const report = await post(service, quads(512, 256, ["b2f", "f2b", "f2bd", "unsorted", "wboit", "mboit"]));
  const html = await (await fetch(`${service.url}/api/v1/reports/${report.id}/report.html`)).arrayBuffer();
  return `report.html of 6 methods at 512 × 512: ${(html.byteLength / 1e6).toFixed(1)} MB`;
}

async function frames(service) {
  const report = await post(service, quads(2048, 256, ["b2f", "unsorted"]));
  const page = await browser.newPage({ viewport: WINDOW });
  const told = await measure_frames(page, `${service.url}/#/reports/${report.id}`);
  await page.close();
  return told;
}

/** 10,000 reports made through the store's interface, and newer ones that have pictures. */
async function archive() {
  const folder = mkdtempSync(join(tmpdir(), "sheer-page-"));
  try {
    assert.ok(process.env.ARCHIVE_LOAD, "ARCHIVE_LOAD must name the program that fills an archive");
    const data = join(folder, "data");
    execFileSync(process.env.ARCHIVE_LOAD, [data, String(ARCHIVE), "1"]);
    const service = await start_service(process.env.SHEER, data);
    try {
      for (let i = 0; i < WITH_PICTURES; ++i) await post(service, quads(64, 16, ["b2f", "f2b"], { title: `New ${i}` }));
      return await opened(service, "/#/reports", ".entry img");
    } finally {
      await service.stop();
    }
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

const all = { paint, sweep, weight, file, frames, archive };
const names = process.argv.slice(2);
const service = await start_service(process.env.SHEER);
try {
  for (const [name, measure] of Object.entries(all))
    if (names.length === 0 || names.includes(name))
      console.log(`${name}: ${await measure(service)}; load ${loadavg()[0].toFixed(1)}`);
} finally {
  await browser.close();
  await service.stop();
}
