// Builds DOM without markup strings: text from users becomes only text nodes and attribute values.

const SVG = "http://www.w3.org/2000/svg";

function fill(node, properties, children) {
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (name === "value" || name === "checked" || name === "selected") node[name] = value;
    else node.setAttribute(name, value === true ? "" : value);
  }
  append(node, children);
  return node;
}

/** Adds children: nodes, strings, numbers, nested arrays; null, undefined and false are left out. */
export function append(node, children) {
  for (const child of [children].flat(Infinity)) {
    if (child === null || child === undefined || child === false) continue;
    node.append(child instanceof Node ? child : String(child));
  }
  return node;
}

/** An HTML element. `on…` properties are listeners, the others attributes. */
export function el(tag, properties = {}, ...children) {
  return fill(document.createElement(tag), properties, children);
}

/** An SVG element. */
export function svg(tag, properties = {}, ...children) {
  return fill(document.createElementNS(SVG, tag), properties, children);
}

/** Replaces all children. */
export function set_children(node, ...children) {
  node.replaceChildren();
  return append(node, children);
}

let last_id = 0;
/** An id that is unique on the page. */
export function unique_id(stem = "id") {
  return `${stem}-${++last_id}`;
}

/** A row of buttons, one of which is pressed; `choices` are [value, label, title?]. */
export function segmented(label, choices, current, on_choose) {
  const buttons = choices.map(([value, text, title]) =>
    el(
      "button",
      {
        type: "button",
        title,
        "data-value": value,
        "aria-pressed": String(value === current),
        onclick: () => {
          for (const button of buttons) button.setAttribute("aria-pressed", String(button.dataset.value === value));
          on_choose(value);
        },
      },
      text,
    ),
  );
  return el("div", { class: "segmented", role: "group", "aria-label": label }, buttons);
}

/** A select; `choices` are [value, label] or {label, choices} for a group. */
export function select(properties, choices, current) {
  const option = ([value, text]) => el("option", { value, selected: value === current }, text);
  return el(
    "select",
    properties,
    choices.map((choice) =>
      Array.isArray(choice) ? option(choice) : el("optgroup", { label: choice.label }, choice.choices.map(option)),
    ),
  );
}
