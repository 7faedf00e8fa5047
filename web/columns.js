// What the result tables show: one entry a column. Captions come from the metrics' own descriptions where there are any.
import { column_decimals, fixed, integer, is_number } from "./format.js";

const lower = { better: (value) => value };
const nearer_zero = { better: (value) => Math.abs(value) };

/** The value at a dotted path, undefined where there is none. */
export function value_at(object, path) {
  return path.split(".").reduce((part, key) => (part === null || part === undefined ? undefined : part[key]), object);
}

/**
 * Of the timing table: path below a result, heading, unit, explanation. No time is best by its number alone: `timed`
 * columns mark the methods that fastest_labels() names.
 */
export const TIMING_COLUMNS = [
  { path: "timing.median", head: "Median", unit: "ms", title: "Median of the timed frames", timed: true },
  { path: "timing.mad", head: "MAD", unit: "ms", title: "Median absolute deviation from the median" },
  { path: "timing.min", head: "Min", unit: "ms", title: "Shortest frame" },
  { path: "timing.p95", head: "p95", unit: "ms", title: "95th percentile of the frames" },
  {
    path: "timing.initialization",
    head: "Init.",
    unit: "ms",
    digits: 2,
    title: "Initialization: preparing the method's own targets, part of the frame",
  },
  {
    path: "timing.finalization",
    head: "Final.",
    unit: "ms",
    digits: 2,
    title: "Finalization: bringing the result into the image, part of the frame",
  },
];

/** Of the table of fragments. */
export const FRAGMENT_COLUMNS = [
  {
    path: "fragments.submitted",
    head: "Submitted",
    whole: true,
    title: "Transparent fragments that opaque geometry does not hide",
  },
  {
    path: "fragments.shaded",
    head: "Shaded",
    whole: true,
    title: "How often the method ran the scene's shading for a transparent fragment",
  },
  {
    path: "fragments.visible",
    head: "Visible",
    whole: true,
    title:
      "Of the shaded fragments those that depth and stencil tests let through: what is shaded at least, on any device",
  },
  {
    path: "fragments.needed",
    head: "Needed",
    whole: true,
    title: "Fragments from front to back until less than the method's threshold of the light gets through",
  },
  {
    path: "images.shaded.greatest",
    head: "Most shaded",
    unit: "per px",
    whole: true,
    title: "Greatest number of fragments that the method shaded in one pixel",
  },
  {
    path: "fragments.efficiency",
    head: "Efficiency",
    title: "Ideal time, that of f2b for the needed fragments alone, over the method's own time",
  },
];

export const SPEEDUP_COLUMN = {
  path: "speedup.value",
  head: "Speed-up",
  unit: "×",
  timed: true,
  title:
    "Median of the baseline's times over this method's, round by round, with its 95 % interval; not the ratio of the medians",
};

/** What sorting from a moved camera takes, and the speed-up where each frame is preceded by it. */
export const SORT_COLUMN = {
  path: "timing.sort.median",
  head: "Sort",
  unit: "ms",
  title: "Making the order anew, which the timed frames leave out: keys, sort and upload of what the scene draws",
};
export const SORTED_SPEEDUP_COLUMN = {
  path: "speedup_with_sort.value",
  head: "With sort",
  unit: "×",
  title: "Speed-up where a method that sorts does so in each frame, the baseline too",
};

/** Of the table of differences, in the order they are shown; `better` gives a value to be made small. */
export const DIFFERENCE_COLUMNS = [
  {
    path: "metrics.signed.mean_abs",
    metric: "signed.mean_abs",
    head: "Mean |Δ|",
    unit: "levels",
    ...lower,
    title: "Mean absolute difference over red, green and blue, in 8-bit levels",
  },
  {
    path: "metrics.signed.min",
    metric: "signed.min",
    head: "Min Δ",
    unit: "levels",
    ...nearer_zero,
    title: "Smallest reference minus method: how far the method is too bright",
  },
  {
    path: "metrics.signed.max",
    metric: "signed.max",
    head: "Max Δ",
    unit: "levels",
    ...nearer_zero,
    title: "Greatest reference minus method: how far the method is too dark",
  },
  { path: "metrics.rmse", metric: "rmse", head: "RMSE", unit: "0..1", ...lower, title: "Root mean square error" },
  {
    path: "metrics.psnr",
    metric: "psnr",
    head: "PSNR",
    unit: "dB",
    better: (value) => -value,
    title: "Peak signal-to-noise ratio",
    null_is_perfect: true,
  },
  {
    path: "metrics.ssim",
    metric: "ssim",
    head: "SSIM",
    unit: "−1..1",
    better: (value) => -value,
    digits: 4,
    title: "Structural similarity",
  },
  {
    path: "metrics.flip.mean",
    metric: "flip.mean",
    head: "FLIP mean",
    unit: "0..1",
    ...lower,
    title: "Mean FLIP error",
  },
  {
    path: "metrics.linear.rmse",
    metric: "linear.rmse",
    head: "Float RMSE",
    unit: "0..",
    ...lower,
    title: "Root mean square error of the float pictures, neither clamped nor rounded",
  },
  {
    path: "metrics.over_backgrounds.rmse",
    metric: "over_backgrounds.rmse",
    head: "Worst background",
    unit: "RMSE",
    ...lower,
    title: "Root mean square error of the float pictures over black, white or a checker, whichever is worst",
    note: "metrics.over_backgrounds.worst",
  },
  {
    path: "metrics.differing_pixels",
    metric: "differing_pixels",
    head: "Differing",
    unit: "px",
    whole: true,
    ...lower,
    title: "Pixels that differ from the reference after rounding to 8 bits",
  },
  {
    path: "metrics.worst_pixel",
    metric: "worst_pixel",
    head: "Worst pixel",
    unit: "x, y",
    pixel: true,
    null_is_perfect: true,
    title: "Pixel that differs most; click it to look there",
  },
  {
    path: "metrics.non_finite",
    metric: "non_finite",
    head: "Non-finite",
    unit: "px",
    whole: true,
    ...lower,
    title: "Pixels with an infinity or a NaN",
  },
];

/** Explanation of a column, from the descriptions of the metrics where they have one. */
export function column_title(column, metrics) {
  const [id, field = ""] = (column.metric ?? "").split(".");
  const info = metrics.find((metric) => metric.id === id);
  if (!info) return column.title;
  const part = info.fields?.find((one) => one.name === field)?.summary;
  return [info.name, part ?? info.summary].filter(Boolean).join(": ");
}

/** Why a value is missing: the report says so beside the value, or it follows from the status. */
export function missing_reason(result, column) {
  if (result.status !== "ok") return `${result.status}: ${result.reason ?? "no reason given"}`;
  if (column.path.startsWith("speedup") && result.speedup_reason) return result.speedup_reason;
  const parts = column.path.split(".");
  for (let length = parts.length; length > 0; --length) {
    const owner = length > 1 ? value_at(result, parts.slice(0, length - 1).join(".")) : result;
    const key = parts[length - 1];
    const reason =
      owner?.reasons?.[key] ?? owner?.[`${key}_reason`] ?? (length < parts.length ? owner?.[key]?.reason : null);
    if (reason) return reason;
  }
  if (column.null_is_perfect && is_perfect(result)) return "none: identical to the reference";
  return result.reason || "not measured";
}

export function is_perfect(result) {
  return result.metrics?.differing_pixels === 0 || result.metrics?.rmse === 0;
}

/** Decimals of a column, so that its numbers line up. */
export function decimals_of(results, column) {
  return column_decimals(
    results.map((result) => value_at(result, column.path)),
    column.digits,
  );
}

const has_picture = (result) => result.status === "ok" && result.metrics;

/**
 * The results that hold the best value of a column by the digits shown: of those that gave a picture, and none where all
 * are equal. A method that only bounds what is attainable has no metrics and takes no part.
 */
export function best_results(results, column) {
  if (!column.better) return new Set();
  const decimals = decimals_of(results, column);
  const shown = (score) => (column.whole ? integer(score) : fixed(score, decimals));
  const scores = results
    .filter(has_picture)
    .map((result) => {
      const value = value_at(result, column.path);
      if (is_number(value)) return { result, score: column.better(value) };
      return { result, score: column.null_is_perfect && is_perfect(result) ? -Infinity : NaN };
    })
    .filter(({ score }) => !Number.isNaN(score))
    .map((one) => ({ ...one, text: shown(one.score) }));
  const best = Math.min(...scores.map(({ score }) => score));
  const { text } = scores.find(({ score }) => score === best) ?? {};
  const first = scores.filter((one) => one.text === text);
  if (scores.length < 2 || first.length === scores.length) return new Set();
  return new Set(first.map(({ result }) => result));
}

/**
 * Labels of the methods of a run that may be called fastest: those that the report names. A report from before it named
 * any is read strictly: of the least median shown, what is resolved faster than the baseline.
 */
export function fastest_labels(run) {
  if (run.frontier?.fastest) return new Set(run.frontier.fastest);
  const least = best_results(run.results, { path: "timing.median", ...lower });
  return new Set([...least].filter(({ speedup }) => speedup?.verdict === "faster").map(({ label }) => label));
}

/** The results that a column of a run's timing table marks. */
export function fastest_results(run, column) {
  const labels = column.timed ? fastest_labels(run) : new Set();
  return new Set(run.results.filter(({ label }) => labels.has(label)));
}
