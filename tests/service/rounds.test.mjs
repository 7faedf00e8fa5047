// Rounds that are doubled until the checks on times are decided.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { QUICK } from "./service.mjs";

const folder = mkdtempSync(join(tmpdir(), "sheer-rounds-"));
after(() => rmSync(folder, { recursive: true, force: true }));

function compare(name, spec, ...words) {
  const file = join(folder, `${name}.json`);
  writeFileSync(file, JSON.stringify({ ...QUICK, ...spec }));
  const out = join(folder, name);
  const run = spawnSync(process.env.SHEER, ["compare", file, "--out", out, ...words], { encoding: "utf8" });
  const report = existsSync(out) ? JSON.parse(readFileSync(join(out, "report.json"), "utf8")) : null;
  return { ...run, report };
}

const SLOW_ENOUGH = { metric: "timing.median", method: "b2f", max: 10_000 };

test("rounds are doubled until the interval of the look decides", () => {
  // Look k has an error rate of 0.05 / 2^k. An interval needs n rounds with 2 / 2^n at most that: 7, 8, 9 and 10 rounds
  // for looks 1 to 4, which have 2, 4, 8 and 16.
  const { status, report, stdout } = compare("doubled", { timing: { warmup: 1, rounds: 2 }, checks: [SLOW_ENOUGH] });
  assert.equal(status, 0, stdout);
  assert.deepEqual(report.runs[0].rounds, { asked: 2, done: 16, looks: 4, needed: 10 });
  assert.equal(report.checks[0].outcome, "passed");
  assert.equal(report.runs[0].results[0].timing.samples.length, 16);
  assert.match(stdout, /16 of 2 rounds\. Checks were undecided, so their times were looked at 4 times;/);
});

test("without checks on times the rounds are those of the spec", () => {
  const checks = [{ metric: "flip.mean", method: "f2b", max: 0.05 }];
  const { report } = compare("plain", { timing: { warmup: 1, rounds: 2 }, checks });
  assert.deepEqual(report.runs[0].rounds, { asked: 2, done: 2, looks: 0, needed: 6 });
});

test("when the time is over, the spec says what undecided counts as", () => {
  const spec = { timing: { warmup: 1, rounds: 1, max_seconds: 0.001 }, checks: [SLOW_ENOUGH] };
  const ended = (on_undecided) => {
    const { status, report } = compare(on_undecided, { ...spec, on_undecided });
    assert.equal(report.checks[0].outcome, "undecided");
    assert.ok(report.runs[0].rounds.done < 7);
    return [status, report.verdict];
  };
  assert.deepEqual(ended("neutral"), [0, "undecided"]);
  assert.deepEqual(ended("pass"), [0, "passed"]);
  assert.deepEqual(ended("fail"), [5, "failed"]);
});
