// A finished report as a part of a page. Both the served page and the self-contained file use it.
import { across_section } from "./across_devices.js";
import { AnswerCard } from "./answer_card.js";
import { changes_section, checks_section } from "./checks_view.js";
import { el, set_children } from "./dom.js";
import { is_number } from "./format.js";
import { frontier_section } from "./frontier_view.js";
import { ImageViewer } from "./image_viewer.js";
import { note_list } from "./notes.js";
import { PixelView } from "./pixel_view.js";
import { error_text, facts, reference_text, report_details, report_head } from "./report_head.js";
import { is_shown, kinds_of, sources_of } from "./report_pictures.js";
import { difference_table, fragment_table, timing_table } from "./result_tables.js";
import { suite_section } from "./suite_view.js";
import { SweepView } from "./sweep_view.js";

function notes_list(notes = []) {
  if (notes.length === 0) return null;
  return el(
    "section",
    { class: "notes", "aria-label": "Notes" },
    el("h2", {}, notes.length === 1 ? "Note" : `${notes.length} notes`),
    note_list(notes),
  );
}

const NO_PIXELS =
  " How a pixel is made is not in this file: the service's page of the report shows it, and saves files that explain some.";
const ENDINGS = { "image/png": "png", "image/x-exr": "exr" };

/** A link to every picture of a run, which saves it under a readable name. */
function picture_links(run, picture_url) {
  const files = [["reference", run.reference], ...run.results.map((result) => [result.label, result])]
    .flatMap(([label, owner]) => Object.entries(owner?.images ?? {}).map(([key, image]) => ({ label, key, image })))
    .map(({ label, key, image }) => ({
      name: `${label}-${key}.${ENDINGS[image.media_type] ?? "bin"}`.replaceAll(/[^\w.-]+/g, "-"),
      text: `${label} ${key}`,
      is_float: !is_shown(image),
      url: picture_url(image),
    }))
    .filter(({ url }) => url);
  if (files.length === 0) return null;
  return el(
    "details",
    { class: "files" },
    el("summary", {}, `Save pictures: ${files.length} files`),
    el(
      "ul",
      {},
      files.map(({ name, text, is_float, url }) =>
        el(
          "li",
          {},
          el("a", { href: url, download: name }, text),
          is_float ? el("span", { class: "muted" }, " floats") : null,
        ),
      ),
    ),
  );
}

/** Buttons for the pixels that the self-contained file explains in this run. */
function explained_pixels(explained, run, on_choose) {
  const here = explained.filter((one) => one.run === run);
  if (here.length === 0) return null;
  return el(
    "div",
    { class: "explained-pixels", role: "group", "aria-label": "Pixels explained in this file" },
    "Explained in this file:",
    here.map((one) =>
      el(
        "button",
        { type: "button", class: "small", onclick: () => on_choose(one) },
        `x ${one.x}, y ${one.y} (${one.why})`,
      ),
    ),
  );
}

function run_part(report, run, options) {
  const { methods, metrics, columns, picture_url, load_pixel, explained, on_change } = options;
  const index = report.runs.indexOf(run);
  const pixel = load_pixel ? new PixelView((x, y, signal) => load_pixel({ x, y, run: index }, signal)) : null;
  const show_explained = ({ x, y }) => {
    viewer.show_pixel(x, y);
    pixel.show(x, y);
  };
  const { width, height, background } = run_image(report, run);
  const viewer = new ImageViewer({
    width_px: width,
    height_px: height,
    background,
    sources: sources_of(run, picture_url),
    kinds: kinds_of(run, metrics),
    no_pick: NO_PIXELS,
    on_pick: pixel ? (x, y) => pixel.show(x, y) : null,
    below: pixel ? [explained_pixels(explained, index, show_explained), pixel.element] : [],
    on_change,
  });
  const context = {
    methods,
    metrics,
    columns,
    baseline: report.spec?.baseline,
    show_pixel: (x, y) => {
      viewer.show_pixel(x, y);
      const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
      viewer.element.scrollIntoView({ block: "nearest", behavior: calm ? "auto" : "smooth" });
    },
  };
  const times = timing_table(run, context);
  const fragments = fragment_table(run.results, context);
  const nodes = [
    report.runs.length > 1 ? facts([["Reference", reference_text(run)]]) : null,
    viewer.element,
    picture_links(run, picture_url),
    report.device?.software
      ? [fragments, frontier_section(run, metrics), times]
      : [frontier_section(run, metrics), times, fragments],
    difference_table(run.results, context, run.reference?.rounded),
  ];
  return { viewer, nodes };
}

/** A sweep may change the image. */
function run_image(report, run) {
  const image = report.spec?.image ?? {};
  const of_run = (name, usual) => run.point?.[`/image/${name}`] ?? image[name] ?? usual;
  return { width: of_run("width", 512), height: of_run("height", 512), background: of_run("background", [0, 0, 0]) };
}

/**
 * {element, show(query), run}: the report, a function that makes it show what an address says, and the number of the run that is
 * shown.
 *
 * `options`: `picture_url(image)` returns the address of an image object or null; `methods`, `metrics` and `columns`
 * are their descriptions (may be empty); `actions` are elements for the head; `load_pixel({x, y, run}, signal)` loads the
 * explanation of a pixel, `explained` are the places that have one if not all do, and `on_rounds(rounds)` repeats the comparison with more rounds: neither is offered without it. `query`: what to show first, as
 * texts; `on_query(query, is_step)` gets what is shown whenever it changes, with true for a step that "back" should undo.
 */
export function report_view(
  report,
  {
    picture_url,
    methods = [],
    metrics = [],
    columns = [],
    actions = [],
    load_pixel = null,
    explained = [],
    on_rounds = null,
    query = {},
    on_query = () => {},
  },
) {
  const runs = report.runs ?? [];
  const place = el("div", { class: "run" });
  let viewer = null;
  let shown = query; // what the next viewer begins with
  let run_index = 0;
  let restores = true; // while an address is taken over it is not written
  const tell = (is_step) => {
    if (restores || !viewer) return;
    shown = viewer.query;
    on_query({ ...(run_index > 0 ? { run: run_index } : {}), ...shown }, is_step);
  };
  const options = { picture_url, methods, metrics, columns, load_pixel, explained, on_change: tell };
  const answer = new AnswerCard({
    runs,
    methods,
    baseline: report.spec?.baseline,
    software: Boolean(report.device?.software),
    picture_url,
    on_show: (label) => viewer.compare_with(label),
    on_rounds,
  });
  const show = (run) => {
    answer.element.hidden = !run;
    if (!run) {
      set_children(place, el("p", { class: "notice" }, "This point has no results."));
      return;
    }
    answer.show(run);
    const part = run_part(report, run, options);
    const was_restoring = restores;
    restores = true;
    viewer = part.viewer;
    set_children(place, part.nodes);
    viewer.query = shown;
    restores = was_restoring;
    run_index = runs.indexOf(run);
    tell(true);
  };
  const first = Number(query.run ?? first_run(runs)) || 0;
  const sweep = runs.length > 1 ? new SweepView(report, options, show, runs[first] ?? runs[0]) : null;
  if (runs.length === 1) show(runs[0]);
  restores = false;
  const take = (next) => {
    restores = true;
    shown = next;
    const run = runs[Number(next.run ?? 0)] ?? runs[0];
    if (sweep && runs.indexOf(run) !== run_index) sweep.choose_run(run);
    else if (viewer) viewer.query = next;
    restores = false;
  };
  const element = el(
    "article",
    { class: "report", "aria-label": "Report" },
    report_head(report, actions),
    report.error ? el("p", { class: "notice error", role: "alert" }, error_text(report.error)) : null,
    runs.length > 0 ? answer.element : null,
    notes_list(report.notes),
    checks_section(report),
    runs.length === 1 ? changes_section(runs[0]) : null,
    suite_section(report, options),
    across_section(report),
    sweep ? [sweep.element, sweep.point_choice] : null,
    place,
    report_details(report),
  );
  return {
    element,
    show: take,
    get run() {
      return run_index;
    },
  };
}

/** The run of a sweep to begin with: the one in which the methods' errors are farthest apart. */
function first_run(runs) {
  const spread = (run) => {
    const errors = run.results.map((result) => result.metrics?.flip?.mean).filter(is_number);
    return errors.length > 0 ? Math.max(...errors) - Math.min(...errors) : -1;
  };
  const spreads = runs.map(spread);
  return Math.max(0, spreads.indexOf(Math.max(...spreads)));
}
