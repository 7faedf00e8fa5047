// Reads the OpenEXR files that the service writes: one part, scanlines from the top, 32-bit floats, stored raw or with
// ZIP compression. (OpenEXR file layout, openexr.com.)
import assert from "node:assert/strict";
import { inflateSync } from "node:zlib";

const FLOAT = 2,
  RAW = 0,
  ZIP = 3,
  LINES_PER_ZIP_BLOCK = 16;

class Reader {
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 0;
  }
  int() {
    this.at += 4;
    return this.bytes.readInt32LE(this.at - 4);
  }
  byte() {
    return this.bytes[this.at++];
  }
  text() {
    const end = this.bytes.indexOf(0, this.at);
    const text = this.bytes.toString("latin1", this.at, end);
    this.at = end + 1;
    return text;
  }
  take(length) {
    this.at += length;
    return this.bytes.subarray(this.at - length, this.at);
  }
}

function read_header(reader) {
  assert.equal(reader.int(), 20000630, "the magic number of OpenEXR");
  assert.equal(reader.int() & 0x1e00, 0, "one part of scanlines");
  const attributes = {};
  for (let name = reader.text(); name; name = reader.text()) {
    reader.text(); // its type
    attributes[name] = new Reader(reader.take(reader.int()));
  }
  return attributes;
}

/** The names of the channels, in the order in which they are stored. */
function read_channels(reader) {
  const names = [];
  for (let name = reader.text(); name; name = reader.text()) {
    assert.equal(reader.int(), FLOAT, `channel ${name} holds 32-bit floats`);
    reader.take(12); // linearity and sampling
    names.push(name);
  }
  return names;
}

/** Reverses the preparation of a block for deflate: each byte is a difference, the even bytes come first. */
function restore(differences) {
  for (let i = 1; i < differences.length; ++i) differences[i] = (differences[i - 1] + differences[i] - 128) & 255;
  const half = Math.ceil(differences.length / 2);
  return Buffer.from(differences.map((_, i) => differences[(i >> 1) + (i % 2 ? half : 0)]));
}

/** {width, height, channels: {R: Float32Array of width * height from the top left, ...}} */
export function read_exr(bytes) {
  const reader = new Reader(Buffer.from(bytes));
  const header = read_header(reader);
  const compression = header.compression.byte();
  assert.ok([RAW, ZIP].includes(compression), `compression ${compression}`);
  const [x0, y0, x1, y1] = Array.from({ length: 4 }, () => header.dataWindow.int());
  const width = x1 - x0 + 1,
    height = y1 - y0 + 1,
    names = read_channels(header.channels);
  const channels = Object.fromEntries(names.map((name) => [name, new Float32Array(width * height)]));
  const lines = compression === ZIP ? LINES_PER_ZIP_BLOCK : 1,
    blocks = Math.ceil(height / lines);
  reader.take(8 * blocks); // the offsets of the blocks, which are consecutive
  for (let block = 0; block < blocks; ++block) {
    const first = reader.int() - y0,
      stored = reader.take(reader.int()),
      count = Math.min(lines, height - first);
    const size = 4 * width * count * names.length;
    const pixels = stored.length === size ? stored : restore(inflateSync(stored));
    assert.equal(pixels.length, size);
    for (let y = first, at = 0; y < first + count; ++y)
      for (const name of names)
        for (let x = 0; x < width; ++x, at += 4) channels[name][y * width + x] = pixels.readFloatLE(at);
  }
  return { width, height, channels };
}
