// PNG files for the tests, made by hand (ISO 15948).
import { deflateSync } from "node:zlib";

function crc32(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}

function chunk(name, data) {
  const content = Buffer.concat([Buffer.from(name, "latin1"), data]);
  const bytes = Buffer.alloc(content.length + 8);
  bytes.writeUInt32BE(data.length, 0);
  content.copy(bytes, 4);
  bytes.writeUInt32BE(crc32(content), content.length + 4);
  return bytes;
}

/** `rows` are the bytes of each row without its filter byte; color type 2 is RGB, 0 gray. */
export function png(width, height, color_type, rows) {
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header[8] = 8;
  header[9] = color_type;
  const data = Buffer.concat(rows.flatMap((row) => [Buffer.from([0]), row]));
  return Buffer.concat([
    Buffer.from("\x89PNG\r\n\x1a\n", "latin1"),
    chunk("IHDR", header),
    chunk("IDAT", deflateSync(data, { level: 1 })),
    chunk("IEND", Buffer.alloc(0)),
  ]);
}

/** A single color, RGB of 8 bits. */
export function plain_png(side, [red, green, blue]) {
  const row = Buffer.concat(Array(side).fill(Buffer.from([red, green, blue])));
  return png(side, side, 2, Array(side).fill(row));
}
