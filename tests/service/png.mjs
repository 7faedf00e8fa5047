// Reads the PNG files that Sheer writes: 8 bits, RGB, not interlaced.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { inflateSync } from "node:zlib";

function paeth(left, above, corner) {
  const guess = left + above - corner;
  const [a, b, c] = [left, above, corner].map((value) => Math.abs(guess - value));
  return a <= b && a <= c ? left : b <= c ? above : corner;
}

/** {width, height, pixel(x, y): [red, green, blue]} */
export function read_png(path) {
  const file = readFileSync(path);
  const parts = [];
  let header;
  for (let at = 8; at < file.length; at += 12 + file.readUInt32BE(at)) {
    const type = file.toString("latin1", at + 4, at + 8);
    const data = file.subarray(at + 8, at + 8 + file.readUInt32BE(at));
    if (type === "IHDR") header = data;
    if (type === "IDAT") parts.push(data);
  }
  assert.deepEqual([...header.subarray(8)], [8, 2, 0, 0, 0], `${path} is RGB of 8 bits`);
  const [width, height] = [header.readUInt32BE(0), header.readUInt32BE(4)];
  const raw = inflateSync(Buffer.concat(parts));
  const stride = 3 * width;
  const bytes = new Uint8Array(stride * height);
  for (let y = 0; y < height; ++y) {
    const filter = raw[y * (stride + 1)];
    for (let i = 0; i < stride; ++i) {
      const at = y * stride + i;
      const left = i >= 3 ? bytes[at - 3] : 0;
      const above = y > 0 ? bytes[at - stride] : 0;
      const corner = i >= 3 && y > 0 ? bytes[at - stride - 3] : 0;
      const guess = [0, left, above, (left + above) >> 1, paeth(left, above, corner)][filter];
      bytes[at] = raw[y * (stride + 1) + 1 + i] + guess;
    }
  }
  return { width, height, bytes, pixel: (x, y) => [...bytes.subarray((y * width + x) * 3, (y * width + x) * 3 + 3)] };
}
