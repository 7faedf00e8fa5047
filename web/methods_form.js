// The methods of a spec: a card for each, and buttons that add one.
import { el, set_children, unique_id } from "./dom.js";
import { form_section } from "./form_section.js";
import { field_frame } from "./field_frame.js";
import { fields_of } from "./param_form.js";
import { pointer_of, same_id } from "./spec_model.js";
import { labels_of, method_object, method_specs } from "./spec_methods.js";

/** A method's parameters, folded away until one of them is set. */
export function parameter_fields({ parameters }, path, model) {
  if (parameters.length === 0) return null;
  const is_set = parameters.some((param) => model.get([...path, param.name]) !== undefined);
  return el(
    "details",
    { class: "parameters", open: is_set },
    el("summary", {}, parameters.length === 1 ? "1 parameter" : `${parameters.length} parameters`),
    fields_of(parameters, path, model),
  );
}

function bytes_text(bytes) {
  if (!bytes) return "depends on the scene";
  const of_formats = [...new Set([bytes.rgba8, bytes.rgba16f, bytes.rgba32f])];
  if (of_formats.length === 1) return `${of_formats[0]} bytes per pixel`;
  return `${bytes.rgba8}, ${bytes.rgba16f} and ${bytes.rgba32f} bytes per pixel of rgba8, rgba16f and rgba32f`;
}

/** What a method is and what it costs, folded away. */
function about(method) {
  const rows = [
    ["From", method.paper],
    ["Good at", method.good_at],
    ["Bad at", method.bad_at],
    ["Passes", method.passes],
    ["Memory", method.memory],
    ["By default", bytes_text(method.bytes_per_px)],
    ["Needs", method.needs || "nothing more than blending and a depth test"],
    ["Sorts", method.needs_sorting ? "yes" : "no"],
  ];
  return el(
    "details",
    { class: "about" },
    el("summary", {}, "About this method"),
    el(
      "dl",
      {},
      rows.map(([caption, text]) => [el("dt", {}, caption), el("dd", {}, text)]),
    ),
  );
}

export class MethodsForm {
  #model;
  #methods;
  #on_labels;
  #list = el("ol", { class: "method-list" });
  element;

  /** `methods`: their descriptions; `on_labels()`: there are other labels. */
  constructor(model, methods, on_labels) {
    this.#model = model;
    this.#methods = methods;
    this.#on_labels = on_labels;
    this.#draw();
    this.element = form_section(
      "Methods",
      "/methods",
      this.#list,
      el(
        "ul",
        { class: "add-methods", "aria-label": "Add a method" },
        methods.map((method) => this.#add_item(method)),
      ),
    );
  }

  get #specs() {
    return this.#model.get(["methods"]) ?? [];
  }

  #add_item(method) {
    const add = () => {
      this.#put([...this.#specs, method.id]);
      const card = this.#list.lastElementChild;
      card.querySelector("details")?.setAttribute("open", "");
      card.querySelector("input").focus();
    };
    return el(
      "li",
      {},
      el(
        "button",
        { type: "button", class: "small", "aria-label": `Add ${method.name}`, onclick: add },
        `+ ${method.name}`,
      ),
      el("p", { class: "hint" }, method.summary),
    );
  }

  #put(methods) {
    this.#model.set(["methods"], methods);
    this.#draw();
    this.#on_labels();
  }

  #draw() {
    const cards = method_specs(this.#model).map((method, index) => this.#card(method, index));
    set_children(this.#list, cards.length > 0 ? cards : el("li", { class: "empty muted" }, "No methods yet."));
  }

  #card(method, index) {
    const info = this.#methods.find((one) => same_id(one.id, method.id));
    const path = ["methods", index];
    const name = info?.name ?? String(method.id);
    return el(
      "li",
      { class: "method-card", "data-pointer": pointer_of(path) },
      el(
        "div",
        { class: "method-head" },
        el("strong", {}, name),
        info?.kind ? el("span", { class: "muted kind" }, info.kind) : null,
        this.#buttons(name, index),
      ),
      info ? el("p", { class: "hint" }, info.summary) : null,
      el("div", { class: "fields" }, this.#label_field(method, index)),
      info ? parameter_fields(info, path, this.#model) : null,
      info ? about(info) : null,
      el("p", { class: "error-text", hidden: true }),
    );
  }

  #buttons(name, index) {
    const button = (text, label, onclick, disabled = false) =>
      el(
        "button",
        {
          type: "button",
          class: "quiet small",
          "aria-label": `${label} ${name} (${index + 1})`,
          title: label,
          disabled,
          onclick,
        },
        text,
      );
    const copy = () => {
      const { label, ...rest } = method_object(this.#specs[index]);
      this.#put(this.#specs.toSpliced(index + 1, 0, Object.keys(rest).length > 1 ? rest : rest.id));
    };
    const move = () => {
      const next = [...this.#specs];
      [next[index - 1], next[index]] = [next[index], next[index - 1]];
      this.#put(next);
    };
    return el(
      "span",
      { class: "head-buttons" },
      button("↑", "Move up", move, index === 0),
      button("Copy", "Copy", copy),
      button("✕", "Remove", () => this.#put(this.#specs.toSpliced(index, 1))),
    );
  }

  #label_field(method, index) {
    const path = ["methods", index, "label"];
    const id = unique_id("field");
    const input = el("input", {
      id,
      type: "text",
      value: method.label ?? "",
      placeholder: labels_of(this.#model)[index],
      oninput: () => {
        this.#model.set(path, input.value === "" ? undefined : input.value);
        this.#on_labels();
      },
    });
    return field_frame({ name: "label", kind: "text", summary: "" }, path, input, { for_id: id });
  }
}
