// Form fields made from the service's descriptions of parameters.
import { asset_control } from "./asset_field.js";
import { el, select, set_children, unique_id } from "./dom.js";
import { field_frame } from "./field_frame.js";
import { words } from "./format.js";
import { number_input } from "./number_input.js";
import { numbered_lines } from "./source_field.js";
import { pointer_of } from "./spec_model.js";

const LONG_TEXT_BYTES = 200;
const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);

/** Removes the value from the spec if it is the default. */
function store(model, path, param, value) {
  const is_default = !param.required && same(value, param.default);
  model.set(path, value === undefined || is_default ? undefined : value);
}

function number_field(param, path, model) {
  const id = unique_id("field");
  const input = number_input(
    param,
    model.get(path) ?? param.default,
    (value) => store(model, path, param, value),
    null,
    id,
  );
  return field_frame(param, path, input, { for_id: id });
}

function boolean_field(param, path, model) {
  const id = unique_id("field");
  const input = el("input", {
    type: "checkbox",
    id,
    checked: Boolean(model.get(path) ?? param.default),
    onchange: () => store(model, path, param, input.checked),
  });
  return field_frame(param, path, input, { for_id: id });
}

/** The value for the object that may replace a choice; no choice has this name. */
const OWN = "";

function choice_field(param, path, model) {
  const id = unique_id("field");
  const fields = param.fields ?? [];
  const value = model.get(path) ?? param.default;
  const current = fields.length > 0 && typeof value === "object" ? OWN : String(value);
  const choices = param.choices.map((choice) => [choice, choice]);
  if (fields.length > 0) choices.push([OWN, `own ${words(fields[0].name)}`]);
  if (!choices.some(([choice]) => choice === current)) choices.push([current, current]);
  const own_fields = el("div");
  const draw = () => set_children(own_fields, input.value === OWN ? fields_of(fields, path, model) : null);
  const choose = () => {
    if (input.value === OWN) model.set(path, new_entry(fields));
    else store(model, path, param, input.value);
    draw();
  };
  const input = select({ id, onchange: choose }, choices, current);
  const frame = field_frame(param, path, fields.length > 0 ? el("div", {}, input, own_fields) : input, { for_id: id });
  // The fields have hints and errors of their own, so they are added after the frame has been made.
  draw();
  return frame;
}

function asset_field(param, path, model) {
  if (param.max_length) return several_assets_field(param, path, model);
  const control = asset_control(param, model.get(path) ?? param.default, (value) => store(model, path, param, value));
  return field_frame(param, path, control.element, { for_id: control.id });
}

/** One file for all, or, if ticked, one for each. */
function several_assets_field(param, path, model) {
  const stored = () => model.get(path) ?? param.default;
  const id = unique_id("field");
  const box = el("input", {
    type: "checkbox",
    id,
    checked: Array.isArray(stored()),
    onchange: () => {
      const value = stored();
      store(model, path, param, box.checked ? Array(param.max_length).fill(value) : value[0]);
      draw();
    },
  });
  const controls = el("div");
  const for_all = () => {
    const { element } = asset_control(param, stored(), (value) => store(model, path, param, value));
    element.querySelector("select").setAttribute("aria-label", words(param.name));
    return element;
  };
  const draw = () =>
    set_children(
      controls,
      box.checked
        ? stored().map((one, index) => {
            const choose = (value) =>
              store(
                model,
                path,
                param,
                stored().map((other, at) => (at === index ? value : other)),
              );
            const { element, id: for_id } = asset_control(param, one, choose);
            return [el("label", { for: for_id }, `Number ${index + 1}`), element];
          })
        : for_all(),
    );
  draw();
  const line = el(
    "div",
    { class: "ticked" },
    box,
    el("label", { for: id }, `A different one for each of ${param.max_length}`),
  );
  return field_frame(param, path, el("div", {}, controls, line), { group: true });
}

function text_field(param, path, model) {
  const id = unique_id("field");
  const long = (param.max_length ?? 0) > LONG_TEXT_BYTES;
  const input = el(long ? "textarea" : "input", {
    id,
    class: long ? "source" : null,
    type: long ? null : "text",
    spellcheck: "false",
    value: model.get(path) ?? param.default ?? "",
    placeholder: param.placeholder,
    oninput: () => store(model, path, param, input.value === "" && !param.required ? undefined : input.value),
  });
  if (!long) return field_frame(param, path, input, { for_id: id });
  const lines = numbered_lines(input);
  const frame = field_frame(param, path, lines.element, { for_id: id });
  frame.addEventListener("error-text", ({ detail }) => lines.mark(detail));
  return frame;
}

const to_hex = (rgb) =>
  "#" +
  rgb
    .map((part) =>
      Math.round(Math.min(1, Math.max(0, part ?? 0)) * 255)
        .toString(16)
        .padStart(2, "0"),
    )
    .join("");
const from_hex = (hex) => [1, 3, 5].map((at) => Number((parseInt(hex.slice(at, at + 2), 16) / 255).toFixed(4)));

function numbers_field(param, path, model) {
  const value = () => {
    const stored = model.get(path) ?? param.default;
    return Array.isArray(stored) ? stored : [];
  };
  const count = param.max_length ?? value().length;
  const names = param.parts ?? Array.from({ length: count }, (_, index) => `number ${index + 1}`);
  const change = (index, part) => {
    const next = names.map((_, at) => (at === index ? part : value()[at]) ?? null);
    const emptied = param.optional && next.every((one) => one === null);
    store(model, path, param, emptied ? undefined : next);
    if (picker) picker.value = to_hex(next);
  };
  const inputs = names.map((part, index) =>
    number_input(
      { ...param, kind: "number", default: null },
      value()[index],
      (part) => change(index, part),
      `${words(param.name)} ${part}`,
    ),
  );
  const picker =
    names[0] === "red"
      ? el("input", {
          type: "color",
          "aria-label": `${words(param.name)} picker`,
          value: to_hex(value()),
          oninput: () => {
            const next = from_hex(picker.value);
            inputs.forEach((input, index) => {
              input.value = next[index];
            });
            store(model, path, param, next);
          },
        })
      : null;
  return field_frame(param, path, el("div", { class: "numbers" }, inputs, picker), { group: true });
}

function object_field(param, path, model) {
  if (param.optional) return optional_object_field(param, path, model);
  const fields = fields_of(param.fields ?? [], path, model);
  // The optional object next to a file describes its bytes: it is needed if there is no header, and useless otherwise.
  fields.addEventListener("filechosen", ({ detail }) => {
    const box = fields.querySelector(":scope > .kind-object .ticked input");
    if (box && box.checked !== detail.bare) box.click();
  });
  return field_frame(param, path, fields, { group: true });
}

/** An optional object: a box that adds it to the spec, and its fields while it is there. */
function optional_object_field(param, path, model) {
  // The model drops an object that has lost its last field; here only the box decides whether it is there.
  const kept = {
    get: (at) => model.get(at),
    set: (at, value) => {
      model.set(at, value);
      if ((model.get(path) ?? null) === null) model.set(path, {});
    },
  };
  const id = unique_id("field");
  const box = el("input", {
    type: "checkbox",
    id,
    checked: (model.get(path) ?? null) !== null,
    onchange: () => {
      model.set(path, box.checked ? new_entry(param.fields ?? []) : undefined);
      draw();
    },
  });
  const fields = el("div");
  const draw = () => set_children(fields, box.checked ? fields_of(param.fields ?? [], path, kept) : null);
  draw();
  const label = el("label", { for: id }, `Set the ${words(param.name).toLowerCase()}`);
  const line = el("div", { class: "ticked" }, box, label);
  return field_frame(param, path, el("div", {}, line, fields), { group: true });
}

/** A value for a required field; undefined if only the user can know it, such as a file. */
export function first_value(param) {
  if (param.kind === "list") return [new_entry(param.fields)];
  if (param.kind === "object") return new_entry(param.fields);
  return param.suggestion ?? param.default ?? undefined;
}

/** A new object with only the required fields. */
export function new_entry(fields) {
  const entries = fields.filter((field) => field.required).map((field) => [field.name, first_value(field)]);
  return structuredClone(Object.fromEntries(entries.filter(([, value]) => value !== undefined)));
}

/** A list that is not in the spec means the usual entries; they are added to the spec when they are edited. */
function list_field(param, path, model) {
  const rows = el("ol", { class: "rows" });
  const entries = () => {
    const stored = model.get(path);
    return Array.isArray(stored) ? stored : [];
  };
  const is_usual = () => model.get(path) === undefined && param.default?.length > 0;
  const put = (next) => {
    model.set(path, next);
    draw();
  };
  const button = (text, label, action, disabled = false) =>
    el(
      "button",
      { type: "button", class: "quiet small", "aria-label": label, title: label, disabled, onclick: action },
      text,
    );
  const more = el("button", {
    type: "button",
    class: "small",
    onclick: () => put(is_usual() ? structuredClone(param.default) : [...entries(), new_entry(param.fields ?? [])]),
  });
  const draw = () => {
    const what = words(param.name).toLowerCase();
    more.disabled = entries().length >= (param.max_length ?? Infinity);
    more.textContent = is_usual() ? `Change the ${param.default.length} usual entries of ${what}` : `Add to ${what}`;
    set_children(
      rows,
      entries().map((_, index) => {
        const name = `${words(param.name)} ${index + 1}`;
        const fields = fields_of(param.fields ?? [], [...path, index], model);
        fields.setAttribute("role", "group");
        fields.setAttribute("aria-label", name);
        return el(
          "li",
          { "data-pointer": pointer_of([...path, index]) },
          fields,
          el(
            "div",
            { class: "row-buttons" },
            button(
              "Copy",
              `Copy ${name}`,
              () => put(entries().toSpliced(index, 0, structuredClone(entries()[index]))),
              more.disabled,
            ),
            button(
              "✕",
              `Remove ${name}`,
              () => put(entries().toSpliced(index, 1)),
              entries().length <= (param.min_length ?? 0),
            ),
          ),
          el("p", { class: "error-text", hidden: true }),
        );
      }),
    );
  };
  draw();
  return field_frame(param, path, el("div", {}, rows, more), { group: true });
}

/** Any JSON; anything else is taken as a string. */
function any_field(param, path, model) {
  const id = unique_id("field");
  const value = model.get(path) ?? param.default;
  const input = el("textarea", {
    id,
    spellcheck: "false",
    rows: "2",
    value: typeof value === "string" ? value : JSON.stringify(value),
    oninput: () => {
      let read = input.value;
      try {
        read = JSON.parse(input.value);
      } catch {
        // A word without quotes is taken as it is.
      }
      store(model, path, param, input.value === "" ? undefined : read);
    },
  });
  return field_frame(param, path, input, { for_id: id });
}

const FIELDS = {
  number: number_field,
  integer: number_field,
  boolean: boolean_field,
  choice: choice_field,
  asset: asset_field,
  text: text_field,
  numbers: numbers_field,
  object: object_field,
  list: list_field,
  any: any_field,
};

/** The fields of the object at `path` in the spec. */
export function fields_of(params, path, model) {
  return el(
    "div",
    { class: "fields" },
    params.map((param) => (FIELDS[param.kind] ?? any_field)(param, [...path, param.name], model)),
  );
}
