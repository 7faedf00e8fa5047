// What the tests of the page share: a real service with its own data folder, a browser, and checks of every page.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createRequire } from "node:module";
import { chromium } from "playwright-core";

const axe_source = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const failures = process.env.SHEER_SCREENSHOTS ?? join(tmpdir(), "sheer-web-failures");
const START_MS = 30_000;
const WAIT_MS = 15_000;

/**
 * Nothing here is about the sandbox, which tests/service covers. Without one the driver keeps its compiled shaders between
 * processes, so that a small report takes a sixth of the time.
 */
const CONFIG = { sandbox: { enabled: false, required: false } };

/** Starts `sheer serve` on a free port, with an empty archive or the one in `archive`; returns {url, folder, stop}. */
export async function start_service(program, archive = null) {
  assert.ok(program, "SHEER and SHEER_MADE_UP must name the programs");
  const folder = mkdtempSync(join(tmpdir(), "sheer-web-"));
  const config = join(folder, "server.json");
  writeFileSync(config, JSON.stringify(CONFIG));
  const data = archive ?? join(folder, "data");
  const child = spawn(program, ["serve", "--listen", "127.0.0.1:0", "--data", data, "--config", config], {
    stdio: ["ignore", "pipe", "pipe"],
  });
  const ended = new Promise((resolve) => child.once("exit", resolve));
  let output = "";
  const url = await new Promise((resolve, reject) => {
    const timer = setTimeout(() => reject(new Error(`the service did not start: ${output}`)), START_MS);
    const read = (bytes) => {
      output += bytes;
      const found = /Sheer listens on (http:\/\/\S+)/.exec(output);
      if (!found) return;
      clearTimeout(timer);
      resolve(found[1]);
    };
    child.stdout.on("data", read);
    child.stderr.on("data", read);
    child.once("exit", (code) => reject(new Error(`the service ended with ${code}: ${output}`)));
  });
  return {
    url,
    folder,
    async stop() {
      child.kill("SIGTERM");
      await ended;
      rmSync(folder, { recursive: true, force: true });
    },
  };
}

export function start_browser() {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    headless: true,
    args: [
      "--no-sandbox",
      "--disable-gpu",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
    ],
  });
}

/**
 * Runs `body(page)` on a new page, and asserts that nothing went wrong: no exception, no console message (violations
 * of the content security policy are messages), no request to another host. Answers in `expected_statuses` are part
 * of the test. A failure leaves a picture of the page.
 */
async function with_page(browser, name, options, body) {
  const { expected_statuses = [], origin, ...context_options } = options;
  const context = await browser.newContext({
    viewport: { width: 1280, height: 860 },
    reducedMotion: "reduce",
    ...context_options,
  });
  const page = await context.newPage();
  page.setDefaultTimeout(WAIT_MS);
  const complaints = [];
  page.on("pageerror", (error) => complaints.push(`exception: ${error.stack}`));
  page.on("console", (message) => {
    if (!["error", "warning"].includes(message.type())) return;
    const status = /Failed to load resource: the server responded with a status of (\d+)/.exec(message.text());
    if (!status || !expected_statuses.includes(Number(status[1]))) complaints.push(`console: ${message.text()}`);
  });
  page.on("request", (request) => {
    const url = request.url();
    if (origin && !url.startsWith(origin) && !/^(data|blob|about):/.test(url)) complaints.push(`request to ${url}`);
  });
  try {
    await body(page);
    assert.deepEqual(complaints, []);
  } catch (error) {
    mkdirSync(failures, { recursive: true });
    const picture = join(failures, `${name.replaceAll(/\W+/g, "-")}.png`);
    await page.screenshot({ path: picture, fullPage: true }).catch(() => {});
    error.message += `\n(picture: ${picture}${complaints.length > 0 ? `; page: ${complaints.join("; ")}` : ""})`;
    throw error;
  } finally {
    await context.close();
  }
}

/**
 * Asserts that axe finds nothing. What it checks besides colors is the same in the dark. With `part`, a selector, only there:
 * for a view whose other parts another test checks.
 */
export async function assert_accessible(page, what, part = null) {
  if (!(await page.evaluate(() => "axe" in globalThis))) await page.evaluate(axe_source);
  if (part) assert.ok((await page.locator(part).count()) > 0, `${what} has ${part}`);
  for (const [colorScheme, options] of [
    ["light", {}],
    ["dark", { runOnly: ["color-contrast"] }],
  ]) {
    await page.emulateMedia({ colorScheme });
    const found = await page.evaluate(
      async ([rules, place]) =>
        (await globalThis.axe.run(place ?? document, { ...rules, resultTypes: ["violations"] })).violations.map(
          (violation) => `${violation.id}: ${violation.nodes.map((node) => node.html).join(" | ")}`,
        ),
      [options, part],
    );
    assert.deepEqual(found, [], `${what} in ${colorScheme}`);
  }
  const [content, window] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
  assert.ok(content <= window, `${what} is ${content} px wide in a window of ${window} px`);
}

/** Values of a table of results: {label: {path: text of the value}}, and the text that is shown for them. */
export function table_values(page, table) {
  return page.$$eval(`table.${table} tbody tr[data-label]`, (rows) =>
    Object.fromEntries(
      rows.map((row) => [
        row.dataset.label,
        Object.fromEntries(
          [...row.querySelectorAll("td[data-path]")].map((cell) => {
            const text = [...cell.childNodes]
              .filter((node) => node.nodeType === Node.TEXT_NODE)
              .map((node) => node.data)
              .join("");
            return [cell.dataset.path, { exact: cell.dataset.value, shown: text || cell.textContent }];
          }),
        ),
      ]),
    ),
  );
}

/** The value of an object at a dotted path. */
export function at(object, path) {
  return path.split(".").reduce((part, key) => part?.[key], object);
}

/** The text of a number as the page should show it must round to the number within half of its last digit. */
export function assert_shown(shown, exact, what) {
  const plain = shown.replaceAll(",", "").replace(/−/g, "-");
  const mantissa = /^-?\d+(?:\.(\d+))?(?:e(-?\d+))?$/.exec(plain);
  assert.ok(mantissa, `${what}: "${shown}" is not a number`);
  const last_digit = 10 ** (Number(mantissa[2] ?? 0) - (mantissa[1]?.length ?? 0));
  assert.ok(Math.abs(Number(plain) - exact) <= last_digit * 0.5001, `${what}: ${shown} for ${exact}`);
}

/** A title that would break out of markup made of strings. */
export const HOSTILE = `Quads </script><img src=x onerror="alert(1)"> & “more”`;

/** A small comparison for the tests. */
const SPEC = {
  title: HOSTILE,
  tags: { note: "needle-7" },
  image: { width: 96, height: 64 },
  scene: { type: "quads", count: 24, shading: "1-texture", texture: { size: 64 } },
  methods: ["b2f", "f2b", { id: "f2bd", threshold: 0.1, label: "F2BD <i>0.1</i>" }, "unsorted"],
  baseline: "b2f",
  timing: { rounds: 8 },
  checks: [{ metric: "flip.mean", method: "b2f", max: 0.1 }],
};

/** A pixel of its pictures under which there are more than two fragments. */
export const CROWDED = { x: 25, y: 25 };

export const field = (pointer) => `[data-pointer="${pointer}"]`;

/** Fills the form with a small comparison that has a hostile title. */
export async function fill_form(page, url) {
  await page.goto(`${url}/#/new`);
  await page.getByRole("button", { name: "Quick look" }).click();
  await page.locator(`${field("/title")} input`).fill(HOSTILE);
  await page.locator(`${field("/scene/count")} input`).fill("24");
  await page.locator(`${field("/image/width")} input`).fill("96");
  await page.locator(`${field("/image/height")} input`).fill("64");
  await page.locator(`${field("/tags")} input`).fill("branch: main, note: a:b");
}

/** A service with one finished report, and a browser, for all tests of a file. */
export function service_tests(program = process.env.SHEER) {
  let service;
  let browser;
  let report;
  const api = async (path, options) => (await fetch(`${service.url}/api/v1${path}`, options)).json();
  const post_report = (spec, headers = {}) =>
    api("/reports", {
      method: "POST",
      headers: { "Content-Type": "application/json", ...headers },
      body: JSON.stringify(spec),
    });
  before(async () => {
    const starting = start_browser();
    try {
      service = await start_service(program);
      report = await post_report(SPEC, { Prefer: "wait=60" });
    } finally {
      browser = await starting;
    }
    assert.equal(report.status, "done", JSON.stringify(report));
  });
  after(async () => {
    await browser?.close();
    await service?.stop();
  });
  return {
    api,
    post_report,
    url: () => service.url,
    folder: () => service.folder,
    report_id: () => report.id,
    /** A test that gets a page; see with_page. */
    page_test: (name, options, body) =>
      test(name, () => with_page(browser, name, { origin: service.url, ...options }, body)),
  };
}
