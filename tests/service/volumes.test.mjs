// Uploaded volumes: rendered correctly, or refused with the reason.
import assert from "node:assert/strict";
import { test } from "node:test";
import { gzipSync } from "node:zlib";
import { assert_problem, QUICK, with_service } from "./service.mjs";

const VOXELS = Buffer.from(Array.from({ length: 4 * 3 * 2 }, (_, i) => (i * 11) % 256));

function nrrd(encoding, data) {
  const header = `NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 3 2\nencoding: ${encoding}\n\n`;
  return Buffer.concat([Buffer.from(header), data]);
}

async function upload(service, bytes, type) {
  const response = await fetch(`${service.api}/assets`, {
    method: "POST",
    body: bytes,
    headers: { "Content-Type": type },
  });
  return { response, asset: await response.clone().json() };
}

const spec_of = (volume) => ({
  ...QUICK,
  scene: {
    type: "volume",
    slices: 16,
    frame: false,
    volume,
    transfer: [
      { value: 0, color: [1, 0, 0], alpha: 0 },
      { value: 1, color: [0, 1, 0], alpha: 0.2 },
    ],
  },
});

test("the same voxels give the same picture, however they are encoded", async () => {
  await with_service({}, async (service) => {
    const pictures = [];
    for (const [bytes, type, raw] of [
      [nrrd("raw", VOXELS), "application/x-nrrd", undefined],
      [nrrd("gzip", gzipSync(VOXELS)), "application/x-nrrd", undefined],
      [VOXELS, "application/octet-stream", { size: [4, 3, 2] }],
      [VOXELS, "application/octet-stream", { size: [3, 4, 2] }],
      [nrrd("hex", Buffer.from(VOXELS.toString("hex"))), "application/x-nrrd", undefined],
    ]) {
      const { response, asset } = await upload(service, bytes, type);
      assert.ok(response.status === 201 || response.status === 200, JSON.stringify(asset));
      assert.equal(asset.type, "volume");
      if (type === "application/x-nrrd") {
        assert.deepEqual(asset.size, [4, 3, 2]);
        assert.deepEqual(asset.range, [0, 253]);
      }
      const report = await service.settled(await service.submit(spec_of({ data: asset.sha256, ...(raw && { raw }) })));
      assert.equal(report.status, "done", JSON.stringify(report.error));
      assert.deepEqual(
        report.runs[0].notes.map(({ code }) => code),
        ["value-range"],
      );
      pictures.push(report.runs[0].results[0].images.color.sha256);
    }
    assert.equal(pictures[1], pictures[0]);
    assert.equal(pictures[2], pictures[0]);
    assert.notEqual(pictures[3], pictures[0]);
    assert.equal(pictures[4], pictures[0]);
  });
});

test("a raw volume that is too short fails at its field with the reason", async () => {
  await with_service({}, async (service) => {
    const { asset } = await upload(service, VOXELS, "application/octet-stream");
    const spec = spec_of({ data: asset.sha256, raw: { size: [4, 3, 3] } });
    const report = await service.settled(await service.submit(spec));
    assert.equal(report.status, "failed");
    const text = JSON.stringify(report.error);
    assert.match(text, /\/scene\/volume\/data/);
    assert.match(text, /24 bytes of voxels, but 4 x 3 x 3 of type uint8 are 36/);
  });
});

test("a file that is not a volume is refused at once", async () => {
  await with_service({ workers: 0 }, async (service) => {
    for (const [bytes, reason] of [
      [Buffer.from("P6 1 1 255 abc"), /not an NRRD file/],
      [nrrd("raw", VOXELS.subarray(1)), /holds 23 bytes of voxels/],
      [nrrd("gzip", Buffer.from("no gzip")), /damaged/],
      [nrrd("zrl", VOXELS), /encoding "zrl"; supported are raw, ascii, hex, gzip and bzip2/],
      [nrrd("raw\ndata file: voxels.raw", Buffer.alloc(0)), /keeps its data in another file, "voxels.raw"/],
    ]) {
      const { response } = await upload(service, bytes, "application/x-nrrd");
      const problem = await assert_problem(response, 422);
      assert.match(problem.detail, reason);
    }
  });
});
