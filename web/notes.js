// Notes: what was not read from an input, or was read differently than intended.
import { el } from "./dom.js";

/** A list of notes [{code, text, where}], null if there are none. */
export function note_list(notes) {
  if (notes.length === 0) return null;
  return el(
    "ul",
    { class: "note-list" },
    notes.map(({ code, text, where }) =>
      el("li", { "data-code": code }, where ? el("span", { class: "where" }, where) : null, el("span", {}, text)),
    ),
  );
}
