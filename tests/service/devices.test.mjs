// One report of several devices: two workers with different labels, one of them in trouble, and pictures that differ.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import {
  assert_problem,
  children_of,
  command_line,
  is_alive,
  QUICK,
  read_events,
  until,
  with_service,
} from "./service.mjs";

const CONFIG = {
  worker: { device: "a", poll_s: 0.1 },
  jobs: { lease_s: 5, heartbeat_s: 0.5, max_attempts: 10 }, // a busy machine may lose a lease
  http: { ready_within_s: 60 },
};
const BOTH = { ...QUICK, device: ["a", "b"] };

/** Textures that are smaller than the pixels which they fill, so that their filter shows. */
const TEXTURED = {
  ...QUICK,
  image: { width: 64, height: 64 },
  scene: { type: "quads", count: 8, shading: "1-texture", texture: { image: "leaf", size: 16 } },
};

/** It is timed for some seconds. */
const LONGER = { ...TEXTURED, timing: { warmup: 1, rounds: 1000, max_seconds: 5 }, device: ["a", "b"] };
const PATIENCE_S = 240; // each device renders in its turn

/** A worker beside the service's own. */
class Worker {
  constructor(service, label, environment = {}) {
    const words = ["worker", ...service.place(), "--device", label, "--config", service.config];
    this.process = spawn(process.env.SHEER, words, {
      stdio: ["ignore", "ignore", "pipe"],
      env: { ...process.env, ...environment },
    });
    this.log = "";
    this.process.stderr.on("data", (text) => {
      this.log += text;
    });
    this.ended = new Promise((resolve) => this.process.on("exit", resolve));
  }

  renderer() {
    return children_of(this.process.pid).find((pid) => command_line(pid).some((word) => word.endsWith("spec.json")));
  }

  kill(signal = "SIGTERM") {
    this.process.kill(signal);
    return this.ended;
  }
}

async function with_worker(service, label, environment, body) {
  const worker = new Worker(service, label, environment);
  try {
    await body(worker);
  } finally {
    await worker.kill();
  }
}

const picture = (run, label) => run.results.find((result) => result.label === label).images.color.sha256;

test("two equal devices give one report with a run of each and equal pictures", () =>
  with_service(CONFIG, async (service) => {
    const posted = await service.post({ ...BOTH, title: "equal", tags: { kind: "both" } });
    assert.equal(posted.status, 202);
    const { id, notes, devices } = await posted.json();
    assert.deepEqual(
      notes.map(({ code, text }) => [code, /"b"/.test(text)]).filter(([, is_b]) => is_b),
      [["no-worker", true]],
      "it waits for a worker of b, and says so",
    );
    assert.deepEqual(
      devices.map(({ label }) => label),
      ["a", "b"],
    );
    const half = await until(async () => {
      const report = await service.report(id);
      return report.devices[0].status === "done" && report;
    }, "a has rendered its part");
    assert.equal(half.devices[1].status, "queued");
    assert.equal(half.status, "queued");
    assert.ok(Math.abs(half.progress - 1 / 3) < 1e-9, `${half.progress}`);
    assert.equal((await service.reports()).length, 1, "parts are not listed");
    const stream = await fetch(`${service.api}/reports/${id}/events`);
    await with_worker(service, "b", {}, async () => {
      const events = (await read_events(stream)).filter(({ data }) => data);
      assert.equal(events.at(-1).event, "done");
      assert.ok(
        events.some(({ data }) => data.devices?.some(({ label, status }) => label === "b" && status !== "done")),
      );
      const report = await service.settled(id);
      assert.equal(report.status, "done");
      assert.deepEqual(
        report.runs.map(({ point }) => point),
        [{ "/device": "a" }, { "/device": "b" }],
      );
      assert.deepEqual(
        report.devices.map(({ label, status, device }) => [label, status, device.renderer]),
        ["a", "b"].map((label) => [label, "done", report.device.renderer]),
      );
      assert.equal(report.across_devices.length, 2);
      for (const { method, devices: cells } of report.across_devices) {
        const medians = report.runs.map(({ results }) => results.find(({ label }) => label === method).timing.median);
        assert.deepEqual(
          cells.map(({ device, median, flip }) => [device, median, flip]),
          [
            ["a", medians[0], null],
            ["b", medians[1], 0],
          ],
        );
      }
      for (const label of QUICK.methods) assert.equal(picture(report.runs[0], label), picture(report.runs[1], label));
      const [line] = await service.reports("?tag=kind:both&status=done");
      assert.equal(line.id, id);
      const again = await (await fetch(`${service.api}/reports/${id}/summary.md`)).text();
      assert.match(again, /\| method \| a ms &#91;95 %&#93; \| b ms &#91;95 %&#93; \| FLIP \|/);
      const checked = spawnSync(process.env.SHEER, ["archive", "fsck", ...service.place()], { encoding: "utf8" });
      assert.equal(checked.status, 0, checked.stdout + checked.stderr);
    });
  }));

test("pictures that differ are compared as sheer diff compares them", () =>
  with_service(CONFIG, (service) =>
    // Mesa's software rasteriser, told to leave out the linear filter of textures.
    with_worker(service, "b", { LP_PERF: "no_linear" }, async () => {
      const render = async (spec) => service.settled(await service.submit(spec));
      const report = await render({ ...TEXTURED, device: ["a", "b"], title: "different" });
      assert.equal(report.status, "done", service.log);
      const a = await render({ ...TEXTURED, device: "a" });
      const b = await render({ ...TEXTURED, device: "b" });
      const diff = await (await fetch(`${service.api}/reports/${a.id}/diff?against=${b.id}`)).json();
      for (const { method, devices } of report.across_devices) {
        const { picture: wanted } = diff.runs[0].results.find(({ label }) => label === method);
        assert.equal(wanted.verdict, "different");
        assert.ok(devices[1].flip > 0.001, `${devices[1].flip}`);
        assert.ok(Math.abs(devices[1].flip - wanted.flip.mean) < 1e-12);
        assert.equal(devices[1].differing_pixels, wanted.differing_pixels);
      }
    }),
  ));

test("a device whose worker is killed renders its part again", () =>
  with_service(CONFIG, async (service) => {
    const id = await service.submit(LONGER);
    const killed = new Worker(service, "b");
    const renderer = await until(() => killed.renderer(), "b renders", PATIENCE_S);
    await until(async () => (await service.report(id)).progress > 1 / 3, "there is progress", PATIENCE_S);
    await killed.kill("SIGKILL");
    await until(() => !is_alive(renderer), "its renderer ends with it");
    await with_worker(service, "b", {}, async (next) => {
      const report = await service.settled(id);
      assert.equal(report.status, "done", next.log);
      assert.deepEqual(
        report.devices.map(({ label, reason }) => [label, reason]),
        [
          ["a", undefined],
          ["b", undefined],
        ],
      );
    });
  }));

test("a device that fails has the reason in its run, and the report says so", () =>
  with_service(CONFIG, async (service) => {
    const checks = [{ metric: "flip.mean", method: "f2b", max: 1 }];
    await with_worker(service, "b", {}, async (worker) => {
      const id = await service.submit({ ...LONGER, checks });
      for (let attempt = 1, last; attempt <= 2; ++attempt) {
        const renderer = await until(
          () => worker.renderer() !== last && worker.renderer(),
          `attempt ${attempt}`,
          PATIENCE_S,
        );
        last = renderer;
        process.kill(renderer, "SIGKILL");
        await until(() => !is_alive(renderer), "it ends");
      }
      const report = await service.settled(id);
      const reason = "Rendering failed: The renderer died (signal 9).";
      assert.equal(report.status, "done");
      assert.equal(report.verdict, "failed");
      assert.match(report.verdict_reason, /the device b failed: Rendering failed: The renderer died \(signal 9\)\.$/);
      assert.deepEqual([report.devices[1].status, report.devices[1].reason], ["failed", reason]);
      const [done, failed] = report.runs;
      assert.ok(done.results.every(({ status }) => status === "ok"));
      assert.deepEqual(failed.point, { "/device": "b" });
      assert.ok(failed.results.every((result) => result.status === "failed" && result.reason === reason));
      assert.deepEqual(
        report.checks.map(({ at, outcome }) => [at["/device"], outcome]),
        [
          ["a", "passed"],
          ["b", "failed"],
        ],
      );
      assert.ok(report.across_devices.every(({ devices }) => devices[1].flip_reason === reason));
    });
  }));

test("a report that waits for a device is cancelled with the parts that it has", () =>
  with_service(CONFIG, async (service) => {
    const id = await service.submit(BOTH);
    await until(async () => (await service.report(id)).devices[0].status === "done", "a has rendered");
    assert.ok(service.kept("blobs").length > 0);
    await fetch(`${service.api}/reports/${id}`, { method: "DELETE" });
    assert.equal((await service.report(id)).status, "cancelled");
    await until(() => service.kept("blobs").length === 0, "its pictures are gone");
  }));

test("wrong lists of devices are refused, and sheer compare says what to do", () =>
  with_service(CONFIG, async (service) => {
    for (const [device, pointer] of [
      [[], "/device"],
      [["a", "a"], "/device/1"],
      [["a", ""], "/device/1"],
      [Array.from({ length: 9 }, (_, index) => `d${index}`), "/device"],
      [{}, "/device"],
    ]) {
      const { errors } = await assert_problem(await service.post({ ...QUICK, device }), 422);
      assert.deepEqual(
        errors.map((error) => error.pointer),
        [pointer],
      );
    }
    const folder = mkdtempSync(join(tmpdir(), "sheer-devices-"));
    try {
      writeFileSync(join(folder, "spec.json"), JSON.stringify(BOTH));
      const here = spawnSync(process.env.SHEER, ["compare", join(folder, "spec.json")], { encoding: "utf8" });
      assert.equal(here.status, 2);
      assert.match(here.stderr, /\/device: lists several devices.*sheer submit/);
      await with_worker(service, "b", {}, async () => {
        const words = ["submit", join(folder, "spec.json"), "--server", service.origin, "--out", join(folder, "out")];
        const sent = await new Promise((resolve) => {
          const program = spawn(process.env.SHEER, words);
          let text = "";
          for (const stream of [program.stdout, program.stderr])
            stream.on("data", (more) => {
              text += more;
            });
          program.on("exit", (status) => resolve({ status, text }));
        });
        assert.equal(sent.status, 0, sent.text);
        assert.match(sent.text, /^method +a ms \[95 %\] +b ms \[95 %\] +FLIP$/m);
        const report = JSON.parse(readFileSync(join(folder, "out", "report.json"), "utf8"));
        assert.equal(report.runs.length, 2);
      });
    } finally {
      rmSync(folder, { recursive: true });
    }
  }));
