// sheer-bench gives the same numbers as `sheer compare`, without pictures or a display.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";

const { SHEER, SHEER_BENCH } = process.env;
assert.ok(SHEER_BENCH, "SHEER_BENCH must be the path of sheer-bench");

// A half-transparent red layer over black: 128 levels of red after rounding, from which no method may differ by more
// than one.
const SPEC = {
  image: { width: 16, height: 8 },
  scene: { type: "layers", layers: [{ rect: [0, 0, 0.5, 1], depth: 0.5, color: [1, 0, 0], alpha: 0.5 }] },
  methods: ["b2f", "f2bd"],
  timing: { warmup: 1, rounds: 2 },
  checks: [{ metric: "signed.max", method: "f2bd", max: 1 }],
};

/** Runs `action` with a folder and a spec's file in it. */
function with_folder(spec, action) {
  const folder = mkdtempSync(join(tmpdir(), "sheer-bench-"));
  try {
    const file = join(folder, "spec.json");
    writeFileSync(file, JSON.stringify(spec));
    return action(folder, file);
  } finally {
    rmSync(folder, { recursive: true });
  }
}

const run = (program, ...words) => spawnSync(program, words, { encoding: "utf8" });
const read = (file) => JSON.parse(readFileSync(file, "utf8"));

test("it measures the same as sheer compare, without pictures", () =>
  with_folder(SPEC, (folder, spec) => {
    const out = join(folder, "bench.json");
    const bench = run(SHEER_BENCH, spec, "--out", out);
    assert.equal(bench.status, 0, bench.stderr);
    const compare = run(SHEER, "compare", spec, "--context", "egl", "--out", join(folder, "compare"));
    assert.equal(compare.status, 0, compare.stderr);
    const a = read(out),
      b = read(join(folder, "compare", "report.json"));
    assert.equal(a.spec_sha256, b.spec_sha256);
    assert.equal(a.device.context, "egl");
    assert.deepEqual(a.runs[0].reference.images, {});
    for (const [i, result] of a.runs[0].results.entries()) {
      assert.deepEqual(result.metrics, b.runs[0].results[i].metrics);
      assert.deepEqual(result.images, {});
      assert.equal(result.fragments.submitted, 8 * 8);
      assert.equal(result.fragments.shaded, 8 * 8);
      assert.equal(result.timing.samples.length, 2);
    }
    assert.match(bench.stdout, /f2bd/);
  }));

test("a suite is compared with its published figures", () =>
  with_folder({}, (folder) => {
    const out = join(folder, "table.json");
    const bench = run(SHEER_BENCH, "--suite", "paper-table-7", "--scale", "0.02", "--max-seconds", "5", "--out", out);
    assert.equal(bench.status, 0, bench.stderr);
    const { suite, provenance, spec } = read(out);
    assert.equal(spec.timing.max_seconds, 5);
    assert.equal(suite.id, "paper-table-7");
    assert.ok(
      suite.figures.every((figure) => figure.measured > 0),
      JSON.stringify(suite.figures),
    );
    assert.match(
      provenance.rerun,
      /^sheer-bench --suite paper-table-7 --scale 0\.02 --max-seconds 5 --device egl:\d+$/,
    );
  }));

test("errors are reported, and leave no file", () =>
  with_folder({ ...SPEC, methods: ["b3f"] }, (folder, spec) => {
    const out = join(folder, "bench.json");
    for (const [words, status, message] of [
      [[spec], 2, /^\/methods\/0: /m],
      [[], 2, /give either a SPEC\.json or a --suite/],
      [["--suite", "paper-table-8"], 2, /there is no suite "paper-table-8"; known are paper-table-1, /],
      [["--suite", "paper-table-7", "--scale", "2"], 2, /--scale/],
      [["--suite", "paper-table-7", "--max-seconds", "-1"], 2, /^\/timing\/max_seconds: /],
      [[spec, "--max-seconds", "5"], 2, /--suite/],
      [["--suite", "paper-table-7", "--device", "none such"], 3, /no OpenGL 4\.5 context 'egl' on device 'none such'/],
    ]) {
      const bench = run(SHEER_BENCH, ...words, "--out", out);
      assert.equal(bench.status, status, bench.stderr);
      assert.match(bench.stderr + bench.stdout, message);
      assert.ok(!existsSync(out));
    }
    assert.deepEqual(readdirSync(folder), ["spec.json"]);
    const nowhere = run(SHEER_BENCH, "--suite", "paper-table-7", "--out", join(folder, "missing", "bench.json"));
    assert.equal(nowhere.status, 3);
    assert.match(nowhere.stderr, /cannot write .*missing/);
  }));

test("a failed check sets the exit code", () => {
  const failing = { ...SPEC, checks: [{ metric: "fragments.shaded", method: "b2f", max: 1 }] };
  with_folder(failing, (folder, spec) => assert.equal(run(SHEER_BENCH, spec).status, 1));
});

test("the only graphics library that it needs is EGL", () => {
  const libraries = run("ldd", SHEER_BENCH).stdout;
  assert.match(libraries, /libEGL/);
  assert.doesNotMatch(libraries, /OpenImageIO|OSMesa|glfw|X11|sqlite|boost/i);
});
