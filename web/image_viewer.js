// The pictures of one run: all side by side, or two with a line between them; zoom, pan and pixel mark are shared.
import { el, segmented, select, set_children, unique_id } from "./dom.js";
import { zoom_text } from "./format.js";
import { PicturePane } from "./picture_pane.js";
import { Viewport } from "./viewport.js";

const KEYS =
  "Drag to pan, double-click to zoom in and out. Ctrl and wheel, or the wheel alone after a click, zooms. " +
  "Keys: arrows pan, Shift and arrows move the pixel mark, + and − zoom, 0 fits, 1 is 100 %.";
const PICK_KEYS = " A click, or Enter at the mark, takes a pixel apart.";
const INSPECT_ZOOM = 16;
const SLIDER_HEIGHT_SHARE = 0.8;
const MIN_SLIDER_PX = 320;

function swatch(value) {
  const node = el("span", { class: "swatch", "aria-hidden": "true" }, el("span"));
  if (value) node.firstChild.style.backgroundColor = `rgb(${value[0]} ${value[1]} ${value[2]} / ${value[3] / 255})`;
  return node;
}

/** "12 200 0", with alpha where the picture is not opaque there. */
function value_text(value) {
  if (!value) return "";
  return (value[3] === 255 ? value.slice(0, 3) : value).join(" ");
}

function value_nodes(value) {
  return value ? [swatch(value), el("span", { class: "value" }, value_text(value))] : [];
}

export class ImageViewer {
  #sources;
  #kinds;
  #viewport;
  #panes = [];
  #kind;
  #layout = "grid";
  #pane_size = "medium";
  #pair;
  #split = 0.5;
  #on_pick;
  #hint_id = unique_id("keys");
  #stage = el("div", { class: "stage" });
  #readout = el("span", { class: "readout" });
  #announcer = el("div", { class: "visually-hidden", role: "status" });
  #zoom_label = el("output", { class: "zoom-value" });
  #kind_control;
  #size_control;
  #layout_control = null;
  #pair_control = el("div", { class: "pair-control" });
  #note = el("p", { class: "kind-note" });
  #missing = el("ul", { class: "missing-pictures" });

  /**
   * `sources`: [{key, label, pictures: {kind: url}, missing}], the reference first; `kinds`: [{key, label, note}],
   * the first is what the reference has too. A source without pictures says why in `missing`; the reference may have
   * another `name`. `on_pick(x, y)` hears which pixel is chosen by a click or by Enter; null where nothing comes of it.
   */
  constructor({ width_px, height_px, sources, kinds, on_pick = null }) {
    this.#on_pick = on_pick;
    this.#sources = sources;
    this.#kinds = kinds;
    this.#kind = kinds[0].key;
    this.#viewport = new Viewport(width_px, height_px);
    this.#pair = this.#first_pair();
    this.#viewport.addEventListener("view", () => this.#refresh());
    this.#viewport.addEventListener("cursor", () => this.#show_cursor());
    this.#viewport.addEventListener("inspect", () => this.#announce());
    this.element = el(
      "section",
      { class: "viewer", "aria-label": "Pictures" },
      this.#toolbar(),
      this.#note,
      this.#stage,
      this.#missing,
      el("p", { class: "keys-hint", id: this.#hint_id }, KEYS + (on_pick ? PICK_KEYS : "")),
      this.#announcer,
    );
    this.#build();
  }

  /** Zooms to a pixel in every pane and marks it. */
  show_pixel(x, y) {
    this.#viewport.show_pixel(x, y, INSPECT_ZOOM);
  }

  get #options() {
    return this.#sources.flatMap((source) =>
      this.#kinds
        .filter((kind) => source.pictures[kind.key])
        .map((kind) => ({
          value: `${source.key}/${kind.key}`,
          source,
          kind,
          url: source.pictures[kind.key],
          label: source.reference ? source.label : `${source.label} · ${kind.label}`,
        })),
    );
  }

  #first_pair() {
    const values = this.#options.map((option) => option.value);
    const colours = values.filter((value) => value.endsWith(`/${this.#kinds[0].key}`));
    const left = colours[0] ?? values[0];
    return [left, colours[2] ?? colours[1] ?? values[1] ?? left];
  }

  #toolbar() {
    this.#kind_control = segmented(
      "Kind of picture",
      this.#kinds.map((kind) => [kind.key, kind.label]),
      this.#kind,
      (kind) => {
        this.#kind = kind;
        this.#build();
      },
    );
    this.#size_control = segmented(
      "Size of the panes",
      [
        ["small", "S", "Small panes"],
        ["medium", "M", "Medium panes"],
        ["large", "L", "Large panes"],
      ],
      this.#pane_size,
      (size) => {
        this.#pane_size = size;
        this.#stage.dataset.size = size;
      },
    );
    const first_pane = () => this.#panes[0]?.pane.size ?? { width: 1, height: 1 };
    const button = (text, label, action) =>
      el("button", { type: "button", title: label, "aria-label": label, onclick: action }, text);
    this.#layout_control = segmented(
      "Layout",
      [
        ["grid", "Side by side"],
        ["slider", "Slider"],
      ],
      this.#layout,
      (layout) => {
        this.#layout = layout;
        this.#build();
      },
    );
    return el(
      "div",
      { class: "toolbar", role: "group", "aria-label": "Picture tools" },
      this.#layout_control,
      this.#kind_control,
      this.#pair_control,
      this.#readout,
      this.#size_control,
      el(
        "div",
        { class: "zoom-control" },
        button("−", "Zoom out", () => this.#viewport.step(-1, first_pane())),
        this.#zoom_label,
        button("+", "Zoom in", () => this.#viewport.step(1, first_pane())),
        button("Fit", "Fit the pictures into the panes", () => this.#viewport.fit()),
        button("1:1", "1:1, a picture pixel is a screen pixel", () => this.#viewport.zoom_to(1, first_pane())),
      ),
    );
  }

  #build() {
    for (const { pane } of this.#panes) pane.resize_observer.disconnect();
    const slider = this.#layout === "slider";
    this.#kind_control.hidden = slider || this.#kinds.length < 2;
    this.#size_control.hidden = slider;
    this.#pair_control.hidden = !slider;
    const kind = this.#kinds.find((one) => one.key === this.#kind);
    this.#note.textContent = slider ? "" : (kind.note ?? "");
    this.#note.hidden = !this.#note.textContent;
    if (slider) this.#build_slider();
    else this.#build_grid(kind);
    this.#refresh();
    this.#show_cursor();
  }

  #build_grid(kind) {
    this.#panes = [];
    const shown_kind = (source) => (source.reference ? this.#kinds[0] : kind);
    const shown = this.#sources.filter((source) => source.pictures[shown_kind(source).key]);
    const missing = this.#sources.filter((source) => !shown.includes(source));
    this.#stage.className = "stage grid";
    this.#stage.dataset.size = this.#pane_size;
    set_children(
      this.#stage,
      shown.map((source) => this.#figure(source, shown_kind(source), kind)),
    );
    set_children(
      this.#missing,
      missing.map((source) =>
        el(
          "li",
          {},
          el("strong", {}, source.label),
          ` has no ${kind.label} picture`,
          source.missing ? `: ${source.missing}` : "",
        ),
      ),
    );
  }

  #figure(source, shown, asked) {
    const value = el("span", { class: "pane-value" });
    const base = this.#sources.find((one) => one.reference);
    const slide = `Slide between ${base?.name ?? "the reference"} and ${source.label}`;
    const caption = el(
      "figcaption",
      {},
      el("span", { class: "pane-name", title: source.title }, source.label),
      shown === asked ? null : el("span", { class: "muted" }, shown.label.toLowerCase()),
      value,
      source.reference
        ? null
        : el(
            "button",
            {
              type: "button",
              class: "quiet small",
              title: slide,
              "aria-label": slide,
              onclick: () => this.#slide_to(source),
            },
            "Slide",
          ),
    );
    const alt = `${source.label}: ${shown.label}`;
    const pane = new PicturePane(this.#viewport, {
      label: alt,
      hint_id: this.#hint_id,
      on_pick: this.#on_pick,
      on_resize: () => this.#show_zoom(),
    });
    this.#set_shape(pane.element);
    pane.show({ url: source.pictures[shown.key], alt });
    this.#panes.push({ pane, values: [value] });
    return el("figure", { class: "pane", "data-source": source.key }, pane.element, caption);
  }

  #build_slider() {
    const options = this.#options;
    const chosen = this.#pair.map((value) => options.find((option) => option.value === value));
    const values = [el("span", { class: "pane-value" }), el("span", { class: "pane-value" })];
    const pane = new PicturePane(this.#viewport, {
      label: `${chosen[0].label} left of the line, ${chosen[1].label} right of it`,
      hint_id: this.#hint_id,
      on_pick: this.#on_pick,
      on_resize: () => this.#show_zoom(),
      on_split: (fraction) => {
        this.#split = fraction;
      },
    });
    pane.element.classList.add("sliding");
    this.#set_shape(pane.element);
    pane.show(...chosen.map((option) => ({ url: option.url, alt: option.label })));
    pane.split = this.#split;
    this.#panes = [{ pane, values }];
    this.#missing.replaceChildren();
    this.#stage.className = "stage slider";
    const figure = el(
      "figure",
      { class: "pane" },
      pane.element,
      el(
        "figcaption",
        {},
        el("span", { class: "side" }, el("span", { class: "pane-name" }, chosen[0].label), values[0]),
        el("span", { class: "side right" }, values[1], el("span", { class: "pane-name" }, chosen[1].label)),
      ),
    );
    figure.style.maxWidth = `${this.#slider_width()}px`;
    set_children(this.#stage, figure);
    this.#build_pair_control(options);
  }

  /** As wide as the picture when all of it is shown as large as the window allows. */
  #slider_width() {
    const [width] = this.#viewport.size;
    const zoom = this.#viewport.fit_zoom(this.#stage.clientWidth - 2, window.innerHeight * SLIDER_HEIGHT_SHARE);
    return Math.max(MIN_SLIDER_PX, (width * zoom) / (window.devicePixelRatio || 1) + 2);
  }

  #build_pair_control(options) {
    const groups = this.#sources
      .map((source) => ({
        label: source.label,
        choices: options.filter((option) => option.source === source).map((option) => [option.value, option.label]),
      }))
      .filter((group) => group.choices.length > 0);
    const choose = (side, label) =>
      select(
        {
          "aria-label": label,
          onchange: (event) => {
            this.#pair[side] = event.target.value;
            this.#build();
          },
        },
        groups,
        this.#pair[side],
      );
    set_children(
      this.#pair_control,
      choose(0, "Left picture"),
      el(
        "button",
        {
          type: "button",
          title: "Swap the two pictures",
          "aria-label": "Swap the two pictures",
          onclick: () => {
            this.#pair.reverse();
            this.#build();
          },
        },
        "⇄",
      ),
      choose(1, "Right picture"),
    );
  }

  #slide_to(source) {
    const reference = this.#options.find((option) => option.source.reference) ?? this.#options[0];
    this.#pair = [reference.value, `${source.key}/${source.pictures[this.#kind] ? this.#kind : this.#kinds[0].key}`];
    this.#layout = "slider";
    for (const button of this.#layout_control.children) {
      button.setAttribute("aria-pressed", String(button.dataset.value === "slider"));
    }
    this.#build();
    this.#panes[0].pane.element.focus({ preventScroll: true });
  }

  #set_shape(element) {
    const [width, height] = this.#viewport.size;
    element.style.aspectRatio = `${width} / ${height}`;
  }

  #refresh() {
    for (const { pane } of this.#panes) pane.refresh();
    this.#show_zoom();
  }

  #show_zoom() {
    const zoom = this.#panes[0]?.pane.size.width ? this.#panes[0].pane.zoom : null;
    this.#zoom_label.textContent = zoom === null ? "" : zoom_text(zoom);
  }

  #show_cursor() {
    const cursor = this.#viewport.cursor;
    for (const { pane, values } of this.#panes) {
      pane.refresh();
      const read = cursor ? pane.read(...cursor) : [];
      values.forEach((node, side) => set_children(node, value_nodes(read[side])));
    }
    this.#readout.textContent = cursor ? this.#cursor_text(cursor) : "";
  }

  #cursor_text([x, y]) {
    const [a, b] = this.#panes[0].pane.read(x, y);
    const channels = a && b ? (a[3] === 255 && b[3] === 255 ? [0, 1, 2] : [0, 1, 2, 3]) : [];
    const difference = channels
      .map((channel) => a[channel] - b[channel])
      .join(" ")
      .replaceAll("-", "−");
    return `x ${x}, y ${y}${difference ? ` · left − right ${difference}` : ""}`;
  }

  #announce() {
    const cursor = this.#viewport.cursor;
    if (!cursor) return;
    const values = this.#panes.flatMap(({ pane }) =>
      pane.read(...cursor).map((value) => `${pane.element.getAttribute("aria-label")} ${value_text(value)}`),
    );
    this.#announcer.textContent = `Pixel ${cursor.join(", ")}: ${values.join("; ")}`;
  }
}
