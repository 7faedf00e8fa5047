// Baselines: the accepted reports with which others are compared. The list at #/baselines, the form that accepts a
// report, and what changed in a report that was compared with one.
import { accept_report, forget_baseline, get_baselines, get_diff } from "./api.js";
import { el, set_children, unique_id } from "./dom.js";
import { fixed, when } from "./format.js";
import { point_text } from "./sweep.js";

const report_address = (id) => `#/reports/${encodeURIComponent(id)}`;

function message(kind, text) {
  return el("p", { class: `notice ${kind}`, role: kind === "error" ? "alert" : "status" }, text);
}

/** `on_forget(name, id)`: without an id the whole baseline. */
function baseline_section({ name, reports }, on_forget) {
  const row = (one) =>
    el(
      "tr",
      {},
      el("th", { scope: "row" }, el("a", { href: report_address(one.report) }, one.title || one.report)),
      el("td", {}, when(one.accepted_at)),
      el("td", {}, one.by || "–"),
      el("td", {}, one.reason || "–"),
      el("td", {}, one.device || "–"),
      el(
        "td",
        {},
        el(
          "button",
          {
            type: "button",
            "aria-label": `Forget ${one.title || one.report}`,
            onclick: () => on_forget(name, one.report),
          },
          "Forget",
        ),
      ),
    );
  return el(
    "section",
    { class: "baseline", "data-name": name },
    el("h2", {}, name),
    el(
      "div",
      { class: "table-scroll", tabindex: 0, role: "region", "aria-label": `Accepted reports of ${name}` },
      el(
        "table",
        { class: "baseline-table" },
        el(
          "thead",
          {},
          el(
            "tr",
            {},
            ["Report", "Accepted", "By", "Why", "Device", ""].map((text) =>
              text ? el("th", { scope: "col" }, text) : el("td"),
            ),
          ),
        ),
        el("tbody", {}, reports.map(row)),
      ),
    ),
    el(
      "div",
      { class: "actions" },
      el("button", { type: "button", class: "danger", onclick: () => on_forget(name, null) }, `Forget all of ${name}`),
    ),
  );
}

export async function show_baselines(main, signal) {
  document.title = "Baselines – Sheer";
  const list = el("div", {}, message("info", "Loading the baselines…"));
  const show = async () => {
    try {
      const baselines = await get_baselines(signal);
      const sections = baselines.map((one) => baseline_section(one, forget));
      set_children(list, sections.length > 0 ? sections : message("info", "No report is accepted yet."));
    } catch (error) {
      if (!signal.aborted) set_children(list, message("error", error.message));
    }
  };
  const forget = async (name, id) => {
    const what = id ? `this report of ${name}` : `the baseline ${name}`;
    if (!window.confirm(`Forget ${what}? The reports themselves stay.`)) return;
    try {
      await forget_baseline(name, id);
      await show();
    } catch (error) {
      list.prepend(message("error", error.message));
    }
  };
  set_children(
    main,
    el(
      "div",
      { class: "baselines" },
      el("h1", {}, "Baselines"),
      el(
        "p",
        { class: "muted" },
        "Accepted reports, with which a report is compared if its spec says ",
        el("code", {}, '"against": "baseline:NAME"'),
        ". Accept one from its own page, in the menu ⋯.",
      ),
      list,
    ),
  );
  await show();
}

/** A button that asks for a name and a reason, and accepts the report. */
export function accept_button(report) {
  const state = el("p", { role: "status", class: "error-text" });
  const input = (label, properties) => {
    const id = unique_id("accept");
    return el(
      "div",
      { class: "field" },
      el("label", { for: id }, label),
      el("input", { id, maxlength: 200, ...properties }),
    );
  };
  const dialog = el(
    "dialog",
    { class: "accept-dialog", "aria-label": "Accept as baseline" },
    el(
      "form",
      {
        method: "dialog",
        onsubmit: async (event) => {
          event.preventDefault();
          const { name, by, reason } = Object.fromEntries(new FormData(event.target));
          try {
            await accept_report(name, { report: report.id, by, reason });
            dialog.close();
            location.hash = "#/baselines";
          } catch (error) {
            state.textContent = error.message;
          }
        },
      },
      el("h2", {}, "Accept as baseline"),
      input("Name", { name: "name", value: "main", required: true }),
      input("Accepted by", { name: "by", autocomplete: "name" }),
      input("Why", { name: "reason" }),
      state,
      el(
        "div",
        { class: "actions" },
        el("button", { type: "submit" }, "Accept"),
        el("button", { type: "button", onclick: () => dialog.close() }, "Cancel"),
      ),
    ),
  );
  dialog.addEventListener("close", () => dialog.remove());
  return el(
    "button",
    {
      type: "button",
      onclick: () => {
        document.body.append(dialog);
        dialog.showModal();
      },
    },
    "Accept as baseline…",
  );
}

function result_text({ label, picture, time, status }) {
  const parts = [];
  if (status.a !== status.b) parts.push(`was ${status.a}, is ${status.b}`);
  if (picture?.verdict === "different") parts.push(`another picture, mean FLIP ${fixed(picture.flip.mean, 4)}`);
  const judged = time?.relative ?? time?.absolute;
  if (judged && time.verdict !== "not resolved") parts.push(`${time.verdict}, ${fixed(judged.value, 2)}× the speed`);
  return parts.length > 0 ? `${label}: ${parts.join("; ")}` : null;
}

function changes_of(runs) {
  return runs.flatMap((run) => {
    const where = point_text(run.point);
    return run.results
      .map(result_text)
      .filter(Boolean)
      .map((text) => (where ? `${where}: ${text}` : text));
  });
}

/** What changed since the report with which this one was compared, or null if it was compared with none. */
export function change_panel({ id, against, spec }, signal) {
  if (!against?.report) return null;
  const allow = spec?.under_test ?? [];
  const query = allow.length > 0 ? `?allow=${encodeURIComponent(allow.join())}` : "";
  const body = el("div", {}, el("p", { class: "muted" }, "Comparing…"));
  get_diff(against.report, id, { allow }, signal)
    .then(({ runs, differences }) => {
      const fields = differences.filter(({ allowed }) => allowed).map(({ pointer }) => pointer.slice(5));
      const changes = changes_of(runs);
      set_children(
        body,
        changes.length > 0
          ? el(
              "ul",
              {},
              changes.map((text) => el("li", {}, text)),
            )
          : el("p", {}, "No picture changed, and no time is resolved to have changed."),
        fields.length > 0 ? el("p", { class: "muted" }, `In the spec: ${fields.join(", ")}`) : null,
      );
    })
    .catch((error) => {
      if (!signal.aborted) set_children(body, el("p", { class: "error-text" }, error.message));
    });
  const before = encodeURIComponent(against.report);
  return el(
    "section",
    { class: "changed-panel", "aria-label": "What changed" },
    el("h2", {}, "What changed since the accepted report"),
    body,
    el(
      "p",
      {},
      el("a", { href: `#/diff/${before}/${encodeURIComponent(id)}${query}` }, "All of it, with both pictures"),
    ),
  );
}
