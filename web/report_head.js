// The head of a report: its title and verdict, what was compared in one line, and everything else about its origin behind
// "Details".
import { value_at } from "./columns.js";
import { el } from "./dom.js";
import { fixed, integer, is_number, short_value, when, words } from "./format.js";
import { axes_of, point_text } from "./sweep.js";

/** Why there is no picture; null if there is one. References of older reports have no status. */
export function status_text({ status = "ok", reason } = {}) {
  return status === "ok" ? null : `${words(status)}: ${reason ?? "no reason given"}`;
}

/** The scene's type and the size of the pictures. */
export function subject_text({ scene, image } = {}) {
  const size = image?.width ? `${image.width} × ${image.height} px` : "";
  return [words(scene?.type ?? ""), size].filter(Boolean).join(" · ");
}

/** What was rendered, in one line. */
export function scene_text(scene) {
  if (!scene) return "";
  const { type, layers, ...rest } = scene;
  const given = Object.entries(rest).filter(([, value]) => value !== null);
  const facts = given.map(([name, value]) => {
    const own_code = value?.glsl !== undefined;
    if (own_code) return `${name} of one's own`;
    return typeof value === "object" ? short_value(value) : `${name} ${short_value(value)}`;
  });
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

export function facts(entries) {
  return el(
    "dl",
    { class: "facts" },
    entries.filter(([, value]) => value).map(([name, value]) => el("div", {}, el("dt", {}, name), el("dd", {}, value))),
  );
}

export function reference_text(run) {
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

/** A report fails if a check fails or if something could not be rendered. */
function verdict_chip({ verdict, checks = [] }) {
  if (!verdict || verdict === "none") return null;
  const by_checks = checks.some((check) => !check.passed) || verdict === "passed";
  return el("span", { class: `verdict ${verdict}` }, by_checks ? `Checks ${verdict}` : words(verdict));
}

/** `actions`: elements at the end of the line of the title. */
export function report_head(report, actions) {
  const { spec = {}, device = {}, runs = [] } = report;
  const tags = Object.entries(spec.tags ?? {});
  const summary = [
    subject_text(spec),
    runs.length > 1 ? `${runs.length} points` : point_text(runs[0]?.point, spec),
    report.devices ? `${report.devices.length} devices` : device.renderer,
    when(report.finished_at),
  ];
  return el(
    "header",
    { class: "report-head" },
    el(
      "div",
      { class: "title-line" },
      el("h1", {}, spec.title || "Untitled comparison"),
      verdict_chip(report),
      tags.map(([name, value]) => el("span", { class: "chip tag" }, `${name}: ${short_value(value)}`)),
      actions.length > 0 ? el("div", { class: "actions" }, actions) : null,
    ),
    el("p", { class: "muted" }, summary.filter(Boolean).join(" · ")),
    report.verdict_reason ? el("p", { class: "verdict-reason" }, report.verdict_reason) : null,
  );
}

/** Load averages before and after: a busy machine disturbs the times. */
function load_text(load) {
  if (!load) return "";
  const one = (means) => (Array.isArray(means) ? means.map((mean) => fixed(mean, 2)).join(", ") : null);
  const [start, end] = [one(load.start), one(load.end)];
  if (!start || !end) return load.reason ?? "not measured";
  return `${start} at the start, ${end} at the end (means over 1, 5 and 15 minutes)`;
}

function color_text(space) {
  return space ? [space.values, `blended ${space.blending}`].join("; ") : "";
}

/** Every file that the report used. */
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
  return [
    el("h3", {}, files.length === 1 ? "1 file" : `${files.length} files`),
    el("ul", { class: "source-files", "aria-label": "Files" }, files.map(of_file)),
  ];
}

/** Everything about what was compared, and on what. */
export function report_details(report) {
  const { spec = {}, runs = [], device = {}, provenance = {} } = report;
  const image = spec.image ?? {};
  const compared = [
    ["Point", runs.length === 1 ? point_text(runs[0].point, spec) : ""],
    ["Scene", scene_text(unswept(spec).scene)],
    ...axes_of(spec).map((axis) => ["Sweep", `${axis.name}: ${axis.stops.map((stop) => stop.text).join(" · ")}`]),
    ["Image", image.width ? `${image.width} × ${image.height} px, ${image.format}` : ""],
    ["Reference", runs.length === 1 ? reference_text(runs[0]) : ""],
    ["Color", color_text(report.color_space)],
    ["Spec SHA-256", report.spec_sha256],
    ["Rerun", provenance.rerun],
  ];
  const origin = [
    ["Renderer", device.renderer],
    ["Vendor", device.vendor],
    ["OpenGL", device.gl_version],
    ["Driver", device.driver ?? device.driver_reason],
    ["Context", device.context],
    ["CPU", [device.cpu, provenance.cores ? `${provenance.cores} cores` : null].filter(Boolean).join(", ")],
    ["Governor", provenance.governor ?? provenance.governor_reason],
    ["Load", load_text(provenance.load)],
    ["Workarounds", (device.workarounds ?? []).join(", ") || "none"],
    ["Version", [provenance.version, provenance.commit].filter(Boolean).join(" ")],
    ["Done", when(report.finished_at)],
  ];
  return el(
    "details",
    { class: "report-details" },
    el("summary", {}, "Details"),
    el(
      "div",
      { class: "details-row" },
      el("div", {}, el("h3", {}, "What was compared"), facts(compared), files_part(report.files)),
      el("div", {}, el("h3", {}, "Device and origin"), facts(origin)),
      el(
        "div",
        {},
        el("h3", {}, "Spec"),
        el("pre", { tabindex: "0", "aria-label": "Spec as JSON" }, JSON.stringify(spec, null, 2)),
      ),
    ),
  );
}

/** The report's `error`, a string or a problem object. */
export function error_text(error) {
  return typeof error === "string" ? error : (error?.detail ?? error?.title ?? error?.message ?? "Rendering failed");
}
