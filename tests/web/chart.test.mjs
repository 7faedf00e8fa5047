// Scales of charts and the data of sweeps: values worked out by hand.
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

const { make_scale, round_to_step, scale_kind, thinned, tick_text, value_axis } = await load("scales.js");
const { axes_of, field_name, point_text, runs_along, series_along, stops_of } = await load("sweep.js");

test("a scale is logarithmic only over more than a decade above 0", () => {
  assert.equal(scale_kind([1, 11]), "log");
  assert.equal(scale_kind([1, 10]), "linear");
  assert.equal(scale_kind([0, 1000]), "linear");
  assert.equal(scale_kind([-1, 1000]), "linear");
  assert.equal(scale_kind([5]), "linear");
  assert.equal(scale_kind([1, "16"]), "categories");
  assert.equal(scale_kind([1, null]), "categories");
  assert.equal(scale_kind([]), "categories");
});

test("values are at the right places", () => {
  const linear = make_scale("linear", [0, 50], [100, 0]);
  assert.deepEqual([0, 10, 50, 60].map(linear), [100, 80, 0, -20]);
  const log = make_scale("log", [1, 10_000], [20, 420]);
  // A decade is 100 px; log10 of 2 is 0.30103.
  assert.deepEqual([1, 10, 100, 10_000].map(log), [20, 120, 220, 420]);
  assert.ok(Math.abs(log(2) - 50.103) < 1e-3);
  assert.equal(make_scale("linear", [3, 3], [0, 40])(3), 20);
});

test("axes end at round numbers and contain every value", () => {
  assert.deepEqual(value_axis("linear", [0, 9.3]), { domain: [0, 10], ticks: [0, 2, 4, 6, 8, 10] });
  assert.deepEqual(value_axis("linear", [-3, 4]), { domain: [-4, 4], ticks: [-4, -2, 0, 2, 4] });
  assert.deepEqual(value_axis("linear", [0, 0.3]).ticks, [0, 0.1, 0.2, 0.3]);
  assert.deepEqual(value_axis("linear", [0, 0]).ticks, [0, 0.2]);
  assert.deepEqual(value_axis("log", [0.6, 17]), { domain: [0.5, 20], ticks: [0.5, 1, 2, 5, 10, 20] });
  assert.deepEqual(value_axis("log", [2, 2]), { domain: [2, 5], ticks: [2, 5] });
  assert.deepEqual(value_axis("log", [0.15, 8900]), { domain: [0.1, 10_000], ticks: [0.1, 1, 10, 100, 1000, 10_000] });
});

test("steps are 1, 2 and 5", () => {
  assert.deepEqual(
    [1, 1.2, 3, 7, 0.0021, 10].map((value) => round_to_step(value)),
    [1, 2, 5, 10, 0.005, 10],
  );
  assert.deepEqual(
    [1, 1.9, 4.9, 99, 0.3].map((value) => round_to_step(value, true)),
    [1, 1, 2, 50, 0.2],
  );
});

test("names on an axis do not overlap, and the last one is always shown", () => {
  assert.deepEqual(thinned([0, 10, 20, 30, 40], 20), [0, 20, 40]);
  assert.deepEqual(thinned([0, 35, 40], 20), [0, 40]);
  assert.deepEqual(thinned([0, 100], 20), [0, 100]);
  assert.deepEqual(thinned([], 20), []);
});

test("numbers on an axis are short", () => {
  assert.deepEqual([0, 8192, 0.1 + 0.2, 0.0005, 1e6, -2, 2e-7].map(tick_text), [
    "0",
    "8192",
    "0.3",
    "0.0005",
    "1e6",
    "−2",
    "2e−7",
  ]);
});

const SPEC = {
  methods: ["b2f", { id: "f2bd", label: "mine" }],
  sweep: [
    { pointer: "/scene/count", values: [64, 1, 16] },
    { points: [{ "/scene/shading": "constant" }, { "/scene/shading": "1-texture", "/scene/texture/size": 64 }] },
  ],
};

test("points have readable names", () => {
  assert.equal(point_text({ "/scene/count": 16 }, SPEC), "count 16");
  assert.equal(point_text({ "/scene/texture/size": 64, "/image/width": 32 }, SPEC), "texture size 64, width 32");
  assert.equal(field_name("/methods/1/threshold", SPEC), "mine threshold");
  assert.equal(field_name("/methods/0/alpha_target", SPEC), "b2f alpha target");
  assert.equal(point_text({ "/image/background": [0, 0.5, 1] }, SPEC), "background [0, 0.5, 1]");
  assert.equal(point_text({}, SPEC), "");
  assert.equal(field_name("/scene/a~1b~0"), "a/b~");
});

test("axes hold single values, or points of several fields", () => {
  const [count, shading] = axes_of(SPEC);
  assert.equal(count.name, "count");
  assert.deepEqual(count.stops, [
    { value: 64, text: "64" },
    { value: 1, text: "1" },
    { value: 16, text: "16" },
  ]);
  assert.equal(shading.name, "shading, texture size");
  assert.deepEqual(
    shading.stops.map((stop) => stop.text),
    ["constant", "1-texture, 64"],
  );
  assert.deepEqual(axes_of({}), []);
});

test("fields of several methods that are called alike are named once", () => {
  const fields = ["/methods/0/passes", "/methods/1/passes", "/methods/2/frames"];
  const point = (...values) => Object.fromEntries(fields.map((field, index) => [field, values[index]]));
  const [axis] = axes_of({
    methods: ["stochastic", "stochastic", "hashed_alpha"],
    sweep: [{ points: [point(1, 1, 4), point(4, 8, 16)] }],
  });
  assert.equal(axis.name, "passes, frames");
  assert.deepEqual(
    axis.stops.map((stop) => stop.text),
    ["1, 4", "4/8, 16"],
  );
});

/** A run whose method took `median` ms. */
const run = (count, shading, median) => ({
  point: { "/scene/count": count, ...shading },
  results: [
    { label: "b2f", status: "ok", timing: { median, ci95: [median - 1, median + 1] } },
    { label: "mine", status: "failed", timing: null, reason: "out of memory" },
  ],
});
const CONSTANT = { "/scene/shading": "constant" };
const TEXTURE = { "/scene/shading": "1-texture", "/scene/texture/size": 64 };

test("a line follows one axis at the values that the others have at the chosen point", () => {
  const axes = axes_of(SPEC);
  const runs = [64, 1, 16].flatMap((count) => [run(count, CONSTANT, count), run(count, TEXTURE, count * 10)]);
  assert.deepEqual(stops_of(axes, runs[5].point), [2, 1]);
  assert.deepEqual(stops_of(axes, { "/scene/count": 3 }), [-1, -1]);
  const along = runs_along(axes, runs, 0, runs[1]);
  assert.deepEqual(series_along(along, "timing.median", "timing.ci95"), [
    {
      label: "b2f",
      points: [
        { stop: 0, value: 640, interval: [639, 641] },
        { stop: 1, value: 10, interval: [9, 11] },
        { stop: 2, value: 160, interval: [159, 161] },
      ],
    },
    { label: "mine", points: [0, 1, 2].map((stop) => ({ stop, value: null, interval: null })) },
  ]);
  const across = runs_along(axes, runs, 1, runs[4]);
  assert.deepEqual(
    series_along(across, "timing.median")[0].points.map((point) => point.value),
    [16, 160],
  );
});
