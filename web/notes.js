// Notes: what of an input was not read, or was read otherwise than it was meant.
import { el } from "./dom.js";

/** A list of notes [{code, text, where}], null where there are none. */
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
