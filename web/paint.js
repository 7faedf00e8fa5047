// Pictures that are computed in the page: colors under another exposure, single channels, differences. All functions return
// red, green, blue and alpha in 8 bits, top row first.

const OPAQUE = 255;
const SQUARE_PX = 8; // of the checker, as in the metric "Over other backgrounds"
const to_level = (value) => Math.max(0, Math.min(OPAQUE, Math.round(value * OPAQUE)));

/** What a level 0..255 becomes under exposure and gamma. */
function tone_of({ exposure, gamma }) {
  const factor = 2 ** exposure;
  return (value) => (value <= 0 ? 0 : (value * factor) ** (1 / gamma));
}

/** What is behind the pictures: a function of the pixel and the channel. */
function backdrop(over) {
  if (over !== "checker") return () => Number(over === "white");
  return (x, y) => 1 - ((Math.floor(x / SQUARE_PX) + Math.floor(y / SQUARE_PX)) % 2);
}

/**
 * The picture over another background: a pixel is C + T B, where `opacity` has the levels of 1 - T, and `background` is the
 * B with which `raster` was drawn. Floats.
 */
export function over_background(raster, opacity, background, over) {
  const { data, channels, width, height } = raster;
  const unit = data instanceof Float32Array ? 1 : 1 / OPAQUE;
  const behind = backdrop(over);
  const moved = new Float32Array(width * height * 3);
  for (let i = 0; i < width * height; ++i)
    for (let c = 0; c < 3; ++c) {
      const shows = 1 - opacity.data[i * 4 + c] / OPAQUE;
      const step = behind(i % width, Math.floor(i / width)) - background[c];
      moved[i * 3 + c] = data[i * channels + c] * unit + step * shows;
    }
  return { width, height, channels: 3, data: moved };
}

/** `raster` has levels (Uint8) or floats. */
export function paint_color(raster, { exposure, gamma, channel }) {
  const { data, channels } = raster;
  const count = raster.width * raster.height;
  const painted = new Uint8ClampedArray(count * 4);
  const unit = data instanceof Float32Array ? 1 : 1 / OPAQUE;
  const tone = tone_of({ exposure, gamma });
  const single = { r: 0, g: 1, b: 2 }[channel];
  // Levels have few values, so each is computed once.
  const table = unit === 1 ? null : Uint8Array.from({ length: 256 }, (_, level) => to_level(tone(level * unit)));
  const shown = (value) => (table ? table[value] : to_level(tone(value)));
  for (let i = 0; i < count; ++i) {
    for (let c = 0; c < 3; ++c) painted[i * 4 + c] = shown(data[i * channels + (single ?? c)]);
    painted[i * 4 + 3] = OPAQUE;
  }
  return painted;
}

/** The level of a difference of -255..255 levels: its sign from mid grey, or without sign from black. */
export function difference_level(difference, { gain, absolute }) {
  const size = gain === 0 ? Math.sqrt(Math.abs(difference) / 255) : (Math.abs(difference) / 255) * gain;
  const shown = Math.min(1, size);
  if (absolute) return Math.round(shown * OPAQUE);
  return 128 + Math.sign(difference) * Math.trunc(shown * 127 + 0.5);
}

/** `against` minus `shown`, two rasters of levels. */
export function paint_difference(against, shown, settings) {
  const table = Uint8Array.from({ length: 511 }, (_, index) => difference_level(index - 255, settings));
  const painted = new Uint8ClampedArray(against.width * against.height * 4);
  for (let i = 0; i < painted.length; ++i)
    painted[i] = i % 4 === 3 ? OPAQUE : table[against.data[i] - shown.data[i] + 255];
  return painted;
}

/** Greatest absolute difference of a channel, for each pixel. */
export function greatest_differences(against, shown) {
  const greatest = new Uint8Array(against.width * against.height);
  for (let i = 0; i < greatest.length; ++i)
    for (let c = 0; c < 3; ++c)
      greatest[i] = Math.max(greatest[i], Math.abs(against.data[i * 4 + c] - shown.data[i * 4 + c]));
  return greatest;
}

/** How many pixels have each size of difference, 0..255 levels. */
export function histogram(sizes) {
  const counts = new Uint32Array(256);
  for (const size of sizes) ++counts[size];
  return counts;
}

/** [x, y] of the pixel in which two rasters of levels differ most, null if they do not. */
export function worst_of(against, shown) {
  return worst_pixels(greatest_differences(against, shown), against.width)[0] ?? null;
}

const BLOCK_PX = 16;

/** The worst pixel of each block of 16 × 16, the worst of all first: [[x, y]]. Pixels without error are left out. */
export function worst_pixels(sizes, width) {
  const worst = new Map();
  const height = sizes.length / width;
  const in_row = Math.ceil(width / BLOCK_PX);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const size = sizes[y * width + x];
      const block = Math.floor(y / BLOCK_PX) * in_row + Math.floor(x / BLOCK_PX);
      if (size > (worst.get(block)?.size ?? 0)) worst.set(block, { size, x, y });
    }
  return [...worst.values()].sort((a, b) => b.size - a.size).map(({ x, y }) => [x, y]);
}
