// A report at #/reports/{id}: its progress while it is rendered, then the report itself.
import { AddressWriter } from "./address.js";
import { get_columns, get_methods, get_metrics, get_pixel, get_report } from "./api.js";
import { change_panel } from "./baselines_view.js";
import { el, set_children } from "./dom.js";
import { when } from "./format.js";
import { delete_button, edit_button, report_actions, run_again, run_again_button } from "./report_actions.js";
import { error_text, scene_text } from "./report_head.js";

const UNSETTLED = ["queued", "running"];

function message(kind, text) {
  return el("p", { class: `notice ${kind}`, role: kind === "error" ? "alert" : "status" }, text);
}

/** How a comparison ended that was not completed. */
function ended_text({ status, error }) {
  return status === "cancelled" ? "This comparison was cancelled." : `Rendering failed: ${error_text(error)}`;
}

async function show_settled(main, signal, report, { view_module, descriptions }, { query, on_query }) {
  document.title = `${report.spec?.title || "Report"} – Sheer`;
  // The finished parts of a job that ended early are shown as well.
  const is_done = report.status === "done";
  if (is_done || report.runs?.length > 0) {
    const [module, [methods, metrics, columns]] = await Promise.all([view_module, descriptions]);
    if (signal.aborted) return;
    if (!module) {
      set_children(main, message("error", "A part of the page could not be loaded: reload to try again."));
      return;
    }
    const address = new AddressWriter(signal);
    const fail = (error) => main.prepend(message("error", error.message));
    const seen = []; // the pixels that were explained
    const save = async (tell) => {
      const { save_with_pixels } = await import("./report_file.js");
      await save_with_pixels(report, view.run, seen, tell);
    };
    const view = module.report_view(report, {
      picture_url: (image) => image.url,
      methods,
      metrics: metrics ?? [],
      columns: columns ?? [],
      actions: report_actions(report, { link: () => address.href, save }, fail),
      on_rounds: (rounds) => run_again({ ...report.spec, timing: { ...report.spec.timing, rounds } }).catch(fail),
      load_pixel: async (place, signal) => {
        const pixel = await get_pixel(report.id, place, signal);
        seen.push({ ...place, pixel });
        return pixel;
      },
      query,
      on_query: (shown, is_step) => address.write(shown, is_step),
    });
    on_query((next) => view.show(next));
    set_children(
      main,
      metrics && columns
        ? null
        : message("error", "The descriptions of the columns could not be loaded: reload to see all tables."),
      is_done || report.error ? null : message("info", ended_text(report)),
      change_panel(report, signal),
      view.element,
    );
    return;
  }
  set_children(main, ended_page(main, report));
}

/** A report of which nothing was finished: what happened, what was asked for, what can be done. */
function ended_page(main, report) {
  const fail = (error) => main.prepend(message("error", error.message));
  const was_cancelled = report.status === "cancelled";
  return el(
    "section",
    { class: "plain-page" },
    el("h1", {}, report.spec?.title || "Untitled comparison"),
    el("p", { class: "muted" }, [scene_text(report.spec?.scene), when(report.finished_at)].filter(Boolean).join(" · ")),
    message(was_cancelled ? "info" : "error", ended_text(report)),
    el(
      "p",
      {},
      was_cancelled
        ? "Nothing was finished before that. Run it again, or change it first."
        : "The message tells what to change. If it tells of the service, run the comparison again.",
    ),
    el(
      "div",
      { class: "actions" },
      run_again_button(report, fail),
      edit_button(report),
      delete_button(report, fail),
      el("a", { class: "button", href: "#/reports" }, "All reports"),
    ),
    el(
      "details",
      {},
      el("summary", {}, "Its spec"),
      el("pre", { tabindex: "0", "aria-label": "Spec as JSON" }, JSON.stringify(report.spec, null, 2)),
    ),
  );
}

/** Without the descriptions a report is still shown, but with fewer captions and without differences. */
function load_descriptions() {
  return Promise.all([get_methods().catch(() => []), get_metrics().catch(() => null), get_columns().catch(() => null)]);
}

/** `context`: {parts: [id], query, on_query}, see app.js. */
export async function show_report(main, signal, context) {
  const [id] = context.parts;
  if (!main.firstChild) set_children(main, message("info", "Loading the report…"));
  // All at once: the view's modules import each other over many steps, each of which waits for the one before.
  const view_module = import("./report_view.js").catch(() => null);
  const parts = { view_module, descriptions: load_descriptions() };
  let report;
  try {
    report = await get_report(id, signal);
  } catch (error) {
    if (signal.aborted) return;
    document.title = "Sheer";
    set_children(
      main,
      el(
        "section",
        { class: "plain-page" },
        el("h1", {}, error.status === 404 ? "No such report" : "The report could not be loaded"),
        message("error", error.status === 404 ? "It may have been deleted." : error.message),
        el(
          "div",
          { class: "actions" },
          error.status === 404
            ? null
            : el("button", { type: "button", onclick: () => show_report(main, signal, context) }, "Try again"),
          el("a", { class: "button", href: "#/reports" }, "All reports"),
          el("a", { class: "button", href: "#/" }, "Start"),
        ),
      ),
    );
    return;
  }
  if (signal.aborted) return;
  if (UNSETTLED.includes(report.status)) {
    const { show_waiting } = await import("./waiting_view.js");
    if (signal.aborted) return;
    show_waiting(main, signal, report, () => {
      if (!signal.aborted) show_report(main, signal, context);
    });
  } else await show_settled(main, signal, report, parts, context);
}
