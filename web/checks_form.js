// The checks of a spec.
import { el, select, set_children, unique_id } from "./dom.js";
import { form_section } from "./form_section.js";
import { field_frame } from "./field_frame.js";
import { fields_of, new_entry } from "./param_form.js";
import { pointer_of } from "./spec_model.js";
import { labels_of } from "./spec_methods.js";

const USUAL_LIMIT = 0.05;

export class ChecksForm {
  #model;
  #fields;
  #list = el("ol", { class: "check-list" });
  element;

  /** `described`: the description of the spec's field. */
  constructor(model, described) {
    this.#model = model;
    this.#fields = described.fields;
    this.draw();
    this.element = form_section(
      "Checks",
      "/checks",
      el("p", { class: "hint" }, described.summary),
      this.#list,
      el(
        "div",
        { class: "add-row" },
        el("button", { type: "button", class: "small", onclick: () => this.#add() }, "+ Add a check"),
      ),
    );
  }

  get #checks() {
    const checks = this.#model.get(["checks"]);
    return Array.isArray(checks) ? checks : [];
  }

  draw() {
    set_children(
      this.#list,
      this.#checks.map((check, index) => this.#row(check ?? {}, index)),
    );
  }

  #add() {
    const check = { ...new_entry(this.#fields), method: labels_of(this.#model)[0] ?? "", max: USUAL_LIMIT };
    this.#model.set(["checks"], [...this.#checks, check]);
    this.draw();
    this.#list.lastElementChild.querySelector("select").focus();
  }

  #remove(index) {
    const left = this.#checks.toSpliced(index, 1);
    this.#model.set(["checks"], left.length > 0 ? left : undefined);
    this.draw();
  }

  #row(check, index) {
    const path = ["checks", index];
    const { choices: metrics } = this.#fields.find(({ name }) => name === "metric");
    const with_points = (this.#model.get(["sweep"]) ?? []).length > 0 || check.at !== undefined;
    const bounds = this.#fields.filter(({ name }) => ["min", "max"].includes(name) || (name === "at" && with_points));
    const pick = (name, choices) => {
      const id = unique_id("field");
      const current = check[name] ?? "";
      const all = choices.includes(current) ? choices : [...choices, current];
      const input = select(
        { id, onchange: () => this.#model.set([...path, name], input.value) },
        all.map((one) => [one, one]),
        current,
      );
      return field_frame({ name, kind: "choice", summary: "" }, [...path, name], input, { for_id: id });
    };
    const fields = fields_of(bounds, path, this.#model);
    fields.prepend(pick("metric", metrics), pick("method", labels_of(this.#model)));
    return el(
      "li",
      { class: "check-row", "data-pointer": pointer_of(path) },
      fields,
      el(
        "button",
        {
          type: "button",
          class: "quiet small",
          "aria-label": `Remove check ${index + 1}`,
          title: "Remove",
          onclick: () => this.#remove(index),
        },
        "✕",
      ),
      el("p", { class: "error-text", hidden: true }),
    );
  }
}
