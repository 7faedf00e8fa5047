// The frame of a part of the form of a spec.
import { el } from "./dom.js";

export function form_section(title, pointer, ...children) {
  return el(
    "section",
    { class: "card", "data-pointer": pointer, "aria-label": title },
    el("h2", {}, title),
    children,
    el("p", { class: "error-text", hidden: true }),
  );
}
