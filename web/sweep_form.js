// The form's part for sweeps: which parameters are varied in one job, and over which values.
import { el, select, set_children, unique_id } from "./dom.js";
import { field_frame } from "./param_form.js";
import { pointer_of } from "./spec_model.js";
import { field_name } from "./sweep.js";

const MOST_AXES = 4;

/** Values from a text with commas between them: JSON where it is such, else words. */
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

export function values_text(values) {
  if (!Array.isArray(values)) return "";
  return values.map((value) => (typeof value === "string" ? value : JSON.stringify(value))).join(", ");
}

/** The parameters that have one value, those within objects among them, but not within objects that are left out. */
function leaves(params, path, model) {
  return params.flatMap((param) => {
    const here = [...path, param.name];
    if (param.optional && (model.get(here) ?? null) === null) return [];
    if (param.kind === "object") return leaves(param.fields ?? [], here, model);
    return param.kind === "list" ? [] : [{ pointer: pointer_of(here), param }];
  });
}

/** Values to begin with: all choices, or the parameter's default. */
function first_values(param) {
  if (param?.choices?.length > 0) return [...param.choices];
  const value = param?.default ?? param?.min;
  return value === undefined || value === null ? [] : [value];
}

export class SweepForm {
  #model;
  #groups_now;
  #rows = el("ol", { class: "sweep-list" });

  /** `groups()` gives what can be swept now: [{label, params, path}]. */
  constructor(model, groups) {
    this.#model = model;
    this.#groups_now = groups;
    this.element = el(
      "section",
      { class: "card", "data-pointer": "/sweep", "aria-label": "Sweep" },
      el("h2", {}, "Sweep"),
      el("p", { class: "hint" }, "Parameters to vary in one job; several give every combination of their values."),
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

  get #groups() {
    return this.#groups_now()
      .map(({ label, params, path }) => ({ label, fields: leaves(params, path, this.#model) }))
      .filter(({ fields }) => fields.length > 0);
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
    this.#put([...this.#axes, { pointer: field.pointer, values: first_values(field.param) }]);
    this.#rows.lastElementChild.querySelector("select").focus();
  }

  /** Anew, after the parameters that can be swept have changed. */
  draw() {
    set_children(
      this.#rows,
      this.#axes.map((axis, index) => this.#row(axis ?? {}, index)),
    );
    this.element.querySelector(".add-row").hidden = this.#axes.length >= MOST_AXES;
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
    return el("p", {}, `${points.length} points of ${names} set together; they can be changed as JSON.`);
  }

  #fields(axis, index, path) {
    const pointer_id = unique_id("field");
    const groups = this.#groups;
    const current = axis.pointer ?? "";
    const choices = groups.map(({ label, fields }) => ({
      label,
      choices: fields.map(({ pointer }) => [pointer, field_name(pointer, this.#named_spec())]),
    }));
    const known = groups.flatMap((group) => group.fields).find(({ pointer }) => pointer === current);
    if (!known) choices.unshift([current, current === "" ? "Choose a parameter" : `${current} (unknown)`]);
    const pointer = select(
      {
        id: pointer_id,
        onchange: () => {
          const field = groups.flatMap((group) => group.fields).find((one) => one.pointer === pointer.value);
          const next = { pointer: pointer.value, values: first_values(field?.param) };
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
      field_frame(
        { name: "values", kind: "text", summary: "separated by commas" },
        [...path, "values"],
        values,
        { for_id: values_id },
      ),
    );
  }

  /** The spec with methods named as their groups are. */
  #named_spec() {
    const methods = [];
    for (const { label, path } of this.#groups_now()) if (path[0] === "methods") methods[path[1]] = { label };
    return { methods };
  }
}
