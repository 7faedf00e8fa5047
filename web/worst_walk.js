// A walk through the pixels in which two pictures differ most.
import { shown_kind } from "./layer.js";
import { greatest_differences, worst_pixels } from "./paint.js";

export class WorstWalk {
  #pair = "";
  #pixels = [];
  #index = -1;

  /** The next pixel [x, y], or the previous one for −1; null if the pictures do not differ, undefined if one has none. */
  async next(direction, base, shown) {
    const pair = `${base.key} ${shown.key}`;
    if (this.#pair !== pair) {
      if (!shown_kind(shown, "difference", base) || shown === base) return undefined;
      const rasters = await Promise.all([base.data.load("color"), shown.data.load("color")]);
      this.#pixels = worst_pixels(greatest_differences(...rasters), rasters[0].width);
      this.#pair = pair;
      this.#index = direction > 0 ? -1 : 0;
    }
    const count = this.#pixels.length;
    if (count === 0) return null;
    this.#index = (this.#index + direction + count) % count;
    return this.#pixels[this.#index];
  }
}
