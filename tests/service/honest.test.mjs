// A failure, or a comparison of nothing, never passes silently: on the command line, in JUnit and over REST. A driver
// that crashes is one line in the list of devices.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { QUICK, with_service } from "./service.mjs";

const { SHEER, SHEER_BENCH } = process.env;

const CHECKS = [{ metric: "flip.mean", method: "f2b", max: 1 }];
/** Only an opaque layer, so all methods agree whatever they do. */
const EMPTY = {
  ...QUICK,
  checks: CHECKS,
  scene: { type: "layers", layers: [{ rect: [0, 0, 1, 1], depth: 0.5, color: [1, 0, 0], alpha: 1, opaque: true }] },
};
const WHY = "Nothing transparent was drawn: the scene has no layers other than opaque ones.";
/** Lists of 1 MiB are too small for a pixel with 40,000 fragments. */
const NO_REFERENCE = {
  methods: ["b2f", "f2b"],
  reference: { id: "exact", form: "lists", memory_mib: 1 },
  scene: { type: "quads", count: 40000, distribution: "full", shading: "constant" },
  image: { width: 2, height: 1 },
  timing: { warmup: 1, rounds: 1 },
  checks: CHECKS,
};

function compare(spec) {
  const folder = mkdtempSync(join(tmpdir(), "sheer-honest-"));
  try {
    const file = join(folder, "spec.json"),
      junit = join(folder, "junit.xml"),
      out = join(folder, "out");
    writeFileSync(file, JSON.stringify(spec));
    const run = spawnSync(SHEER, ["compare", file, "--out", out, "--junit", junit], { encoding: "utf8" });
    return {
      ...run,
      junit: readFileSync(junit, "utf8"),
      report: JSON.parse(readFileSync(join(out, "report.json"), "utf8")),
    };
  } finally {
    rmSync(folder, { recursive: true });
  }
}

test("a comparison of nothing passes no check and says why", () => {
  const checked = compare(EMPTY);
  assert.equal(checked.status, 1, checked.stderr);
  assert.equal(checked.report.verdict, "failed");
  assert.equal(checked.report.checks[0].reason, WHY);
  assert.deepEqual(checked.report.notes, [{ code: "nothing-transparent", text: WHY, where: "/scene" }]);
  assert.ok(checked.stdout.includes(WHY), checked.stdout);
  assert.match(checked.junit, /<failure message="[^"]*Nothing transparent was drawn/);
  const unchecked = compare({ ...EMPTY, checks: [] });
  assert.equal(unchecked.status, 0, unchecked.stderr);
  assert.equal(unchecked.report.verdict, "none");
  assert.equal(unchecked.report.verdict_reason, WHY);
  assert.match(unchecked.junit, /<skipped message="Nothing transparent was drawn/);
});

test("without a reference the methods are timed, and checks of differences fail with the reference's reason", () => {
  const { status, report, stdout } = compare(NO_REFERENCE);
  assert.equal(status, 1, stdout);
  assert.equal(report.runs[0].reference.status, "unsupported");
  for (const result of report.runs[0].results) {
    assert.equal(result.status, "ok");
    assert.ok(result.timing.median > 0);
    assert.equal(result.metrics, null);
    assert.match(result.metrics_reason, /the reference exact is unsupported: .*40000 fragments/);
  }
  assert.match(report.checks[0].reason, /40000 fragments/);
});

test("both over REST", () =>
  with_service({ workers: 1 }, async (service) => {
    for (const [spec, why] of [
      [EMPTY, /Nothing transparent was drawn/],
      [NO_REFERENCE, /40000 fragments/],
    ]) {
      const report = await service.settled(await service.submit(spec));
      assert.equal(report.status, "done", JSON.stringify(report.error));
      assert.equal(report.verdict, "failed");
      assert.match(report.checks[0].reason, why);
      const junit = await (await fetch(`${service.api}/reports/${report.id}/junit.xml`)).text();
      assert.match(junit, /<failure/);
      assert.match(junit, why);
    }
  }));

// On some machines zink finds no Vulkan and crashes; the assertions also hold if it does not.
const ZINK = { ...process.env, LIBGL_ALWAYS_SOFTWARE: "1", GALLIUM_DRIVER: "zink" };

test("a driver that crashes affects only its device's line, and no process of ours dies", () => {
  const usual = spawnSync(SHEER, ["devices", "--json"], { encoding: "utf8" });
  const zink = spawnSync(SHEER, ["devices", "--json"], { encoding: "utf8", env: ZINK });
  assert.equal(zink.signal, null);
  assert.equal(zink.status, 0, zink.stderr);
  const devices = JSON.parse(zink.stdout);
  assert.deepEqual(
    devices.map(({ name }) => name),
    JSON.parse(usual.stdout).map(({ name }) => name),
  );
  for (const { error, renderer } of devices) assert.ok(error ? error.length > 0 : renderer.length > 0);
  const lines = spawnSync(SHEER, ["devices"], { encoding: "utf8", env: ZINK }).stdout;
  for (const { name, error } of devices.filter((device) => device.error))
    assert.ok(lines.includes(`not usable: ${error}`), name);

  const spec = join(mkdtempSync(join(tmpdir(), "sheer-zink-")), "spec.json");
  writeFileSync(spec, JSON.stringify(QUICK));
  for (const words of [
    [SHEER, "compare", spec],
    [SHEER_BENCH, spec],
    [SHEER, "pixel", spec, "--x", "1", "--y", "1"],
  ]) {
    const run = spawnSync(words[0], words.slice(1), { encoding: "utf8", env: ZINK });
    assert.equal(run.signal, null, words.join(" "));
    const usable = devices.some(
      ({ error, context }) => !error && (context === "egl" || (context === "osmesa" && words[0] === SHEER)),
    );
    assert.equal(run.status, usable ? 0 : 3, `${words.join(" ")}: ${run.stderr}`);
    if (!usable) assert.match(run.stderr, /its driver|not|no /);
  }
  rmSync(join(spec, ".."), { recursive: true });
});
