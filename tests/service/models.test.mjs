// Uploaded glTF models: rendered with all three alpha modes, or refused with the reason.
import assert from "node:assert/strict";
import { test } from "node:test";
import { read_exr } from "./exr.mjs";
import { glb, three_squares } from "./glb.mjs";
import { assert_problem, with_service } from "./service.mjs";

const GLB = "model/gltf-binary",
  GLTF = "model/gltf+json";

const upload = (service, bytes, type) =>
  fetch(`${service.api}/assets`, { method: "POST", body: bytes, headers: { "Content-Type": type } });

const spec = (model) => ({
  image: { width: 16, height: 16, format: "rgba32f" },
  scene: { type: "gltf", model, light: "none", camera: { eye: [0, 0, 10], target: [0, 0, 0], fov_y_deg: 90 } },
  methods: ["b2f", "f2b"],
  timing: { warmup: 1, rounds: 1 },
});

test("a model is uploaded and rendered: masked on the left, blended over opaque on the right", async () => {
  await with_service({}, async (service) => {
    const { json, binary } = three_squares();
    const as_text = {
      ...json,
      buffers: [{ ...json.buffers[0], uri: `data:application/octet-stream;base64,${binary.toString("base64")}` }],
    };
    for (const [bytes, type] of [
      [glb({ json, binary }), GLB],
      [JSON.stringify(as_text), GLTF],
    ]) {
      const created = await upload(service, bytes, type);
      assert.equal(created.status, 201, await created.clone().text());
      const asset = await created.json();
      assert.equal(asset.type, "model");
      assert.deepEqual([asset.triangles, asset.materials, asset.pictures], [6, 3, 1]);
      const report = await service.settled(await service.submit(spec(asset.sha256)));
      assert.equal(report.status, "done", JSON.stringify(report.error));
      for (const result of report.runs[0].results) {
        const image = await fetch(service.origin + result.images.linear.url);
        const { width, height, channels } = read_exr(await image.arrayBuffer());
        for (let i = 0; i < width * height; ++i) {
          const expected = i % width < width / 2 ? [0.2, 0.6, 1] : [0.5, 0, 0.5];
          ["R", "G", "B"].forEach((name, channel) =>
            assert.ok(Math.abs(channels[name][i] - expected[channel]) < 1e-5, `${name} ${i}: ${channels[name][i]}`),
          );
        }
      }
    }
  });
});

/** The valid model with one change. */
function broken(change) {
  const model = three_squares();
  change(model);
  return glb(model);
}

test("a broken model is refused with the reason, and nothing is left", async () => {
  await with_service({ workers: 0 }, async (service) => {
    const good = glb(three_squares());
    const refused = [
      ["half a file", good.subarray(0, good.length / 2), /cut off/],
      ["a wild index", broken(({ binary }) => binary.writeUInt16LE(9999, 80)), /9999 is not one of the 4 vertices/],
      [
        "no buffer",
        broken((model) => {
          model.binary = Buffer.alloc(0);
        }),
        /buffer 0 is missing/,
      ],
      [
        "another file",
        broken(({ json }) => {
          json.buffers[0].uri = "scene.bin";
        }),
        /needs another file, "scene\.bin"/,
      ],
      [
        "a secret file",
        broken(({ json }) => {
          json.images[0] = { uri: "../../etc/passwd" };
        }),
        /needs another file/,
      ],
      [
        "a loop of nodes",
        broken(({ json }) => {
          json.nodes[0].children = [0];
        }),
        /must form trees/,
      ],
      [
        "a position that is no number",
        broken(({ binary }) => binary.writeUInt32LE(0x7fc00000, 0)),
        /not a finite number/,
      ],
      [
        "compressed",
        broken(({ json }) => {
          json.extensionsRequired = ["KHR_texture_basisu"];
        }),
        /KHR_texture_basisu/,
      ],
      ["text", Buffer.from("glory"), /begins with "glTF"/],
    ];
    for (const [name, bytes, reason] of refused) {
      const problem = await assert_problem(await upload(service, bytes, GLB), 422);
      assert.match(problem.detail, reason, name);
    }
    assert.deepEqual((await (await fetch(`${service.api}/assets`)).json()).assets, []);
    assert.equal((await upload(service, good, GLB)).status, 201);
    assert.match((await assert_problem(await upload(service, "{}", GLTF), 422)).detail, /version of glTF/);
  });
});
