// Scales of charts: from values to places on the screen, and the ticks of an axis.
import { is_number } from "./format.js";

const DECADE = 10;
const STEPS = [1, 2, 5, 10];
const MOST_LOG_TICKS = 7;
const ROUNDING = 1e-9; // of a step: tolerates rounding in a division

/** "log" if all values are over 0 and span more than a decade, "linear" for other numbers, otherwise "categories". */
export function scale_kind(values) {
  if (values.length === 0 || !values.every(is_number)) return "categories";
  const [low, high] = [Math.min(...values), Math.max(...values)];
  return low > 0 && high / low > DECADE ? "log" : "linear";
}

/** A function from `domain` [low, high] to `range` [start, end]; an empty domain maps to the middle. */
export function make_scale(kind, domain, range) {
  const map = kind === "log" ? Math.log10 : (value) => value;
  const [low, high] = domain.map(map);
  const [start, end] = range;
  return (value) => (high === low ? (start + end) / 2 : start + ((map(value) - low) / (high - low)) * (end - start));
}

/** The next 1, 2 or 5 times a power of ten that is not below `value` > 0; with `down`, not above it. */
export function round_to_step(value, down = false) {
  const power = 10 ** Math.floor(Math.log10(value) + ROUNDING);
  const steps = STEPS.map((step) => Number((step * power).toPrecision(12)));
  return down
    ? steps.findLast((step) => step <= value * (1 + ROUNDING))
    : steps.find((step) => step >= value * (1 - ROUNDING));
}

function linear_axis(low, high, wanted) {
  const step = round_to_step((high - low || Math.abs(high) || 1) / wanted);
  const first = Math.floor(low / step + ROUNDING);
  const last = Math.max(first + 1, Math.ceil(high / step - ROUNDING));
  const ticks = [];
  for (let number = first; number <= last; ++number) ticks.push(Number((number * step).toPrecision(12)));
  return { domain: [ticks[0], ticks.at(-1)], ticks };
}

function log_axis(low, high) {
  const domain = [round_to_step(low, true), round_to_step(high)];
  if (domain[0] === domain[1]) domain[1] = round_to_step(high * 1.5);
  let ticks = [];
  for (let tick = domain[0]; tick <= domain[1]; tick = round_to_step(tick * 1.5)) ticks.push(tick);
  if (ticks.length > MOST_LOG_TICKS) ticks = ticks.filter((tick) => Number.isInteger(Math.log10(tick)));
  const every = Math.ceil(ticks.length / MOST_LOG_TICKS);
  return { domain, ticks: ticks.filter((_, index) => index % every === 0) };
}

/**
 * {domain, ticks} of an axis that contains all `values` and ends at round numbers; `wanted`: approximate number of
 * steps.
 */
export function value_axis(kind, values, wanted = 5) {
  if (values.length === 0) return { domain: [0, 1], ticks: [0, 1] };
  const [low, high] = [Math.min(...values), Math.max(...values)];
  return kind === "log" ? log_axis(low, high) : linear_axis(low, high, wanted);
}

/** Of places in pixels in ascending order, those at least `room_px` after the previous one; the last one is kept. */
export function thinned(places, room_px) {
  const kept = [];
  for (const place of [...places].reverse()) if (kept.length === 0 || kept[0] - place >= room_px) kept.unshift(place);
  return kept;
}

/** A number as short as possible with 4 digits: 0.25, 8192, 1e6. */
export function tick_text(value) {
  const rounded = Number(value.toPrecision(4));
  const size = Math.abs(rounded);
  const text = size !== 0 && (size >= 1e5 || size < 1e-4) ? rounded.toExponential() : String(rounded);
  return text.replace("e+", "e").replaceAll("-", "−");
}
