// A report of several devices: each method's time on all of them, and how far the pictures are from those of the first.
import { el } from "./dom.js";
import { DASH, column_decimals, fixed, is_number } from "./format.js";
import { point_text } from "./sweep.js";

const FLIP_DECIMALS = 4;

function time_cell({ median, median_reason, ci95 }, decimals) {
  if (!is_number(median)) return el("td", { class: "number muted", title: median_reason ?? null }, DASH);
  const interval = ci95 ? ` [${ci95.map((end) => fixed(end, decimals)).join(", ")}]` : "";
  return el("td", { class: "number" }, fixed(median, decimals), el("span", { class: "muted" }, interval));
}

function flip_cell({ flip, flip_reason, differing_pixels }) {
  if (!is_number(flip)) return el("td", { class: "number muted", title: flip_reason ?? null }, DASH);
  const pixels = differing_pixels === 1 ? "1 pixel differs" : `${differing_pixels ?? 0} pixels differ`;
  return el("td", { class: "number", title: pixels }, fixed(flip, FLIP_DECIMALS));
}

function row_of(row, spec, with_place, decimals) {
  const place = point_text(row.at, spec);
  return el(
    "tr",
    {},
    el("th", { scope: "row" }, row.method),
    with_place ? el("td", {}, place) : null,
    row.devices.map((device, index) => [time_cell(device, decimals[index]), index > 0 ? flip_cell(device) : null]),
  );
}

function heading(devices, with_place) {
  const head = (...text) => el("th", { scope: "col", class: "number" }, text);
  return el(
    "tr",
    {},
    el("th", { scope: "col" }, "Method"),
    with_place ? el("th", { scope: "col" }, "Point") : null,
    devices.map(({ label }, index) => [
      head(label, el("span", { class: "unit" }, "ms [95 %]")),
      index > 0 ? head("FLIP", el("span", { class: "unit" }, `beside ${devices[0].label}`)) : null,
    ]),
  );
}

/** The device of each label, or why it rendered nothing. */
function device_item({ label, status, reason, device }) {
  const text = status === "failed" ? `failed: ${reason ?? "no reason given"}` : (device?.renderer ?? "");
  return el("li", {}, el("strong", {}, label), ` ${text}`);
}

/** Null if the report is of one device. */
export function across_section(report) {
  const { devices = [], across_devices: rows = [], spec } = report;
  if (rows.length === 0) return null;
  const with_place = rows.some(({ at }) => Object.keys(at ?? {}).length > 0);
  const decimals = devices.map((_, index) => column_decimals(rows.map((row) => row.devices[index]?.median)));
  return el(
    "section",
    { class: "across", "aria-label": "Devices" },
    el("h2", {}, `${devices.length} devices`),
    el("ul", { class: "note-list" }, devices.map(device_item)),
    el(
      "div",
      { class: "table-box", tabindex: "0", role: "region", "aria-label": "Methods on each device" },
      el(
        "table",
        { class: "results" },
        el("caption", {}, "Median times with their 95 % intervals, and the mean FLIP error of the pictures"),
        el("thead", {}, heading(devices, with_place)),
        el(
          "tbody",
          {},
          rows.map((row) => row_of(row, spec, with_place, decimals)),
        ),
      ),
    ),
  );
}

const STATES = { queued: "waits", running: "renders", done: "done", failed: "failed" };

/** "1 of 2 devices done: nvidia done, llvmpipe renders"; "" for one device. */
export function devices_text(devices = []) {
  if (devices.length === 0) return "";
  const done = devices.filter(({ status }) => status === "done" || status === "failed").length;
  const each = devices.map(({ label, status }) => `${label} ${STATES[status] ?? status}`);
  return `${done} of ${devices.length} devices ended: ${each.join(", ")}`;
}
