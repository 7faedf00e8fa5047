// A sweep of two axes as a grid of cells, colored by a value of one method; a cell opens its point.
import { value_at } from "./columns.js";
import { el, select, set_children } from "./dom.js";
import { column_decimals, DASH, fixed, integer, is_number } from "./format.js";
import { MAGMA } from "./magma.js";
import { stops_of } from "./sweep.js";

const EQUAL_CONTRAST = 0.179; // relative luminance at which black and white text are equally readable
const TOP_LEVEL = 235;

/** Relative luminance of WCAG 2, 0 to 1. */
function luminance(color) {
  const [r, g, b] = color.map((level) => {
    const value = level / 255;
    return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/** 0 to 1 for a value between the extremes, by its logarithm where they are more than a decade apart. */
function share_of(values) {
  const known = values.filter(is_number);
  const [least, greatest] = [Math.min(...known), Math.max(...known)];
  const by_log = least > 0 && greatest / least > 10;
  const place = by_log ? Math.log : (value) => value;
  const span = place(greatest) - place(least);
  return (value) => (span > 0 ? (place(value) - place(least)) / span : 0);
}

export class SweepGrid {
  #axes;
  #runs;
  #columns;
  #column;
  #label;
  #on_choose;
  #body = el("div", { class: "table-box", tabindex: "0", role: "region", "aria-label": "Values over two axes" });
  #chosen = null;
  element;

  /** `axes`: the two of the grid, as [axis, index]; `first`: the column to begin with; `on_choose(run)`. */
  constructor({ axes, all_axes, runs, columns, first, on_choose }) {
    this.#axes = { shown: axes, all: all_axes };
    this.#runs = runs;
    this.#columns = columns;
    this.#column = first;
    const labels = runs[0].results.map(({ label }) => label);
    this.#label = labels.at(-1);
    this.#on_choose = on_choose;
    const choose = (name, choices, current, take) =>
      select(
        {
          "aria-label": name,
          onchange: (event) => {
            take(event.target.value);
            this.#draw();
          },
        },
        choices,
        current,
      );
    this.element = el(
      "section",
      { class: "sweep-grid", "aria-label": "Grid of the sweep" },
      el(
        "div",
        { class: "chart-head" },
        el("h2", {}, `${axes[0][0].name} × ${axes[1][0].name}`),
        choose(
          "Value of the grid",
          columns.map(({ path, head }) => [path, head]),
          this.#column.path,
          (path) => {
            this.#column = columns.find((column) => column.path === path);
          },
        ),
        choose(
          "Method of the grid",
          labels.map((label) => [label, label]),
          this.#label,
          (label) => {
            this.#label = label;
          },
        ),
      ),
      this.#body,
    );
  }

  /** Marks the run, and shows those that share its values on all other axes. */
  show(run) {
    this.#chosen = run;
    this.#draw();
  }

  #run_at(row, column) {
    const stops = stops_of(this.#axes.all, this.#chosen.point);
    const [[, down], [, across]] = this.#axes.shown;
    stops[down] = row;
    stops[across] = column;
    return this.#runs.find((run) => stops_of(this.#axes.all, run.point).join() === stops.join());
  }

  #draw() {
    const [[down], [across]] = this.#axes.shown;
    const cells = down.stops.map((_, row) => across.stops.map((__, column) => this.#run_at(row, column)));
    const value = (run) => value_at(run?.results.find(({ label }) => label === this.#label) ?? {}, this.#column.path);
    const values = cells.flat().map(value);
    const share = share_of(values);
    const decimals = column_decimals(values, this.#column.digits);
    const text = (number) =>
      !is_number(number) ? DASH : this.#column.whole ? integer(number) : fixed(number, decimals);
    set_children(
      this.#body,
      el(
        "table",
        { class: "heat" },
        el("caption", {}, `${this.#column.head} of ${this.#label}${this.#column.unit ? `, ${this.#column.unit}` : ""}`),
        el(
          "thead",
          {},
          el(
            "tr",
            {},
            el("th", {}, `${down.name} ↓ ${across.name} →`),
            across.stops.map((stop) => el("th", { scope: "col" }, stop.text)),
          ),
        ),
        el(
          "tbody",
          {},
          cells.map((row, index) =>
            el(
              "tr",
              {},
              el("th", { scope: "row" }, down.stops[index].text),
              row.map((run) => this.#cell(run, value(run), share, text)),
            ),
          ),
        ),
      ),
    );
  }

  #cell(run, value, share, text) {
    if (!run) return el("td", { class: "missing" }, DASH);
    const button = el(
      "button",
      {
        type: "button",
        "aria-pressed": String(run === this.#chosen),
        "data-value": value,
        onclick: () => {
          this.#on_choose(run);
          this.#body.querySelector("[aria-pressed=true]")?.focus({ preventScroll: true });
        },
      },
      text(value),
    );
    if (is_number(value)) {
      const color = MAGMA[Math.round(share(value) * TOP_LEVEL)];
      button.style.background = `rgb(${color.join(" ")})`;
      button.style.color = luminance(color) < EQUAL_CONTRAST ? "#fff" : "#000";
    }
    return el("td", {}, button);
  }
}
