// A report of several devices on the page: while it waits for one of them, and when it is done.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { join } from "node:path";
import { assert_accessible, assert_shown, service_tests } from "./harness.mjs";

const RENDER_MS = 90_000;
const tests = service_tests();
const { page_test, api, post_report } = tests;

const SPEC = {
  title: "Two devices",
  image: { width: 64, height: 64 },
  scene: { type: "quads", count: 8, shading: "1-texture", texture: { image: "leaf", size: 16 } },
  methods: ["b2f", "f2b", { id: "f2bd", threshold: 0.1 }],
  timing: { rounds: 4 },
  device: ["local", "nearest"],
};

/** Another worker of the service's archive, whose driver leaves out the linear filter of textures. */
function start_worker(label) {
  const words = ["worker", "--data", join(tests.folder(), "data"), "--config", join(tests.folder(), "server.json")];
  return spawn(process.env.SHEER, [...words, "--device", label], {
    stdio: "ignore",
    env: { ...process.env, LP_PERF: "no_linear" },
  });
}

page_test("several devices wait, and then have a table", {}, async (page) => {
  const { id } = await post_report(SPEC);
  await page.goto(`${tests.url()}/#/reports/${id}`);
  await page.getByText("1 of 2 devices ended: local done, nearest waits").waitFor({ timeout: RENDER_MS });
  await assert_accessible(page, "a report that waits for a device");
  const worker = start_worker("nearest");
  try {
    await page.locator("article.report").waitFor({ timeout: RENDER_MS });
  } finally {
    worker.kill();
  }
  const report = await api(`/reports/${id}`);
  const table = page.getByRole("region", { name: "Methods on each device" });
  const rows = await table
    .locator("tbody tr")
    .evaluateAll((all) => all.map((row) => [...row.children].map((cell) => cell.textContent)));
  assert.equal(rows.length, 3);
  for (const [index, [method, first, second, flip]] of rows.entries()) {
    const { method: wanted, devices } = report.across_devices[index];
    assert.equal(method, wanted);
    for (const [shown, device] of [
      [first, devices[0]],
      [second, devices[1]],
    ])
      assert_shown(shown.replace(/ \[.*/, ""), device.median, `${method} on ${device.device}`);
    assert_shown(flip, devices[1].flip, `FLIP of ${method}`);
    assert.ok(devices[1].flip > 0.001);
  }
  // The devices are an axis of the sweep: the other one's run is shown too.
  const choice = page.getByLabel("device", { exact: true });
  assert.deepEqual(await choice.locator("option").allTextContents(), ["device local", "device nearest"]);
  await choice.selectOption({ label: "device local" });
  await assert_accessible(page, "a report of several devices");
  if (process.env.SHEER_PICTURE) await page.screenshot({ path: process.env.SHEER_PICTURE, fullPage: true });
});
