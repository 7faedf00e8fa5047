// A finished report as a page part. The served page and the self-contained file both show reports with this.
import { value_at } from "./columns.js";
import { el, set_children } from "./dom.js";
import { fixed, integer, is_number, short_value, when, words } from "./format.js";
import { frontier_section } from "./frontier_view.js";
import { ImageViewer } from "./image_viewer.js";
import { note_list } from "./notes.js";
import { PixelView } from "./pixel_view.js";
import { difference_table, fragment_table, timing_table } from "./result_tables.js";
import { suite_section } from "./suite_view.js";
import { axes_of, point_text } from "./sweep.js";
import { SweepView } from "./sweep_view.js";

const KIND_ORDER = ["color", "difference", "flip", "overdraw", "shaded", "saturation"];
const COUNT_NOTES = {
  overdraw: "Transparent fragments of each pixel that opaque geometry does not hide",
  shaded: "Fragments of each pixel that the method shaded",
  saturation:
    "The fragment, counted from the front, with which less than the threshold is left; black where that never happens",
};
const KIND_LABELS = { color: "Colour", difference: "Difference", flip: "FLIP" };

function is_shown(image) {
  return Boolean(image?.media_type?.startsWith("image/") && !image.media_type.includes("exr"));
}

function kinds_of(run, metrics) {
  const keys = new Set(
    run.results.flatMap((result) =>
      Object.entries(result.images ?? {})
        .filter(([, image]) => is_shown(image))
        .map(([key]) => key),
    ),
  );
  keys.add("color");
  const rank = (key) => (KIND_ORDER.includes(key) ? KIND_ORDER.indexOf(key) : KIND_ORDER.length);
  return [...keys]
    .sort((a, b) => rank(a) - rank(b))
    .map((key) => ({
      key,
      label: KIND_LABELS[key] ?? words(key),
      note: metrics.find((metric) => metric.picture === key)?.summary ?? count_note(run, key),
    }));
}

/** What the colours of a picture of counts mean; all of a run share one scale. */
function count_note(run, key) {
  const images = run.results.map((result) => result.images?.[key]).filter((image) => is_number(image?.full_scale));
  if (images.length === 0) return undefined;
  const greatest = Math.max(...images.map((image) => image.greatest));
  return `${COUNT_NOTES[key] ?? words(key)}. Black is 0, the palest yellow ${images[0].full_scale}; greatest ${greatest}`;
}

function pictures_of(images, picture_url) {
  return Object.fromEntries(
    Object.entries(images ?? {})
      .filter(([, image]) => is_shown(image))
      .map(([key, image]) => [key, picture_url(image)])
      .filter(([, url]) => url),
  );
}

/** Why there is no picture; null where there is one. Reports from before references could fail give them no status. */
function status_text({ status = "ok", reason } = {}) {
  return status === "ok" ? null : `${words(status)}: ${reason ?? "no reason given"}`;
}

function sources_of(run, picture_url) {
  const reference = {
    key: "reference",
    label: "Reference",
    reference: true,
    title: run.reference?.method,
    pictures: pictures_of(run.reference?.images, picture_url),
    missing: status_text(run.reference) ?? "The report has no reference picture",
  };
  return [
    reference,
    ...run.results.map((result, index) => ({
      key: `result-${index}`,
      label: result.label,
      title: result.method,
      pictures: pictures_of(result.images, picture_url),
      missing: status_text(result) ?? result.metrics_reason ?? "",
    })),
  ];
}

/** What was rendered, in one line. */
export function scene_text(scene) {
  if (!scene) return "";
  const { type, layers, ...rest } = scene;
  const given = Object.entries(rest).filter(([, value]) => value !== null);
  const facts = given.map(([name, value]) =>
    typeof value === "object" && value !== null ? short_value(value) : `${name} ${short_value(value)}`,
  );
  if (Array.isArray(layers)) facts.unshift(layers.length === 1 ? "1 layer" : `${layers.length} layers`);
  return [type, ...facts].join(" · ");
}

/** The spec without the fields that its sweep sets. */
function unswept(spec) {
  const copy = structuredClone(spec);
  for (const pointer of axes_of(spec).flatMap(({ points }) => points.flatMap(Object.keys))) {
    const parts = pointer.split("/").slice(1);
    const owner = value_at(copy, parts.slice(0, -1).join("."));
    if (owner && !Array.isArray(owner)) delete owner[parts.at(-1)];
  }
  return copy;
}

function facts(entries) {
  return el(
    "dl",
    { class: "facts" },
    entries.filter(([, value]) => value).map(([name, value]) => el("div", {}, el("dt", {}, name), el("dd", {}, value))),
  );
}

function reference_text(run) {
  const residuals = Object.entries(run.reference?.residual ?? {}).filter(([, value]) => is_number(value));
  const unknown = run.reference?.residual_reason;
  return [
    run.reference?.method,
    status_text(run.reference),
    ...residuals.map(([name, value]) =>
      value === 0 ? `agrees exactly with ${name}` : `differs from ${name} by at most ${value.toPrecision(2)}`,
    ),
    unknown ? `residual not measured: ${unknown}` : null,
  ]
    .filter(Boolean)
    .join(", ");
}

/** A report fails by its checks, and by what could not be rendered. */
function verdict_chip({ verdict, checks = [] }) {
  if (!verdict || verdict === "none") return null;
  const by_checks = checks.some((check) => !check.passed) || verdict === "passed";
  return el("span", { class: `verdict ${verdict}` }, by_checks ? `Checks ${verdict}` : words(verdict));
}

function header(report) {
  const { spec = {}, device = {}, runs = [] } = report;
  const image = spec.image ?? {};
  const axes = axes_of(spec);
  const tags = Object.entries(spec.tags ?? {});
  return el(
    "header",
    { class: "report-head" },
    el(
      "div",
      { class: "title-line" },
      el("h1", {}, spec.title || "Untitled comparison"),
      verdict_chip(report),
      tags.map(([name, value]) => el("span", { class: "chip tag" }, `${name}: ${short_value(value)}`)),
    ),
    report.verdict_reason ? el("p", { class: "verdict-reason" }, report.verdict_reason) : null,
    facts([
      ["Point", runs.length === 1 ? point_text(runs[0].point, spec) : ""],
      ["Scene", scene_text(unswept(spec).scene)],
      ...axes.map((axis) => ["Sweep", `${axis.name}: ${axis.stops.map((stop) => stop.text).join(" · ")}`]),
      ["Image", image.width ? `${image.width} × ${image.height} px, ${image.format}` : ""],
      ["Reference", runs.length === 1 ? reference_text(runs[0]) : ""],
      ["Device", [device.renderer, device.context].filter(Boolean).join(", ")],
      ["Done", when(report.finished_at)],
    ]),
  );
}

function software_notice(device) {
  if (!device?.software) return null;
  return el(
    "p",
    { class: "notice warning", role: "note" },
    el("strong", {}, "Software rasteriser. "),
    "Times on a software rasteriser do not predict a GPU; counts of fragments come nearer.",
  );
}

function bound_text(check) {
  const bounds = [
    is_number(check.min) ? `at least ${check.min}` : null,
    is_number(check.max) ? `at most ${check.max}` : null,
  ];
  return bounds.filter(Boolean).join(" and ");
}

const CHECK_MARKS = { passed: "✓ passed", failed: "✗ failed", undecided: "? undecided" };

function checks_list(report) {
  const checks = report.checks ?? [];
  if (checks.length === 0) return null;
  const asked = (check) =>
    report.spec?.checks?.find((one) => one.metric === check.metric && one.method === check.method);
  return el(
    "section",
    { class: "checks", "aria-label": "Checks" },
    el("h2", {}, "Checks"),
    el(
      "ul",
      {},
      checks.map((check) => {
        const point = point_text(check.at, report.spec);
        const outcome = check.outcome ?? (check.passed ? "passed" : "failed");
        return el(
          "li",
          { class: outcome },
          el("span", { class: "check-mark" }, CHECK_MARKS[outcome]),
          el("span", {}, `${check.metric} of ${check.method}${point ? ` at ${point}` : ""}`),
          el(
            "span",
            { class: "muted" },
            `${bound_text({ ...asked(check), ...check })}; is ` +
              (is_number(check.value) ? fixed(check.value, 4) : (check.reason ?? "not measured")) +
              (is_number(check.value) && check.reason ? `: ${check.reason}` : ""),
          ),
        );
      }),
    ),
  );
}

function notes_list(notes = []) {
  if (notes.length === 0) return null;
  return el(
    "section",
    { class: "notes", "aria-label": "Notes" },
    el("h2", {}, notes.length === 1 ? "Note" : `${notes.length} notes`),
    note_list(notes),
  );
}

function linear_links(run, picture_url) {
  const files = [["Reference", run.reference], ...run.results.map((result) => [result.label, result])]
    .flatMap(([label, owner]) =>
      Object.entries(owner?.images ?? {})
        .filter(([, image]) => image?.url && !is_shown(image))
        .map(([key, image]) => ({ label: `${label} ${key}`, url: picture_url(image) })),
    )
    .filter((file) => file.url);
  if (files.length === 0) return null;
  return el(
    "p",
    { class: "files" },
    el("span", { class: "muted" }, "Linear pictures (float): "),
    files.map((file) => el("a", { href: file.url, download: true }, file.label)),
  );
}

function run_part(report, run, options) {
  const { methods, metrics, picture_url, load_pixel } = options;
  const index = report.runs.indexOf(run);
  const pixel = load_pixel ? new PixelView((x, y, signal) => load_pixel({ x, y, run: index }, signal)) : null;
  const { width, height } = run_size(report, run);
  const viewer = new ImageViewer({
    width_px: width,
    height_px: height,
    sources: sources_of(run, picture_url),
    kinds: kinds_of(run, metrics),
    on_pick: pixel ? (x, y) => pixel.show(x, y) : null,
  });
  const context = {
    methods,
    metrics,
    baseline: report.spec?.baseline,
    show_pixel: (x, y) => {
      viewer.show_pixel(x, y);
      const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
      viewer.element.scrollIntoView({ block: "nearest", behavior: calm ? "auto" : "smooth" });
    },
  };
  const times = timing_table(run, context);
  const fragments = fragment_table(run.results, context);
  return [
    report.runs.length > 1 ? facts([["Reference", reference_text(run)]]) : null,
    viewer.element,
    pixel?.element,
    linear_links(run, picture_url),
    report.device?.software ? [fragments, frontier_section(run), times] : [frontier_section(run), times, fragments],
    difference_table(run.results, context, run.reference?.rounded),
  ];
}

/** A sweep may change the size of the image. */
function run_size(report, run) {
  const image = report.spec?.image ?? {};
  return {
    width: run.point?.["/image/width"] ?? image.width ?? 512,
    height: run.point?.["/image/height"] ?? image.height ?? 512,
  };
}

/** Processes that wanted a core, before and after: a busy machine disturbs the times. */
function load_text(load) {
  if (!load) return "";
  const one = (means) => (Array.isArray(means) ? means.map((mean) => fixed(mean, 2)).join(", ") : null);
  const [start, end] = [one(load.start), one(load.end)];
  if (!start || !end) return load.reason ?? "not measured";
  return `${start} at the start, ${end} at the end (means over 1, 5 and 15 minutes)`;
}

function colour_text(space) {
  return space ? [space.values, `blended ${space.blending}`].join("; ") : "";
}

/** Every file that the report drew from. */
function files_part(files = []) {
  if (files.length === 0) return null;
  const of_file = ({ pointer, name, of, sha256, bytes }) =>
    el(
      "li",
      {},
      el("strong", {}, name === sha256 ? pointer : name),
      el("span", { class: "muted" }, ` ${of ? `of ${of}, ` : ""}${pointer}, ${integer(bytes)} bytes`),
      el("code", {}, sha256),
    );
  return el(
    "details",
    {},
    el("summary", {}, files.length === 1 ? "1 file" : `${files.length} files`),
    el("ul", { class: "source-files", "aria-label": "Files" }, files.map(of_file)),
  );
}

function origin(report) {
  const { device = {}, provenance = {} } = report;
  const rows = [
    ["Renderer", device.renderer],
    ["Vendor", device.vendor],
    ["OpenGL", device.gl_version],
    ["Driver", device.driver ?? device.driver_reason],
    ["Context", device.context],
    ["CPU", [device.cpu, provenance.cores ? `${provenance.cores} cores` : null].filter(Boolean).join(", ")],
    ["Governor", provenance.governor ?? provenance.governor_reason],
    ["Load", load_text(provenance.load)],
    ["Workarounds", (device.workarounds ?? []).join(", ") || "none"],
    ["Colour", colour_text(report.color_space)],
    ["Version", [provenance.version, provenance.commit].filter(Boolean).join(" ")],
    ["Rerun", provenance.rerun],
    ["Spec SHA-256", report.spec_sha256],
  ];
  return el(
    "div",
    { class: "details-row" },
    el("details", {}, el("summary", {}, "Device and origin"), facts(rows)),
    files_part(report.files),
    el(
      "details",
      {},
      el("summary", {}, "Spec"),
      el("pre", { tabindex: "0", "aria-label": "Spec as JSON" }, JSON.stringify(report.spec, null, 2)),
    ),
  );
}

/**
 * `options`: `picture_url(image)` gives the address of an image object or null, `methods` and `metrics` are their
 * descriptions (may be empty), `actions` are elements for the line under the head; `load_pixel({x, y, run}, signal)`
 * takes a pixel apart, and where it is missing that is not offered.
 */
export function report_view(report, { picture_url, methods = [], metrics = [], actions = [], load_pixel = null }) {
  const options = { picture_url, methods, metrics, load_pixel };
  const runs = report.runs ?? [];
  const place = el("div", { class: "run" });
  const show = (run) =>
    set_children(
      place,
      run ? run_part(report, run, options) : el("p", { class: "notice" }, "This point has no results."),
    );
  const sweep = runs.length > 1 ? new SweepView(report, show) : null;
  if (runs.length === 1) show(runs[0]);
  return el(
    "article",
    { class: "report", "aria-label": "Report" },
    header(report),
    actions.length > 0 ? el("div", { class: "actions" }, actions) : null,
    software_notice(report.device),
    report.error ? el("p", { class: "notice error", role: "alert" }, error_text(report.error)) : null,
    notes_list(report.notes),
    checks_list(report),
    suite_section(report),
    sweep ? [sweep.element, sweep.point_choice] : null,
    place,
    origin(report),
  );
}

/** The report's `error`, a text or a problem. */
export function error_text(error) {
  return typeof error === "string" ? error : (error?.detail ?? error?.title ?? error?.message ?? "Rendering failed");
}
