// One pixel explained: its fragments, the methods' results, and refused requests.
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { spawnSync } from "node:child_process";
import { glb, three_squares } from "./glb.mjs";
import { assert_problem, lasting, QUICK, until, with_service } from "./service.mjs";

const layer = (depth, color, alpha, opaque = false) => ({ rect: [0, 0, 1, 0.5], depth, color, alpha, opaque });

/**
 * In the upper half, four layers over an opaque one; a sweep sets the threshold of f2bd so that it takes effect before
 * the second or the fourth.
 */
const SPEC = {
  title: "Four layers",
  image: { width: 16, height: 8, background: [0.25, 0.5, 0.75] },
  scene: {
    type: "layers",
    layers: [
      layer(0.4, [0, 0, 1], 0.5),
      layer(0.2, [1, 0, 0], 0.5),
      layer(0.9, [1, 1, 1], 1, true),
      layer(0.8, [1, 1, 0], 0.5),
      layer(0.6, [0, 1, 0], 0.5),
    ],
  },
  methods: ["b2f", { id: "f2bd", threshold: 0.3, label: "early" }, "unsorted"],
  sweep: [{ pointer: "/methods/1/threshold", values: [0.6, 0.1] }],
  timing: { warmup: 1, rounds: 1 },
};

async function done(service, spec) {
  const { id } = await (await service.post(spec)).json();
  const report = await service.settled(id);
  assert.equal(report.status, "done", service.log);
  return id;
}

function near(actual, expected, tolerance, what) {
  assert.equal(actual.length, expected.length, what);
  actual.forEach((value, i) =>
    assert.ok(Math.abs(value - expected[i]) <= tolerance, `${what}: ${actual} for ${expected}`),
  );
}

const pointers = async (response) => (await response.json()).errors.map((error) => error.pointer);

test("a pixel's fragments, their weights and the methods' values are given", () =>
  with_service({}, async (service) => {
    const id = await done(service, SPEC);
    const pixel_at = async (query) => {
      const response = await fetch(`${service.api}/reports/${id}/pixel?${query}`);
      assert.equal(response.status, 200, service.log);
      return response.json();
    };
    const pixel = await pixel_at("x=3&y=2&run=1");
    assert.deepEqual([pixel.x, pixel.y, pixel.point], [3, 2, { "/methods/1/threshold": 0.1 }]);
    assert.deepEqual(
      pixel.fragments.map((one) => one.primitive),
      [1, 0, 4, 3],
    );
    near(
      pixel.fragments.map((one) => one.depth),
      [0.2, 0.4, 0.6, 0.8],
      1e-6,
      "depths",
    );
    near(
      pixel.fragments.map((one) => one.transmittance_before),
      [1, 0.5, 0.25, 0.125],
      1e-9,
      "transmittances",
    );
    near(
      pixel.fragments.map((one) => one.weight),
      [0.5, 0.25, 0.125, 0.0625],
      1e-9,
      "weights",
    );
    near(pixel.fragments[2].color, [0, 1, 0], 1e-6, "color");
    near(pixel.opaque.color, [1, 1, 1], 1e-6, "opaque color");
    near(pixel.background, [0.25, 0.5, 0.75], 1e-6, "background");
    assert.equal(pixel.transmittance, 0.0625);
    // Red 0.5, yellow 0.0625, white 0.0625; and so on.
    const sum = [0.625, 0.25, 0.3125];
    near(pixel.sum, sum, 1e-6, "sum");
    near(pixel.reference.value, sum, 1e-6, "reference");
    const [b2f, early, unsorted] = pixel.methods;
    near(b2f.value, sum, 2.5 / 255, "b2f");
    assert.deepEqual([b2f.shaded, b2f.needed, b2f.saturated_at], [4, 4, null]);
    // 1/16 is the first value under 0.1: nothing is left out.
    assert.deepEqual([early.label, early.shaded, early.needed, early.saturated_at], ["early", 4, 4, 4]);
    for (const method of pixel.methods)
      near(
        method.difference,
        method.value.map((value, i) => pixel.sum[i] - value),
        1e-12,
        method.label,
      );
    // Over white come blue, red, yellow and green, half of each.
    near(unsorted.value, [0.4375, 0.8125, 0.125], 2.5 / 255, "unsorted");

    const fact = (method, name) => method.explanation.find((one) => one.name === name)?.value;
    assert.deepEqual(fact(b2f, "blended"), [4, 3, 2, 1]);
    // As submitted: blue, red, yellow, green.
    assert.deepEqual(fact(unsorted, "blended"), [2, 1, 4, 3]);
    assert.deepEqual(
      [fact(early, "blended"), fact(early, "discarded"), fact(early, "saturated_at")],
      [[1, 2, 3, 4], [], null],
    );
    assert.ok(Math.abs(fact(early, "transmittance") - 1 / 16) <= 2 / 255);
    for (const method of pixel.methods) {
      near(method.explained_value, method.value, 1e-6, "drawn again");
      assert.equal(method.explanation_reason, undefined);
    }

    const first = await pixel_at("x=3&y=2");
    assert.deepEqual([fact(first.methods[1], "discarded"), fact(first.methods[1], "saturated_at")], [[2, 3, 4], 1]);
    assert.deepEqual(first.point, { "/methods/1/threshold": 0.6 });
    assert.deepEqual([first.methods[1].shaded, first.methods[1].needed, first.methods[1].saturated_at], [1, 1, 1]);
    near(first.methods[1].value, [0.5 + 0.5, 0.5, 0.5], 1.5 / 255, "only the first, over white");

    const empty = await pixel_at("x=15&y=7");
    assert.deepEqual([empty.fragments, empty.opaque, empty.methods[0].shaded], [[], null, 0]);
    near(empty.sum, [0.25, 0.5, 0.75], 1e-6, "background");
  }));

test("a pixel that does not exist is refused with the parameter's name", () =>
  with_service({}, async (service) => {
    const id = await done(service, SPEC);
    const ask = (query) => fetch(`${service.api}/reports/${id}/pixel${query}`);
    for (const [query, wrong] of [
      ["?x=16&y=0", ["/x"]],
      ["?x=0&y=8", ["/y"]],
      ["?x=16&y=8", ["/x", "/y"]],
      ["?x=-1&y=0", ["/x"]],
      ["?x=0", ["/y"]],
      ["", ["/x", "/y"]],
      ["?x=a&y=0", ["/x"]],
      ["?x=1.5&y=0", ["/x"]],
      ["?x=&y=0", ["/x"]],
      ["?x=0&y=0&run=2", ["/run"]],
      ["?x=0&y=0&run=one", ["/run"]],
      ["?x=0&y=0&z=0", ["/z"]],
      ["?x=99999999999999999999&y=0", ["/x"]],
    ]) {
      const response = await ask(query);
      assert.equal(response.status, 422, query);
      assert.match(response.headers.get("content-type"), /problem\+json/);
      assert.deepEqual((await pointers(response)).sort(), wrong, query);
    }
    await assert_problem(await fetch(`${service.api}/reports/none/pixel?x=0&y=0`), 404);
    await assert_problem(await ask("?x=%zz&y=0"), 400);
  }));

test("a report that is not done has no pixels yet", () =>
  with_service({}, async (service) => {
    const { id } = await (await service.post(lasting(30))).json();
    const response = await fetch(`${service.api}/reports/${id}/pixel?x=0&y=0`);
    await assert_problem(response, 409);
    await fetch(`${service.api}/reports/${id}`, { method: "DELETE" });
  }));

test("explaining a pixel has a time limit, and the service answers meanwhile", () =>
  with_service({ worker: { pixel_time_limit_s: 0.05 } }, async (service) => {
    // Making its textures already takes longer than that.
    const scene = { type: "quads", count: 1, texture: { size: 1024 } };
    const id = await done(service, { ...QUICK, scene, methods: ["b2f"] });
    const pixel = fetch(`${service.api}/reports/${id}/pixel?x=0&y=0`);
    assert.equal((await fetch(`${service.origin}/healthz`)).status, 200);
    await assert_problem(await pixel, 503);
  }));

test("only one pixel is explained at a time", () =>
  with_service({}, async (service) => {
    const id = await done(service, SPEC);
    const ask = () => fetch(`${service.api}/reports/${id}/pixel?x=0&y=0`);
    const answers = await Promise.all([ask(), ask(), ask()]);
    const statuses = answers.map((answer) => answer.status);
    assert.ok(statuses.includes(200), String(statuses));
    for (const answer of answers.filter((one) => one.status !== 200)) {
      assert.equal(answer.headers.get("retry-after"), "1");
      await assert_problem(answer, 429);
    }
    await until(async () => (await ask()).status === 200, "there is room again");
  }));

test("sheer pixel gives the same for a spec and a folder", () =>
  with_service({}, async (service) => {
    const spec = join(service.folder, "spec.json"),
      out = join(service.folder, "out");
    writeFileSync(spec, JSON.stringify(SPEC));
    const sheer = (...args) => spawnSync(process.env.SHEER, args, { encoding: "utf8" });
    assert.equal(sheer("compare", spec, "--out", out).status, 0);
    const of_spec = sheer("pixel", spec, "--x=3", "--y=2", "--run=1", "--json");
    assert.equal(of_spec.status, 0, of_spec.stderr);
    const of_folder = sheer("pixel", out, "--x=3", "--y=2", "--run=1", "--json");
    assert.deepEqual(JSON.parse(of_folder.stdout), JSON.parse(of_spec.stdout));
    assert.equal(JSON.parse(of_spec.stdout).fragments.length, 4);

    const table = sheer("pixel", out, "--x", "3", "--y", "2");
    assert.match(table.stdout, /4 transparent fragments/);
    assert.match(table.stdout, /early/);
    for (const args of [["--x=16", "--y=0"], ["--x=0", "--y=8"], ["--x=0", "--y=0", "--run=2"], ["--x=0"]])
      assert.equal(sheer("pixel", out, ...args).status, 2, String(args));
    const outside = sheer("pixel", out, "--x=16", "--y=0", "--json");
    assert.equal(outside.status, 2);
    assert.match(JSON.parse(outside.stdout).error.detail, /--x must be from 0 to 15/);
    assert.equal(sheer("pixel", join(service.folder, "none.json"), "--x=0", "--y=0").status, 2);

    const file = join(out, "report.json");
    const report = JSON.parse(readFileSync(file, "utf8"));
    report.runs[1].results[0].images = [];
    writeFileSync(file, JSON.stringify(report));
    const wrong = sheer("pixel", out, "--x=0", "--y=0");
    assert.equal(wrong.status, 2);
    assert.ok(
      wrong.stderr.includes(`${file} is not a report: /runs/1/results/0/images must be an object, not []`),
      wrong.stderr,
    );
  }));

/** A model in three files, a spec beside its folder, and a report of it in a folder elsewhere. */
function model_report(folder) {
  const { json, binary } = three_squares();
  mkdirSync(join(folder, "specs", "models"), { recursive: true });
  writeFileSync(
    join(folder, "specs", "models", "squares.gltf"),
    JSON.stringify({ ...json, buffers: [{ ...json.buffers[0], uri: "squares.bin" }] }),
  );
  writeFileSync(join(folder, "specs", "models", "squares.bin"), binary);
  const spec = { ...QUICK, scene: { type: "gltf", model: "models/squares.gltf", light: "none" } };
  writeFileSync(join(folder, "specs", "spec.json"), JSON.stringify(spec));
  const sheer = (...args) => spawnSync(process.env.SHEER, args, { encoding: "utf8", cwd: folder });
  const made = sheer("compare", "specs/spec.json", "--out", "out");
  assert.equal(made.status, 0, made.stderr);
  return { sheer, binary, report: JSON.parse(readFileSync(join(folder, "out", "report.json"), "utf8")) };
}

test("fragments of a file that has changed are not shown beside the old pictures", () => {
  const folder = mkdtempSync(join(tmpdir(), "sheer-pixel-"));
  try {
    const { sheer, binary, report } = model_report(folder);
    const sha256 = (bytes) => createHash("sha256").update(bytes).digest("hex");
    assert.deepEqual(
      report.files.map(({ pointer, name, of, sha256, bytes }) => [pointer, name, of, sha256, bytes]),
      [
        [
          "/scene/model",
          "models/squares.gltf",
          null,
          sha256(readFileSync(join(folder, "specs/models/squares.gltf"))),
          readFileSync(join(folder, "specs/models/squares.gltf")).length,
        ],
        ["/scene/model", "models/squares.bin", "models/squares.gltf", sha256(binary), binary.length],
      ],
    );
    const pixel = (...more) => sheer("pixel", "out", "--x=8", "--y=8", ...more);
    const same = pixel();
    assert.equal(same.status, 0, `the spec's folder is known: ${same.stderr}`);
    assert.equal(sheer("compare", "specs/spec.json", "--out", "before").status, 0);

    const other = Buffer.from(binary);
    other.writeFloatLE(-0.5, 0);
    writeFileSync(join(folder, "specs/models/squares.bin"), other);
    const changed = pixel();
    assert.equal(changed.status, 2, changed.stdout);
    assert.match(changed.stderr, /^sheer: models\/squares\.bin has changed since the report was made/);
    assert.equal(changed.stdout, "");
    assert.match(JSON.parse(pixel("--json").stdout).error.detail, /squares\.bin has changed/);

    assert.equal(sheer("compare", "specs/spec.json", "--out", "after").status, 0);
    const diff = sheer("diff", "before", "after");
    assert.match(
      diff.stdout,
      new RegExp(`^The file models/squares\\.bin \\(/scene/model\\): .*${sha256(binary)} \\| .*${sha256(other)}$`, "m"),
    );

    // One that can no longer be read is also reported as changed.
    writeFileSync(join(folder, "specs/models/squares.gltf"), "{}");
    assert.match(pixel().stderr, /models\/squares\.gltf has changed/);
    rmSync(join(folder, "specs/models/squares.gltf"));
    const gone = pixel();
    assert.equal(gone.status, 2);
    assert.ok(gone.stderr.includes(`looked for it at ${join(folder, "specs/models/squares.gltf")}`), gone.stderr);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
});

test("over HTTP a report names uploaded files by their hashes, and no path of the host", () =>
  with_service({}, async (service) => {
    const upload = await fetch(`${service.api}/assets`, {
      method: "POST",
      body: glb(three_squares()),
      headers: { "Content-Type": "model/gltf-binary" },
    });
    const { sha256, bytes } = await upload.json();
    const id = await done(service, { ...QUICK, scene: { type: "gltf", model: sha256, light: "none" } });
    const report = await service.report(id);
    assert.deepEqual(report.files, [{ pointer: "/scene/model", name: sha256, of: null, sha256, bytes }]);
    assert.equal((await fetch(`${service.api}/reports/${id}/pixel?x=8&y=8`)).status, 200);
    assert.equal((await fetch(`${service.api}/assets/${sha256}`, { method: "DELETE" })).status, 204);
    const gone = await assert_problem(await fetch(`${service.api}/reports/${id}/pixel?x=8&y=8`), 409);
    assert.ok(!gone.detail.includes(service.folder) && !JSON.stringify(report).includes(service.folder), gone.detail);
  }));
