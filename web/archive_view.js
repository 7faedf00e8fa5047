// The archive at #/reports: a table of all reports, newest first, with filters, live rows, and the choice of two to compare.
import { AddressWriter } from "./address.js";
import { get_methods, get_scenes, list_reports } from "./api.js";
import { ArchiveChoice } from "./archive_choice.js";
import { archive_row } from "./archive_row.js";
import { el, select, set_children } from "./dom.js";
import { integer } from "./format.js";

const PAGE_SIZE = 100;
const TYPING_PAUSE_MS = 250;
const LIVE_PAUSE_MS = 2000;
const STATUSES = ["done", "running", "queued", "failed", "cancelled"];
const FILTERS = { q: "", status: "Status", scene: "Scene", method: "Method", device: "Device" };
const HEADS = ["", "", "Comparison", "Scene", "Methods", "Verdict", "Device", "Date", ""];

function day_of(entry, now = new Date()) {
  const date = new Date(entry.created_at);
  const days = Math.round((new Date(now.toDateString()) - new Date(date.toDateString())) / 86_400_000);
  if (days <= 0) return "Today";
  if (days === 1) return "Yesterday";
  return date.toLocaleDateString("en-GB", { weekday: "long", day: "numeric", month: "long", year: "numeric" });
}

const is_unsettled = ({ status }) => status === "queued" || status === "running";

class Archive {
  #signal;
  #address;
  #query = {};
  #entries = [];
  #cursor = null;
  #request = null;
  #choice;
  #body = el("tbody", { "aria-label": "Reports" });
  #note = el("p", { class: "muted", role: "status" });
  #chips = el("div", { class: "filter-chips" });
  #more = el("button", { type: "button", hidden: true, onclick: () => this.#load(false) }, "Load more");
  #search;
  #selects;
  element;

  constructor(signal, query, { scenes, methods }) {
    this.#signal = signal;
    this.#address = new AddressWriter(signal);
    this.#choice = new ArchiveChoice((query.choose ?? "").split(",").filter(Boolean), () => this.#write(false));
    let typing = null;
    this.#search = el("input", {
      type: "search",
      "aria-label": "Search reports",
      placeholder: "Search titles and tags",
      oninput: () => {
        clearTimeout(typing);
        typing = setTimeout(() => this.#filter({ q: this.#search.value.trim() }, false), TYPING_PAUSE_MS);
      },
    });
    const choose = (name, choices) =>
      select(
        { "aria-label": FILTERS[name], onchange: (event) => this.#filter({ [name]: event.target.value }, true) },
        [["", `Any ${FILTERS[name].toLowerCase()}`], ...choices],
        "",
      );
    this.#selects = {
      status: choose(
        "status",
        STATUSES.map((status) => [status, status]),
      ),
      scene: choose(
        "scene",
        scenes.map(({ id, name }) => [id, name]),
      ),
      method: choose(
        "method",
        methods.map(({ id }) => [id, id]),
      ),
    };
    this.element = el(
      "div",
      { class: "archive" },
      el("h1", {}, "Reports"),
      el("div", { class: "filters", role: "search" }, this.#search, Object.values(this.#selects)),
      this.#chips,
      this.#choice.element,
      this.#note,
      el(
        "div",
        { class: "table-box", tabindex: "0", role: "region", "aria-label": "Table of reports" },
        el(
          "table",
          { class: "archive-table" },
          el(
            "thead",
            {},
            el(
              "tr",
              {},
              HEADS.map((head) => (head ? el("th", { scope: "col" }, head) : el("td"))),
            ),
          ),
          this.#body,
        ),
      ),
      this.#more,
    );
    this.take(query);
    this.#keep_live();
  }

  /** Shows what an address says. */
  take(query) {
    this.#query = Object.fromEntries(Object.keys(FILTERS).map((name) => [name, query[name] ?? ""]));
    this.#search.value = this.#query.q;
    for (const [name, control] of Object.entries(this.#selects)) control.value = this.#query[name];
    this.#load(true);
  }

  #filter(change, is_step) {
    this.#query = { ...this.#query, ...change };
    this.#write(is_step);
    this.take(this.#query);
  }

  #write(is_step) {
    const choose = this.#choice.ids.join();
    const filled = Object.entries({ ...this.#query, choose }).filter(([, value]) => value);
    this.#address.write(Object.fromEntries(filled), is_step);
  }

  async #load(from_start) {
    this.#request?.abort();
    const mine = (this.#request = new AbortController());
    this.#signal.addEventListener("abort", () => mine.abort(), { once: true });
    this.#draw_chips();
    try {
      const cursor = from_start ? "" : this.#cursor;
      const page = await list_reports({ ...this.#query, limit: PAGE_SIZE, cursor }, mine.signal);
      if (mine.signal.aborted) return;
      this.#entries = from_start ? page.reports : [...this.#entries, ...page.reports];
      this.#cursor = page.next_cursor ?? null;
      this.#more.hidden = !this.#cursor;
      this.#choice.learn(page.reports);
      this.#draw();
      this.#say_count(page);
    } catch (error) {
      if (!mine.signal.aborted) this.#fail(error);
    }
  }

  #say_count({ count, count_is_exact }) {
    const is_filtered = Object.values(this.#query).some(Boolean);
    const some = `${count_is_exact ? "" : "More than "}${integer(count)} ${count === 1 ? "report" : "reports"}${is_filtered ? " match" : ""}`;
    set_children(
      this.#note,
      count > 0
        ? some
        : is_filtered
          ? "No report matches."
          : ["No reports yet. ", el("a", { href: "#/" }, "Start with a ready comparison"), "."],
    );
  }

  #fail(error) {
    const text = error.status === 0 ? "Connection lost, trying again…" : error.message;
    set_children(this.#note, el("span", { class: "error-text" }, text));
  }

  #draw_chips() {
    const active = Object.entries(this.#query).filter(([, value]) => value);
    set_children(
      this.#chips,
      active.map(([name, value]) =>
        el(
          "button",
          {
            type: "button",
            class: "small filter-chip",
            "aria-label": `Remove the filter ${value}`,
            onclick: () => this.#filter({ [name]: "" }, true),
          },
          `${FILTERS[name] ? `${FILTERS[name].toLowerCase()}: ` : ""}${value} ×`,
        ),
      ),
    );
  }

  #row(entry) {
    return archive_row(entry, {
      box: this.#choice.box(entry),
      on_filter: (change) => this.#filter(change, true),
      on_gone: (node) => this.#remove(entry, node),
      on_error: (error) => this.#fail(error),
    });
  }

  #draw() {
    let day = null;
    set_children(
      this.#body,
      this.#entries.map((entry) => {
        const this_day = day_of(entry);
        const heads_day = this_day !== day;
        day = this_day;
        return [
          heads_day ? el("tr", { class: "day" }, el("th", { colspan: HEADS.length, scope: "rowgroup" }, day)) : null,
          this.#row(entry),
        ];
      }),
    );
  }

  #remove(entry, node) {
    const neighbour = node.nextElementSibling ?? node.previousElementSibling;
    this.#choice.drop(entry.id);
    this.#entries = this.#entries.filter(({ id }) => id !== entry.id);
    node.remove();
    this.#note.textContent = "Deleted.";
    neighbour?.querySelector("a")?.focus();
    if (this.#entries.length === 0) this.#load(true);
  }

  /** Rows of queued and running reports are renewed until they have ended; also after the connection was lost. */
  async #keep_live() {
    while (!this.#signal.aborted) {
      await new Promise((resolve) => setTimeout(resolve, LIVE_PAUSE_MS));
      const was_lost = this.#note.querySelector(".error-text") !== null;
      if (this.#signal.aborted || !(was_lost || this.#entries.some(is_unsettled))) continue;
      try {
        const page = await list_reports({ ...this.#query, limit: PAGE_SIZE }, this.#signal);
        this.#renew(page.reports);
        if (was_lost) this.#say_count(page);
      } catch (error) {
        if (!this.#signal.aborted) this.#fail(error);
      }
    }
  }

  #renew(reports) {
    const known = new Set(this.#entries.map(({ id }) => id));
    const by_id = new Map(reports.map((entry) => [entry.id, entry]));
    this.#choice.learn(reports);
    if (reports.some(({ id }) => !known.has(id))) {
      this.#entries = [...reports, ...this.#entries.filter(({ id }) => !by_id.has(id))];
      this.#draw();
      return;
    }
    this.#entries = this.#entries.map((entry) => {
      const now = by_id.get(entry.id) ?? entry;
      if (now.status !== entry.status || now.progress !== entry.progress)
        this.#body.querySelector(`[data-id="${CSS.escape(entry.id)}"]`)?.replaceWith(this.#row(now));
      return now;
    });
  }
}

export async function show_archive(main, signal, { query, on_query }) {
  document.title = "Reports – Sheer";
  const none = () => [];
  const [scenes, methods] = await Promise.all([get_scenes().catch(none), get_methods().catch(none)]);
  if (signal.aborted) return;
  const archive = new Archive(signal, query, { scenes, methods });
  set_children(main, archive.element);
  on_query((next) => archive.take(next));
}
