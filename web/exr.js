// OpenEXR files as Sheer writes them: one part of scan lines, 32-bit floats, uncompressed or by ZIP.
// "The OpenEXR file layout", openexr.com.

const MAGIC = 20000630;
const FLAGS_SHIFT = 8; // above the version: tiles, long names, deep data, parts
const ZIP = { 0: 1, 2: 1, 3: 16 }; // scan lines of a chunk by the compression's number: none, ZIPS, ZIP
const FLOAT = 2;

async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Undoes the predictor, then puts the two halves of the bytes back in turn. */
function unpredicted(bytes) {
  for (let i = 1; i < bytes.length; ++i) bytes[i] += bytes[i - 1] - 128;
  const whole = new Uint8Array(bytes.length);
  const half = (bytes.length + 1) >> 1;
  for (let i = 0; i < bytes.length; ++i) whole[i] = bytes[i & 1 ? half + (i >> 1) : i >> 1];
  return whole;
}

function read_header(view) {
  let at = 8;
  const text = () => {
    let word = "";
    for (let code = view.getUint8(at++); code !== 0; code = view.getUint8(at++)) word += String.fromCharCode(code);
    return word;
  };
  const header = {};
  for (let name = text(); name !== ""; name = text()) {
    text(); // its type
    const size = view.getInt32(at, true);
    header[name] = at += 4;
    at += size;
  }
  const end = at;
  const box = [0, 4, 8, 12].map((offset) => view.getInt32(header.dataWindow + offset, true));
  const channels = [];
  at = header.channels;
  for (let name = text(); name !== ""; name = text()) {
    channels.push({ name, type: view.getInt32(at, true) });
    at += 16;
  }
  return { box, channels, compression: view.getUint8(header.compression), end };
}

/**
 * {width, height, channels, data}: `data` has the channels of each pixel one after another, top row first, in the order red,
 * green, blue, alpha. Throws an Error if the file is of another kind.
 */
export async function read_exr(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (view.getUint32(0, true) !== MAGIC) throw new Error("This is not an OpenEXR file.");
  if (view.getUint32(4, true) >> FLAGS_SHIFT !== 0) throw new Error("Only OpenEXR files of scan lines are read.");
  const { box, channels, compression, end } = read_header(view);
  const lines = ZIP[compression];
  if (!lines || channels.some(({ type }) => type !== FLOAT)) throw new Error("This kind of OpenEXR file is not read.");
  const [width, height] = [box[2] - box[0] + 1, box[3] - box[1] + 1];
  const order = "RGBA";
  const places = channels.map(({ name }) => Math.max(0, order.indexOf(name)));
  const count = channels.length;
  const data = new Float32Array(width * height * count);
  const chunks = Array.from({ length: Math.ceil(height / lines) }, async (_, chunk) => {
    const at = Number(view.getBigUint64(end + chunk * 8, true));
    const first = view.getInt32(at, true) - box[1];
    const rows = Math.min(lines, height - first);
    const size = view.getInt32(at + 4, true);
    const packed = bytes.slice(at + 8, at + 8 + size);
    const plain = size < rows * width * count * 4 ? unpredicted(await inflate(packed)) : packed;
    const floats = new Float32Array(plain.buffer, 0, rows * width * count);
    for (let row = 0; row < rows; ++row)
      for (let channel = 0; channel < count; ++channel)
        for (let x = 0; x < width; ++x)
          data[((first + row) * width + x) * count + places[channel]] = floats[(row * count + channel) * width + x];
  });
  await Promise.all(chunks);
  return { width, height, channels: count, data };
}
