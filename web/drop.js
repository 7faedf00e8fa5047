// Files that are dropped anywhere on the page.
import { el } from "./dom.js";

const has_files = (event) => [...(event.dataTransfer?.types ?? [])].includes("Files");

/** Calls `take(file)` with the first file of each drop. */
export function accept_drops(take) {
  const veil = el("div", { class: "drop-veil", hidden: true }, "Drop the file to compare methods on it");
  document.body.append(veil);
  document.addEventListener("dragover", (event) => {
    if (!has_files(event)) return;
    event.preventDefault();
    veil.hidden = false;
  });
  document.addEventListener("dragleave", (event) => {
    if (event.relatedTarget === null) veil.hidden = true;
  });
  document.addEventListener("drop", (event) => {
    if (!has_files(event)) return;
    event.preventDefault();
    veil.hidden = true;
    const [file] = event.dataTransfer.files;
    if (file) take(file);
  });
}
