// The pictures of one run: side by side, two with a dividing line, or one in front of the others. Zoom, position, pixel mark
// and tools are shared.
import { Chosen } from "./chosen.js";
import { color_bar, difference_scale, magma_scale } from "./color_bar.js";
import { el, set_children, unique_id } from "./dom.js";
import { ErrorPanel } from "./error_panel.js";
import { is_number } from "./format.js";
import { difference_at, levels_text, ValueTable } from "./value_table.js";
import { LAYOUTS, ViewState } from "./view_state.js";
import { key_sheet, listen_to_keys } from "./viewer_keys.js";
import { ViewerStage } from "./viewer_stage.js";
import { ViewerToolbar } from "./viewer_toolbar.js";
import { Viewport } from "./viewport.js";
import { WorstWalk } from "./worst_walk.js";

const KEYS =
  "Drag to pan, double-click to zoom in or out, or zoom with Ctrl and the wheel (after a click, the wheel alone). Arrows pan, " +
  "Shift and arrows move the pixel mark, + and − zoom, ? lists all keys.";
const PICK_KEYS = " A click, or Enter at the mark, shows how a pixel is made.";
const INSPECT_ZOOM = 16;
const CYCLES_MS = [0, 1000, 500];
const REPAINTED = ["exposure", "gamma", "channel", "over", "gain", "absolute"]; // without new panes

const next = (list, current) => list[(list.indexOf(current) + 1) % list.length];

export class ImageViewer {
  #sources;
  #kinds;
  #viewport;
  #state;
  #chosen;
  #stage;
  #toolbar;
  #values;
  #errors;
  #held = false; // the space bar
  #cycle = 0; // index into CYCLES_MS
  #timer = null;
  #frame = null; // in which values are shown
  #worst = new WorstWalk();
  #bar = el("div", { class: "bar-place" });
  #announcer = el("div", { class: "visually-hidden", role: "status" });
  #note = el("p", { class: "kind-note" });
  #sheet = key_sheet();

  /**
   * `sources`: [{key, label, data: PictureData, missing}], the reference first, with keys 0, 1, 2...; one without pictures says
   * why in `missing`. `kinds`: [{key, label, note, once}], colors first; a picture that is `once` is the same for all
   * methods. `background`: with which the pictures were drawn, [red, green, blue]. `on_pick(x, y)` is called when a pixel is chosen
   * by a click or Enter; null if that does nothing, which the text `no_pick` then explains. `below`: elements under the pictures. `on_change(is_step)` is called when
   * what is shown has changed, with true for a step that "back" should undo.
   */
  constructor({
    width_px,
    height_px,
    background = [0, 0, 0],
    sources,
    kinds,
    on_pick = null,
    no_pick = "",
    below = [],
    on_change = () => {},
  }) {
    this.#sources = sources;
    this.#kinds = kinds;
    this.#viewport = new Viewport(width_px, height_px);
    const [base, first = base, second = first] = sources.filter(({ data }) => data.has("color")).map(({ key }) => key);
    this.#state = new ViewState({ mode: kinds[0].key, against: base ?? "0", shown: second ?? "0" });
    this.#chosen = new Chosen(sources, this.#state);
    const hint_id = unique_id("keys");
    this.#stage = new ViewerStage({
      viewport: this.#viewport,
      state: this.#state,
      chosen: this.#chosen,
      kinds,
      background,
      hint_id,
      on_pick,
      on_resize: () => this.#toolbar.show_zoom(this.#stage.zoom_text),
      on_slide: (source) => this.#slide_to(source),
    });
    this.#toolbar = new ViewerToolbar(sources, kinds, this.#state, {
      fill: () => this.#fill(),
      keys: () => this.#sheet.showModal(),
      step: (direction) => this.#viewport.step(direction, this.#stage.pane_size),
      fit: () => this.#viewport.fit(),
      full_size: () => this.#viewport.zoom_to(1, this.#stage.pane_size),
      worst: (direction) => this.#go_to_worst(direction),
      resize: (size) => {
        this.#stage.element.dataset.size = size;
      },
    });
    this.#values = new ValueTable(sources, kinds);
    this.#errors = new ErrorPanel(sources, this.#state, this.#viewport);
    this.#listen(on_change);
    this.element = el(
      "section",
      { class: "viewer", "aria-label": "Pictures" },
      this.#toolbar.element,
      this.#note,
      this.#bar,
      this.#stage.element,
      this.#stage.missing,
      this.#values.element,
      below,
      this.#errors.element,
      el("p", { class: "keys-hint", id: hint_id }, KEYS + (on_pick ? PICK_KEYS : no_pick)),
      this.#announcer,
      this.#sheet,
    );
    this.#build();
    listen_to_keys(this.element, this.#keys());
  }

  #listen(on_change) {
    const viewport = this.#viewport;
    this.#state.addEventListener("change", ({ changed }) => {
      this.#changed(changed);
      on_change(changed.some((name) => ["mode", "layout", "against", "shown", "kept"].includes(name)));
    });
    for (const event of ["view", "inspect", "area"]) viewport.addEventListener(event, () => on_change(false));
    for (const event of ["view", "area"]) viewport.addEventListener(event, () => this.#refresh());
    viewport.addEventListener("cursor", () => this.#show_cursor_soon());
    viewport.addEventListener("inspect", () => this.#announce());
    for (const { data } of this.#sources) data.addEventListener("load", () => this.#show_cursor_soon());
  }

  /** Zooms to a pixel in every pane and marks it. */
  show_pixel(x, y) {
    this.#viewport.show_pixel(x, y, INSPECT_ZOOM);
  }

  /** Shows the source with this label beside the one that it is compared with. */
  compare_with(label) {
    this.#slide_to(this.#sources.find((source) => source.label === label));
  }

  #slide_to({ key }) {
    this.#state.set({ layout: "slider", shown: key });
    this.element.scrollIntoView({ block: "nearest" });
    this.#stage.focus();
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

  #keys() {
    const state = this.#state;
    const modes = this.#kinds.map(({ key }) => key);
    const layouts = LAYOUTS.map(([key]) => key);
    const flips = () => state.get("layout") === "flip";
    return {
      f: () => this.#fill(),
      m: () => state.set({ mode: next(modes, state.get("mode")) }),
      l: () => state.set({ layout: next(layouts, state.get("layout")) }),
      n: () => this.#go_to_worst(1),
      p: () => this.#go_to_worst(-1),
      c: () => flips() && this.#set_cycle((this.#cycle + 1) % CYCLES_MS.length),
      "?": () => this.#sheet.showModal(),
      " ": () => flips() && this.#hold(true),
      Escape: () => this.#escape(),
      digit: (number) => {
        const source = this.#sources[number];
        if (state.get("layout") === "grid" || !source?.data.has("color")) return false;
        return state.set({ shown: source.key });
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
    this.#stage.fills = fills;
    this.#refresh();
    this.#show_cursor();
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
      const keys = this.#chosen.kept.map(({ key }) => key);
      this.#state.set({ shown: next(keys, this.#state.get("shown")) });
    }, CYCLES_MS[index]);
  }

  async #go_to_worst(direction) {
    const { base, shown } = this.#chosen;
    const pixel = await this.#worst.next(direction, base, shown);
    if (pixel === null) this.#announcer.textContent = `${shown.label} and ${base.label} do not differ.`;
    if (pixel) this.show_pixel(...pixel);
  }

  /** After a change of the state: layers are repainted; panes are made again only for another arrangement. */
  #changed(names) {
    const flips = this.#state.get("layout") === "flip";
    if (!flips) this.#set_cycle(0);
    if (flips && names.every((name) => name === "shown")) this.#show_front();
    else if (names.every((name) => REPAINTED.includes(name))) this.#stage.repaint();
    else this.#build();
    this.#refresh();
    this.#toolbar.update();
    this.#show_cursor();
  }

  #build() {
    const kind = this.#kinds.find(({ key }) => key === this.#state.get("mode"));
    this.#note.textContent = kind.note ?? "";
    this.#note.hidden = !kind.note;
    this.#toolbar.update();
    this.#stage.build();
    this.#refresh();
    this.#show_cursor();
  }

  #show_front() {
    this.#stage.show_front(this.#held ? this.#chosen.base : this.#chosen.shown);
    this.#show_cursor();
  }

  #refresh() {
    this.#stage.refresh();
    this.#toolbar.show_zoom(this.#stage.zoom_text);
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
    this.#stage.show_values(cursor);
    this.#values.show(cursor, this.#chosen.base);
    this.#show_bar(cursor);
  }

  #show_bar(cursor) {
    const { mode } = this.#state.values;
    const { base, kept } = this.#chosen;
    if (mode === "color") {
      this.#bar.replaceChildren();
      return;
    }
    const marks = [];
    const mark = (source, value) => is_number(value) && marks.push({ value, name: source.label });
    if (mode === "difference") {
      for (const source of cursor ? kept.filter((one) => one !== base) : []) {
        const difference = difference_at(base, source, ...cursor);
        difference?.forEach((value) => mark(source, this.#state.get("absolute") ? Math.abs(value) : value));
      }
      set_children(this.#bar, color_bar(difference_scale(this.#state.values), marks));
      return;
    }
    const with_map = kept.filter(({ data }) => data.has(mode));
    for (const source of cursor ? with_map : []) mark(source, source.data.map_value(mode, ...cursor));
    const full = with_map[0]?.data.full_scale(mode) ?? 1;
    set_children(this.#bar, with_map.length > 0 ? color_bar(magma_scale(full), marks) : null);
  }

  #announce() {
    const { cursor } = this.#viewport;
    if (!cursor) return;
    const values = this.#chosen.kept.map(
      (source) => `${source.label} ${levels_text(source.data.levels("color", ...cursor))}`,
    );
    this.#announcer.textContent = `Pixel ${cursor.join(", ")}: ${values.join("; ")}`;
  }
}
