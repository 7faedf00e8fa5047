// A report at #/reports/{id}: its progress while it is made, then the report itself.
import { delete_report, follow, get_methods, get_metrics, get_pixel, get_report, report_path } from "./api.js";
import { el, set_children } from "./dom.js";
import { error_text, report_view, scene_text } from "./report_view.js";
import { keep_draft } from "./spec_model.js";

const UNSETTLED = ["queued", "running"];

function message(kind, text) {
  return el("p", { class: `notice ${kind}`, role: kind === "error" ? "alert" : "status" }, text);
}

function use_again(report) {
  return el(
    "button",
    {
      type: "button",
      onclick: () => {
        keep_draft(report.spec);
        location.hash = "#/";
      },
    },
    "Use this spec again",
  );
}

function delete_button(main, report, text, question) {
  return el(
    "button",
    {
      type: "button",
      class: "danger",
      onclick: async () => {
        if (!window.confirm(question)) return;
        try {
          await delete_report(report.id);
          location.hash = "#/reports";
        } catch (error) {
          main.prepend(message("error", error.message));
        }
      },
    },
    text,
  );
}

function actions(main, report) {
  const path = report_path(report.id);
  return [
    use_again(report),
    el("a", { class: "button", href: path }, "report.json"),
    el("a", { class: "button", href: `${path}/report.html` }, "report.html"),
    el("a", { class: "button", href: `${path}/junit.xml` }, "junit.xml"),
    delete_button(
      main,
      report,
      "Delete",
      `Delete the report “${report.spec?.title || report.id}”? This cannot be undone.`,
    ),
  ];
}

/** How a comparison ended that was not done. */
function ended_text({ status, error }) {
  return status === "cancelled" ? "This comparison was cancelled." : `Rendering failed: ${error_text(error)}`;
}

async function show_settled(main, report) {
  document.title = `${report.spec?.title || "Report"} – Sheer`;
  // What a job that ended early has finished is shown as well.
  const is_done = report.status === "done";
  if (is_done || report.runs?.length > 0) {
    // Without the descriptions the report is there all the same, only with fewer captions.
    const [methods, metrics] = await Promise.all([get_methods().catch(() => []), get_metrics().catch(() => [])]);
    set_children(
      main,
      is_done || report.error ? null : message("info", ended_text(report)),
      report_view(report, {
        picture_url: (image) => image.url,
        methods,
        metrics,
        actions: actions(main, report),
        load_pixel: (place, signal) => get_pixel(report.id, place, signal),
      }),
    );
    return;
  }
  set_children(
    main,
    el("h1", {}, report.spec?.title || "Untitled comparison"),
    message(report.status === "cancelled" ? "info" : "error", ended_text(report)),
    el(
      "div",
      { class: "actions" },
      use_again(report),
      delete_button(main, report, "Delete", "Delete this report? This cannot be undone."),
    ),
  );
}

function show_progress(main, report, signal) {
  const bar = el("progress", { max: "1", value: report.progress ?? 0, "aria-label": "Progress" });
  const stage = el(
    "p",
    { class: "stage-text", role: "status" },
    report.status === "queued" ? "Waiting for a worker" : "Rendering",
  );
  const percent = el("span", { class: "percent" });
  const update = ({ progress, stage: text, status }) => {
    if (typeof progress === "number") {
      bar.value = progress;
      percent.textContent = `${Math.round(progress * 100)} %`;
    }
    const said = text || (status === "queued" ? "Waiting for a worker" : "Rendering");
    if (said !== stage.textContent) stage.textContent = said;
  };
  update(report);
  const cancel = el(
    "button",
    {
      type: "button",
      class: "danger",
      onclick: async () => {
        cancel.disabled = true;
        try {
          await delete_report(report.id);
        } catch (error) {
          cancel.disabled = false;
          stage.textContent = error.message;
        }
      },
    },
    "Cancel",
  );
  const methods = (report.spec?.methods ?? []).map((method) => method.label ?? method.id ?? method).join(", ");
  document.title = "Rendering – Sheer";
  set_children(
    main,
    el(
      "section",
      { class: "progress-card", "aria-label": "Progress" },
      el("h1", {}, report.spec?.title || "Untitled comparison"),
      el("p", { class: "muted" }, [scene_text(report.spec?.scene), methods].filter(Boolean).join(" — ")),
      el("div", { class: "progress-line" }, bar, percent),
      stage,
      el("div", { class: "actions" }, cancel),
    ),
  );
  const stop = follow(report.id, update, () => {
    if (!signal.aborted) show_report(main, signal, report.id);
  });
  signal.addEventListener("abort", stop);
}

export async function show_report(main, signal, id) {
  if (!main.firstChild) set_children(main, message("info", "Loading the report…"));
  let report;
  try {
    report = await get_report(id, signal);
  } catch (error) {
    if (signal.aborted) return;
    document.title = "Sheer";
    set_children(
      main,
      el("h1", {}, error.status === 404 ? "No such report" : "The report could not be loaded"),
      message("error", error.status === 404 ? "It may have been deleted." : error.message),
      el("p", {}, el("a", { href: "#/reports" }, "All reports")),
    );
    return;
  }
  if (signal.aborted) return;
  if (UNSETTLED.includes(report.status)) show_progress(main, report, signal);
  else await show_settled(main, report);
}
