// The self-contained report file: everything it shows is in the page.
import { AddressWriter, split_hash } from "./address.js";
import { el } from "./dom.js";
import { report_view } from "./report_view.js";

const block = (id) => JSON.parse(document.getElementById(id)?.textContent ?? "null");
const { report, pictures, methods, metrics, columns } = block("sheer-report");
const explained = block("sheer-pixels"); // [{x, y, run, why, pixel}], if the file was saved with some

/** The explanation of a pixel, of those that are in the file. */
async function load_pixel({ x, y, run }) {
  const found = explained.find((one) => one.x === x && one.y === y && one.run === run);
  if (found) return found.pixel;
  throw new Error("This file does not explain this pixel. The service's page of the report explains every one.");
}

function download_json() {
  const blob = new Blob([JSON.stringify(report, null, 2)], { type: "application/json" });
  const link = el("a", { href: URL.createObjectURL(blob), download: "report.json" });
  link.click();
  URL.revokeObjectURL(link.href);
}

const address = new AddressWriter();
const view = report_view(report, {
  picture_url: (image) => pictures[image.sha256] ?? null,
  methods,
  metrics,
  columns,
  load_pixel: explained ? load_pixel : null,
  explained: explained ?? [],
  actions: [el("button", { type: "button", onclick: download_json }, "Save report.json")],
  query: split_hash(location.hash).query,
  on_query: (shown, is_step) => address.write(shown, is_step),
});
window.addEventListener("hashchange", () => view.show(split_hash(location.hash).query));
document.getElementById("main").append(view.element);
