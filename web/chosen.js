// Which sources the viewer's state chooses.

export class Chosen {
  #sources;
  #state;

  constructor(sources, state) {
    this.#sources = sources;
    this.#state = state;
  }

  get all() {
    return this.#sources;
  }
  /** The one with which the others are compared. */
  get base() {
    return this.#source(this.#state.get("against"));
  }
  /** The one beside it. */
  get shown() {
    return this.#source(this.#state.get("shown"));
  }
  /** Those that have a picture and are not hidden. */
  get kept() {
    return this.#sources.filter((source) => source.data.has("color") && this.is_kept(source));
  }
  is_kept({ key }) {
    const kept = this.#state.get("kept");
    return !kept || kept.includes(key);
  }

  #source(key) {
    return this.#sources.find((source) => source.key === key) ?? this.#sources[0];
  }
}
