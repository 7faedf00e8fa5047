// A glTF model for the tests, made by hand: three squares that face along z, one for each alpha mode.
import { png } from "./pictures.mjs";

const FLOAT = 5126,
  UNSIGNED_SHORT = 5123;

/** Left half (51, 153, 255) and opaque, right half transparent. */
const HALF = png(2, 1, 6, [Buffer.from([51, 153, 255, 255, 51, 153, 255, 0])]);

/**
 * The JSON of the model, and its buffer's data. Seen from 10 on the z axis with a right angle, each square fills the
 * picture.
 */
export function three_squares() {
  const parts = [],
    bufferViews = [],
    accessors = [];
  let length = 0;
  const view = (bytes) => {
    const padded = Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4)]);
    bufferViews.push({ buffer: 0, byteOffset: length, byteLength: bytes.length });
    parts.push(padded);
    length += padded.length;
    return bufferViews.length - 1;
  };
  const floats = (numbers, type, size) => {
    accessors.push({
      bufferView: view(Buffer.from(Float32Array.from(numbers).buffer)),
      componentType: FLOAT,
      type,
      count: numbers.length / size,
    });
    return accessors.length - 1;
  };
  const POSITION = floats([-1, 1, 0, 1, 1, 0, 1, -1, 0, -1, -1, 0], "VEC3", 3);
  const TEXCOORD_0 = floats([0, 0, 1, 0, 1, 1, 0, 1], "VEC2", 2);
  accessors.push({
    bufferView: view(Buffer.from(Uint16Array.of(0, 2, 1, 0, 3, 2).buffer)),
    componentType: UNSIGNED_SHORT,
    type: "SCALAR",
    count: 6,
  });
  const mesh = (material) => ({ primitives: [{ attributes: { POSITION, TEXCOORD_0 }, indices: 2, material }] });
  const node = (number, z) => ({ mesh: number, translation: [0, 0, z], scale: [10 - z, 10 - z, 1] });
  return {
    json: {
      asset: { version: "2.0" },
      scene: 0,
      scenes: [{ nodes: [0, 1, 2] }],
      nodes: [node(0, 2), node(1, 1), node(2, 0)],
      meshes: [mesh(0), mesh(1), mesh(2)],
      materials: [
        { alphaMode: "MASK", pbrMetallicRoughness: { baseColorTexture: { index: 0 } } },
        { alphaMode: "BLEND", pbrMetallicRoughness: { baseColorFactor: [1, 0, 0, 0.5] } },
        { alphaMode: "OPAQUE", pbrMetallicRoughness: { baseColorFactor: [0, 0, 1, 1] } },
      ],
      textures: [{ source: 0 }],
      images: [{ bufferView: view(HALF), mimeType: "image/png" }],
      accessors,
      bufferViews,
      buffers: [{ byteLength: length }],
    },
    binary: Buffer.concat(parts),
  };
}

export function glb({ json, binary }) {
  const chunk = (name, data, padding) => {
    const padded = Buffer.concat([data, Buffer.alloc((4 - (data.length % 4)) % 4, padding)]);
    const header = Buffer.alloc(8);
    header.writeUInt32LE(padded.length, 0);
    header.write(name, 4, "latin1");
    return Buffer.concat([header, padded]);
  };
  const chunks = Buffer.concat([
    chunk("JSON", Buffer.from(JSON.stringify(json)), " "),
    binary.length > 0 ? chunk("BIN\0", binary, 0) : Buffer.alloc(0),
  ]);
  const header = Buffer.alloc(12);
  header.write("glTF", 0, "latin1");
  header.writeUInt32LE(2, 4);
  header.writeUInt32LE(header.length + chunks.length, 8);
  return Buffer.concat([header, chunks]);
}
