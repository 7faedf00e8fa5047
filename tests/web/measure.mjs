// Measures what docs/page.md says of the page's speed and weight, with a service and a browser of its own:
// SHEER=build/release/sheer node tests/web/measure.mjs [paint] [sweep] [archive] [frames] [weight] [file]
import assert from "node:assert/strict";
import { gzipSync } from "node:zlib";
import { start_browser, start_service } from "./harness.mjs";

const REPEATS = 5;
const ARCHIVE = 10_000;
const AT_ONCE = 16;
const WINDOW = { width: 1280, height: 860 };

const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
const p95 = (values) => [...values].sort((a, b) => a - b)[Math.ceil(values.length * 0.95) - 1];
const ms = (value) => `${Math.round(value)} ms`;

const service = await start_service(process.env.SHEER);
const browser = await start_browser();

async function post(spec, wait = true) {
  const answer = await fetch(`${service.url}/api/v1/reports`, {
    method: "POST",
    headers: { "Content-Type": "application/json", ...(wait ? { Prefer: "wait=600" } : {}) },
    body: JSON.stringify(spec),
  });
  const { id } = await answer.json();
  for (;;) {
    const report = await (await fetch(`${service.url}/api/v1/reports/${id}`)).json();
    if (!wait || report.status === "done") return report;
    assert.ok(["queued", "running"].includes(report.status), JSON.stringify(report.error));
    await new Promise((resolve) => setTimeout(resolve, 500));
  }
}

const quads = (size, count, methods, more = {}) => ({
  image: { width: size, height: size },
  scene: { type: "quads", count, shading: "1-texture", texture: { size: 256 } },
  methods,
  baseline: methods[0],
  timing: { warmup: 1, rounds: 1 },
  ...more,
});

/** Times of a page that is opened with nothing in its cache: first paint, and when `selector` is there and drawn. */
async function opened(path, selector) {
  const times = { paint: [], usable: [] };
  for (let i = 0; i < REPEATS; ++i) {
    const context = await browser.newContext({ viewport: WINDOW });
    const page = await context.newPage();
    await page.goto(service.url + path);
    await page.locator(selector).first().waitFor({ state: "attached" });
    const usable = await page.evaluate(
      () => new Promise((resolve) => requestAnimationFrame(() => setTimeout(() => resolve(performance.now())))),
    );
    const paint = await page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0].startTime);
    times.paint.push(paint);
    times.usable.push(usable);
    await context.close();
  }
  return `first paint ${ms(median(times.paint))}, usable ${ms(median(times.usable))}`;
}

async function paint() {
  const report = await post(quads(512, 64, ["b2f", "f2b", "f2bd", "unsorted"]));
  return opened(`/#/reports/${report.id}`, ".pane-view");
}

async function sweep() {
  const values = Array.from({ length: 100 }, (_, i) => i + 1);
  const report = await post(quads(16, 1, ["b2f", "f2b", "f2bd"], { sweep: [{ pointer: "/scene/count", values }] }));
  return opened(`/#/reports/${report.id}`, ".charts path.line");
}

/** Nearly all are cancelled before they are rendered; those on the first page have pictures. */
async function archive() {
  const small = quads(16, 4, ["b2f", "f2b"]);
  const long = await post(quads(512, 4096, ["b2f"], { timing: { rounds: 1000, max_seconds: 600 } }), false);
  const cancel = (id) => fetch(`${service.url}/api/v1/reports/${id}`, { method: "DELETE" });
  let left = ARCHIVE - 100;
  const work = async () => {
    while (left-- > 0) await cancel((await post({ ...small, title: `Number ${left}` }, false)).id);
  };
  await Promise.all(Array.from({ length: AT_ONCE }, work));
  await cancel(long.id);
  for (let i = 0; i < 100; ++i) await post({ ...small, title: `Done ${i}` });
  return opened("/#/reports", ".entry img");
}

/**
 * Intervals between frames while `act(step)` is called once for each, and the processor time of the page's thread per frame, which
 * does not depend on what else the machine does.
 */
async function frames(page, act) {
  const client = await page.context().newCDPSession(page);
  await client.send("Performance.enable", { timeDomain: "threadTicks" });
  const work_s = async () =>
    (await client.send("Performance.getMetrics")).metrics.find(({ name }) => name === "TaskDuration").value;
  await page.evaluate(() => {
    globalThis.frame_times = [];
    let before = performance.now();
    const next = (now) => {
      globalThis.frame_times.push(now - before);
      before = now;
      globalThis.frame_handle = requestAnimationFrame(next);
    };
    globalThis.frame_handle = requestAnimationFrame(next);
  });
  const begin_s = await work_s();
  for (let step = 0; step < 90; ++step) await act(step);
  const end_s = await work_s();
  const times = await page.evaluate(() => {
    cancelAnimationFrame(globalThis.frame_handle);
    return globalThis.frame_times.slice(2);
  });
  await client.detach();
  const own_ms = (1000 * (end_s - begin_s)) / times.length;
  return `95 % of frames within ${p95(times).toFixed(1)} ms, median ${median(times).toFixed(1)}, own work ${own_ms.toFixed(1)}`;
}

async function two_pictures() {
  const report = await post(quads(2048, 256, ["b2f", "unsorted"]));
  const page = await browser.newPage({ viewport: WINDOW });
  const told = [];
  const open = async (query) => {
    await page.goto("about:blank");
    await page.goto(`${service.url}/#/reports/${report.id}?${query}`);
    await page.locator(".pane-view").first().waitFor();
    await page.locator(".picture > *").evaluateAll((all) => Promise.all(all.map((one) => one.decode?.())));
    await page.locator(".pane-view").first().scrollIntoViewIfNeeded();
    return page.locator(".pane-view").first().boundingBox();
  };
  for (const layout of ["slider", "grid"]) {
    const box = await open(`layout=${layout}&kept=1,2&zoom=2&at=1024,1024`);
    const [x, y] = [box.x + box.width * 0.3, box.y + box.height * 0.3];
    await page.mouse.move(x, y);
    await page.mouse.down();
    const pan = (step) => page.mouse.move(x + 80 * Math.sin(step / 5), y + 80 * Math.cos(step / 7));
    told.push(`panning (${layout}): ${await frames(page, pan)}`);
    await page.mouse.up();
  }
  const box = await open("layout=slider");
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.locator(".divider").hover();
  await page.mouse.down();
  const slide = (step) => page.mouse.move(box.x + box.width * (0.5 + 0.4 * Math.sin(step / 9)), box.y + 200);
  told.push(`slider: ${await frames(page, slide)}`);
  await page.mouse.up();
  await open("layout=flip");
  told.push(`flipping: ${await frames(page, (step) => page.keyboard.press(step % 2 ? "1" : "2"))}`);
  return told.join("; ");
}

async function weight() {
  const report = await post(quads(64, 16, ["b2f", "f2bd"]));
  const page = await browser.newPage({ viewport: WINDOW });
  const files = new Map();
  page.on("response", async (response) => {
    const type = response.headers()["content-type"] ?? "";
    if (!type.startsWith("image/png")) files.set(response.url(), await response.body());
  });
  await page.goto(`${service.url}/#/reports/${report.id}`);
  await page.locator(".pane-view").first().waitFor();
  await page.waitForLoadState("networkidle");
  const bytes = [...files.values()].reduce((sum, body) => sum + gzipSync(body).length, 0);
  return `${(bytes / 1000).toFixed(0)} KB compressed in ${files.size} files without pictures`;
}

async function file() {
  const report = await post(quads(512, 256, ["b2f", "f2b", "f2bd", "unsorted", "wboit", "mboit"]));
  const html = await (await fetch(`${service.url}/api/v1/reports/${report.id}/report.html`)).arrayBuffer();
  return `report.html of 6 methods at 512 × 512: ${(html.byteLength / 1e6).toFixed(1)} MB`;
}

const all = { paint, sweep, weight, file, frames: two_pictures, archive };
const names = process.argv.slice(2);
try {
  for (const [name, measure] of Object.entries(all))
    if (names.length === 0 || names.includes(name)) console.log(`${name}: ${await measure()}`);
} finally {
  await browser.close();
  await service.stop();
}
