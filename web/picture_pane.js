// One pane of the viewer: a picture, or two with a movable line between them, seen through the shared viewport.
import { el } from "./dom.js";
import { PixelReader } from "./pixel_reader.js";

const MARK_MIN_PX = 7;
const INSPECT_ZOOM = 8;
const KEY_PAN_SHARE = 0.1;
const CLICK_SLACK_PX = 3;
const DOUBLE_CLICK_MS = 250;

function picture(url, alt, viewport) {
  const [width, height] = viewport.size;
  return el("img", { src: url, alt, width, height, draggable: "false", decoding: "async" });
}

export class PicturePane {
  #viewport;
  #view;
  #mark = el("div", { class: "pixel-mark", hidden: true });
  #pictures = [];
  #divider = null;
  #drag = null;
  #split = 0.5;
  #on_pick;
  #picking = null;
  #pressed_at = null;

  /**
   * `hint_id` is the id of the text that explains the keys. `on_split(fraction)` hears of the line's
   * moves, `on_resize()` of a new size, `on_pick(x, y)` of a pixel that was clicked or chosen by Enter.
   */
  constructor(viewport, { label, hint_id, on_split = () => {}, on_resize = () => {}, on_pick = null }) {
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

  /** Shows one picture, or two with a line between them: {url, alt} each. */
  show(...sources) {
    this.#pictures = sources.map(({ url, alt }) => {
      const image = picture(url, alt, this.#viewport);
      return { image, reader: new PixelReader(image), frame: el("div", { class: "picture" }, image) };
    });
    this.#divider = sources.length > 1 ? (this.#divider ?? this.#make_divider()) : null;
    this.#view.replaceChildren(
      ...this.#pictures.map((shown) => shown.frame),
      this.#mark,
      ...(this.#divider ? [this.#divider] : []),
    );
    this.refresh();
  }

  get size() {
    return { width: this.#view.clientWidth, height: this.#view.clientHeight };
  }
  get zoom() {
    return this.#viewport.zoom_in(this.size.width, this.size.height);
  }

  /** Values of the pixel in every picture of the pane, null where they are not loaded. */
  read(x, y) {
    return this.#pictures.map((shown) => shown.reader.read(x, y));
  }

  refresh() {
    const { width, height } = this.size;
    if (width === 0 || height === 0) return;
    const corner = this.#view.getBoundingClientRect();
    const { scale, left, top } = this.#viewport.place(width, height, corner.left, corner.top);
    const [columns, rows] = this.#viewport.size;
    const pixelated = scale * (window.devicePixelRatio || 1) >= 1;
    for (const { image } of this.#pictures) {
      image.style.transform = `translate(${left}px, ${top}px)`;
      image.style.width = `${columns * scale}px`;
      image.style.height = `${rows * scale}px`;
      image.classList.toggle("pixelated", pixelated);
    }
    this.#place_mark(scale, left, top);
    this.#place_divider();
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
  }

  #place_divider() {
    if (!this.#divider) return;
    const share = `${this.#split * 100}%`;
    this.#divider.style.left = share;
    this.#divider.setAttribute("aria-valuenow", Math.round(this.#split * 100));
    this.#pictures[1].frame.style.clipPath = `inset(0 0 0 ${share})`;
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
      view.setPointerCapture(event.pointerId);
    });
    view.addEventListener("pointermove", (event) => {
      if (this.#drag) {
        this.#viewport.pan(event.clientX - this.#drag[0], event.clientY - this.#drag[1], this.size);
        this.#drag = [event.clientX, event.clientY];
      }
      this.#viewport.set_cursor(this.#pixel_at(event).map(Math.floor));
    });
    for (const end of ["pointerup", "pointercancel"])
      view.addEventListener(end, () => {
        this.#drag = null;
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
        // The wheel scrolls the page unless the user has turned to the picture.
        if (!event.ctrlKey && !event.metaKey && document.activeElement !== view) return;
        event.preventDefault();
        this.#viewport.step(event.deltaY < 0 ? 1 : -1, this.size, ...this.#pixel_at(event));
      },
      { passive: false },
    );
    view.addEventListener("keydown", (event) => this.#key(event));
  }

  /** Of a double click, which zooms, nothing is picked; nor at the end of a drag. */
  #click(event) {
    clearTimeout(this.#picking);
    const [x, y] = this.#pressed_at ?? [Infinity, Infinity];
    const dragged = Math.hypot(event.clientX - x, event.clientY - y) > CLICK_SLACK_PX;
    if (!this.#on_pick || dragged || event.detail > 1) return;
    const pixel = this.#pixel_at(event).map(Math.floor);
    if (this.#viewport.contains(pixel)) this.#picking = setTimeout(() => this.#on_pick(...pixel), DOUBLE_CLICK_MS);
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
    else if (event.key === "0") this.#viewport.fit();
    else if (event.key === "1") this.#viewport.zoom_to(1, this.size);
    else if (event.key === "Enter" && this.#on_pick && this.#viewport.cursor) this.#on_pick(...this.#viewport.cursor);
    else return;
    event.preventDefault();
  }
}
