// The spec that is being edited: plain JSON that the form and the JSON text both edit. Fields with their default value
// are left out, so that the text is as short as a person would write it.

const DRAFT_KEY = "sheer.draft";
const ORIGIN_KEY = "sheer.draft.origin";
const EDITED_KEY = "sheer.draft.edited";

/** The parts of a spec to which a title and the limits of checks apply. */
const SUBJECT = ["image", "scene", "methods", "reference", "sweep"];

/** RFC 6901 pointer of a path of keys and indices. */
export function pointer_of(path) {
  return path.map((part) => `/${String(part).replaceAll("~", "~0").replaceAll("/", "~1")}`).join("");
}

/** Ids are case-insensitive. */
export const same_id = (a, b) => String(a).toLowerCase() === String(b).toLowerCase();

/** Whether a plain string at this path means an object with that id: a method or the reference. */
function is_method_place(path) {
  return (path.length === 2 && path[0] === "methods") || (path.length === 1 && path[0] === "reference");
}

const is_object = (value) => typeof value === "object" && value !== null;

const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);

/** Whether two checks are equivalent, whether or not null fields are written out. */
function same_check(a, b) {
  return ["metric", "method", "min", "max"].every((name) => (a?.[name] ?? null) === (b?.[name] ?? null));
}

/**
 * Events: "edit" after a change by the form; "replace" after the whole spec was replaced; "leave" after a change that
 * made a ready-made spec a different one: its title and checks are then in `left` and no longer in the spec.
 */
export class SpecModel extends EventTarget {
  #spec;
  #origin; // the ready-made spec that this one began as; null once it is a different one
  #left = null;

  constructor(spec, origin = null) {
    super();
    this.#spec = structuredClone(spec);
    this.#origin = structuredClone(origin);
  }

  get spec() {
    return this.#spec;
  }

  get origin() {
    return this.#origin;
  }

  /** {title, checks} that were removed with the ready-made spec, or null. */
  get left() {
    return this.#left;
  }

  replace(spec) {
    this.#spec = structuredClone(spec);
    this.#left = null;
    this.dispatchEvent(new Event("replace"));
  }

  /** Begins with a ready-made spec. */
  start_from(spec) {
    this.#origin = structuredClone(spec);
    this.replace(spec);
  }

  /** Restores the title and checks that were removed; a title that was entered since then stays. */
  put_back() {
    const { title, checks } = this.#left;
    this.#left = null;
    if (title && !this.get(["title"])) this.set(["title"], title);
    if (checks.length > 0) this.set(["checks"], [...checks, ...(this.get(["checks"]) ?? [])]);
  }

  /** The value at a path of keys and indices, undefined if there is none. */
  get(path) {
    let value = this.#spec;
    for (let depth = 0; depth < path.length; ++depth) {
      if (typeof value === "string" && is_method_place(path.slice(0, depth))) value = { id: value };
      if (!is_object(value)) return undefined;
      value = value[path[depth]];
    }
    return value;
  }

  /** Sets a value, or removes it if it is undefined. */
  set(path, value) {
    const before = this.get(path.slice(0, 1));
    this.#spec = this.#changed(is_object(this.#spec) ? this.#spec : {}, [], path, value);
    const is_another = this.#origin && SUBJECT.includes(path[0]) && !same(before, this.get(path.slice(0, 1)));
    if (is_another) this.#leave_origin();
    this.dispatchEvent(new Event("edit"));
    if (is_another && this.#left) this.dispatchEvent(new Event("leave"));
  }

  #leave_origin() {
    const { title, checks = [] } = this.#spec;
    const origin = this.#origin;
    this.#origin = null;
    const is_of_origin = (check) => (origin.checks ?? []).some((one) => same_check(one, check));
    const gone = { title: title === origin.title ? title : undefined, checks: [] };
    if (Array.isArray(checks)) gone.checks = checks.filter(is_of_origin);
    if (!gone.title && gone.checks.length === 0) return;
    this.#left = gone;
    if (gone.title) delete this.#spec.title;
    if (gone.checks.length === 0) return;
    this.#spec.checks = checks.filter((check) => !is_of_origin(check));
    if (this.#spec.checks.length === 0) delete this.#spec.checks;
  }

  /** A copy of `owner`, which is at `done`, in which the rest of `path` holds `value`. */
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

/**
 * Keeps a spec, and the ready-made one that it began as, for the next visit of the form in this browser tab. `is_edited`: the
 * user has changed it and not run it since.
 */
export function keep_draft(spec, origin = null, is_edited = false) {
  try {
    sessionStorage.setItem(DRAFT_KEY, JSON.stringify(spec));
    sessionStorage.setItem(ORIGIN_KEY, JSON.stringify(origin));
    sessionStorage.setItem(EDITED_KEY, JSON.stringify(is_edited));
  } catch {
    // Without storage, the draft lives only as long as the form.
  }
}

function load(key) {
  try {
    return JSON.parse(sessionStorage.getItem(key));
  } catch {
    return null;
  }
}

/** Whether the user has changed the draft and not run it since. */
export function draft_is_edited() {
  return load(EDITED_KEY) === true;
}

/** Whether another spec may replace the draft: asks if it has edits. */
export function may_replace_draft() {
  return !draft_is_edited() || window.confirm("Replace the comparison that you have written?");
}

/** The model of the draft, otherwise of the first of the `ready` specs. */
export function first_model(ready, empty) {
  const draft = load(DRAFT_KEY);
  if (!draft) return new SpecModel(ready[0] ?? empty, ready[0] ?? null);
  // The spec of a report may be a ready-made one.
  const origin = load(ORIGIN_KEY) ?? ready.find(({ title }) => title && title === draft.title) ?? null;
  return new SpecModel(draft, origin);
}
