// A GPU's clock while methods are timed.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { QUICK } from "./service.mjs";

const PROGRAM = process.env.SHEER;

async function in_folder(body) {
  const folder = mkdtempSync(join(tmpdir(), "sheer-clock-"));
  try {
    await body(folder);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

const compared = (folder, environment) => {
  const spec = join(folder, "spec.json");
  writeFileSync(
    spec,
    JSON.stringify({ ...QUICK, methods: ["b2f"], timing: { warmup: 1, rounds: 6, max_seconds: 60 } }),
  );
  const text = execFileSync(PROGRAM, ["compare", spec, "--json", "-q"], { env: { ...process.env, ...environment } });
  return JSON.parse(text);
};

test("frames at a lowered clock are thrown away, taken again and counted", () =>
  in_folder(async (folder) => {
    const nvml = (name, every) => ({
      LD_LIBRARY_PATH: process.env.FAKE_NVML,
      FAKE_NVML_NAME: name,
      FAKE_NVML_LOWERED_EVERY: every,
    });
    const result_of = (environment) => compared(folder, environment).runs[0].results[0];
    const timing_of = (environment) => result_of(environment).timing;

    const steady = timing_of(nvml("llvmpipe", "0"));
    assert.deepEqual(steady.gpu_clock_mhz, Array(6).fill(1980));
    assert.equal(steady.retaken_samples, 0);
    assert.deepEqual(steady.clock_lowered_by, []);

    // 12 frames, of the method and of its second instance, are kept; after two of three readings comes one that is not.
    const hot = timing_of(nvml("llvmpipe", "3"));
    assert.equal(hot.samples.length, 6);
    assert.equal(hot.gpu_clock_mhz.length, 6);
    assert.equal(hot.retaken_samples, 5);
    assert.deepEqual(hot.clock_lowered_by, ["heat"]);

    // It does not wait without end: each of the 12 is taken three times more.
    const always = result_of(nvml("llvmpipe", "1"));
    assert.equal(always.timing.samples.length, 6);
    assert.equal(always.timing.retaken_samples, 36);
    assert.deepEqual(
      always.notes.filter(({ code }) => code === "lowered-clock").map(({ text }) => text),
      ["The GPU's clock stayed lowered while this method was timed: heat."],
    );

    const other = timing_of(nvml("another GPU", "1"));
    assert.equal(other.gpu_clock_mhz, null);
    assert.match(other.gpu_clock_mhz_reason, /no NVML/);
  }));
