// The error tables of Meshkin's slides 19 (the full variant) and 21 (both), from pictures that the service made: four
// layers with the same alpha a, C0 farthest, over D. True minus approximation is d D - c0 C0 - c1 C1 - c2 C2.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { read_exr } from "./exr.mjs";
import { Service } from "./service.mjs";

const TOLERANCE = 1e-3;

const SLIDES = [
  { alpha: 0, simple: [0, 0, 0, 0, 0], full: [0, 0, 0, 0, 0] },
  {
    alpha: 0.25,
    simple: [0.31640625, -0.14453125, -0.109375, -0.0625, 0],
    full: [0.375, -0.14453125, -0.109375, -0.0625, 0],
  },
  { alpha: 0.5, simple: [1.0625, -0.4375, -0.375, -0.25, 0], full: [1.5, -0.4375, -0.375, -0.25, 0] },
  {
    alpha: 0.75,
    simple: [2.00390625, -0.73828125, -0.703125, -0.5625, 0],
    full: [3.375, -0.73828125, -0.703125, -0.5625, 0],
  },
  { alpha: 1, simple: [3, -1, -1, -1, 0], full: [6, -1, -1, -1, 0] },
];

/**
 * D, C0 .. C3 for which the pictures of all rows stay within 0..1, and then with each of them raised, in a separate
 * column.
 */
const STEP = 0.05,
  BASE = [0.1, 0.25, 0.25, 0.25, 0.25];
const COLUMNS = [BASE, ...BASE.map((_, raised) => BASE.map((gray, i) => (i === raised ? gray + STEP : gray)))];

/** The formulas of slides 20 and 34, and the exact one, for D and C0 .. C3. */
const FORMULAS = {
  exact: ([below, ...colors], a) => colors.reduce((behind, color) => a * color + (1 - a) * behind, below),
  simple: ([below, ...colors], a) => below + colors.reduce((sum, color) => sum + a * color, 0) - 4 * a * below,
  full: (grays, a) => FORMULAS.simple(grays, a) - (a === 0 ? 0 : grays[0] * (4 / a) * a ** 4) + grays[0] * a ** 4,
};

function layers(alpha) {
  return COLUMNS.flatMap((grays, column) =>
    grays.map((gray, i) => ({
      rect: [column / COLUMNS.length, 0, (column + 1) / COLUMNS.length, 1],
      depth: 0.9 - 0.1 * i,
      color: [gray, gray, gray],
      alpha: i === 0 ? 1 : alpha,
      opaque: i === 0,
    })),
  );
}

const service = new Service();
before(() => service.start());
after(() => service.end_well());

/** The gray of each column in a picture of the report. */
async function grays_of(image) {
  assert.equal(image.media_type, "image/x-exr");
  const response = await fetch(new URL(image.url, service.origin));
  assert.equal(response.status, 200);
  const { width, height, channels } = read_exr(await response.arrayBuffer());
  assert.deepEqual([width, height], [COLUMNS.length, 3]);
  assert.deepEqual(channels.R, channels.G);
  return Array.from(channels.G.subarray(width, 2 * width));
}

for (const { alpha, ...expected } of SLIDES) {
  test(`four layers of alpha ${alpha}`, async () => {
    const response = await service.post(
      {
        title: `Meshkin, alpha ${alpha}`,
        image: { width: COLUMNS.length, height: 3, format: "rgba32f" },
        scene: { type: "layers", layers: layers(alpha) },
        reference: "exact",
        timing: { warmup: 1, rounds: 1 },
        methods: ["simple", "full"].map((variant) => ({ id: "meshkin", variant, label: variant })),
      },
      { Prefer: "wait=60" },
    );
    const report = await response.json();
    assert.equal(report.status, "done", JSON.stringify(report.error ?? report));
    const [run] = report.runs;
    const truth = await grays_of(run.reference.images.linear);
    for (const result of run.results) {
      const picture = await grays_of(result.images.linear);
      COLUMNS.forEach((grays, column) => {
        for (const [values, formula] of [
          [truth, "exact"],
          [picture, result.label],
        ])
          assert.ok(Math.abs(values[column] - FORMULAS[formula](grays, alpha)) < 1e-5, `${formula}, column ${column}`);
      });
      // The error is linear in D and C0 .. C3: the increase from raising one of them gives its coefficient.
      const errors = truth.map((value, column) => value - picture[column]);
      expected[result.label].forEach((coefficient, i) => {
        const measured = (errors[i + 1] - errors[0]) / STEP;
        assert.ok(
          Math.abs(measured - coefficient) < TOLERANCE,
          `${result.label}, ${i}: ${measured}, not ${coefficient}`,
        );
      });
      const whole = expected[result.label].reduce((sum, coefficient, i) => sum + coefficient * BASE[i], 0);
      assert.ok(Math.abs(errors[0] - whole) < TOLERANCE, `${result.label}: ${errors[0]}, not ${whole}`);
    }
  });
}
