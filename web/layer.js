// One picture in a pane: the file itself where that shows what is asked for, otherwise a canvas painted from its numbers.
import { el } from "./dom.js";
import { over_background, paint_color, paint_difference } from "./paint.js";

export class Layer {
  #source;
  #base;
  #state;
  #kinds;
  #size;
  #background;
  #asked = 0;
  node;
  frame = el("div", { class: "picture" });

  /**
   * `source` and `base`, the one with which it is compared: {key, label, reference, data}. `kinds`: those of the viewer.
   * `size`: [width, height] in pixels. `background`: the one with which the pictures were drawn, [red, green, blue].
   */
  constructor({ source, base, state, kinds, size, background }) {
    this.#source = source;
    this.#base = base;
    this.#state = state;
    this.#kinds = kinds;
    this.#size = size;
    this.#background = background;
    this.update();
  }

  get source() {
    return this.#source;
  }

  /** The key of the kind that is shown: a source without the asked one shows its colors. */
  get kind() {
    return shown_kind(this.#source, this.#state.get("mode"), this.#base);
  }

  get alt() {
    return `${this.#source.label}: ${this.#kinds.find(({ key }) => key === this.kind)?.label ?? "Color"}`;
  }

  /** Shows what the state asks for. */
  update() {
    const { kind } = this;
    const paint = this.#paint_of(kind);
    const is_lacking = kind === "color" && this.#state.needs_opacity && !this.#source.data.has("opacity");
    if (is_lacking) this.frame.dataset.lacks = "opacity not known";
    else delete this.frame.dataset.lacks;
    const [width, height] = this.#size;
    ++this.#asked;
    if (!paint) {
      const url = this.#source.data.url(kind);
      if (this.node?.getAttribute("src") !== url)
        this.#replace(el("img", { src: url, alt: this.alt, width, height, draggable: "false", decoding: "sync" }));
      return;
    }
    if (this.node?.tagName !== "CANVAS") this.#replace(el("canvas", { width, height, role: "img" }));
    this.node.setAttribute("aria-label", this.alt);
    this.#draw(paint, this.#asked);
  }

  #replace(node) {
    if (this.node) {
      node.style.cssText = this.node.style.cssText;
      node.className = this.node.className;
    }
    this.node = node;
    this.frame.replaceChildren(node);
  }

  async #draw(paint, asked) {
    try {
      const painted = await paint();
      if (asked !== this.#asked) return;
      this.node.getContext("2d").putImageData(new ImageData(painted, this.#size[0], this.#size[1]), 0, 0);
      this.node.dataset.painted = "true";
    } catch {
      this.node.dataset.painted = "failed"; // the values table says what could not be read
    }
  }

  /** A function that paints the picture, null if a file shows it as it is. */
  #paint_of(kind) {
    const { values } = this.#state;
    const { data } = this.#source;
    if (kind === "difference") {
      const is_file = this.#base.reference && values.gain === 0 && !values.absolute && data.has("difference");
      if (is_file) return null;
      const pair = [this.#base.data.load("color"), data.load("color")];
      return async () => paint_difference(...(await Promise.all(pair)), values);
    }
    if (kind !== "color" || !this.#state.has_tone) return null;
    const floats = data.has("linear") ? "linear" : "color";
    if (!this.#state.needs_opacity || !data.has("opacity"))
      return async () => paint_color(await data.load(floats), values);
    if (values.channel === "a") return async () => paint_color(await data.load("opacity"), values);
    const pair = [data.load(floats), data.load("opacity")];
    return async () =>
      paint_color(over_background(...(await Promise.all(pair)), this.#background, values.over), values);
  }
}

/** The kind of picture that a source shows if `mode` is asked for, compared with `base`. */
export function shown_kind(source, mode, base) {
  if (mode === "difference")
    return source !== base && source.data.has("color") && base?.data.has("color") ? "difference" : "color";
  return source.data.has(mode) ? mode : "color";
}
