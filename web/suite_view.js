// A repeated publication: its figures next to those measured here, and whether its trends hold.
import { difference_columns } from "./columns.js";
import { el } from "./dom.js";
import { DASH, is_number } from "./format.js";
import { point_text } from "./sweep.js";

const DIGITS = 3;
const ROUNDING_DIGITS = 6; // more than a paper prints
const VERDICTS = { holds: "passed", fails: "failed" };

function measured_text(value) {
  if (!is_number(value)) return DASH;
  const text = Number.isInteger(value) ? String(value) : value.toPrecision(DIGITS);
  return (/e/.test(text) ? String(Number(text)) : text).replaceAll("-", "−");
}

/** A published figure with its digits: a number, or the ends of a range. */
function published_text(value) {
  if (Array.isArray(value))
    return value[0] === value[1] ? published_text(value[0]) : value.map(published_text).join(" to ");
  return is_number(value) ? String(Number(value.toPrecision(ROUNDING_DIGITS))).replaceAll("-", "−") : DASH;
}

function metric_text(metric, columns) {
  const column = columns.find((one) => one.name === metric);
  if (!column) return metric;
  return [column.head, column.unit ? el("span", { class: "unit" }, column.unit) : null];
}

/**
 * `place`: the cell of the point, null if another row's cell covers it; `is_first`: there is no point before the
 * method.
 */
function figure_row(figure, columns, place, is_first) {
  const number = (text) => el("td", { class: "number" }, text);
  return el(
    "tr",
    {},
    place,
    is_first ? el("th", { scope: "row" }, figure.method) : el("td", {}, figure.method),
    el("td", {}, metric_text(figure.metric, columns)),
    number(published_text(figure.published)),
    number(measured_text(figure.measured)),
    el("td", { class: "number muted" }, figure.ci95 ? `[${figure.ci95.map(measured_text).join(", ")}]` : DASH),
  );
}

function figures_table(figures, spec, columns) {
  const place_of = (figure) => point_text(figure.at, spec);
  const with_place = figures.some((figure) => place_of(figure) !== "");
  const rows = figures.map((figure, index) => {
    const place = place_of(figure);
    if (!with_place) return figure_row(figure, columns, null, true);
    if (index > 0 && place_of(figures[index - 1]) === place) return figure_row(figure, columns, null);
    let span = 1;
    while (index + span < figures.length && place_of(figures[index + span]) === place) ++span;
    return figure_row(figure, columns, el("th", { scope: "rowgroup", rowspan: span }, place));
  });
  const heads = ["Method", "Figure", "Published", "Measured", "95 % interval"];
  return el(
    "div",
    { class: "table-box", tabindex: "0", role: "region", "aria-label": "Published and measured" },
    el(
      "table",
      { class: "results suite-figures" },
      el("caption", {}, "Published and measured"),
      el(
        "thead",
        {},
        el(
          "tr",
          {},
          with_place ? el("th", { scope: "col" }, "Point") : null,
          heads.map((head, index) => el("th", { scope: "col", class: index >= 2 ? "number" : null }, head)),
        ),
      ),
      el("tbody", {}, rows),
    ),
  );
}

function trend_item(trend) {
  const verdict = VERDICTS[trend.verdict] ?? "open";
  return el(
    "li",
    {},
    el("span", { class: `verdict small ${verdict}` }, trend.verdict),
    el("div", {}, el("p", {}, trend.text), trend.detail ? el("p", { class: "muted" }, trend.detail) : null),
  );
}

/** Null if the report repeats no publication and measures nothing of our own. `columns` describe what can be measured, `metrics` the differences. */
export function suite_section(report, { columns, metrics }) {
  const { suite } = report;
  if (!suite) return null;
  return el(
    "section",
    { class: "suite", "aria-label": "Published figures" },
    el(
      "div",
      { class: "suite-text" },
      el("h2", {}, suite.title ?? "Published figures"),
      el("p", {}, suite.source),
      suite.device
        ? el(
            "p",
            { class: "muted" },
            `Published on ${suite.device}; measured on ${report.device?.renderer ?? "this device"}.`,
          )
        : null,
      suite.trends?.length > 0
        ? el("ul", { class: "trends", "aria-label": "Trends" }, suite.trends.map(trend_item))
        : null,
    ),
    suite.figures?.length > 0
      ? figures_table(suite.figures, report.spec, [...columns, ...difference_columns(metrics)])
      : null,
  );
}
