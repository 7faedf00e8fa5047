// The values of one pixel in every picture of every source.
import { el, set_children } from "./dom.js";
import { DASH, fixed, is_number } from "./format.js";

const FLOAT_DECIMALS = 4;
const MAP_DECIMALS = 3;

const signed = (value) => (value > 0 ? `+${value}` : String(value).replace("-", "−"));

function swatch(levels) {
  const node = el("span", { class: "swatch", "aria-hidden": "true" }, el("span"));
  if (levels)
    node.firstChild.style.backgroundColor = `rgb(${levels[0]} ${levels[1]} ${levels[2]} / ${levels[3] / 255})`;
  return node;
}

/** "12 200 0", with alpha if the picture is not opaque there; "" if it is not known. */
export function levels_text(levels) {
  if (!levels) return "";
  return Array.from(levels[3] === 255 ? levels.subarray(0, 3) : levels).join(" ");
}

function floats_text(floats) {
  return floats ? Array.from(floats, (value) => fixed(value, FLOAT_DECIMALS)).join(" ") : DASH;
}

/** "0.502", or each channel where they differ. */
function opacity_text(source, x, y) {
  if (!source.data.has("opacity")) return DASH;
  const levels = source.data.levels("opacity", x, y);
  if (!levels) return DASH;
  const channels = Array.from(levels.subarray(0, 3), (level) => fixed(level / 255, MAP_DECIMALS));
  return new Set(channels).size === 1 ? channels[0] : channels.join(" ");
}

/** `base` minus `source` in levels, [red, green, blue]; null if one of them is not known. */
export function difference_at(base, source, x, y) {
  const [a, b] = [base, source].map(({ data }) => data.levels("color", x, y));
  return a && b ? [0, 1, 2].map((channel) => a[channel] - b[channel]) : null;
}

/** The value of a source's picture of this kind, as a text; "" if it is not known. */
export function value_text(source, base, kind, x, y) {
  if (kind === "color") return levels_text(source.data.levels("color", x, y));
  if (kind === "difference") return difference_at(base, source, x, y)?.map(signed).join(" ") ?? "";
  const value = source.data.map_value(kind, x, y);
  if (!is_number(value)) return "";
  return source.data.full_scale(kind) === undefined ? value.toFixed(MAP_DECIMALS) : String(value);
}

export class ValueTable {
  #sources;
  #maps;
  #once;
  #body = el("tbody");
  #place = el("span", { class: "readout" });
  element;

  /** `kinds`: those of the viewer, of which one marked `once` is the same for every source. */
  constructor(sources, kinds) {
    this.#sources = sources;
    const maps = kinds.filter(({ key }) => key !== "color" && key !== "difference");
    this.#maps = maps.filter(({ once }) => !once);
    this.#once = maps.filter(({ once }) => once);
    const heads = ["Color, 0 to 255", "Color as floats", "Opacity", "Difference, levels"];
    heads.push(...this.#maps.map(({ label }) => label));
    this.element = el(
      "div",
      { class: "values table-box", tabindex: "0", role: "region", "aria-label": "Values of the pixel" },
      el(
        "table",
        {},
        el(
          "thead",
          {},
          el(
            "tr",
            {},
            el("th", { scope: "col" }, this.#place),
            heads.map((head) => el("th", { scope: "col" }, head)),
          ),
        ),
        this.#body,
      ),
    );
  }

  /** `pixel`: [x, y] or null; `base` is the source with which the others are compared. */
  show(pixel, base) {
    const value = (source, kind) => (pixel ? value_text(source, base, kind, ...pixel) || DASH : DASH);
    const [first] = this.#sources;
    const once = this.#once.map(({ key, label }) => ` · ${label.toLowerCase()} ${value(first, key)}`);
    this.#place.textContent = pixel ? `x ${pixel[0]}, y ${pixel[1]}${once.join("")}` : "No pixel marked";
    set_children(
      this.#body,
      this.#sources.map((source) => {
        const levels = pixel ? source.data.levels("color", ...pixel) : null;
        return el(
          "tr",
          { "data-source": source.key },
          el("th", { scope: "row" }, source.label),
          el("td", { "data-kind": "color" }, swatch(levels), levels_text(levels) || DASH),
          el("td", { "data-kind": "float" }, pixel ? floats_text(source.data.floats(...pixel)) : DASH),
          el("td", { "data-kind": "opacity" }, pixel ? opacity_text(source, ...pixel) : DASH),
          el("td", { "data-kind": "difference" }, source === base ? DASH : value(source, "difference")),
          this.#maps.map(({ key }) => el("td", { "data-kind": key }, value(source, key))),
        );
      }),
    );
  }
}
