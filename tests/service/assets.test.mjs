// Uploaded files: what is accepted, what is refused, and how a spec may use them.
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { test } from "node:test";
import { plain_png, png } from "./pictures.mjs";
import { assert_problem, QUICK, with_service } from "./service.mjs";

const COLOR = [200, 100, 50];
const PICTURE = plain_png(4, COLOR);
const SHA256 = createHash("sha256").update(PICTURE).digest("hex");

function upload(service, bytes, type, query = "") {
  const headers = type === null ? {} : { "Content-Type": type };
  return fetch(`${service.api}/assets${query}`, { method: "POST", body: bytes, headers });
}

async function listed(service) {
  const response = await fetch(`${service.api}/assets`);
  assert.equal(response.status, 200);
  return (await response.json()).assets;
}

const textured = (image) => ({
  ...QUICK,
  scene: {
    type: "layers",
    shading: "1-texture",
    texture: { image, size: 16 },
    layers: [{ rect: [0, 0, 1, 1], depth: 0.5, color: [1, 1, 1], alpha: 1 }],
  },
});

const CONSTANT = {
  ...QUICK,
  scene: {
    type: "layers",
    shading: "constant",
    layers: [{ rect: [0, 0, 1, 1], depth: 0.5, color: COLOR.map((part) => part / 255), alpha: 1 }],
  },
};

test("an upload is stored once and becomes the texture of a report", async () => {
  await with_service({}, async (service) => {
    const created = await upload(service, PICTURE, "image/png", "?name=rust.png");
    assert.equal(created.status, 201);
    assert.equal(created.headers.get("location"), `/api/v1/assets/${SHA256}`);
    const asset = await created.json();
    const { created_at, ...rest } = asset;
    assert.ok(Math.abs(Date.now() - Date.parse(created_at)) < 600_000);
    assert.deepEqual(rest, {
      sha256: SHA256,
      type: "texture",
      media_type: "image/png",
      name: "rust.png",
      bytes: PICTURE.length,
      width: 4,
      height: 4,
      channels: 3,
      notes: [],
      url: `/api/v1/assets/${SHA256}`,
    });
    const again = await upload(service, PICTURE, "Image/PNG; x=y", "?name=another");
    assert.equal(again.status, 200);
    assert.deepEqual(await again.json(), asset);
    const black = await (await upload(service, plain_png(2, [0, 0, 0]), "image/png")).json();
    assert.deepEqual(await listed(service), [black, asset]);

    const bytes = await fetch(service.origin + asset.url);
    assert.equal(bytes.headers.get("content-type"), "image/png");
    assert.equal(bytes.headers.get("x-content-type-options"), "nosniff");
    assert.deepEqual(Buffer.from(await bytes.arrayBuffer()), PICTURE);

    const pictures = [];
    for (const spec of [textured(SHA256), CONSTANT, textured(black.sha256)]) {
      const report = await service.settled(await service.submit(spec));
      assert.equal(report.status, "done", JSON.stringify(report.error));
      pictures.push(report.runs[0].results[0].images.color.sha256);
    }
    assert.equal(pictures[0], pictures[1]);
    assert.notEqual(pictures[0], pictures[2]);

    assert.equal((await fetch(service.origin + asset.url, { method: "DELETE" })).status, 204);
    await assert_problem(await fetch(service.origin + asset.url), 404);
    await assert_problem(await fetch(service.origin + asset.url, { method: "DELETE" }), 404);
    assert.deepEqual(await listed(service), [black]);
    assert.equal(service.kept("assets").length, 1);
  });
});

test("a file that does not match its type is refused with the reason, and nothing is left", async () => {
  await with_service({ workers: 0, assets: { max_bytes: 20_000 } }, async (service) => {
    const huge = png(60000, 60000, 2, [Buffer.alloc(3)]);
    const refused = [
      ["no type", PICTURE, null, 415, /Content-Type is missing/],
      ["another type", PICTURE, "text/plain", 415, /image\/png.*not text\/plain/],
      ["a PNG as a JPEG", PICTURE, "image/jpeg", 422, /is a PNG, not a JPEG/],
      ["a web page as a PNG", "<html>", "image/png", 422, /not a PNG, JPEG, OpenEXR/],
      ["nothing", "", "image/png", 422, /empty/],
      ["half a PNG", PICTURE.subarray(0, PICTURE.length / 2), "image/png", 422, /ends too early/],
      ["a PNG with a huge size in its header", huge, "image/png", 422, /60000 x 60000/],
      ["too much", Buffer.alloc(20_001), "image/png", 413, /too long/],
    ];
    for (const [name, bytes, type, status, reason] of refused) {
      const problem = await assert_problem(await upload(service, bytes, type), status);
      assert.match(problem.detail, reason, name);
    }
    assert.deepEqual(await listed(service), []);
    assert.deepEqual(service.kept("assets"), []);
    assert.equal((await upload(service, PICTURE, "image/png")).status, 201);
    // Assets have their own limit.
    await assert_problem(await service.post(" ".repeat(30_000)), 400);
  });
});

test("a check that takes too long is a refusal", async () => {
  const large = png(8192, 8192, 0, Array(8192).fill(Buffer.alloc(8192)));
  await with_service({ workers: 0, assets: { check_time_s: 0.05 } }, async (service) => {
    const problem = await assert_problem(await upload(service, large, "image/png"), 422);
    assert.match(problem.detail, /longer than 0\.05 s/);
    assert.deepEqual(service.kept("assets"), []);
  });
});

test("a spec names an existing asset, never a path", async () => {
  await with_service({ workers: 0 }, async (service) => {
    const validate = (spec) =>
      fetch(`${service.api}/specs/validate`, {
        method: "POST",
        body: JSON.stringify(spec),
        headers: { "Content-Type": "application/json" },
      });
    const wrong = [
      [SHA256, /no asset with this SHA-256/],
      ["/etc/passwd", /SHA-256/],
      ["rust.png", /SHA-256/],
      [SHA256.toUpperCase(), /lower-case/],
      ["", /leaf, smoke/],
      [7, /leaf, smoke/],
    ];
    for (const [image, reason] of wrong) {
      for (const ask of [validate, (spec) => service.post(spec)]) {
        const problem = await assert_problem(await ask({ ...textured(image), colour: 1 }), 422);
        const error = problem.errors.find((each) => each.pointer === "/scene/texture/image");
        assert.match(error.detail, reason, String(image));
        assert.ok(problem.errors.some((each) => each.pointer === "/colour"));
      }
    }
    assert.deepEqual(await service.reports(), []);

    const { url } = await (await upload(service, PICTURE, "image/png")).json();
    assert.equal((await validate(textured(SHA256))).status, 200);
    const id = await service.submit(textured(SHA256));
    await assert_problem(await fetch(service.origin + url, { method: "DELETE" }), 409);
    await fetch(`${service.api}/reports/${id}`, { method: "DELETE" });
    assert.equal((await fetch(service.origin + url, { method: "DELETE" })).status, 204);
  });
});

test("each of four textures may be an upload, which is then in use", async () => {
  await with_service({ workers: 0 }, async (service) => {
    const uploads = [];
    for (const color of [
      [1, 2, 3],
      [4, 5, 6],
    ])
      uploads.push(await (await upload(service, plain_png(4, color), "image/png")).json());
    const four = ["leaf", uploads[0].sha256, "smoke", uploads[1].sha256];
    const problem = await assert_problem(await service.post(textured([...four.slice(0, 3), SHA256])), 422);
    assert.deepEqual(
      problem.errors.map(({ pointer }) => pointer),
      ["/scene/texture/image/3"],
    );
    const id = await service.submit(textured(four));
    for (const { url } of uploads) await assert_problem(await fetch(service.origin + url, { method: "DELETE" }), 409);
    await fetch(`${service.api}/reports/${id}`, { method: "DELETE" });
    for (const { url } of uploads) assert.equal((await fetch(service.origin + url, { method: "DELETE" })).status, 204);
  });
});

test("the OpenAPI document describes the uploads", async () => {
  await with_service({ workers: 0 }, async (service) => {
    const { paths, components } = await (await fetch(`${service.api}/openapi.json`)).json();
    const post = paths["/api/v1/assets"].post;
    assert.ok(Object.keys(post.requestBody.content).includes("image/x-exr"));
    for (const status of ["200", "201", "409", "413", "415", "422", "429"]) assert.ok(post.responses[status], status);
    assert.ok(components.schemas.Asset.required.includes("sha256"));
    const response = await upload(service, PICTURE, "text/html");
    assert.deepEqual(response.headers.get("accept").split(", ").sort(), Object.keys(post.requestBody.content));
  });
});
