// One pane of the viewer: a picture, two with a movable dividing line, or several of which one is in front, seen through
// the shared viewport.
import { el } from "./dom.js";

const MARK_MIN_PX = 7;
const INSPECT_ZOOM = 8;
const KEY_PAN_SHARE = 0.1;
const CLICK_SLACK_PX = 3;
const DOUBLE_CLICK_MS = 250;

export class PicturePane {
  #viewport;
  #view;
  #mark = el("div", { class: "pixel-mark", hidden: true });
  #area = el("div", { class: "marked-area", hidden: true });
  #layers = [];
  #front = null;
  #divider = null;
  #drag = null;
  #touches = new Map(); // positions of the fingers by their ids
  #split = 0.5;
  #place = null; // of the pictures, when they were last shown
  #on_pick;
  #on_mark;
  #marked = null; // where a rectangle was begun
  #picking = null;
  #pressed_at = null;

  /**
   * `hint_id` is the id of the text that explains the keys. `on_split(fraction)` is called when the line
   * moves, `on_resize()` after a resize, `on_pick(x, y)` when a pixel is clicked or chosen by Enter, `on_mark(from, to)`
   * while a rectangle is drawn with Shift.
   */
  constructor(viewport, { label, hint_id, on_split = () => {}, on_resize = () => {}, on_pick = null, on_mark = null }) {
    this.#on_mark = on_mark;
    this.#on_pick = on_pick;
    this.#viewport = viewport;
    this.on_split = on_split;
    this.#view = el("div", {
      class: "pane-view",
      tabindex: "0",
      role: "group",
      "aria-label": label,
      "aria-describedby": hint_id,
      "aria-roledescription": "picture viewer",
    });
    this.element = this.#view;
    this.#listen();
    this.resize_observer = new ResizeObserver(() => {
      this.refresh();
      on_resize();
    });
    this.resize_observer.observe(this.#view);
  }

  /** Shows layers, with `divided` two with a line between them. */
  show(layers, divided = false) {
    this.#layers = layers;
    this.#divider = divided ? (this.#divider ?? this.#make_divider()) : null;
    this.#view.replaceChildren(
      ...layers.map((layer) => layer.frame),
      this.#area,
      this.#mark,
      ...(this.#divider ? [this.#divider] : []),
    );
    this.refresh();
  }

  get layers() {
    return this.#layers;
  }

  /** Of several layers the one that is seen. */
  set front(front) {
    this.#front = front;
    for (const layer of this.#layers) layer.frame.classList.toggle("behind", layer !== front);
    this.#view.setAttribute("aria-label", front.alt);
  }
  get front() {
    return this.#front ?? this.#layers[0];
  }

  get size() {
    return { width: this.#view.clientWidth, height: this.#view.clientHeight };
  }
  get zoom() {
    return this.#viewport.zoom_in(this.size.width, this.size.height);
  }

  refresh() {
    const { width, height } = this.size;
    if (width === 0 || height === 0) return;
    const corner = this.#view.getBoundingClientRect();
    const place = this.#viewport.place(width, height, corner.left, corner.top);
    const { scale, left, top } = (this.#place = place);
    const [columns, rows] = this.#viewport.size;
    const pixelated = scale * (window.devicePixelRatio || 1) >= 1;
    for (const { node } of this.#layers) {
      node.style.transform = `translate(${left}px, ${top}px)`;
      node.style.width = `${columns * scale}px`;
      node.style.height = `${rows * scale}px`;
      node.classList.toggle("pixelated", pixelated);
    }
    this.show_mark();
    this.#place_area(scale, left, top);
    this.#place_divider();
  }

  /** Moves the pixel mark, while the pictures stay. */
  show_mark() {
    if (this.#place) this.#place_mark(this.#place.scale, this.#place.left, this.#place.top);
  }

  #place_area(scale, left, top) {
    const { area } = this.#viewport;
    this.#area.hidden = !area;
    if (!area) return;
    const [x0, y0, x1, y1] = area;
    this.#area.style.transform = `translate(${left + x0 * scale}px, ${top + y0 * scale}px)`;
    this.#area.style.width = `${(x1 - x0) * scale}px`;
    this.#area.style.height = `${(y1 - y0) * scale}px`;
  }

  get split() {
    return this.#split;
  }
  set split(fraction) {
    this.#split = Math.min(1, Math.max(0, fraction));
    this.#place_divider();
    this.on_split(this.#split);
  }

  #place_mark(scale, left, top) {
    const cursor = this.#viewport.cursor;
    this.#mark.hidden = !cursor;
    if (!cursor) return;
    const side = Math.max(scale, MARK_MIN_PX);
    const x = left + (cursor[0] + 0.5) * scale - side / 2;
    const y = top + (cursor[1] + 0.5) * scale - side / 2;
    this.#mark.style.transform = `translate(${x}px, ${y}px)`;
    this.#mark.style.width = this.#mark.style.height = `${side}px`;
    // The handle keeps away from the mark.
    this.#divider?.style.setProperty("--handle", y + side / 2 > this.size.height / 2 ? "20%" : "80%");
  }

  #place_divider() {
    if (!this.#divider) return;
    const share = `${this.#split * 100}%`;
    this.#divider.style.left = share;
    this.#divider.setAttribute("aria-valuenow", Math.round(this.#split * 100));
    this.#layers[1].frame.style.clipPath = `inset(0 0 0 ${share})`;
  }

  #make_divider() {
    const moves = { ArrowLeft: -0.01, ArrowRight: 0.01, ArrowDown: -0.01, ArrowUp: 0.01, PageDown: -0.1, PageUp: 0.1 };
    const divider = el("div", {
      class: "divider",
      role: "slider",
      tabindex: "0",
      "aria-label": "Line between the two pictures",
      "aria-valuemin": "0",
      "aria-valuemax": "100",
      "aria-valuenow": "50",
      "aria-orientation": "horizontal",
      onkeydown: (event) => {
        if (event.key in moves) this.split += moves[event.key];
        else if (event.key === "Home" || event.key === "End") this.split = event.key === "Home" ? 0 : 1;
        else return;
        event.preventDefault();
        event.stopPropagation();
      },
      onpointerdown: (event) => {
        divider.setPointerCapture(event.pointerId);
        event.stopPropagation();
      },
      onpointermove: (event) => {
        if (!divider.hasPointerCapture(event.pointerId)) return;
        const box = this.#view.getBoundingClientRect();
        this.split = (event.clientX - box.left) / box.width;
      },
    });
    return divider;
  }

  #pixel_at(event) {
    const box = this.#view.getBoundingClientRect();
    const { scale, left, top } = this.#viewport.place(box.width, box.height, box.left, box.top);
    return [(event.clientX - box.left - left) / scale, (event.clientY - box.top - top) / scale];
  }

  #listen() {
    const view = this.#view;
    view.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      view.focus({ preventScroll: true });
      this.#drag = this.#pressed_at = [event.clientX, event.clientY];
      this.#touches.set(event.pointerId, this.#drag);
      if (this.#on_mark && event.shiftKey) this.#marked = this.#pixel_at(event).map(Math.floor);
      view.setPointerCapture(event.pointerId);
    });
    view.addEventListener("pointermove", (event) => this.#move(event));
    for (const end of ["pointerup", "pointercancel"])
      view.addEventListener(end, (event) => {
        this.#touches.delete(event.pointerId);
        this.#drag = null;
        this.#marked = null;
      });
    view.addEventListener("pointerleave", () => this.#viewport.set_cursor(null));
    view.addEventListener("click", (event) => this.#click(event));
    view.addEventListener("dblclick", (event) => {
      clearTimeout(this.#picking);
      if (!this.#viewport.fits) this.#viewport.fit();
      else this.#viewport.zoom_to(INSPECT_ZOOM, this.size, ...this.#pixel_at(event));
    });
    view.addEventListener(
      "wheel",
      (event) => {
        // The wheel scrolls the page unless the picture has the focus.
        if (!event.ctrlKey && !event.metaKey && document.activeElement !== view) return;
        event.preventDefault();
        this.#viewport.step(event.deltaY < 0 ? 1 : -1, this.size, ...this.#pixel_at(event));
      },
      { passive: false },
    );
    view.addEventListener("keydown", (event) => this.#key(event));
  }

  #move(event) {
    const here = [event.clientX, event.clientY];
    const pixel = this.#pixel_at(event).map(Math.floor);
    const before = this.#touches.get(event.pointerId);
    if (before && this.#touches.size === 2) this.#pinch(event.pointerId, here);
    else if (this.#marked) this.#on_mark(this.#marked, pixel);
    else if (this.#drag) {
      this.#viewport.pan(here[0] - this.#drag[0], here[1] - this.#drag[1], this.size);
      this.#drag = here;
    }
    if (before) this.#touches.set(event.pointerId, here);
    // Reading values would make dragging jerk.
    if (!this.#drag) this.#viewport.set_cursor(pixel);
  }

  /** Two fingers zoom about their middle. */
  #pinch(id, here) {
    const before = this.#touches.get(id);
    const [, other] = [...this.#touches].find(([key]) => key !== id);
    const distance = (place) => Math.hypot(place[0] - other[0], place[1] - other[1]);
    const middle = { clientX: (here[0] + other[0]) / 2, clientY: (here[1] + other[1]) / 2 };
    const zoom = (this.zoom * distance(here)) / Math.max(1, distance(before));
    this.#viewport.zoom_to(zoom, this.size, ...this.#pixel_at(middle));
    this.#pressed_at = null;
  }

  /** Neither a double click, which zooms, nor the end of a drag picks a pixel. */
  #click(event) {
    clearTimeout(this.#picking);
    const [x, y] = this.#pressed_at ?? [Infinity, Infinity];
    const dragged = Math.hypot(event.clientX - x, event.clientY - y) > CLICK_SLACK_PX;
    if (!this.#on_pick || dragged || event.detail > 1) return;
    const pixel = this.#pixel_at(event).map(Math.floor);
    if (!this.#viewport.contains(pixel)) return;
    this.#picking = setTimeout(() => {
      this.#viewport.choose(pixel);
      this.#on_pick(...pixel);
    }, DOUBLE_CLICK_MS);
  }

  #key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const { width, height } = this.size;
    if (event.key in arrows) {
      const [dx, dy] = arrows[event.key];
      if (event.shiftKey) this.#viewport.move_cursor(dx, dy);
      else this.#viewport.pan(-dx * width * KEY_PAN_SHARE, -dy * height * KEY_PAN_SHARE, this.size);
    } else if (event.key === "+" || event.key === "=") this.#viewport.step(1, this.size);
    else if (event.key === "-") this.#viewport.step(-1, this.size);
    else if (event.key === "Home") this.#viewport.fit();
    else if (event.key === "Enter" && this.#on_pick && this.#viewport.cursor) this.#on_pick(...this.#viewport.cursor);
    else return;
    event.preventDefault();
  }
}
