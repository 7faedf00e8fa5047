// The viewer's keys, and the sheet that lists them.
import { el } from "./dom.js";

const SHEET = [
  ["F", "fill the window, or leave it"],
  ["L", "next layout: side by side, slider, flip"],
  ["M", "next kind of picture"],
  ["Space", "while held, in Flip: the picture that is compared with"],
  ["0 … 9", "in Flip and Slider: show the reference or that method"],
  ["C", "in Flip: change the picture every second, every half second, or not"],
  ["N, P", "next and previous worst pixel"],
  ["Arrows", "pan; with Shift move the pixel mark"],
  ["+ −", "zoom in and out, as Ctrl and the wheel do; a double click zooms to the pixel"],
  ["Home", "fit the pictures into the panes"],
  ["Enter", "or a click: how the marked pixel is made"],
  ["Shift and drag", "mark a rectangle, whose errors are then listed"],
  ["Esc", "leave the full window, remove the rectangle"],
  ["?", "this list"],
];

export function key_sheet() {
  const sheet = el(
    "dialog",
    { class: "key-sheet", "aria-label": "Keys of the viewer" },
    el("h2", {}, "Keys"),
    el(
      "dl",
      {},
      SHEET.map(([key, text]) => el("div", {}, el("dt", {}, el("kbd", {}, key)), el("dd", {}, text))),
    ),
    el("form", { method: "dialog" }, el("button", { class: "primary" }, "Close")),
  );
  return sheet;
}

/** Elements in which keys write or choose. */
function takes_keys(element, key) {
  if (element.closest("input:not([type=checkbox]), select, textarea, [role=slider], [role=tablist], dialog"))
    return true;
  const presses = element.closest("button, a, summary, input");
  return Boolean(presses) && (key === " " || key === "Enter");
}

/**
 * Calls `actions[key](event)`, with `actions.digit(number)` for digits, wherever the focus is on the page, and
 * `actions.release()` when the space bar is let go. An action that returns false has not used the key. Ends by itself once `viewer` is no longer on the page.
 */
export function listen_to_keys(viewer, actions) {
  const on_page = (event) => {
    if (viewer.isConnected) return true;
    document.removeEventListener("keydown", down);
    document.removeEventListener("keyup", up);
    return event === null;
  };
  const down = (event) => {
    if (!on_page(event) || event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
    if (takes_keys(event.target, event.key) || document.querySelector("dialog[open]")) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const action = /^[0-9]$/.test(key) ? () => actions.digit(Number(key)) : actions[key];
    if (action && action(event) !== false) event.preventDefault();
  };
  const up = (event) => {
    if (on_page(event) && event.key === " ") actions.release();
  };
  document.addEventListener("keydown", down);
  document.addEventListener("keyup", up);
}
