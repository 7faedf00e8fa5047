// The columns of the result tables: one entry per column, each made from the description of its field.
import { column_decimals, fixed, integer, is_number } from "./format.js";

/** The value at a dotted path, undefined if there is none. */
export function value_at(object, path) {
  return path.split(".").reduce((part, key) => (part === null || part === undefined ? undefined : part[key]), object);
}

/**
 * The columns of a table (times, speedups, sorting, fragments), from the descriptions of GET /columns. A time is never
 * best by its number alone: `timed` columns mark the methods that fastest_labels() names.
 */
export function columns_of(columns, table) {
  return columns.filter((column) => column.table === table);
}

/** Maps a value to a number of which the smallest is best. */
const BETTER = {
  lower: (value) => value,
  higher: (value) => -value,
  "nearer zero": (value) => Math.abs(value),
};

function metric_column(metric, field) {
  const { head, better, digits, note } = field.column;
  const path = `metrics.${field.full_name}`;
  return {
    path,
    name: field.full_name,
    head,
    unit: field.unit || field.range.replaceAll("-", "−"),
    title: [metric.name, field.summary].join(": "),
    digits,
    better: BETTER[better],
    whole: field.kind === "count",
    pixel: field.kind === "pixel",
    null_is_perfect: field.null_is_identical,
    note: note ? `metrics.${metric.id}.${note}` : null,
  };
}

/** The columns of the table of differences, from the descriptions of the metrics and in their order. */
export function difference_columns(metrics) {
  return metrics.flatMap((metric) =>
    metric.fields.filter((field) => field.column).map((field) => metric_column(metric, field)),
  );
}

/** Why a value is missing: the report gives a reason next to the value, or it follows from the status. */
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
 * The results with the best value of a column by the digits shown, among those that have a picture; none if all are
 * equal. A method that only gives an upper bound has no metrics and is not considered.
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
 * Labels of the methods of a run that may be called fastest: those that the report names. For older reports, which name
 * none: those with the least median shown, if they are resolved faster than the baseline.
 */
export function fastest_labels(run) {
  if (run.frontier?.fastest) return new Set(run.frontier.fastest);
  const least = best_results(run.results, { path: "timing.median", better: BETTER.lower });
  return new Set([...least].filter(({ speedup }) => speedup?.verdict === "faster").map(({ label }) => label));
}

/** The results that a column of a run's timing table marks. */
export function fastest_results(run, column) {
  const labels = column.timed ? fastest_labels(run) : new Set();
  return new Set(run.results.filter(({ label }) => labels.has(label)));
}
