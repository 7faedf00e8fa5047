// A row of the archive's table.
import { delete_report } from "./api.js";
import { el } from "./dom.js";
import { ago, short_value, when, words } from "./format.js";

function thumbnail(entry) {
  const url = entry.preview?.url;
  return el(
    "div",
    { class: "thumb" },
    typeof url === "string" ? el("img", { src: url, alt: "", loading: "lazy", decoding: "async" }) : null,
  );
}

/** A renderer's name without what follows in brackets: "llvmpipe (LLVM 15.0.6, 256 bits)" is llvmpipe. */
const short_device = (name) => name.replace(/[ /]*\(.*$/, "") || name;

function verdict_cell(entry) {
  const { status, verdict, progress } = entry;
  return [
    status === "done" ? null : el("span", { class: `status ${status}` }, status),
    status === "running" ? ` ${Math.round(progress * 100)} %` : null,
    status === "done" && verdict && verdict !== "none"
      ? el("span", { class: `verdict small ${verdict}` }, `checks ${verdict}`)
      : null,
    status === "done" && (!verdict || verdict === "none") ? el("span", { class: "muted" }, "no checks") : null,
  ];
}

function delete_button(entry, title, node, { on_gone, on_error }) {
  return el(
    "button",
    {
      type: "button",
      class: "quiet danger",
      "aria-label": `Delete ${title}`,
      onclick: async () => {
        const unsettled = entry.status === "queued" || entry.status === "running";
        if (!window.confirm(unsettled ? `Cancel “${title}”?` : `Delete “${title}”? This cannot be undone.`)) return;
        try {
          await delete_report(entry.id);
          if (!unsettled) on_gone(node);
        } catch (error) {
          on_error(error);
        }
      },
    },
    entry.status === "queued" || entry.status === "running" ? "Cancel" : "Delete",
  );
}

/** `box`: the box that chooses it; `on_filter(change)`, `on_gone(node)` after its deletion, `on_error(error)`. */
export function archive_row(entry, { box, on_filter, on_gone, on_error }) {
  const title = entry.title || "Untitled comparison";
  const filter = (name, value, text) =>
    el(
      "button",
      { type: "button", class: "link", title: `Only with ${text}`, onclick: () => on_filter({ [name]: value }) },
      text,
    );
  const node = el("tr", { class: "entry", "data-id": entry.id });
  node.append(
    el("td", {}, box),
    el("td", {}, thumbnail(entry)),
    el(
      "th",
      { scope: "row" },
      el("a", { class: "entry-title", href: `#/reports/${encodeURIComponent(entry.id)}` }, title),
      el(
        "span",
        { class: "entry-tags" },
        entry.pinned ? el("span", { class: "chip", title: "Neither deleted nor pruned" }, "pinned") : null,
        Object.entries(entry.tags ?? {}).map(([name, value]) =>
          el("span", { class: "chip tag" }, `${name}: ${short_value(value)}`),
        ),
      ),
    ),
    el("td", {}, entry.scene ? filter("scene", entry.scene, words(entry.scene)) : null),
    el(
      "td",
      { class: "entry-methods" },
      (entry.methods ?? []).flatMap((method, index) => [index > 0 ? ", " : null, filter("method", method, method)]),
    ),
    el("td", {}, ...verdict_cell(entry).filter(Boolean)),
    el(
      "td",
      { class: "entry-device" },
      entry.device ? filter("device", entry.device, short_device(entry.device)) : null,
    ),
    el("td", {}, el("time", { datetime: entry.created_at, title: when(entry.created_at) }, ago(entry.created_at))),
    el("td", {}, delete_button(entry, title, node, { on_gone, on_error })),
  );
  return node;
}
