// An input for a number, with the range that the service checks.
import { el } from "./dom.js";

const is_whole = (param) => param.kind === "integer" || param.whole === true;

const tiniest = Number.MIN_VALUE;
/** The nearest number to `bound` on the side of `direction`, 1 or -1. */
function next_number(bound, direction) {
  if (bound === 0) return direction * tiniest;
  const bits = new DataView(new ArrayBuffer(8));
  bits.setFloat64(0, bound);
  bits.setBigInt64(0, bits.getBigInt64(0) + BigInt(bound > 0 === direction > 0 ? 1 : -1));
  return bits.getFloat64(0);
}

/** min, max and step of an input, which has no exclusive bounds: instead of those it gets the numbers next to them. */
function input_range(param) {
  const bound = (value, direction) => {
    if (typeof value !== "number") return null;
    if (!param.exclusive) return value;
    return is_whole(param) ? value + direction : next_number(value, direction);
  };
  return { min: bound(param.min, 1), max: bound(param.max, -1), step: is_whole(param) ? (param.step ?? 1) : "any" };
}

/** The value of a number input: undefined if it is empty, null if it is not a number, which the service refuses. */
function read_number(input) {
  if (input.validity.badInput) return null;
  return input.value === "" ? undefined : Number(input.value);
}

/** `on_change(value)`: undefined if it is empty, null if it is not a number. */
export function number_input(param, value, on_change, label = null, id = null) {
  const input = el("input", {
    type: "number",
    id,
    "aria-label": label,
    ...input_range(param),
    inputmode: is_whole(param) ? "numeric" : "decimal",
    value: value ?? "",
    placeholder: typeof param.default === "number" ? String(param.default) : null,
    required: param.required,
    oninput: () => on_change(read_number(input)),
  });
  return input;
}
