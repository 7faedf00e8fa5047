// The timed frames of one method as a strip: a dot per frame, outliers as rings, a box over the middle half, a line at
// the median.
import { svg } from "./dom.js";
import { fixed, is_number } from "./format.js";

const WIDTH = 220;
const HEIGHT = 22;
const MARGIN = 4;
const ROWS = [0.5, 0.28, 0.72, 0.39, 0.61]; // spreads dots vertically, always in the same way

function quantile(sorted, share) {
  const position = (sorted.length - 1) * share;
  const low = Math.floor(position);
  const high = Math.min(low + 1, sorted.length - 1);
  return sorted[low] + (sorted[high] - sorted[low]) * (position - low);
}

/** Times of a result, numbers only. */
export function timing_samples(result) {
  const samples = result.timing?.samples ?? [];
  return samples.map((sample) => (is_number(sample) ? sample : sample?.ms)).filter(is_number);
}

/** A round number of at least `value`, for the end of the axis. */
export function axis_end(value) {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 1.5, 2, 3, 4, 5, 6, 8, 10].map((step) => step * power).find((end) => end >= value * 0.999);
}

/** `end`: the time at the right edge; `mark`: the baseline's median, or null; `outliers`: indices of samples. */
export function timing_strip(samples, end, mark, outliers = []) {
  const x = (ms) => MARGIN + (ms / end) * (WIDTH - 2 * MARGIN);
  const sorted = [...samples].sort((a, b) => a - b);
  const [q1, median, q3] = [0.25, 0.5, 0.75].map((share) => quantile(sorted, share));
  const far = outliers.length === 1 ? ", 1 outlier" : outliers.length > 1 ? `, ${outliers.length} outliers` : "";
  const label = `${samples.length} frames from ${fixed(sorted[0], 3)} to ${fixed(sorted.at(-1), 3)} ms${far}`;
  return svg(
    "svg",
    { class: "strip", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": label },
    svg("title", {}, label),
    svg("line", { class: "axis", x1: x(0), x2: x(end), y1: HEIGHT - 1, y2: HEIGHT - 1 }),
    is_number(mark) ? svg("line", { class: "baseline", x1: x(mark), x2: x(mark), y1: 0, y2: HEIGHT }) : null,
    svg("rect", { class: "box", x: x(q1), y: 4, width: Math.max(1, x(q3) - x(q1)), height: HEIGHT - 8, rx: 2 }),
    samples.map((ms, index) =>
      svg("circle", {
        class: outliers.includes(index) ? "outlier" : "sample",
        cx: x(ms),
        cy: HEIGHT * ROWS[index % ROWS.length],
        r: outliers.includes(index) ? 3 : 2,
      }),
    ),
    svg("line", { class: "median", x1: x(median), x2: x(median), y1: 2, y2: HEIGHT - 2 }),
  );
}
