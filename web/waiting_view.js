// A report that is queued or running: its place in the queue, how far it is, and how long it will take.
import { devices_text } from "./across_devices.js";
import { delete_report, follow, get_early_pictures, get_workers, list_reports } from "./api.js";
import { el, set_children } from "./dom.js";
import { note_list } from "./notes.js";
import { subject_text } from "./report_head.js";
import { point_text } from "./sweep.js";

const QUEUE_PAUSE_MS = 3000;
const MOST_LISTED = 100;
const EARLY_PAUSE_MS = 500;
const LEAST_PROGRESS = 0.05; // before that the rest cannot be estimated from it

const ORDINALS = { 1: "Next", 2: "2nd", 3: "3rd" };

/** "about 40 s", "about 4 min" */
function about(seconds) {
  if (seconds < 90) return `about ${Math.max(1, Math.round(seconds))} s`;
  return `about ${Math.round(seconds / 60)} min`;
}

/** Place among the queued reports, from 1, and how long recent reports took on average, in seconds; null if not known. */
async function queue_place(id, signal) {
  const [queued, done] = await Promise.all([
    list_reports({ status: "queued", limit: MOST_LISTED }, signal),
    list_reports({ status: "done", limit: 20 }, signal),
  ]);
  // Newest first, so those behind it in the list are before it in the queue.
  const index = queued.reports.findIndex((report) => report.id === id);
  const times = done.reports.map(
    ({ created_at, finished_at }) => (new Date(finished_at) - new Date(created_at)) / 1000,
  );
  const mean_s = times.length > 0 ? times.reduce((sum, time) => sum + time, 0) / times.length : null;
  return index < 0 ? null : { place: queued.reports.length - index, mean_s };
}

function queue_text({ place, mean_s }) {
  const name = place === 1 ? "Next in line" : `${ORDINALS[place] ?? `${place}th`} in line`;
  return mean_s === null ? name : `${name}, ${about(place * mean_s)}`;
}

function worker_line({ label, driver, report }) {
  return el(
    "li",
    {},
    el("span", { class: "where" }, label),
    el("span", {}, driver || "not known yet"),
    el("span", { class: "muted" }, report ? " busy" : " idle"),
  );
}

class Waiting {
  #report;
  #signal;
  #bar = el("progress", { max: "1", "aria-label": "Progress" });
  #percent = el("span", { class: "percent" });
  #devices = el("p", { class: "muted" });
  #stage = el("p", { class: "stage-text", role: "status" });
  #left = el("p", { class: "muted time-left" });
  #connection = el("p", { class: "notice warning", role: "alert", hidden: true }, "Connection lost, trying again…");
  #early = el("section", { class: "early", "aria-label": "Pictures so far", hidden: true });
  #workers = el("section", { class: "workers", "aria-label": "Workers", hidden: true });
  #early_urls = "";
  #began_at = null; // when rendering was first seen, and how far it was
  #began_progress = 0;
  #status;
  element;

  constructor(report, signal) {
    this.#report = report;
    this.#signal = signal;
    const methods = (report.spec?.methods ?? []).map((method) => method.label ?? method.id ?? method).join(", ");
    this.element = el(
      "section",
      { class: "progress-card", "aria-label": "Progress" },
      el("h1", {}, report.spec?.title || "Untitled comparison"),
      el("p", { class: "muted" }, [subject_text(report.spec), methods].filter(Boolean).join(" — ")),
      el("div", { class: "progress-line" }, this.#bar, this.#percent),
      this.#devices,
      this.#stage,
      this.#left,
      note_list(report.notes ?? []),
      this.#connection,
      el("div", { class: "actions" }, this.#cancel_button()),
      this.#early,
      this.#workers,
    );
    this.update(report);
    this.#watch_queue();
    this.#watch_pictures();
  }

  #cancel_button() {
    const button = el("button", { type: "button", class: "danger" }, "Cancel");
    button.addEventListener("click", async () => {
      button.disabled = true;
      try {
        await delete_report(this.#report.id);
      } catch (error) {
        button.disabled = false;
        this.#stage.textContent = error.message;
      }
    });
    return button;
  }

  update({ progress = 0, stage, status, devices }) {
    this.#status = status;
    this.#bar.value = progress;
    this.#percent.textContent = `${Math.round(progress * 100)} %`;
    const text = stage || (status === "queued" ? "Waiting for a worker" : "Rendering");
    if (text !== this.#stage.textContent) this.#stage.textContent = text;
    this.#devices.textContent = devices_text(devices);
    if (status === "running") this.#show_left(progress);
  }

  set is_connected(connected) {
    this.#connection.hidden = connected;
  }

  /** From the share that was done since this page first saw it running. */
  #show_left(progress) {
    const now = performance.now();
    if (this.#began_at === null) {
      this.#began_at = now;
      this.#began_progress = progress;
    }
    const done = progress - this.#began_progress;
    const seconds = ((now - this.#began_at) / 1000) * ((1 - progress) / done);
    this.#left.textContent = done >= LEAST_PROGRESS ? `${about(seconds)} left` : "";
  }

  /** The pictures are there before the times; those of the next point of a sweep replace them. */
  async #watch_pictures() {
    for (;;) {
      await new Promise((resolve) => setTimeout(resolve, EARLY_PAUSE_MS));
      if (this.#signal.aborted || !this.element.isConnected) return;
      if (this.#status !== "running") continue;
      try {
        this.#show_early(await get_early_pictures(this.#report.id, this.#signal));
      } catch {
        // The stream of events says whether the service can be reached.
      }
    }
  }

  #show_early({ point, pictures }) {
    const urls = pictures.map(({ url }) => url).join();
    if (urls === "" || urls === this.#early_urls) return;
    this.#early_urls = urls;
    this.#early.hidden = false;
    const at = point_text(point, this.#report.spec);
    set_children(
      this.#early,
      el(
        "h2",
        {},
        at ? `Pictures at ${at}; their times are being measured` : "Pictures; their times are being measured",
      ),
      el(
        "div",
        { class: "early-pictures" },
        pictures.map(({ label, url }) =>
          el("figure", {}, el("img", { src: url, alt: label }), el("figcaption", {}, label)),
        ),
      ),
    );
  }

  #show_workers(workers) {
    this.#workers.hidden = this.#status !== "queued";
    set_children(
      this.#workers,
      el("h2", {}, workers.length === 0 ? "No worker was seen lately" : "Workers"),
      el("ul", { class: "note-list" }, workers.map(worker_line)),
    );
  }

  async #watch_queue() {
    while (this.#status === "queued" && !this.#signal.aborted) {
      try {
        const place = await queue_place(this.#report.id, this.#signal);
        if (this.#status === "queued") this.#left.textContent = place ? queue_text(place) : "";
        this.#show_workers(await get_workers(this.#signal));
      } catch {
        // The stream of events says whether the service can be reached.
      }
      await new Promise((resolve) => setTimeout(resolve, QUEUE_PAUSE_MS));
    }
    this.#workers.hidden = true;
  }
}

/** Shows a queued or running report until it ends; then `on_end()`. */
export function show_waiting(main, signal, report, on_end) {
  document.title = "Rendering – Sheer";
  const waiting = new Waiting(report, signal);
  set_children(main, waiting.element);
  const stop = follow(report.id, {
    on_progress: (event) => waiting.update(event),
    on_connection: (connected) => {
      waiting.is_connected = connected;
    },
    on_end,
  });
  signal.addEventListener("abort", stop);
}
