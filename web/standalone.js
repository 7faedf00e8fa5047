// The self-contained report file: everything it shows is in the page.
import { el } from "./dom.js";
import { report_view } from "./report_view.js";

const { report, pictures, methods, metrics } = JSON.parse(document.getElementById("sheer-report").textContent);

function download_json() {
  const blob = new Blob([JSON.stringify(report, null, 2)], { type: "application/json" });
  const link = el("a", { href: URL.createObjectURL(blob), download: "report.json" });
  link.click();
  URL.revokeObjectURL(link.href);
}

document.getElementById("main").append(
  report_view(report, {
    picture_url: (image) => pictures[image.sha256] ?? null,
    methods,
    metrics,
    actions: [el("button", { type: "button", onclick: download_json }, "Save report.json")],
  }),
);
