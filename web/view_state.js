// What the viewer shows, as one object that the address can hold. Values at their default are left out of the address.

export const LAYOUTS = [
  ["grid", "Side by side"],
  ["slider", "Slider"],
  ["flip", "Flip"],
];
export const CHANNELS = [
  ["rgb", "RGB"],
  ["r", "Red"],
  ["g", "Green"],
  ["b", "Blue"],
  ["a", "Alpha"],
];
const OWN_BACKGROUND = "own";
export const BACKGROUNDS = [
  [OWN_BACKGROUND, "its background"],
  ["black", "black"],
  ["white", "white"],
  ["checker", "a checker"],
];
export const GAINS = [1, 2, 4, 8, 16, 32, 64];

const NUMBERS = { exposure: [-10, 10], gamma: [0.1, 4], gain: [0, 64] };
const NAMES = [
  "mode",
  "layout",
  "against",
  "shown",
  "kept",
  "exposure",
  "gamma",
  "channel",
  "over",
  "gain",
  "absolute",
];
const TONE = ["exposure", "gamma", "channel", "over"];

/**
 * `mode`: key of the kind of picture. `against`: key of the source with which the others are compared; `shown`: key of the one
 * beside it. `kept`: keys of the sources that are shown, null for all. `exposure` in stops, `gamma` above 0. `over`: what is behind
 * the pictures, see BACKGROUNDS. `gain`: factor
 * of differences, 0 for the square root that shows both small and large ones. `absolute`: differences without their sign.
 *
 * Event "change", whose `changed` are the names of the values that differ.
 */
export class ViewState extends EventTarget {
  #defaults;
  #values;

  constructor({ mode, against, shown }) {
    super();
    this.#defaults = {
      mode,
      layout: "grid",
      against,
      shown,
      kept: null,
      exposure: 0,
      gamma: 1,
      channel: "rgb",
      over: OWN_BACKGROUND,
      gain: 0,
      absolute: false,
    };
    this.#values = { ...this.#defaults };
  }

  get values() {
    return this.#values;
  }
  get(name) {
    return this.#values[name];
  }

  set(changes) {
    const changed = Object.keys(changes).filter((name) => String(changes[name]) !== String(this.#values[name]));
    if (changed.length === 0) return;
    this.#values = { ...this.#values, ...changes };
    this.dispatchEvent(Object.assign(new Event("change"), { changed }));
  }

  get has_tone() {
    return TONE.some((name) => this.#values[name] !== this.#defaults[name]);
  }

  /** Whether what is asked for is made from the pictures' opacity. */
  get needs_opacity() {
    return this.#values.channel === "a" || this.#values.over !== OWN_BACKGROUND;
  }

  reset_tone() {
    this.set(Object.fromEntries(TONE.map((name) => [name, this.#defaults[name]])));
  }

  /** The values that differ from their defaults, as texts by name. */
  to_query() {
    return Object.fromEntries(
      NAMES.filter((name) => String(this.#values[name]) !== String(this.#defaults[name])).map((name) => [
        name,
        name === "kept" ? this.#values.kept.join() : String(this.#values[name]),
      ]),
    );
  }

  /** Takes over what an address says; `allowed`: {mode, source} are the known keys. Anything else keeps its default. */
  from_query(query, allowed) {
    const values = { ...this.#defaults };
    const known = {
      mode: allowed.modes,
      layout: LAYOUTS.map(([key]) => key),
      against: allowed.sources,
      shown: allowed.sources,
      channel: CHANNELS.map(([key]) => key),
      over: BACKGROUNDS.map(([key]) => key),
    };
    for (const [name, keys] of Object.entries(known)) if (keys.includes(query[name])) values[name] = query[name];
    for (const [name, [least, greatest]] of Object.entries(NUMBERS)) {
      const value = Number(query[name] || NaN);
      if (value >= least && value <= greatest) values[name] = value;
    }
    values.absolute = query.absolute === "true";
    const kept = (query.kept ?? "").split(",").filter((key) => allowed.sources.includes(key));
    if (kept.length > 0) values.kept = kept;
    this.set(values);
  }
}
