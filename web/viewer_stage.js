// The panes of the viewer: side by side, two with a dividing line, or one in front of the others.
import { el, set_children } from "./dom.js";
import { zoom_text } from "./format.js";
import { Layer, shown_kind } from "./layer.js";
import { PicturePane } from "./picture_pane.js";
import { value_text } from "./value_table.js";

const HEIGHT_SHARE = 0.8; // of the window, for one large pane
const LEAST_WIDTH_PX = 320;

const big_name = (side, text) => el("span", { class: `big-name ${side}`, "aria-hidden": "true" }, text);
const new_value = (layer) => ({ node: el("span", { class: "pane-value" }), layer });

export class ViewerStage {
  #options;
  #viewport;
  #state;
  #chosen;
  #kinds;
  #panes = []; // [{pane, values: [{node, layer}]}], of the layout "flip" with `name` and `big`
  #split = 0.5;
  #fills = false;
  element = el("div", { class: "stage", "data-size": "medium" });
  missing = el("ul", { class: "missing-pictures" });

  /**
   * `options`: {viewport, state, chosen, kinds, background, hint_id, on_pick, on_resize, on_slide(source)}; `chosen`: a Chosen, the others as of
   * ImageViewer and PicturePane.
   */
  constructor(options) {
    this.#options = options;
    this.#viewport = options.viewport;
    this.#state = options.state;
    this.#chosen = options.chosen;
    this.#kinds = options.kinds;
  }

  get pane_size() {
    return this.#panes[0]?.pane.size ?? { width: 1, height: 1 };
  }
  get zoom_text() {
    return this.#panes[0]?.pane.size.width ? zoom_text(this.#panes[0].pane.zoom) : "";
  }
  set fills(fills) {
    this.#fills = fills;
    this.build();
  }

  focus() {
    this.#panes[0].pane.element.focus({ preventScroll: true });
  }

  refresh() {
    for (const { pane } of this.#panes) pane.refresh();
  }

  /** After a change of exposure, gain and the like. */
  repaint() {
    for (const { pane } of this.#panes) pane.layers.forEach((layer) => layer.update());
  }

  /** Makes the panes again, for another arrangement or kind of picture. */
  build() {
    for (const { pane } of this.#panes) pane.resize_observer.disconnect();
    this.missing.replaceChildren();
    const { layout, mode } = this.#state.values;
    this.element.className = `stage ${layout}`;
    if (layout === "grid") this.#build_grid(this.#kinds.find(({ key }) => key === mode));
    else if (layout === "slider") this.#build_slider();
    else this.#build_flip();
  }

  /** In the layout "flip": brings `source` to the front. */
  show_front(source) {
    const [{ pane, values, name, big }] = this.#panes;
    if (!big) return;
    pane.front = pane.layers.find((layer) => layer.source === source) ?? pane.layers[0];
    values[0].layer = pane.front;
    name.textContent = pane.front.source.label;
    big.textContent = `${source.key} ${source.label}`;
  }

  /** The values of a pixel, [x, y] or null, under the pictures. */
  show_values(pixel) {
    for (const { pane, values } of this.#panes) {
      pane.show_mark();
      for (const { node, layer } of values) {
        const text = pixel ? value_text(layer.source, this.#chosen.base, layer.kind, ...pixel) : "";
        set_children(node, text ? el("span", { class: "value" }, text) : null);
      }
    }
  }

  #layer(source) {
    const { viewport, background } = this.#options;
    const { base } = this.#chosen;
    return new Layer({ source, base, state: this.#state, kinds: this.#kinds, size: viewport.size, background });
  }

  #pane(label, layers, options = {}) {
    const { hint_id, on_pick, on_resize } = this.#options;
    const on_mark = (from, to) => this.#viewport.mark_area(from, to);
    const pane = new PicturePane(this.#viewport, { label, hint_id, on_pick, on_mark, on_resize, ...options });
    const [width, height] = this.#viewport.size;
    pane.element.style.aspectRatio = `${width} / ${height}`;
    pane.show(layers, layers.length === 2 && Boolean(options.on_split));
    return pane;
  }

  #build_grid(kind) {
    const { all, base, kept } = this.#chosen;
    const has_kind = (source) =>
      kind.once
        ? source.data.has(kind.key)
        : source.reference || source === base || shown_kind(source, kind.key, base) === kind.key;
    const shown = kept.filter(has_kind);
    this.#panes = [];
    set_children(
      this.element,
      shown.map((source) => this.#figure(source, kind)),
    );
    const lacking = all.filter((source) => this.#chosen.is_kept(source) && !shown.includes(source));
    set_children(this.missing, kind.once ? null : lacking.map((source) => this.#lack(source, kind)));
  }

  #lack({ label, missing }, kind) {
    return el("li", {}, el("strong", {}, label), ` has no ${kind.label} picture`, missing ? `: ${missing}` : "");
  }

  #figure(source, asked) {
    const layer = this.#layer(source);
    const value = new_value(layer);
    const shown = this.#kinds.find(({ key }) => key === layer.kind);
    const pane = this.#pane(layer.alt, [layer]);
    this.#panes.push({ pane, values: [value] });
    return el(
      "figure",
      { class: "pane", "data-source": source.key },
      pane.element,
      el(
        "figcaption",
        {},
        el("kbd", {}, source.key),
        el("span", { class: "pane-name", title: source.title }, asked.once ? asked.label : source.label),
        shown === asked ? null : el("span", { class: "muted" }, shown.label.toLowerCase()),
        value.node,
        this.#slide_button(source),
      ),
    );
  }

  #slide_button(source) {
    const { base } = this.#chosen;
    if (source === base) return null;
    const label = `Slide between ${base.name ?? base.label} and ${source.label}`;
    const onclick = () => this.#options.on_slide(source);
    return el("button", { type: "button", class: "quiet small", title: label, "aria-label": label, onclick }, "Slide");
  }

  #large_figure(pane, caption) {
    const figure = el("figure", { class: "pane" }, pane.element, el("figcaption", {}, caption));
    const [width] = this.#viewport.size;
    // It has no width before it is on the page.
    const room = (this.element.clientWidth || Infinity) - 2;
    const zoom = this.#viewport.fit_zoom(room, window.innerHeight * HEIGHT_SHARE);
    const whole_px = (width * zoom) / (window.devicePixelRatio || 1) + 2;
    figure.style.maxWidth = this.#fills ? "" : `${Math.max(LEAST_WIDTH_PX, whole_px)}px`;
    set_children(this.element, figure);
  }

  #build_slider() {
    const { base: left, shown: right } = this.#chosen;
    const layers = [left, right].map((source) => this.#layer(source));
    const values = layers.map(new_value);
    const pane = this.#pane(`${layers[0].alt} left of the line, ${layers[1].alt} right of it`, layers, {
      on_split: (fraction) => {
        this.#split = fraction;
      },
    });
    pane.element.classList.add("sliding");
    pane.split = this.#split;
    this.#panes = [{ pane, values }];
    this.#large_figure(pane, [
      el("span", { class: "side" }, el("span", { class: "pane-name" }, left.label), values[0].node),
      el("span", { class: "side right" }, values[1].node, el("span", { class: "pane-name" }, right.label)),
    ]);
    pane.element.append(big_name("left", left.label), big_name("right", right.label));
  }

  #build_flip() {
    const { base, kept, shown } = this.#chosen;
    const sources = [...new Set([base, ...kept, shown])].filter(({ data }) => data.has("color"));
    const layers = sources.map((source) => this.#layer(source));
    const pane = this.#pane("", layers);
    const name = el("span", { class: "pane-name" });
    const value = new_value(layers[0]);
    this.#panes = [{ pane, values: [value], name, big: big_name("left") }];
    this.#large_figure(pane, [name, value.node]);
    pane.element.append(this.#panes[0].big);
    this.show_front(shown);
  }
}
