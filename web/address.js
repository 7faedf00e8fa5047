// The address of the page: "#/path?query". Views keep what they show in the query.

/** {path, query} of an address's hash; the query as an object of texts. */
export function split_hash(hash) {
  const at = hash.indexOf("?");
  const path = at < 0 ? hash : hash.slice(0, at);
  return { path, query: Object.fromEntries(new URLSearchParams(at < 0 ? "" : hash.slice(at + 1))) };
}

const WRITE_PAUSE_MS = 200; // browsers refuse more than about a hundred changes in ten seconds

/** Writes a view's state into the address. */
export class AddressWriter {
  #timer = null;
  #waiting = null;

  /** `signal`: when it is aborted, nothing more is written. */
  constructor(signal = null) {
    signal?.addEventListener("abort", () => this.#stop());
  }

  /** With `is_step` "back" returns to the state before. */
  write(query, is_step) {
    const { path } = split_hash(location.hash);
    const text = new URLSearchParams(query).toString();
    const hash = `${path || "#"}${text ? `?${text}` : ""}`;
    this.#stop();
    if (is_step) this.#commit(hash, true);
    else this.#timer = setTimeout(() => this.#commit(hash, false), WRITE_PAUSE_MS);
    this.#waiting = hash;
  }

  /** The address with all changes that are not written yet. */
  get href() {
    return new URL(this.#waiting ?? location.hash, location.href).href;
  }

  #commit(hash, is_step) {
    if (hash === location.hash) return;
    try {
      history[is_step ? "pushState" : "replaceState"](null, "", hash);
    } catch {
      // A sandboxed page has no address of its own.
    }
  }

  #stop() {
    clearTimeout(this.#timer);
  }
}
