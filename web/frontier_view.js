// Speed, error and memory of a run's methods: which of them are worth their time, as a chart and in words.
import { scatter_chart } from "./chart.js";
import { difference_columns, fastest_labels, value_at } from "./columns.js";
import { el } from "./dom.js";
import { column_decimals, fixed, is_number, memory_text } from "./format.js";

/** One line for all methods that are dominated for the same reason. */
function dominated_lines(dominated) {
  const methods_of = new Map();
  for (const { method, by, reason } of dominated) {
    const why = reason ?? `${by} is at least as fast and at least as close to the reference`;
    methods_of.set(why, [...(methods_of.get(why) ?? []), method]);
  }
  return [...methods_of].map(([why, methods]) => el("p", { class: "muted" }, `Grey: ${methods.join(", ")}. ${why}.`));
}

/** Null if the report has no frontier. */
export function frontier_section(run, metrics) {
  const { frontier } = run;
  if (!frontier) return null;
  const error_name = frontier.error ?? "flip.mean"; // older reports do not name it
  const error_path = `metrics.${error_name}`;
  const error_head = difference_columns(metrics).find(({ name }) => name === error_name)?.head ?? error_name;
  const by = new Map(frontier.dominated.map((entry) => [entry.method, entry.by]));
  const fastest = fastest_labels(run);
  const measured = run.results
    .map((result, index) => ({
      result,
      index,
      time_ms: value_at(result, "timing.median"),
      error: value_at(result, error_path),
    }))
    .filter(({ time_ms, error }) => is_number(time_ms) && is_number(error) && time_ms > 0);
  if (measured.length === 0) return null;
  const time_decimals = column_decimals(measured.map((one) => one.time_ms));
  const error_decimals = column_decimals(measured.map((one) => one.error));
  const most_bytes = Math.max(...measured.map(({ result }) => result.memory_bytes ?? 0));
  const points = measured.map(({ result, index, time_ms, error }) => {
    const better = by.get(result.label);
    const interval = result.timing.ci95;
    const range = interval ? ` [${interval.map((bound) => fixed(bound, time_decimals)).join(", ")}]` : "";
    return {
      label: result.label,
      index,
      x: time_ms,
      y: error,
      x_interval: interval,
      grey: better !== undefined,
      fastest: fastest.has(result.label),
      share: most_bytes > 0 ? (result.memory_bytes ?? 0) / most_bytes : 0,
      lines: [
        el("strong", {}, result.label),
        el("span", {}, `${fixed(time_ms, time_decimals)} ms${range}`),
        el("span", {}, `${error_head} ${fixed(error, error_decimals)}`),
        el("span", {}, `memory ${memory_text(result.memory_bytes)}`),
        better === undefined ? null : el("span", {}, `dominated by ${better}`),
      ],
    };
  });
  return el(
    "section",
    { class: "frontier", "aria-label": "Speed versus error" },
    scatter_chart({
      title: "Speed versus error",
      unit: error_head,
      x_name: "time, ms",
      label: `Time and ${error_head} of ${points.length} methods; use the arrow keys to read the values`,
      points,
    }),
    el(
      "div",
      { class: "frontier-text" },
      el(
        "ul",
        {},
        frontier.sentences.map((sentence) => el("li", {}, sentence)),
      ),
      dominated_lines(frontier.dominated),
      most_bytes > 0
        ? el(
            "p",
            { class: "muted" },
            `The area of a ring is the method's own memory; the largest is ${memory_text(most_bytes)}.`,
          )
        : null,
    ),
  );
}
