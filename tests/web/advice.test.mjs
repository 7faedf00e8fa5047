// Which method a report recommends, and the numbers behind the tools of the viewer: values worked out by hand.
import assert from "node:assert/strict";
import { cpSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";

// The page's modules end in .js, which older versions of Node accept as modules only next to such a package.json.
const folder = mkdtempSync(join(tmpdir(), "sheer-modules-"));
after(() => rmSync(folder, { recursive: true, force: true }));
cpSync(fileURLToPath(new URL("../../web", import.meta.url)), folder, { recursive: true });
writeFileSync(join(folder, "package.json"), '{"type": "module"}');
const load = (name) => import(pathToFileURL(join(folder, name)));

const { advise, ANY, tally } = await load("advice.js");
const { MAGMA, magma_level } = await load("magma.js");
const { difference_level, greatest_differences, over_background, paint_color, worst_pixels } = await load("paint.js");
const { axes_of, growth_along, point_text } = await load("sweep.js");

const METHODS = [
  { id: "b2f", needs_sorting: true },
  { id: "meshkin", needs_sorting: false },
];

function result(label, error, shaded, { verdict = "not resolved", value = 1, sort = true, memory = 0, ...more } = {}) {
  return {
    label,
    method: label,
    status: "ok",
    metrics: error === null ? null : { flip: { mean: error }, differing_pixels: error === 0 ? 0 : 9, non_finite: 0 },
    fragments: { shaded },
    timing: { median: 10, sort: sort ? { median: 0.1 } : null },
    speedup: { value, verdict, ci95: [value * 0.9, value * 1.1] },
    memory_bytes: memory,
    ...more,
  };
}

const RUN = {
  results: [
    result("b2f", 0.01, 1000),
    result("f2bd", 0.017, 630, { value: 1.28 }),
    result("coarse", 0.06, 100, { verdict: "faster", value: 5 }),
    result("bound", null, 0, { verdict: "faster", value: 9 }),
    result("meshkin", 0.019, 1000, { sort: false, memory: 2 ** 21 }),
  ],
};
const choose = (run, more = {}) => {
  const { chosen, by } = advise(run, { methods: METHODS, baseline: "b2f", software: true, ...more });
  return [chosen?.label ?? null, by];
};

test("the fewest shaded fragments win among those that look like the reference", () => {
  assert.deepEqual(choose(RUN), ["f2bd", "fragments"]);
});

test("what is resolved to be slower does not win by its fragments", () => {
  const slower = result("slow", 0.001, 10, { verdict: "slower", value: 0.7 });
  assert.deepEqual(choose({ results: [RUN.results[0], slower] }), ["b2f", "baseline"]);
});

test("a saving of less than 5 % is not worth a change", () => {
  assert.deepEqual(choose({ results: [RUN.results[0], result("f2bd", 0.01, 951)] }), ["b2f", "baseline"]);
  assert.deepEqual(choose({ results: [RUN.results[0], result("f2bd", 0.01, 950)] }), ["f2bd", "fragments"]);
});

test("an upper bound or a failed method is never chosen", () => {
  const failed = { ...result("broken", 0, 1), status: "failed", metrics: null, fragments: null, timing: null };
  assert.deepEqual(choose({ results: [RUN.results[0], RUN.results[3], failed] }), ["b2f", "baseline"]);
});

test("on a GPU a resolved time comes first, an open one does not count", () => {
  const faster = result("f2b", 0.01, 1000, { verdict: "faster", value: 1.5 });
  assert.deepEqual(choose({ results: [...RUN.results, faster] }, { software: false }), ["f2b", "time"]);
  assert.deepEqual(choose(RUN, { software: false }), ["f2bd", "fragments"]);
  assert.deepEqual(choose({ results: [RUN.results[0], RUN.results[4]] }, { software: false }), ["b2f", "baseline"]);
});

test("limits exclude methods, with the reason", () => {
  assert.deepEqual(choose(RUN, { limits: { ...ANY, no_sorting: true } }), ["meshkin", "limits"]);
  assert.deepEqual(choose(RUN, { limits: { ...ANY, error_limit: 0.1 } }), ["coarse", "fragments"]);
  assert.deepEqual(choose(RUN, { limits: { ...ANY, error_limit: 0.001 } }), [null, "none"]);
  const narrow = { ...ANY, no_sorting: true, memory_limit_bytes: 2 ** 20 };
  const { entries, closest } = advise(RUN, { methods: METHODS, baseline: "b2f", software: true, limits: narrow });
  assert.deepEqual(
    entries.map(({ excluded }) => excluded),
    ["sorts", "sorts", "visible error", "an upper bound, not a picture", "memory over the limit"],
  );
  assert.equal(closest.label, "b2f");
});

test("nothing is chosen where nothing was drawn or a pixel is not finite", () => {
  assert.deepEqual(choose({ ...RUN, nothing_drawn: "no fragment" }), [null, "none"]);
  const [baseline, other] = structuredClone(RUN.results);
  other.metrics.non_finite = 1;
  assert.deepEqual(choose({ results: [baseline, other] }), ["b2f", "baseline"]);
});

test("choices are counted over a sweep", () => {
  const runs = [RUN, RUN, { results: [RUN.results[0]] }];
  assert.deepEqual(tally(runs, { methods: METHODS, baseline: "b2f", software: true }), [
    ["f2bd", 2],
    ["b2f", 1],
  ]);
});

test("a color of the map leads back to its level", () => {
  // matplotlib's magma at 0, 128 and 255, in 8 bits.
  assert.deepEqual(
    [MAGMA[0], MAGMA[255]],
    [
      [0, 0, 4],
      [252, 253, 191],
    ],
  );
  assert.ok(MAGMA.every((color, level) => magma_level(...color) === level));
  assert.equal(magma_level(1, 2, 3), undefined);
});

test("differences are shown by their square root, or by a gain", () => {
  const root = { gain: 0, absolute: false };
  assert.deepEqual(
    [-255, -1, 0, 1, 255].map((size) => difference_level(size, root)),
    [1, 120, 128, 136, 255],
  );
  assert.equal(difference_level(-8, { gain: 16, absolute: true }), 128);
  assert.equal(difference_level(40, { gain: 64, absolute: false }), 255);
});

test("exposure doubles, gamma bends, channels are alone", () => {
  const floats = { width: 1, height: 1, channels: 4, data: Float32Array.of(0.25, 0.5, 2, 0.5) };
  const neutral = { exposure: 0, gamma: 1, channel: "rgb" };
  assert.deepEqual([...paint_color(floats, neutral)], [64, 128, 255, 255]);
  assert.deepEqual([...paint_color(floats, { ...neutral, exposure: 1 })], [128, 255, 255, 255]);
  assert.deepEqual([...paint_color(floats, { ...neutral, gamma: 2 })], [128, 180, 255, 255]);
  assert.deepEqual([...paint_color(floats, { ...neutral, channel: "g" })], [128, 128, 128, 255]);
  const levels = { width: 1, height: 1, channels: 4, data: Uint8ClampedArray.of(10, 20, 30, 255) };
  assert.deepEqual([...paint_color(levels, neutral)], [10, 20, 30, 255]);
});

test("a picture is put over another background by its opacity", () => {
  // A fifth of red, all of green and none of blue is hidden; the second pixel is the background itself.
  const size = { width: 2, height: 1 };
  const floats = { ...size, channels: 3, data: Float32Array.of(0.6, 0.9, 0.6, 0.2, 0.4, 0.6) };
  const opacity = { ...size, channels: 4, data: Uint8ClampedArray.of(51, 255, 0, 255, 0, 0, 0, 255) };
  const over = (name) => [...over_background(floats, opacity, [0.2, 0.4, 0.6], name).data].map((x) => x.toFixed(4));
  assert.deepEqual(over("black"), ["0.4400", "0.9000", "0.0000", "0.0000", "0.0000", "0.0000"]);
  assert.deepEqual(over("white"), ["1.2400", "0.9000", "1.0000", "1.0000", "1.0000", "1.0000"]);
  const wide = { width: 9, height: 1, channels: 3, data: new Float32Array(27) };
  const clear = { ...wide, channels: 4, data: new Uint8ClampedArray(36) };
  const checker = over_background(wide, clear, [0, 0, 0], "checker").data;
  assert.deepEqual([checker[0], checker[21], checker[24]], [1, 1, 0]);
});

test("the worst pixels come by size, one of each block", () => {
  const raster = (pixels) => {
    const data = new Uint8ClampedArray(32 * 16 * 4);
    for (const [x, y, level] of pixels) data[(y * 32 + x) * 4 + 1] = level;
    return { width: 32, height: 16, data };
  };
  const sizes = greatest_differences(
    raster([]),
    raster([
      [3, 4, 50],
      [5, 6, 60],
      [20, 7, 200],
    ]),
  );
  assert.deepEqual(worst_pixels(sizes, 32), [
    [20, 7],
    [5, 6],
  ]);
});

test("the growth along an axis is that at the run's other values", () => {
  const spec = {
    sweep: [
      { pointer: "/scene/count", values: [1, 2, 4] },
      { pointer: "/image/width", values: [8, 16] },
    ],
  };
  const entry = (width, exponent) => ({ pointer: "/scene/count", at: { "/image/width": width }, exponent });
  const memory = { ...entry(16, 5), metric: "memory_bytes" };
  const report = { growth: [entry(8, 1), entry(16, 2), { pointer: "/image/width", at: {}, exponent: 3 }, memory] };
  const [count, width] = axes_of(spec);
  const run = { point: { "/image/width": 16, "/scene/count": 4 } };
  const exponents = (axis, metric) => growth_along(report, axis, run, metric).map(({ exponent }) => exponent);
  assert.deepEqual(exponents(count, "timing.median"), [2]);
  assert.deepEqual(exponents(count, "memory_bytes"), [5]);
  assert.deepEqual(exponents(width, "timing.median"), []);
  assert.deepEqual(growth_along({}, count, run, "timing.median"), []);
});

test("a swept program is named, not written out", () => {
  const codes = ["return tint;", "vec4 color = tint;\nreturn color * 0.5;", "float a = 0.5;\nreturn tint * a;"];
  const spec = { sweep: [{ pointer: "/scene/shading/glsl", values: codes }] };
  const texts = codes.map((code) => point_text({ "/scene/shading/glsl": code }, spec));
  assert.deepEqual(texts, ["shading glsl return tint;", "shading glsl GLSL 2", "shading glsl GLSL 3"]);
});
