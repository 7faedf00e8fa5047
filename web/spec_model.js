// The spec that is being written: plain JSON that the form and the JSON text both edit. Fields left at their default
// are left out, so that the text stays as short as what a person would write.

const DRAFT_KEY = "sheer.draft";

/** RFC 6901 pointer of a path of keys and indices. */
export function pointer_of(path) {
  return path.map((part) => `/${String(part).replaceAll("~", "~0").replaceAll("/", "~1")}`).join("");
}

/** Ids are matched without regard to case. */
export const same_id = (a, b) => String(a).toLowerCase() === String(b).toLowerCase();

/** Whether a plain text at this path stands for an object with that id: a method or the reference. */
function is_method_place(path) {
  return (path.length === 2 && path[0] === "methods") || (path.length === 1 && path[0] === "reference");
}

const is_object = (value) => typeof value === "object" && value !== null;

/** Events: "edit" after a change by the form, "replace" after the whole spec was exchanged. */
export class SpecModel extends EventTarget {
  #spec;

  constructor(spec) {
    super();
    this.#spec = structuredClone(spec);
  }

  get spec() {
    return this.#spec;
  }

  replace(spec) {
    this.#spec = structuredClone(spec);
    this.dispatchEvent(new Event("replace"));
  }

  /** The value at a path of keys and indices, undefined where there is none. */
  get(path) {
    let value = this.#spec;
    for (let depth = 0; depth < path.length; ++depth) {
      if (typeof value === "string" && is_method_place(path.slice(0, depth))) value = { id: value };
      if (!is_object(value)) return undefined;
      value = value[path[depth]];
    }
    return value;
  }

  /** Sets a value, or with undefined takes it out. */
  set(path, value) {
    this.#spec = this.#changed(is_object(this.#spec) ? this.#spec : {}, [], path, value);
    this.dispatchEvent(new Event("edit"));
  }

  /** A copy of `owner`, which lies at `done`, in which the rest of `path` holds `value`. */
  #changed(owner, done, path, value) {
    const key = path[done.length];
    const here = [...done, key];
    let copy = typeof owner === "string" && is_method_place(done) ? { id: owner } : owner;
    copy = Array.isArray(copy) ? [...copy] : { ...(is_object(copy) ? copy : {}) };
    if (here.length < path.length) {
      const inner = this.#changed(copy[key], here, path, value);
      const emptied = is_object(inner) && !Array.isArray(inner) && Object.keys(inner).length === 0;
      if (emptied && value === undefined && !Array.isArray(copy)) delete copy[key];
      else copy[key] = inner;
    } else if (value !== undefined) copy[key] = value;
    else if (Array.isArray(copy)) copy.splice(key, 1);
    else delete copy[key];
    if (is_method_place(done) && Object.keys(copy).join() === "id") return copy.id;
    return copy;
  }
}

/** Keeps a spec for the next visit of the form in this browser tab. */
export function keep_draft(spec) {
  try {
    sessionStorage.setItem(DRAFT_KEY, JSON.stringify(spec));
  } catch {
    // Without storage the draft lives as long as the form.
  }
}

export function load_draft() {
  try {
    return JSON.parse(sessionStorage.getItem(DRAFT_KEY));
  } catch {
    return null;
  }
}
