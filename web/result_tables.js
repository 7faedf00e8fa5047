// The tables of a run: fragments, times, and differences from the reference. One row per result, in the order of the
// spec.
import { append, el } from "./dom.js";
import {
  best_results,
  columns_of,
  decimals_of,
  difference_columns,
  fastest_results,
  missing_reason,
  value_at,
} from "./columns.js";
import { column_decimals, DASH, fixed, integer, is_number, short_value } from "./format.js";
import { axis_end, timing_samples, timing_strip } from "./timing_strip.js";

/** The label of a method and its parameters. */
function method_cell(result, context) {
  const info = context.methods.find((method) => method.id === result.method);
  const parameters = Object.entries(result.parameters ?? {});
  const is_default = ([name, value]) =>
    JSON.stringify(info?.parameters?.find((param) => param.name === name)?.default) === JSON.stringify(value);
  const text = (entries) => entries.map(([name, value]) => `${name} ${short_value(value)}`).join(", ");
  return el(
    "th",
    { scope: "row" },
    el("span", { class: "label" }, result.label),
    result.label === context.baseline ? el("span", { class: "chip" }, "baseline") : null,
    el(
      "span",
      { class: "caption", title: [info?.summary, text(parameters)].filter(Boolean).join("\n") },
      [info?.name ?? result.method, text(parameters.filter((entry) => !is_default(entry)))].filter(Boolean).join(" · "),
    ),
  );
}

function missing_cell(reason) {
  return el(
    "td",
    { class: "number missing", title: reason },
    el("span", { "aria-hidden": "true" }, DASH),
    el("span", { class: "visually-hidden" }, `none: ${reason}`),
  );
}

function number_cell(result, column, decimals, best) {
  const value = value_at(result, column.path);
  const is_best = best.has(result);
  if (!is_number(value)) {
    const cell = missing_cell(missing_reason(result, column));
    if (is_best) cell.classList.add("best");
    return cell;
  }
  const text = column.whole ? integer(value) : fixed(value, decimals);
  const note = column.note ? value_at(result, column.note) : null;
  return el(
    "td",
    {
      class: is_best ? "number best" : "number",
      "data-path": column.path,
      "data-value": String(value),
      title: is_best ? `${value} (best)` : String(value),
    },
    text,
    note ? el("span", { class: "muted" }, ` ${note}`) : null,
    is_best ? el("span", { class: "visually-hidden" }, " (best)") : null,
  );
}

function pixel_cell(result, column, context) {
  const pixel = value_at(result, column.path);
  if (!Array.isArray(pixel)) return missing_cell(missing_reason(result, column));
  const text = pixel.join(", ");
  return el(
    "td",
    { class: "number", "data-path": column.path, "data-value": text },
    el(
      "button",
      {
        type: "button",
        class: "link",
        "aria-label": `Show pixel ${text} of ${result.label}`,
        onclick: () => context.show_pixel(pixel[0], pixel[1], result),
      },
      text,
    ),
  );
}

function interval_text(ci95) {
  return Array.isArray(ci95) && ci95.every(is_number) ? ci95.map((bound) => fixed(bound, 2)).join("–") : null;
}

/** `judged`: the result's speed-up of that column; that of the baseline over itself needs no verdict. */
function speedup_cell(result, column, { judged, decimals, best, is_baseline }) {
  const cell = number_cell(result, column, decimals, best);
  const { ci95, verdict, reason } = judged ?? {};
  if (!cell.dataset.value || is_baseline) return cell;
  return append(cell, [
    el(
      "span",
      { class: "interval" },
      interval_text(ci95),
      verdict ? el("span", { class: `verdict-word ${verdict.replace(" ", "-")}` }, verdict) : null,
    ),
    reason ? el("span", { class: "interval" }, reason) : null,
  ]);
}

function head_cell(column) {
  return el(
    "th",
    { scope: "col", class: "number", title: column.title },
    column.head,
    column.unit ? el("span", { class: "unit" }, column.unit) : null,
  );
}

/** Fills the row of a result without values with the reason. */
function reason_cell(result, span) {
  return el(
    "td",
    { class: "reason", colspan: span },
    el("span", { class: `status ${result.status}` }, result.status),
    " ",
    result.reason ?? "no reason given",
  );
}

function scroll_box(label, table) {
  return el("div", { class: "table-box", tabindex: "0", role: "region", "aria-label": label }, table);
}

/** How many rounds were timed, and by how much the baseline differs from itself. */
function trust_text(run) {
  const { rounds, noise_floor } = run;
  const texts = [];
  if (rounds?.done < rounds?.needed) {
    texts.push(`too few rounds: ${rounds.done}, needs ${rounds.needed}`);
  } else if (rounds) {
    const done = rounds.done < rounds.asked ? `${rounds.done} of ${rounds.asked}` : rounds.done;
    texts.push(`${done} rounds${rounds.done < rounds.asked ? ", ended by max_seconds" : ""}`);
  }
  if (noise_floor) {
    const interval = interval_text(noise_floor.ci95);
    texts.push(
      `noise floor: ${noise_floor.method} against itself ${fixed(noise_floor.value, 2)}×${interval ? ` (${interval})` : ""}`,
    );
  }
  return texts.join(" · ");
}

/** How to read the speed-ups. */
function reading_text(with_sort) {
  const paired =
    "A speed-up is the median of the ratios to the baseline round by round, not the ratio of the medians. A time is " +
    "marked as the best if it is resolved: its interval excludes 1 and it lies outside the noise floor.";
  const sort =
    " Frames are drawn in a precomputed order; Sort is the time to compute it again, and With sort adds that to each frame.";
  return with_sort ? paired + sort : paired;
}

/** `context`: {methods, metrics, columns, baseline, show_pixel(x, y, result)}. */
export function timing_table(run, context) {
  const { results } = run;
  const has_values = (column) => results.some((result) => is_number(value_at(result, column.path)));
  const columns = columns_of(context.columns, "times").filter(has_values);
  const decimals = column_decimals(results.map((result) => value_at(result, "timing.median")));
  const decimals_in = (column) => (column.digits ? decimals_of(results, column) : decimals);
  const with_speedup = results.some((result) => result.speedup);
  const sorting = columns_of(context.columns, "sorting");
  const with_sort = results.some((result) => result.timing?.sort);
  const tail = [...(with_speedup ? columns_of(context.columns, "speedups") : []), ...(with_sort ? sorting : [])];
  const tail_cell = (result, column) => {
    const decimals = decimals_of(results, column);
    if (!column.is_speedup) return number_cell(result, column, decimals, new Set());
    return speedup_cell(result, column, {
      judged: value_at(result, column.path.split(".")[0]),
      decimals,
      best: fastest_results(run, column),
      is_baseline: result.label === context.baseline,
    });
  };
  const end = axis_end(Math.max(0, ...results.flatMap(timing_samples)));
  const mark = value_at(results.find((result) => result.label === context.baseline) ?? {}, "timing.median");
  const clocks = [...new Set(results.map((result) => result.timing?.clock).filter(Boolean))];
  const body = results.map((result) => {
    const heading = method_cell(result, context);
    if (result.status !== "ok") {
      return el("tr", { class: "no-result" }, heading, reason_cell(result, columns.length + tail.length + 1));
    }
    const samples = timing_samples(result);
    return el(
      "tr",
      { "data-label": result.label },
      heading,
      el(
        "td",
        { class: "strip-cell" },
        samples.length > 0 ? timing_strip(samples, end, mark, result.timing.outliers) : null,
      ),
      columns.map((column) => number_cell(result, column, decimals_in(column), fastest_results(run, column))),
      tail.map((column) => tail_cell(result, column)),
    );
  });
  return scroll_box(
    "Timings",
    el(
      "table",
      { class: "results timings" },
      el(
        "caption",
        {},
        "Timings",
        el(
          "span",
          { class: "muted" },
          ` ${[clocks.length > 0 ? `${clocks.join(" and ")} clock` : null, trust_text(run)].filter(Boolean).join(" · ")}`,
        ),
        with_speedup ? el("span", { class: "caption-line" }, reading_text(with_sort)) : null,
      ),
      el(
        "thead",
        {},
        el(
          "tr",
          {},
          el("th", { scope: "col" }, "Method"),
          el(
            "th",
            { scope: "col", class: "strip-head" },
            "Frames",
            el("span", { class: "axis-text" }, el("span", {}, "0"), el("span", {}, `${end} ms`)),
          ),
          columns.map(head_cell),
          tail.map(head_cell),
        ),
      ),
      el("tbody", {}, body),
    ),
  );
}

/** Null if the report has no counts. */
export function fragment_table(results, context) {
  if (!results.some((result) => result.fragments)) return null;
  const columns = columns_of(context.columns, "fragments");
  const best = new Map(columns.map((column) => [column, best_results(results, column)]));
  const body = results.map((result) =>
    el(
      "tr",
      result.fragments ? { "data-label": result.label } : { class: "no-result" },
      method_cell(result, context),
      result.fragments
        ? columns.map((column) => number_cell(result, column, decimals_of(results, column), best.get(column)))
        : reason_cell(result, columns.length),
    ),
  );
  return scroll_box(
    "Fragments",
    el(
      "table",
      { class: "results fragments" },
      el("caption", {}, "Fragments", el("span", { class: "muted" }, " counted in frames that are not timed")),
      el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "Method"), columns.map(head_cell))),
      el("tbody", {}, body),
    ),
  );
}

/** What the image format alone costs: the reference rounded as the methods' pictures are. Older reports do not have it. */
function rounded_row(rounded, columns, results, context) {
  if (!rounded) return null;
  const result = { status: "ok", label: rounded.label, metrics: rounded.metrics };
  return el(
    "tr",
    { class: "rounded" },
    el(
      "th",
      { scope: "row" },
      el("span", { class: "label" }, rounded.label),
      el("span", { class: "caption" }, "what the image format alone costs"),
    ),
    columns.map((column) => {
      const cell = column.pixel
        ? pixel_cell(result, column, context)
        : number_cell(result, column, decimals_of([...results, result], column), new Set());
      // It is not a method, so the columns do not compare it.
      delete cell.dataset.path;
      return cell;
    }),
  );
}

/** Null without descriptions of the metrics. */
export function difference_table(results, context, rounded) {
  const columns = difference_columns(context.metrics);
  if (columns.length === 0) return null;
  const best = new Map(columns.map((column) => [column, best_results(results, column)]));
  const body = results.map((result) => {
    const heading = method_cell(result, context);
    if (result.status !== "ok" || !result.metrics) {
      const why = { ...result, reason: missing_reason(result, { path: "metrics" }).replace(/^\w+: /, "") };
      return el(
        "tr",
        { class: "no-result" },
        heading,
        result.status === "ok"
          ? el("td", { class: "reason", colspan: columns.length }, why.reason)
          : reason_cell(result, columns.length),
      );
    }
    return el(
      "tr",
      { "data-label": result.label },
      heading,
      columns.map((column) =>
        column.pixel
          ? pixel_cell(result, column, context)
          : number_cell(result, column, decimals_of(results, column), best.get(column)),
      ),
    );
  });
  const last = rounded_row(rounded, columns, results, context);
  if (last) body.push(last);
  return scroll_box(
    "Differences from the reference",
    el(
      "table",
      { class: "results differences" },
      el("caption", {}, "Difference from the reference"),
      el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "Method"), columns.map(head_cell))),
      el("tbody", {}, body),
    ),
  );
}
