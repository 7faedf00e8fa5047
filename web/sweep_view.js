// The part of a report for sweeps: charts of times and metrics, and the choice of the point to show.
import { legend, line_chart } from "./chart.js";
import { columns_of, difference_columns, missing_reason, value_at } from "./columns.js";
import { append, el, select, set_children } from "./dom.js";
import { column_decimals, DASH, fixed, integer, is_number } from "./format.js";
import { axes_of, growth_along, point_text, runs_along, series_along, stops_of } from "./sweep.js";
import { SweepGrid } from "./sweep_grid.js";

const FIRST_METRIC = "metrics.flip.mean";

function has_values(runs, column) {
  return runs.some((run) => run.results.some((result) => is_number(value_at(result, column.path))));
}

function shown_in(along, column) {
  const decimals = column_decimals(
    along.flatMap(({ run }) => run.results.map((result) => value_at(result, column.path))),
    column.digits,
  );
  const text = (value) => (column.whole ? integer(value) : fixed(value, decimals));
  return (value, interval) => (interval ? `${text(value)} [${interval.map(text).join(", ")}]` : text(value));
}

/** All values along the axis as numbers: one row per point and method. */
function values_rows(axis, along, columns) {
  const shown = columns.map((column) => shown_in(along, column));
  const cell = (result, column, index) => {
    const value = value_at(result, column.path);
    if (!is_number(value)) return el("td", { class: "number missing", title: missing_reason(result, column) }, DASH);
    return el("td", { class: "number", "data-path": column.path, "data-value": String(value) }, shown[index](value));
  };
  return along.flatMap(({ stop, run }) =>
    run.results.map((result) =>
      el(
        "tr",
        { "data-stop": axis.stops[stop].text, "data-label": result.label },
        el("th", { scope: "row" }, `${axis.name} ${axis.stops[stop].text}, ${result.label}`),
        columns.map((column, index) => cell(result, column, index)),
      ),
    ),
  );
}

/** The rows are made when it is opened: a sweep of a hundred points has thousands of values. */
function values_table(axis, along, columns, open) {
  const body = el("tbody");
  const fill = () => body.firstChild || append(body, values_rows(axis, along, columns));
  const heads = columns.map((column) =>
    el(
      "th",
      { scope: "col", class: "number" },
      column.head,
      column.unit ? el("span", { class: "unit" }, column.unit) : null,
    ),
  );
  return el(
    "details",
    { class: "sweep-values", open, ontoggle: fill },
    el("summary", {}, "Values as a table"),
    el(
      "div",
      { class: "table-box", tabindex: "0", role: "region", "aria-label": "Values over the sweep" },
      el(
        "table",
        { class: "results sweep" },
        el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "Point and method"), heads)),
        body,
      ),
    ),
  );
}

/** `element` is for the page; `on_run(run)` is called for the run `first` and for every chosen one. */
export class SweepView {
  #report;
  #axes;
  #stops;
  #axis = 0;
  #metrics;
  #timed;
  #metric;
  #on_run;
  #charts = el("div", { class: "charts" });
  #values = el("div");
  #points = el("div", { class: "point-row", role: "group", "aria-label": "Point of the sweep" });
  #metric_select;
  #grid;
  #growth = el("p", { class: "growth muted" });

  constructor(report, { metrics, columns }, on_run, first) {
    this.#report = report;
    this.#on_run = on_run;
    this.#axes = axes_of(report.spec);
    this.#axis = Math.max(
      0,
      this.#axes.findIndex((axis) => axis.stops.length > 1),
    );
    this.#stops = stops_of(this.#axes, first.point);
    this.#metrics = [...difference_columns(metrics), ...columns_of(columns, "fragments")].filter(
      (column) => !column.pixel && has_values(report.runs, column),
    );
    this.#timed = [
      ...columns_of(columns, "speedups").map((column) => ({ ...column, interval: "speedup.ci95", mark: 1 })),
      ...columns_of(columns, "times")
        .slice(0, 1)
        .map((column) => ({ ...column, head: "Time", interval: "timing.ci95" })),
    ];
    this.#metric = this.#metrics.find((column) => column.path === FIRST_METRIC) ?? this.#metrics[0];
    this.#metric_select = select(
      {
        "aria-label": "Metric of the chart",
        onchange: (event) => {
          this.#metric = this.#metrics.find((column) => column.path === event.target.value);
          this.#draw_charts();
          this.#metric_select.focus();
        },
      },
      this.#metrics.map((column) => [column.path, column.head]),
      this.#metric?.path,
    );
    const labels = report.runs[0].results.map((result) => result.label);
    this.#grid = this.#make_grid();
    this.element = el(
      "section",
      { class: "sweep-view", "aria-label": "Sweep" },
      el("div", { class: "chart-head" }, el("h2", {}, "Over the sweep"), this.#axis_choice(), legend(labels)),
      this.#charts,
      el(
        "p",
        { class: "hint" },
        "Bars are 95 % intervals, if there were enough rounds. A click, or Enter, shows the point below.",
      ),
      this.#growth,
      this.#grid?.element,
      this.#values,
    );
    this.point_choice = this.#points;
    this.#choose(this.#stops);
  }

  /** Null if fewer than two axes have several stops. */
  #make_grid() {
    const wide = this.#axes.map((axis, index) => [axis, index]).filter(([axis]) => axis.stops.length > 1);
    const columns = [...this.#metrics, ...this.#timed].filter((column) => has_values(this.#report.runs, column));
    if (wide.length < 2 || columns.length === 0) return null;
    return new SweepGrid({
      axes: wide.slice(0, 2),
      all_axes: this.#axes,
      runs: this.#report.runs,
      columns,
      first: columns.includes(this.#metric) ? this.#metric : columns[0],
      on_choose: (run) => this.choose_run(run),
    });
  }

  /** How times and memory grow along the axis, where its values are numbers. */
  #show_growth(axis, run) {
    const text = ({ method, exponent, ci95 }) =>
      `${method} ${fixed(exponent, 2)} [${ci95.map((end) => fixed(end, 2)).join(", ")}]`;
    const sentence = (metric, what) => {
      const known = run ? growth_along(this.#report, axis, run, metric) : [];
      const told = metric === "timing.median" ? known : known.filter(({ exponent }) => Math.abs(exponent) >= 0.005);
      return told.length === 0 ? "" : `${what} grows with the power of ${axis.name}: ${told.map(text).join(", ")}. `;
    };
    this.#growth.textContent = sentence("timing.median", "Time") + sentence("memory_bytes", "Memory");
    this.#growth.hidden = this.#growth.textContent === "";
  }

  /** Shows a run of the report. */
  choose_run(run) {
    this.#choose(stops_of(this.#axes, run.point));
  }

  #axis_choice() {
    if (this.#axes.length < 2) return null;
    return el(
      "label",
      { class: "point-select" },
      "Along ",
      select(
        {
          onchange: (event) => {
            this.#axis = Number(event.target.value);
            this.#draw_charts();
          },
        },
        this.#axes.map((axis, index) => [String(index), axis.name]),
        String(this.#axis),
      ),
    );
  }

  get #run() {
    return this.#report.runs.find((run) => stops_of(this.#axes, run.point).join() === this.#stops.join());
  }

  #choose(stops) {
    this.#stops = stops;
    this.#draw_points();
    this.#draw_charts();
    this.#on_run(this.#run);
  }

  #draw_points() {
    const had_focus = [...this.#points.querySelectorAll("select")].indexOf(document.activeElement);
    set_children(
      this.#points,
      el("strong", {}, "Looking at"),
      this.#axes.map((axis, index) =>
        select(
          {
            "aria-label": axis.name,
            onchange: (event) => this.#choose(this.#stops.with(index, Number(event.target.value))),
          },
          axis.points.map((point, stop) => [String(stop), point_text(point, this.#report.spec)]),
          String(this.#stops[index]),
        ),
      ),
    );
    this.#points.querySelectorAll("select")[had_focus]?.focus();
  }

  #draw_charts() {
    const axis = this.#axes[this.#axis];
    const run = this.#run;
    const along = run ? runs_along(this.#axes, this.#report.runs, this.#axis, run) : [];
    const chart = (column, heading) =>
      line_chart({
        title: column.head,
        heading,
        unit: column.unit,
        x: axis,
        series: series_along(along, column.path, column.interval),
        mark: column.mark,
        shown: shown_in(along, column),
        chosen: this.#stops[this.#axis],
        on_choose: (stop) => this.#choose(this.#stops.with(this.#axis, stop)),
      });
    const had_focus = [...this.#charts.querySelectorAll(".plot")].indexOf(document.activeElement);
    const timed = this.#timed.filter((column) => has_values(this.#report.runs, column));
    set_children(
      this.#charts,
      timed.map((column) => chart(column)),
      this.#metric ? chart(this.#metric, this.#metric_select) : null,
    );
    this.#charts.querySelectorAll(".plot")[had_focus]?.focus();
    const open = this.#values.querySelector("details")?.open ?? false;
    set_children(this.#values, values_table(axis, along, [...timed, ...this.#metrics], open));
    this.#show_growth(axis, run);
    if (run) this.#grid?.show(run);
  }
}
