// The pictures of one run: side by side, two with a dividing line, or one in front of the others. Zoom, position, pixel mark
// and tools are shared.
import { color_bar, difference_scale, magma_scale } from "./color_bar.js";
import { el, set_children, unique_id } from "./dom.js";
import { ErrorPanel } from "./error_panel.js";
import { is_number, zoom_text } from "./format.js";
import { Layer, shown_kind } from "./layer.js";
import { greatest_differences, worst_pixels } from "./paint.js";
import { PicturePane } from "./picture_pane.js";
import { difference_at, levels_text, value_text, ValueTable } from "./value_table.js";
import { LAYOUTS, ViewState } from "./view_state.js";
import { key_sheet, listen_to_keys } from "./viewer_keys.js";
import { ViewerToolbar } from "./viewer_toolbar.js";
import { Viewport } from "./viewport.js";

const KEYS =
  "Drag to pan, double-click to zoom in or out, or zoom with Ctrl and the wheel (after a click, the wheel alone). Arrows pan, " +
  "Shift and arrows move the pixel mark, + and − zoom, ? lists all keys.";
const PICK_KEYS = " A click, or Enter at the mark, shows how a pixel is made.";
const INSPECT_ZOOM = 16;
const HEIGHT_SHARE = 0.8; // of the window, for one large pane
const LEAST_WIDTH_PX = 320;
const CYCLES_MS = [0, 1000, 500];

export class ImageViewer {
  #sources;
  #kinds;
  #viewport;
  #state;
  #toolbar;
  #values;
  #errors;
  #panes = [];
  #split = 0.5;
  #held = false; // the space bar
  #cycle = 0; // index into CYCLES_MS
  #timer = null;
  #frame = null; // in which values are shown
  #worst = { key: "", pixels: [], index: -1 };
  #on_pick;
  #hint_id = unique_id("keys");
  #stage = el("div", { class: "stage" });
  #bar = el("div", { class: "bar-place" });
  #announcer = el("div", { class: "visually-hidden", role: "status" });
  #note = el("p", { class: "kind-note" });
  #missing = el("ul", { class: "missing-pictures" });
  #sheet = key_sheet();

  /**
   * `sources`: [{key, label, data: PictureData, missing}], the reference first, with keys 0, 1, 2...; one without pictures says
   * why in `missing`. `kinds`: [{key, label, note, once}], colors first; a picture that is `once` is the same for all
   * methods. `on_pick(x, y)` is called when a pixel is chosen by a click or Enter; null if that does nothing. `below`:
   * elements under the pictures. `on_change(is_step)` is called when what is shown has changed, with true for a step that "back"
   * should undo.
   */
  constructor({ width_px, height_px, sources, kinds, on_pick = null, below = [], on_change = () => {} }) {
    this.#on_pick = on_pick;
    this.#sources = sources;
    this.#kinds = kinds;
    this.#viewport = new Viewport(width_px, height_px);
    const [base, first = base, second = first] = sources.filter(({ data }) => data.has("color")).map(({ key }) => key);
    this.#state = new ViewState({ mode: kinds[0].key, against: base ?? "0", shown: second ?? "0" });
    this.#state.addEventListener("change", ({ changed }) => {
      this.#changed(changed);
      on_change(changed.some((name) => ["mode", "layout", "against", "shown", "kept"].includes(name)));
    });
    for (const event of ["view", "inspect", "area"]) this.#viewport.addEventListener(event, () => on_change(false));
    this.#viewport.addEventListener("view", () => this.#refresh());
    this.#viewport.addEventListener("area", () => this.#refresh());
    this.#viewport.addEventListener("cursor", () => this.#show_cursor_soon());
    for (const { data } of sources) data.addEventListener("load", () => this.#show_cursor_soon());
    this.#viewport.addEventListener("inspect", () => this.#announce());
    this.#toolbar = new ViewerToolbar(sources, kinds, this.#state, {
      fill: () => this.#fill(),
      keys: () => this.#sheet.showModal(),
      step: (direction) => this.#viewport.step(direction, this.#pane_size),
      fit: () => this.#viewport.fit(),
      full_size: () => this.#viewport.zoom_to(1, this.#pane_size),
      worst: (direction) => this.#go_to_worst(direction),
      resize: (size) => {
        this.#stage.dataset.size = size;
      },
    });
    this.#values = new ValueTable(sources, kinds);
    this.#errors = new ErrorPanel(sources, this.#state, this.#viewport);
    this.#stage.dataset.size = "medium";
    this.element = el(
      "section",
      { class: "viewer", "aria-label": "Pictures" },
      this.#toolbar.element,
      this.#note,
      this.#bar,
      this.#stage,
      this.#missing,
      this.#values.element,
      below,
      this.#errors.element,
      el("p", { class: "keys-hint", id: this.#hint_id }, KEYS + (on_pick ? PICK_KEYS : "")),
      this.#announcer,
      this.#sheet,
    );
    this.#build();
    listen_to_keys(this.element, this.#keys());
  }

  /** Zooms to a pixel in every pane and marks it. */
  show_pixel(x, y) {
    this.#viewport.show_pixel(x, y, INSPECT_ZOOM);
  }

  /** Shows the source with this label beside the one that it is compared with. */
  compare_with(label) {
    const { key } = this.#sources.find((source) => source.label === label);
    this.#state.set({ layout: "slider", shown: key });
    this.element.scrollIntoView({ block: "nearest" });
    this.#panes[0].pane.element.focus({ preventScroll: true });
  }

  /** What is shown, as texts for the address. */
  get query() {
    return { ...this.#state.to_query(), ...this.#viewport.to_query() };
  }
  set query(query) {
    const allowed = { modes: this.#kinds.map(({ key }) => key), sources: this.#sources.map(({ key }) => key) };
    this.#state.from_query(query, allowed);
    this.#viewport.from_query(query);
  }

  #source(key) {
    return this.#sources.find((source) => source.key === key) ?? this.#sources[0];
  }
  get #base() {
    return this.#source(this.#state.get("against"));
  }
  get #shown() {
    return this.#source(this.#state.get("shown"));
  }
  get #kept() {
    const { kept } = this.#state.values;
    return this.#sources.filter(({ key, data }) => data.has("color") && (!kept || kept.includes(key)));
  }
  get #pane_size() {
    return this.#panes[0]?.pane.size ?? { width: 1, height: 1 };
  }

  #keys() {
    const next = (list, current) => list[(list.indexOf(current) + 1) % list.length];
    const flips = () => this.#state.get("layout") === "flip";
    return {
      f: () => this.#fill(),
      m: () =>
        this.#state.set({
          mode: next(
            this.#kinds.map(({ key }) => key),
            this.#state.get("mode"),
          ),
        }),
      l: () =>
        this.#state.set({
          layout: next(
            LAYOUTS.map(([key]) => key),
            this.#state.get("layout"),
          ),
        }),
      n: () => this.#go_to_worst(1),
      p: () => this.#go_to_worst(-1),
      c: () => flips() && this.#set_cycle((this.#cycle + 1) % CYCLES_MS.length),
      "?": () => this.#sheet.showModal(),
      " ": () => flips() && this.#hold(true),
      Escape: () => this.#escape(),
      digit: (number) => {
        const source = this.#sources[number];
        if (this.#state.get("layout") === "grid" || !source?.data.has("color")) return false;
        return this.#state.set({ shown: source.key });
      },
      release: () => this.#hold(false),
    };
  }

  #escape() {
    if (this.#viewport.area) this.#viewport.area = null;
    else if (this.element.classList.contains("filling")) this.#fill();
    else return false;
    return true;
  }

  #fill() {
    const fills = this.element.classList.toggle("filling");
    document.documentElement.classList.toggle("has-filling", fills);
    this.#toolbar.show_filling(fills);
    this.#build();
  }

  #hold(held) {
    this.#held = held;
    this.#show_front();
  }

  #set_cycle(index) {
    this.#cycle = index;
    clearInterval(this.#timer);
    if (CYCLES_MS[index] === 0) return;
    this.#timer = setInterval(() => {
      if (!this.element.isConnected) clearInterval(this.#timer);
      const keys = this.#kept.map(({ key }) => key);
      this.#state.set({ shown: keys[(keys.indexOf(this.#state.get("shown")) + 1) % keys.length] });
    }, CYCLES_MS[index]);
  }

  async #go_to_worst(direction) {
    const [base, shown] = [this.#base, this.#shown];
    const key = `${base.key} ${shown.key}`;
    if (this.#worst.key !== key) {
      if (!shown_kind(shown, "difference", base) || shown === base) return;
      const rasters = await Promise.all([base.data.load("color"), shown.data.load("color")]);
      const pixels = worst_pixels(greatest_differences(...rasters), rasters[0].width);
      this.#worst = { key, pixels, index: direction > 0 ? -1 : 0 };
    }
    const { pixels, index } = this.#worst;
    if (pixels.length === 0) {
      this.#announcer.textContent = `${shown.label} and ${base.label} do not differ.`;
      return;
    }
    this.#worst.index = (index + direction + pixels.length) % pixels.length;
    this.show_pixel(...pixels[this.#worst.index]);
  }

  /** After a change of the state: layers are repainted; panes are made again only for another arrangement. */
  #changed(names) {
    const { layout } = this.#state.values;
    const flips_only = layout === "flip" && names.every((name) => name === "shown");
    const tone_only = names.every((name) => ["exposure", "gamma", "channel", "gain", "absolute"].includes(name));
    if (layout !== "flip") this.#set_cycle(0);
    if (flips_only) this.#show_front();
    else if (tone_only) for (const { pane } of this.#panes) pane.layers.forEach((layer) => layer.update());
    else this.#build();
    this.#refresh();
    this.#toolbar.update();
    this.#show_cursor();
  }

  #build() {
    for (const { pane } of this.#panes) pane.resize_observer.disconnect();
    this.#panes = [];
    const { layout, mode } = this.#state.values;
    this.#toolbar.update();
    const kind = this.#kinds.find(({ key }) => key === mode);
    this.#note.textContent = kind.note ?? "";
    this.#note.hidden = !kind.note;
    this.#missing.replaceChildren();
    this.#stage.className = `stage ${layout}`;
    if (layout === "grid") this.#build_grid(kind);
    else if (layout === "slider") this.#build_slider();
    else this.#build_flip();
    this.#refresh();
    this.#show_cursor();
  }

  #layer(source) {
    return new Layer({ source, base: this.#base, state: this.#state, kinds: this.#kinds, size: this.#viewport.size });
  }

  #pane(label, layers, options = {}) {
    const pane = new PicturePane(this.#viewport, {
      label,
      hint_id: this.#hint_id,
      on_pick: this.#on_pick,
      on_mark: (from, to) => this.#mark(from, to),
      on_resize: () => this.#toolbar.show_zoom(this.#zoom_text),
      ...options,
    });
    const [width, height] = this.#viewport.size;
    pane.element.style.aspectRatio = `${width} / ${height}`;
    pane.show(layers, layers.length === 2 && Boolean(options.on_split));
    return pane;
  }

  #build_grid(kind) {
    const is_shown = (source) =>
      source.reference || source === this.#base || shown_kind(source, kind.key, this.#base) === kind.key;
    const shown = kind.once ? this.#kept.filter(({ data }) => data.has(kind.key)) : this.#kept.filter(is_shown);
    const has_none = kind.once
      ? []
      : this.#sources.filter((source) => !shown.includes(source) && !this.#kept.includes(source));
    const lacks = kind.once ? [] : this.#kept.filter((source) => !shown.includes(source));
    const { kept } = this.#state.values;
    set_children(
      this.#stage,
      shown.map((source) => this.#figure(source, kind)),
    );
    set_children(
      this.#missing,
      [...lacks, ...has_none.filter(({ key, data }) => !data.has("color") && (!kept || kept.includes(key)))].map(
        (source) =>
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

  #figure(source, asked) {
    const value = el("span", { class: "pane-value" });
    const slide = `Slide between ${this.#base.name ?? this.#base.label} and ${source.label}`;
    const layer = this.#layer(source);
    const shown = this.#kinds.find(({ key }) => key === layer.kind);
    const pane = this.#pane(layer.alt, [layer]);
    this.#panes.push({ pane, values: [{ node: value, layer }] });
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
        value,
        source === this.#base
          ? null
          : el(
              "button",
              {
                type: "button",
                class: "quiet small",
                title: slide,
                "aria-label": slide,
                onclick: () => this.compare_with(source.label),
              },
              "Slide",
            ),
      ),
    );
  }

  #large_figure(pane, caption) {
    const figure = el("figure", { class: "pane" }, pane.element, el("figcaption", {}, caption));
    const [width] = this.#viewport.size;
    const fills = this.element.classList.contains("filling");
    const zoom = this.#viewport.fit_zoom(this.#stage.clientWidth - 2 || Infinity, window.innerHeight * HEIGHT_SHARE);
    const whole_px = (width * zoom) / (window.devicePixelRatio || 1) + 2;
    figure.style.maxWidth = fills ? "" : `${Math.max(LEAST_WIDTH_PX, whole_px)}px`;
    set_children(this.#stage, figure);
  }

  #build_slider() {
    const [left, right] = [this.#base, this.#shown];
    const layers = [this.#layer(left), this.#layer(right)];
    const values = layers.map((layer) => ({ node: el("span", { class: "pane-value" }), layer }));
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
    pane.element.append(
      el("span", { class: "big-name left", "aria-hidden": "true" }, left.label),
      el("span", { class: "big-name right", "aria-hidden": "true" }, right.label),
    );
  }

  #build_flip() {
    const sources = [...new Set([this.#base, ...this.#kept, this.#shown])].filter(({ data }) => data.has("color"));
    const layers = sources.map((source) => this.#layer(source));
    const pane = this.#pane("", layers);
    const name = el("span", { class: "pane-name" });
    const value = { node: el("span", { class: "pane-value" }), layer: layers[0] };
    this.#panes = [{ pane, values: [value], name, big: el("span", { class: "big-name left", "aria-hidden": "true" }) }];
    this.#large_figure(pane, [name, value.node]);
    pane.element.append(this.#panes[0].big);
    this.#show_front();
  }

  #show_front() {
    const [{ pane, values, name, big }] = this.#panes;
    if (!big) return;
    const source = this.#held ? this.#base : this.#shown;
    pane.front = pane.layers.find((layer) => layer.source === source) ?? pane.layers[0];
    values[0].layer = pane.front;
    name.textContent = pane.front.source.label;
    big.textContent = `${source.key} ${source.label}`;
    this.#show_cursor();
  }

  #mark([x0, y0], [x1, y1]) {
    const [width, height] = this.#viewport.size;
    const clamp = (value, most) => Math.min(most, Math.max(0, value));
    const [left, right] = [Math.min(x0, x1), Math.max(x0, x1) + 1].map((x) => clamp(x, width));
    const [top, bottom] = [Math.min(y0, y1), Math.max(y0, y1) + 1].map((y) => clamp(y, height));
    this.#viewport.area = left < right && top < bottom ? [left, top, right, bottom] : null;
  }

  get #zoom_text() {
    return this.#panes[0]?.pane.size.width ? zoom_text(this.#panes[0].pane.zoom) : "";
  }

  #refresh() {
    for (const { pane } of this.#panes) pane.refresh();
    this.#toolbar.show_zoom(this.#zoom_text);
  }

  /** Once for all moves of the mouse before the next frame. */
  #show_cursor_soon() {
    this.#frame ??= requestAnimationFrame(() => {
      this.#frame = null;
      this.#show_cursor();
    });
  }

  #show_cursor() {
    const { cursor } = this.#viewport;
    for (const { pane, values } of this.#panes) {
      pane.refresh();
      for (const { node, layer } of values) {
        const text = cursor ? value_text(layer.source, this.#base, layer.kind, ...cursor) : "";
        set_children(node, text ? el("span", { class: "value" }, text) : null);
      }
    }
    this.#values.show(cursor, this.#base);
    this.#show_bar(cursor);
  }

  #show_bar(cursor) {
    const { mode } = this.#state.values;
    const sources = this.#kept;
    if (mode === "color") {
      this.#bar.replaceChildren();
      return;
    }
    const marks = [];
    const mark = (source, value) => is_number(value) && marks.push({ value, name: source.label });
    if (mode === "difference") {
      for (const source of cursor ? sources.filter((one) => one !== this.#base) : []) {
        const difference = difference_at(this.#base, source, ...cursor);
        difference?.forEach((value) => mark(source, this.#state.get("absolute") ? Math.abs(value) : value));
      }
      set_children(this.#bar, color_bar(difference_scale(this.#state.values), marks));
      return;
    }
    const with_map = sources.filter(({ data }) => data.has(mode));
    for (const source of cursor ? with_map : []) mark(source, source.data.map_value(mode, ...cursor));
    const full = with_map[0]?.data.full_scale(mode) ?? 1;
    set_children(this.#bar, with_map.length > 0 ? color_bar(magma_scale(full), marks) : null);
  }

  #announce() {
    const { cursor } = this.#viewport;
    if (!cursor) return;
    const values = this.#kept.map((source) => `${source.label} ${levels_text(source.data.levels("color", ...cursor))}`);
    this.#announcer.textContent = `Pixel ${cursor.join(", ")}: ${values.join("; ")}`;
  }
}
