// A button that opens a list of actions.
import { el } from "./dom.js";

/** `items`: links and buttons; null is left out. It closes by Escape, by a choice and by a click elsewhere. */
export function menu(text, label, items) {
  const list = el("div", { class: "menu-items" }, items);
  const element = el("details", { class: "menu" }, el("summary", { class: "button", "aria-label": label }, text), list);
  const close = () => {
    element.open = false;
  };
  const outside = (event) => {
    if (!element.contains(event.target)) close();
  };
  element.addEventListener("toggle", () => {
    if (element.open) document.addEventListener("pointerdown", outside);
    else document.removeEventListener("pointerdown", outside);
  });
  element.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !element.open) return;
    close();
    element.firstChild.focus();
    event.stopPropagation();
  });
  list.addEventListener("click", ({ target }) => {
    if (!target.closest(".stays-open")) close();
  });
  return element;
}

/** A button that copies a text, and says so. `text` is a string or a function that makes it. */
export function copy_button(name, text) {
  const button = el("button", { type: "button", class: "stays-open" }, name);
  button.addEventListener("click", async () => {
    try {
      await navigator.clipboard.writeText(typeof text === "function" ? text() : text);
      button.textContent = "Copied";
    } catch {
      button.textContent = "Copying is not allowed here";
    }
    setTimeout(() => {
      button.textContent = name;
    }, 2000);
  });
  return button;
}
