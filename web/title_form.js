// Title and tags of a spec, and what was removed together with the ready-made one that it began as.
import { el, set_children, unique_id } from "./dom.js";
import { field_frame } from "./field_frame.js";
import { fields_of } from "./param_form.js";
import { suite_note } from "./suite_chooser.js";

function tags_field(model) {
  const id = unique_id("field");
  const tags = model.get(["tags"]);
  const text = Object.entries(typeof tags === "object" && tags !== null ? tags : {}).map(
    ([name, value]) => `${name}: ${value}`,
  );
  const input = el("input", {
    id,
    type: "text",
    value: text.join(", "),
    placeholder: "branch: main, gpu: none",
    oninput: () => {
      const parts = input.value
        .split(",")
        .map((part) => part.split(":"))
        .filter(([name]) => name.trim() !== "");
      const read = Object.fromEntries(parts.map(([name, ...rest]) => [name.trim(), rest.join(":").trim()]));
      model.set(["tags"], parts.length > 0 ? read : undefined);
    },
  });
  return field_frame({ name: "tags", kind: "text", summary: "name: text, separated by commas" }, ["tags"], input, {
    for_id: id,
  });
}

export class TitleForm {
  #model;
  #title;
  #on_back;
  element = el("section", { class: "card title-card", "aria-label": "Title and tags" });

  /** `described`: the field's description; `on_back()`: title and checks of the ready-made spec are back. */
  constructor(model, described, on_back) {
    this.#model = model;
    this.#title = { ...described, placeholder: "What is compared" };
    this.#on_back = on_back;
    this.draw();
  }

  draw() {
    const fields = fields_of([this.#title], [], this.#model);
    fields.append(tags_field(this.#model));
    set_children(this.element, fields, this.#left_note(), suite_note(this.#model));
  }

  /** What was removed together with the ready-made spec, and a button to restore it. */
  #left_note() {
    const { left } = this.#model;
    if (!left) return null;
    const checks =
      left.checks.length === 1 ? "the check" : left.checks.length > 1 ? `${left.checks.length} checks` : "";
    const what = [left.title ? `the title “${left.title}”` : "", checks].filter(Boolean).join(" and ");
    const put_back = () => {
      this.#model.put_back();
      this.draw();
      this.#on_back();
      this.element.querySelector("input").focus();
    };
    return el(
      "div",
      { class: "left-note", role: "status" },
      `This is now a different comparison, so ${what} of the ready-made one went. `,
      el("button", { type: "button", class: "link", onclick: put_back }, "Put back"),
    );
  }
}
