// Numbers and dates as text. A missing number is an en dash, never 0.

export const DASH = "–";

const MAX_DECIMALS = 6;

export function is_number(value) {
  return typeof value === "number" && Number.isFinite(value);
}

/** Decimals with which the smallest non-zero value has `digits` significant digits, so that a column lines up. */
export function column_decimals(values, digits = 3) {
  if (values.filter(is_number).every(Number.isInteger)) return 0;
  const sizes = values
    .filter(is_number)
    .map(Math.abs)
    .filter((size) => size > 0);
  if (sizes.length === 0) return 0;
  const smallest = Math.min(...sizes);
  return Math.min(MAX_DECIMALS, Math.max(0, digits - 1 - Math.floor(Math.log10(smallest))));
}

export function fixed(value, decimals) {
  if (!is_number(value)) return DASH;
  if (value === 0) return "0";
  const text = value.toFixed(decimals);
  if (Number(text) === 0) return value.toExponential(1).replace("-", "−");
  return text.replace("-", "−");
}

// toLocaleString would make one for each number.
const WITH_COMMAS = new Intl.NumberFormat("en-US");

export function integer(value) {
  return is_number(value) ? WITH_COMMAS.format(Math.round(value)).replace("-", "−") : DASH;
}

export const MIB = 2 ** 20;

/** Of a method's own textures and buffers: 0, under 0.1 MiB, 3.5 MiB. */
export function memory_text(bytes) {
  if (!is_number(bytes)) return DASH;
  if (bytes === 0) return "0";
  return `${bytes < 0.1 * MIB ? "under 0.1" : fixed(bytes / MIB, 1)} MiB`;
}

/** A zoom factor: 25 %, 100 %, 3200 %. */
export function zoom_text(zoom) {
  return `${Math.round(zoom * 100)} %`;
}

export function when(text) {
  const date = new Date(text);
  if (!text || Number.isNaN(date.getTime())) return DASH;
  const two = (n) => String(n).padStart(2, "0");
  return (
    `${date.getFullYear()}-${two(date.getMonth() + 1)}-${two(date.getDate())} ` +
    `${two(date.getHours())}:${two(date.getMinutes())}`
  );
}

/** "3 min ago", or the date if it is more than a day ago. */
export function ago(text, now = Date.now()) {
  const seconds = (now - new Date(text).getTime()) / 1000;
  if (!Number.isFinite(seconds)) return DASH;
  if (seconds < 60) return "just now";
  if (seconds < 3600) return `${Math.floor(seconds / 60)} min ago`;
  if (seconds < 86400) return `${Math.floor(seconds / 3600)} h ago`;
  return when(text);
}

const SHA256 = /^[0-9a-f]{64}$/;
const SHOWN_DIGITS = 12;

/** `value` in one line: 0.02, leaf, [0, 0, 0], {…}; for the SHA-256 of a file, its first digits. */
export function short_value(value) {
  if (Array.isArray(value))
    return value.length > 4 ? `${value.length} items` : `[${value.map(short_value).join(", ")}]`;
  if (value !== null && typeof value === "object") {
    return Object.entries(value)
      .filter(([, part]) => part !== null)
      .map(([key, part]) => `${key} ${short_value(part)}`)
      .join(", ");
  }
  const text = String(value);
  return SHA256.test(text) ? `${text.slice(0, SHOWN_DIGITS)}…` : text;
}

const SPELLED = new Map([
  ["glsl", "GLSL"],
  ["gltf", "glTF"],
]);

/** snake_case to words with an initial capital. */
export function words(name) {
  if (SPELLED.has(name)) return SPELLED.get(name);
  const text = name.replaceAll("_", " ");
  return text.charAt(0).toUpperCase() + text.slice(1);
}
