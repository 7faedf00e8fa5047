// What changed between two reports in the methods of one run, as a table.
import { el } from "./dom.js";
import { column_decimals, DASH, fixed, integer, is_number } from "./format.js";

const HEADS = [
  ["Picture", ""],
  ["FLIP mean", "number"],
  ["FLIP max", "number"],
  ["Differing px", "number"],
  ["Greatest difference, levels", "number"],
  ["Worst pixel", "number"],
  ["A ms", "number"],
  ["B ms", "number"],
  ["A ÷ B", "number"],
  ["To baseline", "number"],
  ["B is", ""],
];
const PICTURE_COLUMNS = 6;

function number_cell(value, text) {
  return el("td", { class: is_number(value) ? "number" : "number missing", "data-value": value }, text);
}

function interval_text(ci95) {
  return Array.isArray(ci95) ? ci95.map((bound) => fixed(bound, 2)).join("–") : "no interval";
}

function ratio_cell(judged, reason) {
  if (!judged) return el("td", { class: "number missing", title: reason }, DASH);
  return el(
    "td",
    { class: "number", "data-value": judged.value, title: judged.reason },
    `${fixed(judged.value, 2)}×`,
    el(
      "span",
      { class: "interval" },
      interval_text(judged.ci95),
      el("span", { class: `verdict-word ${judged.verdict.replace(" ", "-")}` }, judged.verdict),
    ),
  );
}

/** The first cell of a row: its name, which is a button that shows its pictures. */
function heading(row, on_show) {
  const name = row.picture
    ? el(
        "button",
        { type: "button", class: "link", title: "Show its pictures", onclick: () => on_show(row) },
        row.label,
      )
    : row.label;
  return el(
    "th",
    { scope: "row" },
    el("span", { class: "label" }, name),
    el("span", { class: "caption" }, row.caption),
  );
}

function picture_cells({ picture, missing }, decimals, on_pixel) {
  if (!picture || picture.verdict === "not examined") {
    return el("td", { class: "reason", colspan: PICTURE_COLUMNS }, picture?.reason ?? missing);
  }
  const { flip, differing_pixels, greatest_levels, worst_pixel } = picture;
  const pixel = worst_pixel?.join(", ");
  return [
    el(
      "td",
      {},
      el("span", { class: `diff-word ${picture.verdict}` }, picture.verdict),
      picture.linear === "different" && picture.verdict === "identical"
        ? el("span", { class: "interval" }, "but not its floats")
        : null,
    ),
    number_cell(flip.mean, fixed(flip.mean, decimals.mean)),
    number_cell(flip.max, fixed(flip.max, decimals.max)),
    number_cell(differing_pixels, integer(differing_pixels)),
    number_cell(greatest_levels, integer(greatest_levels)),
    el(
      "td",
      { class: "number" },
      pixel
        ? el("button", { type: "button", class: "link", "aria-label": `Show pixel ${pixel}`, onclick: on_pixel }, pixel)
        : DASH,
    ),
  ];
}

function time_cells(time, decimals) {
  if (!time) return HEADS.slice(PICTURE_COLUMNS).map(() => el("td", { class: "number missing" }, DASH));
  return [
    number_cell(time.a.median, fixed(time.a.median, decimals.ms)),
    number_cell(time.b.median, fixed(time.b.median, decimals.ms)),
    ratio_cell(time.absolute, time.reason),
    ratio_cell(time.relative, time.relative_reason),
    el(
      "td",
      { class: "diff-verdict" },
      el("span", { class: `diff-word ${time.verdict.replace(" ", "-")}` }, time.verdict),
      time.reason ? el("span", { class: "interval" }, time.reason) : null,
    ),
  ];
}

/** Rows of a run: the reference, then the methods. */
export function rows_of(run, baseline) {
  const reference = run.reference;
  return [
    { label: "Reference", caption: reference.method.b, picture: reference.picture, missing: "no picture" },
    ...run.results.map((result) => ({
      label: result.label,
      caption: result.label === baseline ? `${result.method} · baseline` : result.method,
      picture: result.picture,
      time: result.time,
      missing: ["a", "b"]
        .map((side) =>
          [`${side.toUpperCase()}: ${result.status[side]}`, result.reason?.[side]].filter(Boolean).join(", "),
        )
        .join("; "),
    })),
  ];
}

/** `on_show(row, pixel)`: shows the pictures of a row, at a pixel if there is one. */
export function run_table(rows, on_show) {
  const pictures = rows.map((row) => row.picture).filter((picture) => picture?.flip);
  const times = rows.map((row) => row.time).filter(Boolean);
  const decimals = {
    mean: column_decimals(pictures.map((picture) => picture.flip.mean)),
    max: column_decimals(pictures.map((picture) => picture.flip.max)),
    ms: column_decimals(times.flatMap((time) => [time.a.median, time.b.median])),
  };
  const body = rows.map((row) =>
    el(
      "tr",
      { "data-label": row.label },
      heading(row, on_show),
      picture_cells(row, decimals, () => on_show(row, row.picture.worst_pixel)),
      time_cells(row.time, decimals),
    ),
  );
  return el(
    "div",
    { class: "table-box", tabindex: "0", role: "region", "aria-label": "Pictures and times" },
    el(
      "table",
      { class: "results diff" },
      el("caption", {}, "Pictures and times", el("span", { class: "muted" }, " A ÷ B over 1: B is faster")),
      el(
        "thead",
        {},
        el(
          "tr",
          {},
          el("th", { scope: "col" }, "Method"),
          HEADS.map(([head, kind]) => el("th", { scope: "col", class: kind }, head)),
        ),
      ),
      el("tbody", {}, body),
    ),
  );
}
