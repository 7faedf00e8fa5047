// The part of the form for sweeps: which parameters are varied in one job, and over which values.
import { el, select, set_children, unique_id } from "./dom.js";
import { field_frame, range_text } from "./field_frame.js";
import { first_value } from "./param_form.js";
import { pointer_of, same_id } from "./spec_model.js";
import { field_name } from "./sweep.js";

/** Values from comma-separated text: JSON if it is valid, otherwise words. */
export function read_values(text) {
  if (text.trim() === "") return [];
  try {
    return JSON.parse(`[${text}]`);
  } catch {
    const parts = text.split(",").filter((part) => part.trim() !== "");
    return parts.map((part) => {
      try {
        return JSON.parse(part);
      } catch {
        return part.trim();
      }
    });
  }
}

/** The text that `read_values` reads as these values. */
export function values_text(values) {
  if (!Array.isArray(values)) return "";
  const is_word = (value) =>
    typeof value === "string" && JSON.stringify(read_values(value)) === JSON.stringify([value]);
  return values.map((value) => (is_word(value) ? value : JSON.stringify(value))).join(", ");
}

/** The parameters with a single value, including those within objects, but not within objects that are left out. */
function leaves(params, path, model) {
  return params.flatMap((param) => {
    const here = [...path, param.name];
    if (param.optional && (model.get(here) ?? null) === null) return [];
    if (param.kind === "object") return leaves(param.fields ?? [], here, model);
    return param.kind === "list" ? [] : [{ pointer: pointer_of(here), path: here, param }];
  });
}

/** Initial values: all choices, or the current value of the parameter. */
function first_values(field, model) {
  if (!field) return [];
  const { param, path } = field;
  if (param.kind === "choice") return [...param.choices];
  const value = model.get(path) ?? first_value(param) ?? null;
  return value === null ? [] : [value];
}

function values_hint(param) {
  if (!param) return "separated by commas";
  const allowed = param.choices ? param.choices.join(", ") : range_text(param);
  return ["separated by commas", param.kind === "integer" ? "whole numbers" : "", allowed].filter(Boolean).join("; ");
}

export class SweepForm {
  #model;
  #fields_of_image;
  #most_axes;
  #methods;
  #scenes;
  #labels;
  #rows = el("ol", { class: "sweep-list" });

  /** `labels()` gives the labels of the spec's methods. */
  constructor(model, { fields, methods, scenes, labels }) {
    this.#model = model;
    this.#fields_of_image = fields.find(({ name }) => name === "image").fields;
    this.#most_axes = fields.find(({ name }) => name === "sweep").max_length;
    this.#methods = methods;
    this.#scenes = scenes;
    this.#labels = labels;
    this.element = el(
      "section",
      { class: "card", "data-pointer": "/sweep", "aria-label": "Sweep" },
      el("h2", {}, "Sweep"),
      el(
        "p",
        { class: "hint" },
        "Parameters to vary in one job; several of them give every combination of their values.",
      ),
      this.#rows,
      el(
        "div",
        { class: "add-row" },
        el("button", { type: "button", class: "small", onclick: () => this.#add() }, "+ Add a sweep"),
      ),
      el("p", { class: "error-text", hidden: true }),
    );
    this.draw();
  }

  get #axes() {
    const sweep = this.#model.get(["sweep"]);
    return Array.isArray(sweep) ? sweep : [];
  }

  /** What can currently be swept: parameters of the scene, the image and each method. */
  get #groups() {
    const scene = this.#scenes.find((one) => same_id(one.id, this.#model.get(["scene", "type"])));
    const parameters = (index) => {
      const id = this.#model.get(["methods", index, "id"]);
      return this.#methods.find((one) => same_id(one.id, id))?.parameters ?? [];
    };
    return [
      { label: "Scene", fields: leaves(scene?.parameters ?? [], ["scene"], this.#model) },
      { label: "Image", fields: leaves(this.#fields_of_image, ["image"], this.#model) },
      ...this.#labels().map((label, index) => ({
        label,
        fields: leaves(parameters(index), ["methods", index], this.#model),
      })),
    ].filter(({ fields }) => fields.length > 0);
  }

  #put(axes) {
    this.#model.set(["sweep"], axes.length > 0 ? axes : undefined);
    this.draw();
  }

  #add() {
    const fields = this.#groups.flatMap((group) => group.fields);
    const taken = this.#axes.map((axis) => axis?.pointer);
    const free = fields.filter(({ pointer }) => !taken.includes(pointer));
    const field = free.find(({ param }) => param.name === "count") ?? free[0];
    if (!field) return;
    this.#put([...this.#axes, { pointer: field.pointer, values: first_values(field, this.#model) }]);
    this.#rows.lastElementChild.querySelector("select").focus();
  }

  /** Draws it again after the parameters that can be swept have changed. */
  draw() {
    set_children(
      this.#rows,
      this.#axes.map((axis, index) => this.#row(axis ?? {}, index)),
    );
    this.element.querySelector(".add-row").hidden = this.#axes.length >= this.#most_axes;
  }

  #row(axis, index) {
    const path = ["sweep", index];
    return el(
      "li",
      { class: "sweep-row", "data-pointer": pointer_of(path) },
      axis.points ? this.#points_text(axis) : this.#fields(axis, index, path),
      el(
        "button",
        {
          type: "button",
          class: "quiet small",
          "aria-label": `Remove sweep ${index + 1}`,
          title: "Remove",
          onclick: () => this.#put(this.#axes.toSpliced(index, 1)),
        },
        "✕",
      ),
      el("p", { class: "error-text", hidden: true }),
    );
  }

  #points_text({ points }) {
    const spec = this.#model.spec;
    const fields = Array.isArray(points) ? [...new Set(points.flatMap((point) => Object.keys(point ?? {})))] : [];
    const names = fields.map((field) => field_name(field, spec)).join(" and ");
    return el("p", {}, `${points.length} points of ${names} set together; they can be edited as JSON.`);
  }

  #fields(axis, index, path) {
    const pointer_id = unique_id("field");
    const groups = this.#groups;
    const named = { methods: this.#labels().map((label) => ({ label })) };
    const current = axis.pointer ?? "";
    const choices = groups.map(({ label, fields }) => ({
      label,
      choices: fields.map(({ pointer }) => [pointer, field_name(pointer, named)]),
    }));
    const known = groups.flatMap((group) => group.fields).find(({ pointer }) => pointer === current);
    if (!known) choices.unshift([current, current === "" ? "Choose a parameter" : `${current} (unknown)`]);
    const pointer = select(
      {
        id: pointer_id,
        onchange: () => {
          const field = groups.flatMap((group) => group.fields).find((one) => one.pointer === pointer.value);
          const next = { pointer: pointer.value, values: first_values(field, this.#model) };
          this.#put(this.#axes.with(index, next));
          this.#rows.children[index].querySelector("select").focus();
        },
      },
      choices,
      current,
    );
    const values_id = unique_id("field");
    const values = el("input", {
      id: values_id,
      type: "text",
      spellcheck: "false",
      value: values_text(axis.values),
      placeholder: "1, 16, 64",
      oninput: () => this.#model.set([...path, "values"], read_values(values.value)),
    });
    return el(
      "div",
      { class: "fields" },
      field_frame({ name: "parameter", kind: "choice", summary: "" }, [...path, "pointer"], pointer, {
        for_id: pointer_id,
      }),
      field_frame({ name: "values", kind: "text", summary: values_hint(known?.param) }, [...path, "values"], values, {
        for_id: values_id,
      }),
    );
  }
}
