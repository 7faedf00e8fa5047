// The numbers in the pictures of a source: levels of its PNG files, floats and counts of its OpenEXR files.
import { read_exr } from "./exr.js";
import { magma_level } from "./magma.js";

async function bytes_of(url) {
  // The self-contained file may not make requests, not even of its own data: URIs.
  if (url.startsWith("data:")) return Uint8Array.from(atob(url.slice(url.indexOf(",") + 1)), (c) => c.charCodeAt(0));
  const response = await fetch(url);
  if (!response.ok) throw new Error(`A picture could not be loaded: ${response.status}.`);
  return new Uint8Array(await response.arrayBuffer());
}

async function read_levels(url) {
  const image = new Image();
  image.src = url;
  await image.decode();
  const canvas = new OffscreenCanvas(image.naturalWidth, image.naturalHeight);
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(image, 0, 0);
  const { width, height, data } = context.getImageData(0, 0, canvas.width, canvas.height);
  return { width, height, channels: 4, data };
}

/** Event "load" after a file was read, so that values which were not known before are now. */
export class PictureData extends EventTarget {
  #files;
  #loading = new Map();
  #loaded = new Map();

  /** `files`: {kind: {url, full_scale, is_float}}; a picture of counts has a `full_scale`. */
  constructor(files) {
    super();
    this.#files = files;
  }

  has(kind) {
    return kind in this.#files;
  }

  /** {width, height, channels, data} of a file; rejects if it cannot be read. */
  load(kind) {
    if (!this.#loading.has(kind)) {
      const { url, is_float } = this.#files[kind];
      const loading = is_float ? bytes_of(url).then(read_exr) : read_levels(url);
      this.#loading.set(
        kind,
        loading.then((raster) => {
          this.#loaded.set(kind, raster);
          this.dispatchEvent(new Event("load"));
          return raster;
        }),
      );
    }
    return this.#loading.get(kind);
  }

  /** The same, or null while it is not there; then it is loaded for the next time. */
  #now(kind) {
    if (!this.has(kind)) return null;
    const loaded = this.#loaded.get(kind);
    if (!loaded) this.load(kind).catch(() => {});
    return loaded ?? null;
  }

  /** Channels of a pixel, null if it is not loaded. */
  #pixel(kind, x, y) {
    const raster = this.#now(kind);
    if (!raster || x < 0 || y < 0 || x >= raster.width || y >= raster.height) return null;
    const at = (y * raster.width + x) * raster.channels;
    return raster.data.subarray(at, at + raster.channels);
  }

  /** 8-bit levels, red, green, blue, alpha. */
  levels(kind, x, y) {
    return this.#pixel(kind, x, y);
  }

  /** Red, green, blue and, if it is stored, alpha as floats: of the picture of floats, or else of the levels. */
  floats(x, y) {
    if (this.has("linear")) return this.#pixel("linear", x, y);
    const levels = this.#pixel("color", x, y);
    return levels && Array.from(levels.subarray(0, 3), (level) => level / 255);
  }

  /** A value of a map of colors: a count, or 0 to 1 in steps of 1 / 255; null if it is not known. */
  map_value(kind, x, y) {
    if (this.has(`${kind}_counts`)) return this.#pixel(`${kind}_counts`, x, y)?.[0] ?? null;
    const color = this.#pixel(kind, x, y);
    const level = color ? magma_level(...color) : undefined;
    if (level === undefined) return null;
    const { full_scale } = this.#files[kind];
    return full_scale === undefined ? level / 255 : Math.round((level * full_scale) / 255);
  }

  full_scale(kind) {
    return this.#files[kind]?.full_scale;
  }
  url(kind) {
    return this.#files[kind]?.url;
  }
}
