// The explanation of a pixel: its stack of fragments, near to far, and what each method made of it.
import { el, set_children } from "./dom.js";
import { DASH, fixed, is_number, words } from "./format.js";
import { patiently } from "./patience.js";

const DECIMALS = 4;
const FIRST_ROWS = 60;

function color_swatch(color) {
  const node = el("span", { class: "swatch", "aria-hidden": "true" }, el("span"));
  const channels = color.map((value) => `${Math.round(Math.min(1, Math.max(0, value)) * 1000) / 10}%`);
  node.firstChild.style.backgroundColor = `rgb(${channels.join(" ")})`;
  return node;
}

/** All channels with the same decimals, so that they line up. */
const color_text = (color) =>
  color
    .map((value) =>
      value
        .toFixed(DECIMALS)
        .replace(/^-(?=[0.]+$)/, "")
        .replace("-", "−"),
    )
    .join(" ");

function color_cell(color, reason) {
  if (!color?.every(is_number)) return missing_cell(reason);
  return el("td", { class: "color" }, color_swatch(color), el("span", {}, color_text(color)));
}

function missing_cell(reason) {
  return el(
    "td",
    { class: "number missing", title: reason },
    el("span", { "aria-hidden": "true" }, DASH),
    el("span", { class: "visually-hidden" }, `none: ${reason ?? "not known"}`),
  );
}

const number_cell = (value, decimals = DECIMALS) => el("td", { class: "number" }, fixed(value, decimals));

/** A share of the whole, as a number over a bar. */
function share_cell(value) {
  const bar = el("span", { "aria-hidden": "true" });
  bar.style.width = `${Math.min(1, Math.max(0, value)) * 100}%`;
  return el("td", { class: "number share" }, el("span", { class: "bar" }, bar), el("span", {}, fixed(value, DECIMALS)));
}

function heads(names) {
  return el(
    "thead",
    {},
    el(
      "tr",
      {},
      names.map(([name, title, kind]) => el("th", { scope: "col", class: kind, title }, name)),
    ),
  );
}

const STACK_HEADS = [
  ["#", "From the front"],
  ["Depth", "0 is nearest, 1 farthest", "number"],
  ["Color", "Red, green and blue, 0 to 1, not premultiplied"],
  ["Alpha", undefined, "number"],
  ["Primitive", "Its number in the scene, in the order of submission", "number"],
  ["Transmittance", "What the nearer fragments let through", "number"],
  ["Weight", "Transmittance times alpha: how much of the color is seen", "number"],
  ["Saturates", "Methods whose threshold is reached at this fragment"],
];

function fragment_row(fragment, number, pixel) {
  const stopped = pixel.methods.filter((method) => method.saturated_at === number);
  return el(
    "tr",
    {},
    el("th", { scope: "row" }, number),
    number_cell(fragment.depth, 6),
    color_cell(fragment.color),
    number_cell(fragment.alpha),
    el("td", { class: "number" }, fragment.primitive),
    share_cell(fragment.transmittance_before),
    share_cell(fragment.weight),
    el(
      "td",
      {},
      stopped.map((method) => el("span", { class: "chip" }, method.label)),
    ),
  );
}

function behind_row(pixel) {
  const { opaque, background, transmittance } = pixel;
  return el(
    "tr",
    { class: "behind" },
    el("th", { scope: "row" }, opaque ? "opaque" : "background"),
    opaque ? number_cell(opaque.depth, 6) : el("td"),
    color_cell(opaque?.color ?? background),
    el("td"),
    el("td"),
    share_cell(transmittance),
    share_cell(transmittance),
    el("td"),
  );
}

function stack_table(pixel) {
  const rows = (fragments, first) =>
    fragments.map((fragment, index) => fragment_row(fragment, first + index + 1, pixel));
  const { fragments } = pixel;
  const body = el("tbody", {}, rows(fragments.slice(0, FIRST_ROWS), 0));
  if (fragments.length > FIRST_ROWS) {
    const show_all = () => more.replaceWith(...rows(fragments.slice(FIRST_ROWS), FIRST_ROWS));
    const more = el(
      "tr",
      {},
      el(
        "td",
        { colspan: STACK_HEADS.length },
        el("button", { type: "button", onclick: show_all }, `Show the other ${fragments.length - FIRST_ROWS}`),
      ),
    );
    body.append(more);
  }
  body.append(behind_row(pixel));
  const count = fragments.length === 1 ? "1 transparent fragment" : `${fragments.length} transparent fragments`;
  return el("table", { class: "pixel-stack" }, el("caption", {}, `${count}, near to far`), heads(STACK_HEADS), body);
}

const METHOD_HEADS = [
  ["Method"],
  ["Value", "Red, green and blue of the picture"],
  ["Exact − value", "The exact sum minus the value", "number"],
  ["Shaded", "Fragments of this pixel that the method shaded", "number"],
  ["Needed", "Fragments until less transmittance than its threshold is left", "number"],
  [
    "Saturated at",
    "The fragment, counted from the front, after which less transmittance than its threshold is left",
    "number",
  ],
];

function method_row(method) {
  const count = (key) =>
    is_number(method[key])
      ? el("td", { class: "number" }, method[key])
      : missing_cell(method[`${key}_reason`] ?? method.reason);
  return el(
    "tr",
    { "data-label": method.label },
    el("th", { scope: "row" }, method.label),
    color_cell(method.value, method.reason ?? words(method.status)),
    method.difference?.every(is_number)
      ? el("td", { class: "number" }, color_text(method.difference))
      : missing_cell(method.reason),
    count("shaded"),
    count("needed"),
    count("saturated_at"),
  );
}

function plain_row(name, value, difference) {
  return el(
    "tr",
    { class: "truth" },
    el("th", { scope: "row" }, name),
    color_cell(value),
    difference ? el("td", { class: "number" }, color_text(difference)) : el("td"),
    el("td"),
    el("td"),
    el("td"),
  );
}

function method_table(pixel) {
  return el(
    "table",
    { class: "pixel-methods" },
    el("caption", {}, "What the methods made of it"),
    heads(METHOD_HEADS),
    el(
      "tbody",
      {},
      plain_row("Exact sum", pixel.sum),
      plain_row(`Reference: ${pixel.reference.method}`, pixel.reference.value, pixel.reference.difference),
      pixel.methods.map(method_row),
    ),
  );
}

/** 1–4, 7, or 4–1, 7: three or more consecutive numbers, up or down, form a range. */
function ranges(numbers) {
  const parts = [];
  for (let first = 0, last; first < numbers.length; first = last + 1) {
    const step = numbers[first + 1] - numbers[first];
    last = first;
    while (Math.abs(step) === 1 && numbers[last + 1] === numbers[last] + step) ++last;
    if (last - first < 2) last = first;
    parts.push(last === first ? numbers[first] : `${numbers[first]}–${numbers[last]}`);
  }
  return parts.join(", ") || "none";
}

const color_line = (color) => el("span", { class: "color" }, color_swatch(color), el("span", {}, color_text(color)));

/** What a fact's value looks like, by its kind. */
const FACT_VALUES = {
  number: (value) => (Number.isInteger(value) ? `${value}` : fixed(value, DECIMALS)),
  color: color_line,
  fragment: (value) => (value === null ? "none" : `#${value}`),
  fragments: ranges,
  samples: (value) =>
    value.map(({ fragment, color }) =>
      el("div", {}, color_line(color), fragment === null ? " opaque" : ` #${fragment}`),
    ),
};

function explained_method(method) {
  const note = method.explanation_reason && el("p", { class: "muted" }, method.explanation_reason);
  const facts = (method.explanation ?? []).map(({ name, kind, value, text }) =>
    el(
      "div",
      {},
      el("dt", {}, words(name)),
      el("dd", {}, FACT_VALUES[kind](value)),
      el("dd", { class: "muted" }, text),
    ),
  );
  if (!note && facts.length === 0) return null;
  return el("section", { "data-label": method.label }, el("h4", {}, method.label), note, el("dl", {}, facts));
}

function explanations(pixel) {
  const methods = pixel.methods
    .filter((method) => method.status === "ok")
    .map(explained_method)
    .filter(Boolean);
  if (methods.length === 0) return null;
  return el(
    "section",
    { class: "pixel-explained" },
    el("h3", {}, "How the methods arrived at their values"),
    el("p", { class: "muted" }, "Fragments are numbered as in the first table."),
    el("div", {}, methods),
  );
}

const scroller = (label, table) =>
  el("div", { class: "scroller", tabindex: "0", role: "group", "aria-label": label }, table);

export class PixelView {
  #load;
  #known = new Map();
  #loading = null;
  #return_to = null;
  #title = el("h2", { tabindex: "-1" });
  #body = el("div", { class: "pixel-body", "aria-live": "polite" });

  /** `load(x, y, signal)` returns the service's description of the pixel. */
  constructor(load) {
    this.#load = load;
    this.element = el(
      "section",
      { class: "pixel-view", "aria-label": "Pixel", hidden: true, onkeydown: (event) => this.#key(event) },
      el(
        "header",
        {},
        this.#title,
        el("button", { type: "button", "aria-label": "Close the pixel", onclick: () => this.close() }, "Close"),
      ),
      this.#body,
    );
  }

  async show(x, y) {
    this.#loading?.abort();
    this.#loading = new AbortController();
    const { signal } = this.#loading;
    if (this.element.hidden) this.#return_to = document.activeElement;
    this.element.hidden = false;
    this.#title.textContent = `Pixel x ${x}, y ${y}`;
    this.#title.focus({ preventScroll: true });
    const key = `${x} ${y}`;
    if (!this.#known.has(key)) {
      set_children(this.#body, el("p", { class: "muted" }, "Rendering its fragments…"));
    }
    try {
      const pixel = this.#known.get(key) ?? (await patiently(() => this.#load(x, y, signal), signal));
      if (signal.aborted) return;
      this.#known.set(key, pixel);
      set_children(
        this.#body,
        scroller("Fragments", stack_table(pixel)),
        scroller("Methods", method_table(pixel)),
        explanations(pixel),
      );
    } catch (error) {
      if (signal.aborted) return;
      set_children(this.#body, el("p", { class: "notice error", role: "alert" }, error.message));
    }
  }

  close() {
    this.#loading?.abort();
    this.element.hidden = true;
    this.#return_to?.focus({ preventScroll: true });
  }

  #key(event) {
    if (event.key !== "Escape") return;
    event.preventDefault();
    this.close();
  }
}
