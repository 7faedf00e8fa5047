// Two looks of one method in one report: `sheer compare` with a shading of a method's own.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { QUICK } from "./service.mjs";

const folder = mkdtempSync(join(tmpdir(), "sheer-looks-"));
after(() => rmSync(folder, { recursive: true, force: true }));

function compare(name, spec) {
  writeFileSync(join(folder, `${name}.json`), JSON.stringify(spec));
  const run = spawnSync(process.env.SHEER, ["compare", join(folder, `${name}.json`), "--out", join(folder, name)], {
    encoding: "utf8",
  });
  const file = join(folder, name, "report.json");
  return { ...run, report: existsSync(file) ? JSON.parse(readFileSync(file, "utf8")) : null };
}

// A layer of alpha 1/2 over black: red 1 becomes 0.5, which is level 128; the new shading halves it to 0.25, level 64.
const looks = (methods, checks = []) => ({ ...QUICK, methods, checks, timing: { warmup: 1, rounds: 8 } });
const HALVED = { id: "b2f", label: "halved", shading: { glsl: "return vec4(tint.rgb * 0.5, tint.a);" } };
const SAME = { id: "b2f", label: "same", shading: { glsl: "return tint;" } };

test("the picture of a look is compared with the method's own, and with the exact picture in that look", () => {
  const { status, stdout, stderr, report } = compare(
    "two",
    looks(
      ["b2f", HALVED, SAME],
      [
        { metric: "change.signed.max", method: "halved", min: 64, max: 64 },
        { metric: "change.differing_pixels", method: "halved", min: 256, max: 256 },
        { metric: "change.differing_pixels", method: "same", max: 0 },
        { metric: "change.psnr", method: "same", min: 99 },
        { metric: "flip.mean", method: "halved", max: 0.001 },
      ],
    ),
  );
  assert.equal(status, 0, stdout + stderr);
  const [own, halved, same] = report.runs[0].results;
  assert.equal(own.change, null);
  assert.equal(halved.change.from, "b2f");
  assert.equal(halved.change.identical, false);
  assert.equal(halved.change.speedup.compared, 2);
  assert.equal(same.change.identical, true);
  assert.equal(halved.metrics.signed.max, 0, "the method itself is exact in either look");
  for (const key of ["exact", "change_difference", "change_flip"])
    assert.ok(existsSync(join(folder, "two", halved.images[key].url)), key);
  assert.match(stdout, /^Change from b2f to halved: the picture is different, mean FLIP 0\.\d+, 256 pixels; speed /m);
  assert.match(stdout, /^Change from b2f to same: the picture is identical; speed /m);
});

test("a changed picture fails its check", () => {
  const check = { metric: "change.flip.mean", method: "halved", max: 0.02 };
  const { status, report } = compare("changed", looks(["b2f", HALVED], [check]));
  assert.equal(status, 1);
  assert.equal(report.checks[0].outcome, "failed");
  assert.equal(report.verdict, "failed");
});

test("a look without a counterpart says so, and its check fails for that reason", () => {
  const check = { metric: "change.flip.mean", method: "halved", max: 1 };
  const { status, report, stdout } = compare("alone", looks(["f2b", HALVED], [check]));
  assert.equal(status, 1);
  assert.match(report.checks[0].reason, /^no other method is b2f with the same parameters/);
  assert.match(stdout, /^Change by halved: not known, as no other method is b2f/m);
});

test("an error in a method's shading names the method", () => {
  const wrong = { id: "b2f", label: "wrong", shading: { glsl: "vec4 c = tint;\nreturn your;" } };
  const { status, stderr } = compare("wrong", looks(["b2f", wrong]));
  assert.equal(status, 2);
  assert.match(stderr, /\/methods\/1\/shading\/glsl: does not compile:\nline 2: .*your/);
  const endless = { id: "b2f", label: "endless", shading: { glsl: "while (uv.x > 0.5) {}\nreturn tint;" } };
  assert.match(compare("endless", looks(["b2f", endless])).stderr, /\/methods\/1\/shading\/glsl: the loops of/);
});

test("one pixel is taken apart in each method's own look", () => {
  const words = ["pixel", join(folder, "two"), "--x", "3", "--y", "3", "--json"];
  const pixel = JSON.parse(spawnSync(process.env.SHEER, words, { encoding: "utf8" }).stdout);
  const values = pixel.methods.map(({ value }) => Math.round((value?.[0] ?? value?.float?.[0]) * 255));
  assert.deepEqual(values, [128, 64, 128]);
});
