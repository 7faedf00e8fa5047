// The visible part of the pictures, shared by all panes so that they zoom and pan together.

const STEPS = [1 / 16, 1 / 8, 1 / 4, 1 / 2, 1, 2, 4, 8, 16, 32, 64];

export class Viewport extends EventTarget {
  #width;
  #height;
  #zoom = null; // device pixels per picture pixel; null: as much as fits
  #center;
  #cursor = null;
  #chosen = null; // the pixel that was marked deliberately, which stays when the mouse leaves
  #area = null; // [x0, y0, x1, y1], the last two beyond its last pixel

  constructor(width_px, height_px) {
    super();
    this.#width = width_px;
    this.#height = height_px;
    this.#center = [width_px / 2, height_px / 2];
  }

  get size() {
    return [this.#width, this.#height];
  }
  get fits() {
    return this.#zoom === null;
  }
  get cursor() {
    return this.#cursor;
  }
  get area() {
    return this.#area;
  }
  set area(area) {
    this.#area = area;
    this.dispatchEvent(new Event("area"));
  }

  /** Marks the rectangle between two pixels, as far as it is in the picture. */
  mark_area([x0, y0], [x1, y1]) {
    const clamp = (value, most) => Math.min(most, Math.max(0, value));
    const [left, right] = [Math.min(x0, x1), Math.max(x0, x1) + 1].map((x) => clamp(x, this.#width));
    const [top, bottom] = [Math.min(y0, y1), Math.max(y0, y1) + 1].map((y) => clamp(y, this.#height));
    this.area = left < right && top < bottom ? [left, top, right, bottom] : null;
  }

  /** Zoom, position and pixel as texts for an address; {} while the whole pictures are shown and no pixel is marked. */
  to_query() {
    const one = (value) => String(Math.round(value * 100) / 100);
    return {
      ...(this.fits ? {} : { zoom: one(this.#zoom), at: this.#center.map(one).join() }),
      ...(this.#area ? { area: this.#area.join() } : {}),
      ...(this.#chosen ? { pixel: this.#chosen.join() } : {}),
    };
  }

  /** The opposite of to_query(). What is not a place in the pictures is ignored. */
  from_query({ zoom, at, area, pixel }) {
    const numbers = (text, count) => {
      const found = (text ?? "").split(",").map((part) => Number(part || NaN));
      return found.length === count && found.every(Number.isFinite) ? found : null;
    };
    const center = numbers(at, 2);
    const factor = Number(zoom || NaN);
    const is_zoomed = center && factor >= STEPS[0] && factor <= STEPS.at(-1);
    this.#zoom = is_zoomed ? factor : null;
    this.#center = is_zoomed ? center : [this.#width / 2, this.#height / 2];
    const box = numbers(area, 4);
    this.#area = box && box[0] < box[2] && box[1] < box[3] ? box : null;
    const marked = numbers(pixel, 2)?.map(Math.floor);
    this.#chosen = this.#cursor = marked && this.contains(marked) ? marked : null;
    this.#changed();
    this.dispatchEvent(new Event("cursor"));
  }

  /** Device pixels per picture pixel in a pane of this size (CSS pixels). */
  zoom_in(pane_width, pane_height) {
    return this.#zoom ?? this.fit_zoom(pane_width, pane_height);
  }

  /** The zoom at which the whole picture fits into a pane of this size. */
  fit_zoom(pane_width, pane_height) {
    const ratio = window.devicePixelRatio || 1;
    const fit = Math.min(pane_width / this.#width, pane_height / this.#height) * ratio;
    // Enlarged only by whole factors: any other would make some pixels wider than their neighbours.
    return fit >= 1 ? Math.floor(fit) : Math.max(fit, 1 / 64);
  }

  /**
   * The place of the picture in a pane: {scale, left, top} in CSS pixels from the pane's corner, which is at
   * (x0, y0) of the window. Snapped to device pixels of the window, so that picture pixels fall on whole screen pixels.
   */
  place(pane_width, pane_height, x0 = 0, y0 = 0) {
    const ratio = window.devicePixelRatio || 1;
    const scale = this.zoom_in(pane_width, pane_height) / ratio;
    const [x, y] = this.fits ? [this.#width / 2, this.#height / 2] : this.#center;
    const snap = (value, corner) => Math.round((value + corner) * ratio) / ratio - corner;
    return { scale, left: snap(pane_width / 2 - x * scale, x0), top: snap(pane_height / 2 - y * scale, y0) };
  }

  fit() {
    this.#zoom = null;
    this.#center = [this.#width / 2, this.#height / 2];
    this.#changed();
  }

  /** Zooms so that the picture's point (x, y) stays where it is in the pane; `pane` is {width, height}. */
  zoom_to(zoom, pane, x = null, y = null) {
    const before = this.place(pane.width, pane.height);
    const ratio = window.devicePixelRatio || 1;
    const middle_x = (pane.width / 2 - before.left) / before.scale;
    const middle_y = (pane.height / 2 - before.top) / before.scale;
    const [anchor_x, anchor_y] = [x ?? middle_x, y ?? middle_y];
    this.#zoom = Math.min(STEPS.at(-1), Math.max(STEPS[0], zoom));
    const shrink = before.scale / (this.#zoom / ratio);
    this.#move_center(anchor_x + (middle_x - anchor_x) * shrink, anchor_y + (middle_y - anchor_y) * shrink);
  }

  /** Zooms one step in (+1) or out (-1). */
  step(direction, pane, x = null, y = null) {
    const now = this.zoom_in(pane.width, pane.height);
    const next =
      direction > 0 ? STEPS.find((step) => step > now * 1.001) : STEPS.findLast((step) => step < now * 0.999);
    if (next !== undefined) this.zoom_to(next, pane, x, y);
  }

  /** Moves the picture by CSS pixels in a pane of that size. */
  pan(dx, dy, pane) {
    if (this.fits) return;
    const { scale } = this.place(pane.width, pane.height);
    this.#move_center(this.#center[0] - dx / scale, this.#center[1] - dy / scale);
  }

  /** Centers the pixel (x, y) and marks it. */
  show_pixel(x, y, zoom) {
    this.#zoom = zoom;
    this.#cursor = [x, y];
    this.#move_center(x + 0.5, y + 0.5);
    this.#inspect();
  }

  contains([x, y]) {
    return x >= 0 && y >= 0 && x < this.#width && y < this.#height;
  }

  /** Marks a pixel; with null the one that was chosen, if there is one. */
  set_cursor(pixel) {
    this.#cursor = pixel && this.contains(pixel) ? pixel : this.#chosen;
    this.dispatchEvent(new Event("cursor"));
  }

  /** Moves the mark by whole pixels, within the picture; the view follows it. */
  move_cursor(dx, dy) {
    const [x, y] = this.#cursor ?? this.#center.map(Math.floor);
    const clamp = (value, limit) => Math.min(limit - 1, Math.max(0, value));
    const start = this.#cursor ? [dx, dy] : [0, 0];
    this.#cursor = [clamp(x + start[0], this.#width), clamp(y + start[1], this.#height)];
    if (!this.fits) this.#move_center(this.#cursor[0] + 0.5, this.#cursor[1] + 0.5);
    this.#inspect();
  }

  #move_center(x, y) {
    this.#center = [Math.min(this.#width, Math.max(0, x)), Math.min(this.#height, Math.max(0, y))];
    this.#changed();
  }

  /** Marks a pixel until another one is chosen. */
  choose(pixel) {
    this.#cursor = pixel;
    this.#inspect();
  }

  /** The user selected a pixel deliberately, not just passed over it. */
  #inspect() {
    this.#chosen = this.#cursor;
    this.dispatchEvent(new Event("cursor"));
    this.dispatchEvent(new Event("inspect"));
  }

  #changed() {
    this.dispatchEvent(new Event("view"));
  }
}
