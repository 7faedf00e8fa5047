// What can be done with a report: run it again, change it, copy it elsewhere, delete it.
import { delete_report, report_path, submit } from "./api.js";
import { accept_button } from "./baselines_view.js";
import { el } from "./dom.js";
import { copy_button, menu } from "./menu.js";
import { keep_draft, may_replace_draft } from "./spec_model.js";

/** Queues a spec and opens its report. */
export async function run_again(spec) {
  const id = await submit(spec);
  location.hash = `#/reports/${encodeURIComponent(id)}`;
}

export function run_again_button(report, on_error) {
  return el("button", { type: "button", onclick: () => run_again(report.spec).catch(on_error) }, "Run again");
}

export function edit_button(report) {
  return el(
    "button",
    {
      type: "button",
      onclick: () => {
        if (!may_replace_draft()) return;
        keep_draft(report.spec);
        location.hash = "#/new";
      },
    },
    "Edit and run",
  );
}

export function delete_button(report, on_error) {
  const question = `Delete the report “${report.spec?.title || report.id}”? This cannot be undone.`;
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
          on_error(error);
        }
      },
    },
    "Delete",
  );
}

/** A text as one word of a POSIX shell. */
function shell_word(text) {
  return `'${text.replaceAll("'", `'\\''`)}'`;
}

function curl_command(spec) {
  const url = new URL("api/v1/reports", document.baseURI).href;
  return `curl -i -H 'Content-Type: application/json' -d ${shell_word(JSON.stringify(spec))} ${url}`;
}

function sheer_command(spec) {
  return `printf %s ${shell_word(JSON.stringify(spec))} > spec.json && sheer compare spec.json --out report`;
}

/** `save(tell)` saves the file, and calls `tell(text)` as it goes on. */
function pixels_button(save, on_error) {
  const name = "report.html with pixels explained";
  const button = el("button", { type: "button", class: "stays-open", title: "The worst pixel of each method" }, name);
  button.addEventListener("click", async () => {
    button.disabled = true;
    try {
      await save((text) => {
        button.textContent = text;
      });
    } catch (error) {
      on_error(error);
    }
    button.textContent = name;
    button.disabled = false;
  });
  return button;
}

/** The buttons of a finished report; `link()` is the address of what is shown, `save(tell)` saves its file with pixels. */
export function report_actions(report, { link, save }, on_error) {
  const path = report_path(report.id);
  const file = (name) => el("a", { class: "button", href: `${path}/${name}` }, name);
  return [
    run_again_button(report, on_error),
    edit_button(report),
    el("a", { class: "button", href: `#/trends/${encodeURIComponent(report.spec_sha256)}` }, "Trend of this spec"),
    copy_button("Copy link", link),
    menu("⋯", "More", [
      el("a", { class: "button", href: path }, "report.json"),
      file("report.html"),
      report.status === "done" ? pixels_button(save, on_error) : null,
      file("junit.xml"),
      copy_button("Copy as curl", () => curl_command(report.spec)),
      copy_button("Copy as sheer command", () => sheer_command(report.spec)),
      report.status === "done" ? accept_button(report) : null,
      delete_button(report, on_error),
    ]),
  ];
}
