// The errors of every source: how often each size of difference occurs, and mean and greatest error in the marked rectangle.
import { el, set_children, svg } from "./dom.js";
import { DASH, fixed, integer } from "./format.js";
import { greatest_differences, histogram } from "./paint.js";

const WIDTH = 256;
const HEIGHT = 44;

/** Mean and greatest of `value(index)` over a rectangle. */
function in_area([x0, y0, x1, y1], width, value) {
  let sum = 0;
  let greatest = 0;
  for (let y = y0; y < y1; ++y)
    for (let x = x0; x < x1; ++x) {
      const one = value(y * width + x);
      sum += one;
      greatest = Math.max(greatest, one);
    }
  return { mean: sum / ((x1 - x0) * (y1 - y0)), greatest };
}

/** Bars over 0..255 levels; their heights are logarithmic, so that a single pixel is seen. */
function histogram_drawing(counts, label) {
  const most = Math.log1p(Math.max(...counts));
  const bars = Array.from(counts, (count, size) => {
    const height = count > 0 ? Math.max(1, (Math.log1p(count) / most) * HEIGHT) : 0;
    return height > 0 ? `M${size} ${HEIGHT}v${-height}h1v${height}z` : "";
  });
  return svg(
    "svg",
    {
      class: "histogram",
      viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
      preserveAspectRatio: "none",
      role: "img",
      "aria-label": label,
    },
    svg("path", { d: bars.join("") }),
  );
}

export class ErrorPanel {
  #sources;
  #state;
  #viewport;
  #body = el("div", { class: "error-body" });
  #asked = 0;
  element;

  constructor(sources, state, viewport) {
    this.#sources = sources;
    this.#state = state;
    this.#viewport = viewport;
    this.element = el(
      "details",
      { class: "errors", ontoggle: () => this.#draw() },
      el("summary", {}, "Errors of every method, as histograms and in a rectangle"),
      this.#body,
    );
    state.addEventListener("change", ({ changed }) => changed.includes("against") && this.#draw());
    viewport.addEventListener("area", () => {
      if (viewport.area) this.element.open = true;
      this.#draw();
    });
  }

  async #draw() {
    if (!this.element.open) return;
    const asked = ++this.#asked;
    const base = this.#sources.find(({ key }) => key === this.#state.get("against"));
    const others = this.#sources.filter((source) => source !== base && source.data.has("color"));
    const [width, height] = this.#viewport.size;
    const area = this.#viewport.area ?? [0, 0, width, height];
    try {
      const rows = await Promise.all(others.map((source) => this.#row(base, source, area)));
      if (asked === this.#asked) this.#show(base, rows);
    } catch (error) {
      set_children(this.#body, el("p", { class: "notice error", role: "alert" }, error.message));
    }
  }

  async #row(base, source, area) {
    const [a, b] = await Promise.all([base.data.load("color"), source.data.load("color")]);
    const sizes = greatest_differences(a, b);
    const levels = in_area(area, a.width, (i) => sizes[i]);
    // The maps of FLIP are those of differences from the reference.
    if (base.reference && source.data.has("flip")) await source.data.load("flip");
    const flip =
      base.reference && source.data.has("flip")
        ? in_area(area, a.width, (i) => source.data.map_value("flip", i % a.width, Math.floor(i / a.width)))
        : null;
    return { source, counts: histogram(sizes), levels, flip };
  }

  #show(base, rows) {
    const { area } = this.#viewport;
    const place = area ? `x ${area[0]} to ${area[2] - 1}, y ${area[1]} to ${area[3] - 1}` : "the whole picture";
    const head = (name) => el("th", { scope: "col" }, name);
    set_children(
      this.#body,
      el(
        "p",
        { class: "hint" },
        `Greatest difference of a channel from ${base.label}, 0 to 255 levels; heights of the bars are logarithmic. ` +
          "Drag with Shift to mark a rectangle.",
        area
          ? el(
              "button",
              { type: "button", class: "small", onclick: () => (this.#viewport.area = null) },
              "Remove the rectangle",
            )
          : null,
      ),
      el(
        "div",
        { class: "table-box", tabindex: "0", role: "region", "aria-label": "Errors of every method" },
        el(
          "table",
          { class: "results errors-table" },
          el("caption", {}, `Errors in ${place}`),
          el(
            "thead",
            {},
            el(
              "tr",
              {},
              [
                "Method",
                "Pixels by size of the difference",
                "Mean levels",
                "Greatest",
                "Mean FLIP",
                "Greatest FLIP",
              ].map(head),
            ),
          ),
          el(
            "tbody",
            {},
            rows.map(({ source, counts, levels, flip }) =>
              el(
                "tr",
                { "data-source": source.key },
                el("th", { scope: "row" }, source.label),
                el(
                  "td",
                  {},
                  histogram_drawing(counts, `${integer(counts[0])} pixels of ${source.label} do not differ`),
                ),
                el("td", { class: "number", "data-value": levels.mean }, fixed(levels.mean, 3)),
                el("td", { class: "number", "data-value": levels.greatest }, integer(levels.greatest)),
                el("td", { class: "number", "data-value": flip?.mean }, flip ? fixed(flip.mean, 4) : DASH),
                el("td", { class: "number", "data-value": flip?.greatest }, flip ? fixed(flip.greatest, 3) : DASH),
              ),
            ),
          ),
        ),
      ),
    );
  }
}
