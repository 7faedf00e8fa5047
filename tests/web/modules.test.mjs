// The page's modules that need no view, run in a browser.
import assert from "node:assert/strict";
import { service_tests } from "./harness.mjs";

const tests = service_tests();

/** A test whose body runs in the page with the module's exports. */
function module_test(name, module, body, expected) {
  tests.page_test(name, {}, async (page) => {
    await page.goto(`${tests.url()}/#/reports`);
    const source = `import("/${module}").then(${body})`;
    assert.deepEqual(await page.evaluate(source), expected);
  });
}

module_test(
  "a spec stays as short as it was written",
  "spec_model.js",
  ({ SpecModel }) => {
    const model = new SpecModel({ methods: ["b2f", "f2bd"], scene: { type: "quads" }, other: 1 });
    const seen = [];
    model.set(["methods", 1, "threshold"], 0.5);
    seen.push(structuredClone(model.spec.methods));
    seen.push([
      model.get(["methods", 1, "id"]),
      model.get(["methods", 0, "id"]),
      model.get(["timing", "rounds"]) ?? null,
    ]);
    model.set(["methods", 1, "threshold"], undefined);
    model.set(["scene", "texture", "size"], 64);
    seen.push(structuredClone(model.spec));
    model.set(["scene", "texture", "size"], undefined);
    seen.push(structuredClone(model.spec));
    return seen;
  },
  [
    ["b2f", { id: "f2bd", threshold: 0.5 }],
    ["f2bd", "b2f", null],
    { methods: ["b2f", "f2bd"], scene: { type: "quads", texture: { size: 64 } }, other: 1 },
    { methods: ["b2f", "f2bd"], scene: { type: "quads" }, other: 1 },
  ],
);

module_test(
  "a JSON pointer leads to its place in the text",
  "json_position.js",
  ({ json_range }) => {
    const text = '{ "a\\"b": [1, {"c/d~": [ "x,]}" ]}], "e": -2.5e3 }';
    const part = (pointer) => text.slice(...json_range(text, pointer));
    return ["/e", '/a"b/0', '/a"b/1/c~1d~0/0', '/a"b/1/missing', "/nothing"].map(part);
  },
  ["-2.5e3", "1", '"x,]}"', '{"c/d~": [ "x,]}" ]}', '{ "a\\"b": [1, {"c/d~": [ "x,]}" ]}], "e": -2.5e3 }'],
);

module_test(
  "numbers line up and a missing one is a dash",
  "format.js",
  ({ column_decimals, fixed, integer, short_value, zoom_text }) => [
    column_decimals([12.3, 0.0456, null]),
    column_decimals([1, 20, 0]),
    column_decimals([]),
    fixed(-1.005, 1),
    fixed(0, 4),
    fixed(null, 2),
    fixed(1e-9, 3),
    integer(-12345),
    zoom_text(0.0625),
    short_value({ data: "ab01".repeat(16), raw: null, sides: [1, 2.5] }),
    short_value("ab01".repeat(10)),
  ],
  [4, 0, 0, "−1.0", "0", "–", "1.0e−9", "−12,345", "6 %", "data ab01ab01ab01…, sides [1, 2.5]", "ab01".repeat(10)],
);

module_test(
  "the best of a column: closest to no error by the digits shown, and none if all are equal",
  "columns.js",
  async ({ best_results, difference_columns, missing_reason }) => {
    const [metrics, columns] = await Promise.all(
      ["metrics", "columns"].map(async (name) => (await fetch(`/api/v1/${name}`)).json()),
    );
    const result = (label, median, psnr, min, extra = {}) => ({
      label,
      status: "ok",
      timing: { median },
      metrics: { psnr, rmse: psnr === null ? 0 : 0.1, signed: { min } },
      ...extra,
    });
    const results = [
      result("identical", 5, null, 0),
      result("near", 4, 60, -3),
      result("far", 3, 20, -90),
      result("bound", 1, null, 0, { metrics: null, metrics_reason: "draws nothing" }),
      result("broken", 0.1, 99, 0, { status: "failed", reason: "out of memory" }),
    ];
    const column = (path) => [...difference_columns(metrics), ...columns].find((one) => one.path === path);
    const best = (path, of = results) => [...best_results(of, column(path))].map((one) => one.label);
    return [
      best("timing.median"),
      best("metrics.psnr"),
      best("metrics.signed.min"),
      best("metrics.signed.min", [results[1], results[1]]),
      best("metrics.psnr", [result("a", 1, 50.0001, 0), result("b", 1, 50.0002, 0), result("c", 1, 40, 0)]),
      best("metrics.psnr", [result("a", 1, 50.0001, 0), result("b", 1, 50.0002, 0)]),
      missing_reason(results[0], column("metrics.psnr")),
      missing_reason(results[3], column("metrics.psnr")),
      missing_reason(results[4], column("timing.median")),
    ];
  },
  [
    [],
    ["identical"],
    ["identical"],
    [],
    ["a", "b"],
    [],
    "none: identical to the reference",
    "draws nothing",
    "failed: out of memory",
  ],
);

module_test(
  "a metric's column comes from its description",
  "columns.js",
  ({ difference_columns }) => {
    const field = { kind: "number", unit: "", range: "-1..1", summary: "How odd", null_is_identical: false };
    const column = { head: "Odd", better: "higher", digits: 4, note: null };
    const metrics = [
      { id: "odd", name: "Oddness", fields: [{ ...field, name: "", full_name: "odd", column }] },
      {
        id: "made_up",
        name: "Made up",
        fields: [
          { ...field, name: "hidden", full_name: "made_up.hidden", column: null },
          {
            ...field,
            ...{ name: "count", full_name: "made_up.count", kind: "count", unit: "px", null_is_identical: true },
            column: { head: "Made", better: "nearer zero", digits: 3, note: "hidden" },
          },
        ],
      },
    ];
    return difference_columns(metrics).map(({ better, ...rest }) => ({ ...rest, better: [-3, 2].map(better) }));
  },
  [
    {
      path: "metrics.odd",
      name: "odd",
      head: "Odd",
      unit: "−1..1",
      title: "Oddness: How odd",
      digits: 4,
      whole: false,
      pixel: false,
      null_is_perfect: false,
      note: null,
      better: [3, -2],
    },
    {
      path: "metrics.made_up.count",
      name: "made_up.count",
      head: "Made",
      unit: "px",
      title: "Made up: How odd",
      digits: 3,
      whole: true,
      pixel: false,
      null_is_perfect: true,
      note: "metrics.made_up.hidden",
      better: [3, 2],
    },
  ],
);

module_test(
  "only resolved methods are fastest, and only if no unresolved one is faster by the digits shown",
  "columns.js",
  async ({ columns_of, fastest_labels, fastest_results }) => {
    const columns = await (await fetch("/api/v1/columns")).json();
    const result = (label, median, verdict, metrics = {}) => ({
      label,
      status: "ok",
      timing: { median },
      speedup: { verdict },
      metrics,
    });
    const base = result("base", 100, "not resolved");
    const labels = (results, frontier = null) => [...fastest_labels({ results, frontier })];
    const run = { results: [base, result("named", 1, "faster")], frontier: { fastest: ["named"] } };
    const column = (path) => columns_of(columns, "times").find((one) => one.path === path);
    const marks = (one) => [...fastest_results(run, one)].map(({ label }) => label);
    return [
      labels([base, result("quick", 50, "faster"), result("slow", 200, "slower")]),
      labels([base, result("perhaps", 50, "not resolved")]),
      labels([base, result("quick", 60, "faster"), result("perhaps", 50, "not resolved")]),
      labels([base, result("a", 50.0001, "faster"), result("b", 50.0002, "faster"), result("c", 51, "faster")]),
      labels([base, result("bound", 1, "faster", null), result("quick", 50, "faster")]),
      labels([base, result("slow", 200, "slower")]),
      labels([base, result("quick", 50, "faster")], { fastest: [] }),
      marks(column("timing.median")),
      marks(column("timing.min")),
      marks(columns_of(columns, "speedups")[0]),
    ];
  },
  [["quick"], [], [], ["a", "b"], ["quick"], [], [], ["named"], [], ["named"]],
);

module_test(
  "pictures stay on whole screen pixels while they are zoomed at a point",
  "viewport.js",
  ({ Viewport }) => {
    const pane = { width: 301, height: 201 };
    const view = new Viewport(64, 32);
    const seen = [view.zoom_in(pane.width, pane.height)];
    const before = view.place(pane.width, pane.height, 0.25, 0);
    seen.push(Number.isInteger(before.left + 0.25), Number.isInteger(before.top));
    view.zoom_to(8, pane, 10, 5);
    const after = view.place(pane.width, pane.height);
    const start = new Viewport(64, 32).place(pane.width, pane.height);
    const moved = (axis, at) => after[axis] + at * after.scale - (start[axis] + at * start.scale);
    seen.push(Math.abs(moved("left", 10)) <= 1, Math.abs(moved("top", 5)) <= 1);
    view.show_pixel(63, 0, 16);
    seen.push(view.cursor);
    view.move_cursor(5, -5);
    seen.push(view.cursor);
    return seen;
  },
  [4, true, true, true, true, [63, 0], [63, 0]],
);
