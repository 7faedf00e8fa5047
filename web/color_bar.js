// The scale of a map of colors: a bar with ticks, and a mark for the value of each source at the marked pixel.
import { el } from "./dom.js";
import { MAGMA } from "./magma.js";
import { difference_level } from "./paint.js";

const STOPS = 32;
const MOST_TICKS = 6;
const DIFFERENCE_TICKS = [-255, -64, -16, -4, 0, 4, 16, 64, 255];

const css = ([r, g, b]) => `rgb(${r} ${g} ${b})`;

function gradient(color_at) {
  const stops = Array.from({ length: STOPS + 1 }, (_, i) => css(color_at(i / STOPS)));
  return `linear-gradient(to right, ${stops.join()})`;
}

/** Round values from 0 to `full`, at most six steps. */
function count_ticks(full) {
  const power = 10 ** Math.floor(Math.log10(Math.max(1, full / MOST_TICKS)));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => full / size <= MOST_TICKS);
  return Array.from({ length: Math.floor(full / step) + 1 }, (_, i) => i * step);
}

/** The scale of magma colors from 0 to `full`; `full` is 1 for FLIP. */
export function magma_scale(full) {
  return {
    background: gradient((share) => MAGMA[Math.round(share * 255)]),
    ticks: full === 1 ? [0, 0.25, 0.5, 0.75, 1] : count_ticks(full),
    place: (value) => value / full,
  };
}

/** The scale of differences in levels: its places are those of the greys, so it bends with the gain's square root. */
export function difference_scale(settings) {
  const level = (difference) => difference_level(difference, settings) / 255;
  const most = settings.gain === 0 ? 255 : Math.floor(255 / settings.gain);
  const wide = DIFFERENCE_TICKS.filter(
    (tick) => Math.abs(tick) <= most && !(settings.gain > 0 && Math.abs(tick) < most / 8 && tick),
  );
  const ticks = [...new Set([...wide, most, ...(settings.absolute ? [] : [-most])])];
  return {
    background: gradient((share) => Array(3).fill(Math.round(share * 255))),
    ticks: ticks.filter((tick) => !settings.absolute || tick >= 0).sort((a, b) => a - b),
    place: level,
  };
}

/** `marks`: [{value, name}]. */
export function color_bar(scale, marks) {
  const at = (value) => `${Math.min(1, Math.max(0, scale.place(value))) * 100}%`;
  const placed = (node, value) => {
    node.style.left = at(value);
    return node;
  };
  const bar = el("div", { class: "color-bar-colors" });
  bar.style.background = scale.background;
  return el(
    "div",
    { class: "color-bar", role: "img", "aria-label": `Scale from ${scale.ticks[0]} to ${scale.ticks.at(-1)}` },
    el(
      "div",
      { class: "color-bar-marks" },
      marks.map(({ value, name }) =>
        placed(el("span", { title: `${name}: ${value}`, "data-value": value }, "▾"), value),
      ),
    ),
    bar,
    el(
      "div",
      { class: "color-bar-ticks" },
      scale.ticks.map((tick) => placed(el("span", {}, String(tick).replace("-", "−")), tick)),
    ),
  );
}
