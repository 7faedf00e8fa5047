// Shows errors of a spec next to the fields that they concern.

/** The element of the form for a JSON pointer: its own field, otherwise the nearest enclosing part. */
function place_of(form, pointer) {
  const places = new Map([...form.querySelectorAll("[data-pointer]")].map((node) => [node.dataset.pointer, node]));
  for (let end = pointer.length; end > 0; end = pointer.lastIndexOf("/", end - 1)) {
    const place = places.get(pointer.slice(0, end));
    if (place) return place;
  }
  return null;
}

const own_slot = (place) => place.querySelector(":scope > .error-text") ?? place.querySelector(".error-text");

/** Event "error-text" tells the field what is shown of it. */
function write(slot, text) {
  slot.textContent = text;
  slot.hidden = text === "";
  slot.parentElement.dispatchEvent(new CustomEvent("error-text", { detail: text }));
}

export function clear_errors(form) {
  for (const slot of form.querySelectorAll("[data-pointer] > .error-text:not([hidden])")) write(slot, "");
  for (const input of form.querySelectorAll("[aria-invalid]")) input.removeAttribute("aria-invalid");
}

/** Shows `errors` [{pointer, detail}] in the form; returns those that belong to no field. */
export function show_errors(form, errors) {
  clear_errors(form);
  return errors.filter(({ pointer, detail }) => {
    const place = place_of(form, pointer);
    const slot = place && own_slot(place);
    if (!slot) return true;
    const exact = place.dataset.pointer === pointer;
    const text = exact ? detail : `${pointer.slice(place.dataset.pointer.length + 1)}: ${detail}`;
    write(slot, slot.hidden ? text : `${slot.textContent}; ${text}`);
    for (let fold = place.closest("details"); fold; fold = fold.parentElement.closest("details")) fold.open = true;
    if (place.classList.contains("field")) {
      for (const input of place.querySelectorAll("input, select, textarea")) input.setAttribute("aria-invalid", "true");
    }
    return false;
  });
}

/** Moves to the first field that is wrong. */
export function focus_first_error(form) {
  const input = form.querySelector("[aria-invalid]");
  const slot = form.querySelector(".error-text:not([hidden])");
  if (input) input.focus();
  else slot?.scrollIntoView({ block: "center" });
}
