// Charts in SVG: lines of methods over a sweep, and points of methods in a plane. A chart is redrawn when its width
// changes; the mouse and the arrow keys show the values at a place.
import { el, set_children, svg } from "./dom.js";
import { is_number } from "./format.js";
import { make_scale, scale_kind, thinned, tick_text, value_axis } from "./scales.js";

const HEIGHT = 236;
const TOP = 10;
const RIGHT = 16;
const BOTTOM = 38;
const LETTER = 6.4; // approximate width of a letter of a tick
const NAME_ROW = 12; // height of a name
const GAP = 12; // between a target and its readout
const FLAT = 0.25; // share of the greatest value: if the spread is smaller, the axis does not include 0
const DODGE = 7; // between methods at one category
const COLORS = 8;
const SHAPES = [
  "M-3.6 0a3.6 3.6 0 1 0 7.2 0a3.6 3.6 0 1 0-7.2 0z",
  "M-3.3-3.3h6.6v6.6h-6.6z",
  "M0-4.4L4.2 3H-4.2z",
  "M0-4.6L4.6 0L0 4.6L-4.6 0z",
  "M0 4.4L4.2-3H-4.2z",
];

const color_class = (index) => `series-${index % COLORS}`;

function marker(index, x, y, name = "") {
  return svg("path", {
    class: `marker ${name || color_class(index)}`,
    d: SHAPES[index % SHAPES.length],
    transform: `translate(${x} ${y})`,
  });
}

/** The area of a ring stands for `point.share`, 0 to 1, of the greatest value. */
function ring({ x, y, share, grey, index }) {
  if (!share) return null;
  return svg("circle", { class: `ring ${grey ? "grey" : color_class(index)}`, cx: x, cy: y, r: 20 * Math.sqrt(share) });
}

/** Names of the lines with their colors and shapes; `labels` in the order of the series. */
export function legend(labels) {
  return el(
    "ul",
    { class: "legend" },
    labels.map((label, index) => el("li", {}, key_mark(index), label)),
  );
}

function key_mark(index) {
  return svg("svg", { class: "key", viewBox: "-7 -7 14 14", "aria-hidden": "true" }, marker(index, 0, 0));
}

/**
 * A chart that draws itself. `paint(width)` returns {nodes, targets}: what is drawn, and the places that have values,
 * {x, y, lines, key}, without `y` if only x counts. `on_choose(key)` is called on a click or Enter.
 */
class Plot {
  #targets = [];
  #current = -1;
  #on_choose;
  #guide = svg("line", { class: "guide", y1: TOP, y2: HEIGHT - BOTTOM, visibility: "hidden" });
  #readout = el("div", { class: "chart-readout", role: "status", hidden: true });

  constructor({ heading, unit, label, paint, on_choose }) {
    this.#on_choose = on_choose;
    const drawing = svg("svg", {
      class: on_choose ? "plot choosable" : "plot",
      role: "img",
      tabindex: "0",
      "aria-label": label,
      height: HEIGHT,
      onpointermove: (event) => this.#show(this.#nearest(event, drawing)),
      onpointerleave: () => this.#show(-1),
      onblur: () => this.#show(-1),
      onclick: (event) => this.#choose(this.#nearest(event, drawing)),
      onkeydown: (event) => this.#key(event),
    });
    const caption = el("figcaption", {}, heading, unit ? el("span", { class: "unit" }, unit) : null);
    this.element = el("figure", { class: "chart" }, caption, el("div", { class: "plot-box" }, drawing, this.#readout));
    let drawn = 0;
    new ResizeObserver(() => {
      const width = Math.floor(drawing.clientWidth);
      if (width === drawn || width === 0) return;
      drawn = width;
      const { nodes, targets } = paint(width);
      drawing.setAttribute("viewBox", `0 0 ${width} ${HEIGHT}`);
      this.#targets = targets;
      this.#show(-1);
      set_children(drawing, nodes, this.#guide);
    }).observe(drawing);
  }

  #nearest(event, drawing) {
    const box = drawing.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    const distance = (target) => Math.hypot(target.x - x, target.y === undefined ? 0 : target.y - y);
    let best = -1;
    this.#targets.forEach((target, index) => {
      if (best < 0 || distance(target) < distance(this.#targets[best])) best = index;
    });
    return best;
  }

  #choose(index) {
    const target = this.#targets[index];
    if (target) this.#on_choose?.(target.key);
  }

  #key(event) {
    const moves = { ArrowLeft: -1, ArrowRight: 1 };
    if (event.key in moves && this.#targets.length > 0) {
      event.preventDefault();
      const next = this.#current < 0 ? 0 : this.#current + moves[event.key];
      this.#show(Math.min(this.#targets.length - 1, Math.max(0, next)));
    } else if (event.key === "Enter") this.#choose(this.#current);
    else if (event.key === "Escape") this.#show(-1);
  }

  #show(index) {
    if (index === this.#current && index >= 0) return;
    this.#current = index;
    const target = this.#targets[index];
    this.#readout.hidden = !target;
    this.#guide.setAttribute("visibility", target && target.y === undefined ? "visible" : "hidden");
    if (!target) return;
    this.#guide.setAttribute("x1", target.x);
    this.#guide.setAttribute("x2", target.x);
    set_children(this.#readout, target.lines);
    this.#readout.style.left = "0"; // where its width is not restricted
    const [left, top] = this.#free_place(target);
    this.#readout.style.left = `${left}px`;
    this.#readout.style.top = `${top}px`;
  }

  /** The place of the readout beside its target: within the chart, covering as few other targets as possible. */
  #free_place({ x, y }) {
    const { offsetWidth: width, offsetHeight: height, parentElement: box } = this.#readout;
    const within = (place, size, all) => Math.max(0, Math.min(place, all - size));
    const places = [x + GAP, x - GAP - width].flatMap((left) =>
      (y === undefined ? [TOP] : [y + GAP, y - GAP - height, y - height / 2]).map((top) => [
        within(left, width, box.clientWidth),
        within(top, height, HEIGHT),
      ]),
    );
    const covered = ([left, top]) =>
      this.#targets.filter(
        (one) => one.x > left && one.x < left + width && (one.y === undefined || (one.y > top && one.y < top + height)),
      ).length;
    return places.reduce((best, place) => (covered(place) < covered(best) ? place : best));
  }
}

function y_axis_nodes(ticks, y, left, right) {
  return ticks.map((tick) => [
    svg("line", { class: "grid", x1: left, x2: right, y1: y(tick), y2: y(tick) }),
    svg("text", { x: left - 6, y: y(tick), dy: "0.32em", "text-anchor": "end" }, tick_text(tick)),
  ]);
}

/** `stops`: [{at, text}] in ascending order of `at`; names without room are left out. */
function x_axis_nodes(stops, name, left, right) {
  const base = HEIGHT - BOTTOM;
  const longest = Math.max(...stops.map(({ text }) => text.length));
  const kept = new Set(
    thinned(
      stops.map(({ at }) => at),
      longest * LETTER + 8,
    ),
  );
  const half = (text) => (text.length * LETTER) / 2;
  return [
    svg("line", { class: "axis", x1: left, x2: right, y1: base, y2: base }),
    stops.map(({ at }) => svg("line", { class: "axis", x1: at, x2: at, y1: base, y2: base + 4 })),
    stops
      .filter(({ at }) => kept.has(at))
      .map(({ at, text }) => {
        const x = Math.min(Math.max(at, half(text)), right + RIGHT - half(text));
        return svg("text", { x, y: base + 16, "text-anchor": "middle" }, text);
      }),
    svg("text", { class: "axis-name", x: (left + right) / 2, y: HEIGHT - 4, "text-anchor": "middle" }, name),
  ];
}

const left_margin = (ticks) => 14 + LETTER * Math.max(...ticks.map((tick) => tick_text(tick).length));

function whisker(x, [low, high], y, name) {
  const d = `M${x} ${y(low)}V${y(high)}M${x - 3} ${y(low)}h6M${x - 3} ${y(high)}h6`;
  return svg("path", { class: `whisker ${name}`, d });
}

/** Places of stops on the x axis: numbers to scale, anything else evenly spaced. */
function stop_places(stops, left, right) {
  const values = stops.map((stop) => stop.value);
  const kind = scale_kind(values);
  if (kind === "categories") {
    const width = (right - left) / stops.length;
    return stops.map((_, index) => left + width * (index + 0.5));
  }
  const scale = make_scale(kind, [Math.min(...values), Math.max(...values)], [left + 10, right - 6]);
  return values.map(scale);
}

/** The path of a line, with gaps at missing points. */
function line_path(places) {
  let pen = "M";
  return places
    .map((place) => {
      if (!place) {
        pen = "M";
        return "";
      }
      const step = `${pen}${place[0]} ${place[1]}`;
      pen = "L";
      return step;
    })
    .join("");
}

/** Kind and axis for all values and ends of intervals; a linear axis has 0 unless that would hide the differences. */
function line_values_axis(series, mark) {
  const points = series.flatMap((one) => one.points).filter((point) => is_number(point.value));
  const values = points.flatMap((point) => [point.value, ...(point.interval ?? [])]);
  if (is_number(mark)) values.push(mark);
  const kind = scale_kind(values) === "log" ? "log" : "linear";
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const is_flat = high > low && high - low < FLAT * Math.max(Math.abs(low), Math.abs(high));
  return { kind, ...value_axis(kind, kind === "linear" && !is_flat ? [...values, 0] : values) };
}

/**
 * One line per method. `heading`: a node instead of the title; `x`: {name, stops: [{value, text}]}; `series`: [{label,
 * points: [{stop, value, interval}]}] with stops as indices of `x.stops`; `mark`: a value at which to draw a line;
 * `shown(value, interval)` returns text; `chosen`: the stop to highlight; `on_choose(stop)`.
 */
export function line_chart({ title, heading = title, unit, x, series, mark, shown, chosen, on_choose }) {
  const axis = line_values_axis(series, mark);
  const is_numeric = scale_kind(x.stops.map((stop) => stop.value)) !== "categories";
  const paint = (width) => {
    const left = left_margin(axis.ticks);
    const right = width - RIGHT;
    const places = stop_places(x.stops, left, right);
    const y = make_scale(axis.kind, axis.domain, [HEIGHT - BOTTOM, TOP]);
    const dodge = (index) => (is_numeric ? 0 : (index - (series.length - 1) / 2) * DODGE);
    const order = x.stops.map((_, stop) => stop).sort((a, b) => places[a] - places[b]);
    const point_at = (one, stop) => one.points.find((point) => point.stop === stop && point.value !== null);
    const lines = series.map((one, index) => {
      const found = order.map((stop) => point_at(one, stop));
      const at = found.map((point) => point && [places[point.stop] + dodge(index), y(point.value)]);
      return [
        svg("path", { class: `line ${is_numeric ? "" : "loose "}${color_class(index)}`, d: line_path(at) }),
        found.map((point, k) => point?.interval && whisker(at[k][0], point.interval, y, color_class(index))),
        found.map((point, k) => point && marker(index, ...at[k])),
      ];
    });
    const targets = order.map((stop) => ({ x: places[stop], key: stop, lines: readout_lines(stop) }));
    const readout_stops = order.map((stop) => ({ at: places[stop], text: x.stops[stop].text }));
    return {
      nodes: [
        is_number(chosen)
          ? svg("line", { class: "chosen", x1: places[chosen], x2: places[chosen], y1: TOP, y2: HEIGHT - BOTTOM })
          : null,
        y_axis_nodes(axis.ticks, y, left, right),
        is_number(mark) ? svg("line", { class: "mark", x1: left, x2: right, y1: y(mark), y2: y(mark) }) : null,
        x_axis_nodes(readout_stops, x.name, left, right),
        lines,
      ],
      targets,
    };
  };
  const readout_lines = (stop) => [
    el("strong", {}, `${x.name} ${x.stops[stop].text}`),
    series.map((one, index) => {
      const point = one.points.find((candidate) => candidate.stop === stop);
      const text = point && point.value !== null ? shown(point.value, point.interval) : "–";
      return el("span", { class: "readout-line" }, key_mark(index), one.label, el("span", { class: "value" }, text));
    }),
  ];
  const measured = series.filter((one) => one.points.some((point) => point.value !== null)).length;
  const label = `${title} of ${measured} methods over ${x.name}; the arrow keys read the values`;
  return new Plot({ heading, unit, label, paint, on_choose }).element;
}

/** Names above points: to the right, or to the left if there is no room, moved up so that they do not overlap. */
function name_nodes(points, right) {
  const rows = [];
  return [...points]
    .sort((a, b) => b.y - a.y)
    .map((point) => {
      const width = point.label.length * LETTER + 10;
      const on_left = point.x + width > right + RIGHT;
      const [from, to] = on_left ? [point.x - width, point.x] : [point.x, point.x + width];
      let y = point.y - 9;
      for (const row of rows) if (row.from < to && from < row.to && row.y - y < NAME_ROW) y = row.y - NAME_ROW;
      rows.push({ from, to, y });
      return svg(
        "text",
        {
          class: ["name", point.grey && "grey", point.fastest && "fastest"].filter(Boolean).join(" "),
          x: on_left ? point.x - 4 : point.x + 4,
          y,
          dy: "0.32em",
          "text-anchor": on_left ? "end" : "start",
        },
        point.label,
      );
    });
}

/**
 * Methods in a plane. `points`: [{label, index, x, y, x_interval, grey, fastest, lines}]: `index` gives color and
 * shape, `x` over 0 on a logarithmic axis, `y` not below 0; grey ones are in the background, names of `fastest` ones
 * are bold; a stepped line joins those that are not grey. `lines` are shown for the point.
 */
export function scatter_chart({ title, unit, x_name, label, points }) {
  const x_axis = value_axis(
    "log",
    points.flatMap((point) => [point.x, ...(point.x_interval ?? [])]),
  );
  const y_axis = value_axis("linear", [0, ...points.map((point) => point.y)]);
  const paint = (width) => {
    const left = left_margin(y_axis.ticks);
    const right = width - RIGHT;
    const x = make_scale("log", x_axis.domain, [left + 10, right - 6]);
    const y = make_scale("linear", y_axis.domain, [HEIGHT - BOTTOM, TOP]);
    const placed = points.map((point) => ({ ...point, x: x(point.x), y: y(point.y) }));
    // A point that is in front only by a third value is not on the line.
    const front = placed
      .filter((point) => !point.grey)
      .sort((a, b) => a.x - b.x)
      .filter((point, k, all) => all.slice(0, k).every((quicker) => quicker.y < point.y));
    const steps = front.map((point, k) => (k === 0 ? `M${point.x} ${point.y}` : `H${point.x}V${point.y}`)).join("");
    const bars = placed.map((point) => {
      if (!point.x_interval) return null;
      const [low, high] = point.x_interval.map(x);
      const d = `M${low} ${point.y}H${high}M${low} ${point.y - 3}v6M${high} ${point.y - 3}v6`;
      return svg("path", { class: `whisker ${point.grey ? "grey" : color_class(point.index)}`, d });
    });
    return {
      nodes: [
        y_axis_nodes(y_axis.ticks, y, left, right),
        x_axis_nodes(
          x_axis.ticks.map((tick) => ({ at: x(tick), text: tick_text(tick) })),
          x_name,
          left,
          right,
        ),
        svg("path", { class: "front", d: steps }),
        bars,
        placed.map((point) => ring(point)),
        placed.map((point) => marker(point.index, point.x, point.y, point.grey ? "grey" : "")),
        name_nodes(placed, right),
      ],
      targets: placed.map(({ x: at, y: height, lines }) => ({ x: at, y: height, lines })),
    };
  };
  return new Plot({ heading: title, unit, label, paint }).element;
}
