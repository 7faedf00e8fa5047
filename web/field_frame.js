// A labelled field with its hint and room for its error.
import { el, unique_id } from "./dom.js";
import { words } from "./format.js";
import { pointer_of } from "./spec_model.js";

const LONG_HINT = 90;

export function range_text(param) {
  const has_min = typeof param.min === "number";
  const has_max = typeof param.max === "number";
  if (has_min && has_max)
    return param.exclusive ? `over ${param.min}, under ${param.max}` : `${param.min} to ${param.max}`;
  if (has_min) return `${param.exclusive ? "over" : "from"} ${param.min}`;
  return has_max ? `${param.exclusive ? "under" : "up to"} ${param.max}` : "";
}

/** `control`: the field's input, whose id is `for_id`, or the group of its inputs. */
export function field_frame(param, path, control, { for_id, group = false } = {}) {
  const suffix = param.unit ? `_${param.unit.toLowerCase()}` : "";
  const name = suffix && param.name.endsWith(suffix) ? param.name.slice(0, -suffix.length) : param.name;
  const caption = [words(name), param.unit ? el("span", { class: "unit" }, param.unit) : null];
  const hint_text = [param.summary, range_text(param)].filter(Boolean).join("; ");
  const hint_id = unique_id("hint");
  const error_id = unique_id("error");
  const targets = control.matches("input, select, textarea")
    ? [control]
    : [...control.querySelectorAll("input, select, textarea")];
  for (const target of targets) target.setAttribute("aria-describedby", `${hint_id} ${error_id}`);
  const hint = el("p", { class: "hint", id: hint_id }, hint_text);
  const wide = hint_text.length > LONG_HINT ? " wide" : "";
  return el(
    group ? "fieldset" : "div",
    { class: `field kind-${param.kind}${wide}`, "data-pointer": pointer_of(path) },
    group ? el("legend", {}, caption) : el("label", { for: for_id }, caption),
    group && param.fields ? [hint, control] : [control, hint],
    el("p", { class: "error-text", id: error_id, hidden: true }),
  );
}
