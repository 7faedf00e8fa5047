// The archive at #/reports: newest first, with search, filter and deletion.
import { delete_report, list_reports } from "./api.js";
import { el, select, set_children } from "./dom.js";
import { ago, short_value, when } from "./format.js";

const PAGE_SIZE = 20;
const TYPING_PAUSE_MS = 250;
const STATUSES = [
  ["", "Any status"],
  ["done", "Done"],
  ["running", "Running"],
  ["queued", "Queued"],
  ["failed", "Failed"],
  ["cancelled", "Cancelled"],
];

function thumbnail(entry) {
  const url = entry.preview?.url;
  return el(
    "div",
    { class: "thumb" },
    typeof url === "string" ? el("img", { src: url, alt: "", loading: "lazy", decoding: "async" }) : null,
  );
}

function method_names(entry) {
  return (entry.methods ?? []).map((method) => method.label ?? method.id ?? method).join(", ");
}

/** Which two reports to hold against each other: chosen in the list, the older one is A. */
class Choice {
  #chosen = new Map();
  #text = el("span", { class: "muted", role: "status" });
  #button = el(
    "button",
    {
      type: "button",
      onclick: () => {
        const [before, after] = [...this.#chosen.values()].sort((a, b) => (a.created_at < b.created_at ? -1 : 1));
        location.hash = `#/diff/${encodeURIComponent(before.id)}/${encodeURIComponent(after.id)}`;
      },
    },
    "Compare",
  );
  element = el("div", { class: "choose-bar" }, this.#button, this.#text);

  constructor() {
    this.#show();
  }

  box(entry) {
    return el("input", {
      type: "checkbox",
      "aria-label": `Choose ${entry.title || "Untitled comparison"} to compare`,
      disabled: entry.status !== "done",
      checked: this.#chosen.has(entry.id),
      onchange: (event) => {
        if (event.target.checked) this.#chosen.set(entry.id, entry);
        else this.#chosen.delete(entry.id);
        this.#show();
      },
    });
  }

  drop(id) {
    this.#chosen.delete(id);
    this.#show();
  }

  #show() {
    const count = this.#chosen.size;
    this.#button.disabled = count !== 2;
    this.#text.textContent =
      count === 2
        ? "Two reports are chosen."
        : `Choose two done reports of one spec to see what changed; ${count} chosen.`;
  }
}

function row(entry, choice, on_deleted, on_error) {
  const title = entry.title || "Untitled comparison";
  const remove = el(
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
          choice.drop(entry.id);
          on_deleted(node, unsettled);
        } catch (error) {
          on_error(error);
        }
      },
    },
    "Delete",
  );
  const node = el(
    "li",
    { class: "entry", "data-id": entry.id },
    choice.box(entry),
    thumbnail(entry),
    el(
      "div",
      { class: "entry-text" },
      el("a", { class: "entry-title", href: `#/reports/${encodeURIComponent(entry.id)}` }, title),
      el("p", { class: "muted" }, [entry.scene?.type ?? entry.scene, method_names(entry)].filter(Boolean).join(" — ")),
      el(
        "p",
        { class: "entry-tags" },
        Object.entries(entry.tags ?? {}).map(([name, value]) =>
          el("span", { class: "chip tag" }, `${name}: ${short_value(value)}`),
        ),
      ),
    ),
    el(
      "div",
      { class: "entry-state" },
      el("span", { class: `status ${entry.status}` }, entry.status),
      entry.verdict && entry.verdict !== "none"
        ? el("span", { class: `verdict small ${entry.verdict}` }, `checks ${entry.verdict}`)
        : null,
      el("time", { class: "muted", datetime: entry.created_at, title: when(entry.created_at) }, ago(entry.created_at)),
    ),
    remove,
  );
  return node;
}

export function show_archive(main, signal) {
  document.title = "Reports – Sheer";
  const query = { q: "", status: "" };
  const list = el("ul", { class: "entries", "aria-label": "Reports" });
  const note = el("p", { class: "muted", role: "status" });
  const choice = new Choice();
  const more = el("button", { type: "button", hidden: true, onclick: () => load(false) }, "Load more");
  let cursor = null;
  let request = null;

  const on_error = (error) => set_children(note, el("span", { class: "error-text" }, error.message));
  const on_deleted = (node, unsettled) => {
    const neighbour = node.nextElementSibling ?? node.previousElementSibling;
    if (unsettled) {
      load(true);
      return;
    }
    node.remove();
    note.textContent = "Deleted.";
    (neighbour?.querySelector("a") ?? main).focus();
    if (list.children.length === 0) load(true);
  };

  async function load(from_start) {
    request?.abort();
    request = new AbortController();
    const mine = request;
    signal.addEventListener("abort", () => mine.abort(), { once: true });
    try {
      const page = await list_reports({ ...query, limit: PAGE_SIZE, cursor: from_start ? "" : cursor }, mine.signal);
      if (mine.signal.aborted) return;
      if (from_start) list.replaceChildren();
      list.append(...page.reports.map((entry) => row(entry, choice, on_deleted, on_error)));
      cursor = page.next_cursor ?? null;
      more.hidden = !cursor;
      note.textContent =
        list.children.length > 0 ? "" : query.q || query.status ? "No report matches." : "No reports yet.";
    } catch (error) {
      if (!mine.signal.aborted) on_error(error);
    }
  }

  let typing = null;
  const search = el("input", {
    type: "search",
    "aria-label": "Search reports",
    placeholder: "Search titles and tags",
    oninput: () => {
      clearTimeout(typing);
      typing = setTimeout(() => {
        query.q = search.value.trim();
        load(true);
      }, TYPING_PAUSE_MS);
    },
  });
  const status = select(
    {
      "aria-label": "Status",
      onchange: (event) => {
        query.status = event.target.value;
        load(true);
      },
    },
    STATUSES,
    "",
  );
  set_children(
    main,
    el("h1", {}, "Reports"),
    el("div", { class: "filters", role: "search" }, search, status),
    choice.element,
    note,
    list,
    el("div", { class: "more" }, more),
  );
  load(true);
}
