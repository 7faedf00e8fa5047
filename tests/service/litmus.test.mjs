// sheer litmus: the scenes for other renderers, and what is said of the pictures that come back.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";

const folder = mkdtempSync(join(tmpdir(), "sheer-litmus-"));
after(() => rmSync(folder, { recursive: true, force: true }));

const sheer = (...words) => spawnSync(process.env.SHEER, words, { encoding: "utf8" });
const pack = join(folder, "pack");
const exported = sheer("litmus", "export", pack);
const scene = (id) => JSON.parse(readFileSync(join(pack, "scenes", `${id}.json`), "utf8"));
const ids = () => readdirSync(join(pack, "scenes")).flatMap((name) => name.match(/^(.*)\.json$/)?.[1] ?? []);

/// A folder with copies of some of the expected PNG pictures, each under the name that `name_of` gives it.
const pictures = (name, wanted, name_of = (id) => id, from = "expected") => {
  const to = join(folder, name);
  mkdirSync(to);
  for (const id of wanted) copyFileSync(join(pack, from, `${id}.png`), join(to, `${name_of(id)}.png`));
  return to;
};
const identify = (...words) => {
  const { status, stdout, stderr } = sheer("litmus", "identify", ...words, "--json");
  return { status, stderr, ...(stdout ? JSON.parse(stdout) : {}) };
};

test("every scene is written as JSON, glTF and expected pictures", () => {
  assert.equal(exported.status, 0, exported.stderr);
  assert.equal(ids().length, 25);
  for (const id of ids())
    for (const file of [`scenes/${id}.gltf`, `expected/${id}.png`, `expected/${id}.exr`, `expected-linear/${id}.png`])
      assert.ok(readFileSync(join(pack, file)).length > 100, file);
  const readme = readFileSync(join(pack, "README.md"), "utf8");
  for (const id of ids().filter((id) => !id.startsWith("shuffled"))) assert.ok(readme.includes(`| \`${id}\` |`), id);
  assert.equal(sheer("litmus", "export", pack).status, 2);
});

test("the glTF has the rectangles of the JSON", () => {
  const { surfaces, background } = scene("self_overlap");
  const gltf = JSON.parse(readFileSync(join(pack, "scenes/self_overlap.gltf"), "utf8"));
  assert.deepEqual(gltf.extras.background, background);
  assert.equal(gltf.meshes.length, surfaces.length);
  const bytes = Buffer.from(gltf.buffers[0].uri.split(",")[1], "base64");
  assert.equal(bytes.length, gltf.buffers[0].byteLength);
  surfaces.forEach(({ rect: [x0, y0, x1, y1], left_depth, right_depth, color, alpha }, i) => {
    const at = gltf.bufferViews[i].byteOffset;
    const corners = Array.from({ length: 12 }, (_, k) => bytes.readFloatLE(at + 4 * k));
    const expected = [
      [2 * x0 - 1, 1 - 2 * y1, -left_depth],
      [2 * x1 - 1, 1 - 2 * y1, -right_depth],
      [2 * x0 - 1, 1 - 2 * y0, -left_depth],
      [2 * x1 - 1, 1 - 2 * y0, -right_depth],
    ].flat();
    corners.forEach((value, k) => assert.ok(Math.abs(value - expected[k]) < 1e-6, `${i} ${k}`));
    const factor = gltf.materials[i].pbrMetallicRoughness.baseColorFactor;
    assert.equal(factor[3], alpha);
    // The transfer function of sRGB, IEC 61966-2-1.
    color.forEach((value, k) =>
      assert.ok(Math.abs(factor[k] - (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4)) < 1e-9),
    );
  });
});

test("a program that reads glTF can draw it", () => {
  const spec = join(folder, "spec.json");
  writeFileSync(
    spec,
    JSON.stringify({
      image: { width: 32, height: 32 },
      scene: { type: "gltf", model: join(pack, "scenes/unequal.gltf") },
      methods: ["b2f"],
      timing: { rounds: 1 },
    }),
  );
  const { status, stdout, stderr } = sheer("compare", spec, "--json", "-q");
  assert.equal(status, 0, stderr);
  assert.equal(JSON.parse(stdout).runs[0].results[0].fragments.submitted > 0, true);
});

test("correct pictures are those of the over operator, sorted by pixel", () => {
  const { status, found, drawings, missing, distance } = identify(
    pictures(
      "correct",
      ids().filter((id) => id !== "fade"),
    ),
  );
  assert.equal(status, 0);
  assert.equal(found, true);
  assert.deepEqual(missing, ["fade"]);
  assert.equal(drawings[0].formula, "exact");
  assert.equal(drawings[0].blends, "sRGB-encoded values");
  assert.ok(distance.rms_levels < 0.5);
});

test("linear blending is told from blending of encoded values", () => {
  const { status, drawings } = identify(
    pictures("linear", ["black", "white", "unequal"], undefined, "expected-linear"),
  );
  assert.equal(status, 0);
  assert.ok(drawings.some(({ formula }) => formula === "exact"));
  for (const { blends } of drawings) assert.equal(blends, "linear values, sRGB-encoded afterwards");
});

test("pictures of other scenes are none of these", () => {
  const swap = { black: "white", white: "black" };
  const folder_of_swapped = pictures("swapped", ["black", "white", "unequal"], (id) => swap[id] ?? id);
  const { status, found, distance } = identify(folder_of_swapped);
  assert.equal(status, 1);
  assert.equal(found, false);
  assert.ok(distance.rms_levels > 10);
  assert.match(sheer("litmus", "identify", folder_of_swapped).stdout, /^Without .*\nNone of these\. The nearest is:\n/);
});

test("a folder without pictures and a picture of another size are wrong", () => {
  const empty = join(folder, "empty");
  mkdirSync(empty);
  const none = identify(empty);
  assert.equal(none.status, 2);
  assert.match(none.stderr, /no picture of a litmus scene, such as shuffled_0\.png/);
  writeFileSync(join(empty, "black.png"), "no picture");
  assert.equal(identify(empty).status, 2);
});
