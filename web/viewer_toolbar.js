// The toolbar of the viewer: layout, kind of picture, what is compared with what, zoom.
import { el, segmented, select } from "./dom.js";
import { menu } from "./menu.js";
import { LAYOUTS } from "./view_state.js";
import { show_tools } from "./viewer_tools.js";

const button = (text, label, action) =>
  el("button", { type: "button", title: label, "aria-label": label, onclick: action }, text);

export class ViewerToolbar {
  #state;
  #zoom = el("output", { class: "zoom-value" });
  #layouts;
  #modes;
  #against;
  #shown;
  #pair;
  #sizes;
  #worst;
  #fill;
  #tools = el("div", { class: "viewer-tools", role: "group", "aria-label": "Tools for this kind of picture" });
  #tools_mode = null;
  #has_opacity;

  /** `actions`: {fill, keys, step(±1), fit, full_size, worst(±1), resize(size)}. */
  constructor(sources, kinds, state, actions) {
    this.#state = state;
    this.#has_opacity = sources.some(({ data }) => data.has("opacity"));
    const with_picture = sources.filter(({ data }) => data.has("color"));
    const choices = with_picture.map(({ key, label }) => [key, label]);
    const choose = (name, label) =>
      select({ "aria-label": label, onchange: (event) => state.set({ [name]: event.target.value }) }, choices, "");
    this.#layouts = segmented("Layout", LAYOUTS, state.get("layout"), (layout) => state.set({ layout }));
    this.#modes = segmented(
      "Kind of picture",
      kinds.map(({ key, label }) => [key, label]),
      state.get("mode"),
      (mode) => state.set({ mode }),
    );
    this.#against = choose("against", "Left picture");
    this.#shown = choose("shown", "Right picture");
    this.#pair = el(
      "div",
      { class: "pair-control" },
      this.#against,
      button("⇄", "Swap the two pictures", () =>
        state.set({ against: state.get("shown"), shown: state.get("against") }),
      ),
      this.#shown,
    );
    this.#sizes = segmented(
      "Size of the panes",
      [
        ["small", "S", "Small panes"],
        ["medium", "M", "Medium panes"],
        ["large", "L", "Large panes"],
      ],
      "medium",
      actions.resize,
    );
    this.#worst = el(
      "div",
      { class: "zoom-control" },
      button("‹", "Previous worst pixel (P)", () => actions.worst(-1)),
      el("span", { class: "muted" }, "worst"),
      button("›", "Next worst pixel (N)", () => actions.worst(1)),
    );
    this.#fill = button("Fill", "Fill the window (F)", actions.fill);
    this.element = el(
      "div",
      { class: "viewer-head" },
      el(
        "div",
        { class: "toolbar", role: "group", "aria-label": "Picture tools" },
        this.#layouts,
        kinds.length > 1 ? this.#modes : null,
        this.#pair,
        with_picture.length > 2 ? this.#keep_menu(with_picture) : null,
        el("span", { class: "toolbar-space" }),
        this.#sizes,
        this.#worst,
        el(
          "div",
          { class: "zoom-control" },
          button("−", "Zoom out", () => actions.step(-1)),
          this.#zoom,
          button("+", "Zoom in", () => actions.step(1)),
          button("Fit", "Fit the pictures into the panes", actions.fit),
          button("1:1", "1:1, one picture pixel per screen pixel", actions.full_size),
        ),
        this.#fill,
        button("?", "Keys (?)", actions.keys),
      ),
      this.#tools,
    );
  }

  #keep_menu(sources) {
    const boxes = sources.map(({ key, label }) => {
      const box = el("input", {
        type: "checkbox",
        "data-key": key,
        onchange: () => {
          const kept = boxes.filter(({ checked }) => checked).map(({ dataset }) => dataset.key);
          if (kept.length === 0) box.checked = true;
          else this.#state.set({ kept: kept.length === boxes.length ? null : kept });
        },
      });
      box.label = label;
      return box;
    });
    this.#keep = boxes;
    return menu(
      "Pictures",
      "Which pictures are shown",
      el(
        "fieldset",
        {},
        el("legend", { class: "visually-hidden" }, "Pictures that are shown"),
        boxes.map((box) => el("label", { class: "keep copy" }, box, ` ${box.label}`)),
      ),
    );
  }
  #keep = [];

  /** Makes the controls agree with the state. */
  update() {
    const { layout, mode, against, shown, kept } = this.#state.values;
    const press = (control, value) => {
      for (const one of control.children) one.setAttribute("aria-pressed", String(one.dataset.value === value));
    };
    press(this.#layouts, layout);
    press(this.#modes, mode);
    this.#against.value = against;
    this.#shown.value = shown;
    this.#pair.hidden = layout === "grid" && mode !== "difference";
    for (const node of [this.#shown, this.#pair.children[1]]) node.hidden = layout === "grid";
    this.#against.setAttribute(
      "aria-label",
      { grid: "Compared with", flip: "While Space is held" }[layout] ?? "Left picture",
    );
    this.#shown.setAttribute("aria-label", layout === "flip" ? "In front" : "Right picture");
    this.#sizes.hidden = layout !== "grid";
    this.#worst.hidden = layout === "grid";
    for (const box of this.#keep) box.checked = !kept || kept.includes(box.dataset.key);
    // A tool that is being used would lose the focus.
    if (!this.#tools.contains(document.activeElement) || this.#tools_mode !== mode)
      show_tools(this.#tools, this.#state, this.#has_opacity);
    this.#tools_mode = mode;
  }

  show_zoom(text) {
    this.#zoom.textContent = text;
  }

  show_filling(fills) {
    this.#fill.textContent = fills ? "Leave" : "Fill";
    this.#fill.title = fills ? "Leave the full window (F)" : "Fill the window (F)";
    this.#fill.setAttribute("aria-label", this.#fill.title);
  }
}
