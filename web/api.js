// The service's REST interface.

// Relative, so that the page works below any path at which a proxy offers it.
const ROOT = "api/v1";

/** An unsuccessful answer. `errors`: [{pointer, detail}] of a wrong spec. */
export class ApiError extends Error {
  constructor(status, problem, retry_after) {
    super(problem.detail || problem.title || `The server answered ${status}`);
    this.status = status;
    this.errors = problem.errors ?? [];
    this.allow = problem.allow ?? [];
    this.retry_after_s = retry_after;
  }
}

const MAX_NAME_BYTES = 200;

/** As much of the beginning of a name as the service accepts. */
function shortened(name) {
  let short = name;
  while (new TextEncoder().encode(short).length > MAX_NAME_BYTES) short = [...short].slice(0, -1).join("");
  return short;
}

async function call(path, options = {}) {
  let response;
  try {
    response = await fetch(ROOT + path, options);
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new ApiError(0, { detail: "The server is not reachable." });
  }
  const is_json = (response.headers.get("Content-Type") ?? "").includes("json");
  const body = is_json ? await response.json() : null;
  if (response.status === 401 && path !== "/session") window.dispatchEvent(new CustomEvent("sheer-token-wanted"));
  if (!response.ok)
    throw new ApiError(response.status, body ?? {}, Number(response.headers.get("Retry-After")) || null);
  return { body, location: response.headers.get("Location") };
}

function post(path, value, options = {}) {
  return call(path, {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(value),
    ...options,
  });
}

export const report_path = (id) => `${ROOT}/reports/${encodeURIComponent(id)}`;

export async function get_methods() {
  return (await call("/methods")).body;
}
export async function get_scenes() {
  return (await call("/scenes")).body;
}
export async function get_columns() {
  return (await call("/columns")).body;
}
/** The rounds that intervals of speedups need, for 1, 2, 3 and more methods. */
export async function get_rounds_needed() {
  return (await call("/rounds")).body;
}
export async function get_metrics() {
  return (await call("/metrics")).body;
}
/** The fields of a spec that are the same for every scene and method. */
export async function get_spec_fields() {
  return (await call("/specs/fields")).body;
}
/** Ready specs to start from: [{id, teaches, spec, files}]. */
export async function get_examples() {
  return (await call("/specs/examples")).body;
}
/** The bytes of a file that a ready spec needs. */
export async function get_spec_file(url) {
  const response = await fetch(url);
  if (!response.ok) throw new ApiError(response.status, { detail: "A file of the ready comparison is missing." });
  return response.blob();
}

/** Whether the service asks for a token, and what the page's allows: {required, name, scope}. */
export async function get_session() {
  return (await call("/session")).body;
}
/** Keeps a token for this browser's session. */
export async function begin_session(token) {
  await post("/session", { token });
}
export async function end_session() {
  await call("/session", { method: "DELETE" });
}

/** Every baseline: [{name, reports}]. */
export async function get_baselines(signal) {
  return (await call("/baselines", { signal })).body.baselines;
}
/** `acceptance`: {report, by, reason}. */
export async function accept_report(name, acceptance) {
  await call(`/baselines/${encodeURIComponent(name)}`, {
    method: "PUT",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(acceptance),
  });
}
/** Forgets one report of a baseline, or all of them without an id. The reports themselves stay. */
export async function forget_baseline(name, id = null) {
  const query = id ? `?${new URLSearchParams({ report: id })}` : "";
  await call(`/baselines/${encodeURIComponent(name)}${query}`, { method: "DELETE" });
}

/** Published measurements that can be repeated. */
export async function get_suites() {
  return (await call("/suites")).body;
}

/** The spec with its defaults filled in; throws ApiError with `errors` if it is wrong. */
export async function validate(spec, signal) {
  return (await post("/specs/validate", spec, { signal })).body;
}

/** Queues a comparison; returns its id. */
export async function submit(spec) {
  const { body, location } = await post("/reports", spec);
  return body?.id ?? location.split("/").pop();
}

/** The self-contained file, as text. */
export async function get_report_html(id) {
  const response = await fetch(`${report_path(id)}/report.html`);
  if (!response.ok) throw new ApiError(response.status, { detail: "The file could not be loaded." });
  return response.text();
}

export async function get_report(id, signal) {
  return (await call(`/reports/${encodeURIComponent(id)}`, { signal })).body;
}

/** The workers that were seen lately: [{name, label, driver, last_seen_at, report}]. */
export async function get_workers(signal) {
  return (await call("/workers", { signal })).body.workers;
}

/** What is drawn already of a report that is being timed: {point, pictures: [{label, url}]}. */
export async function get_early_pictures(id, signal) {
  return (await call(`/reports/${encodeURIComponent(id)}/early`, { signal })).body;
}

/**
 * What changed from report `id` to report `against`: in one `run`, with its FLIP maps, or in all, without them (null).
 * `allow`: pointers to fields of the spec that may differ.
 */
export async function get_diff(id, against, { run = null, allow = [] }, signal) {
  const query = new URLSearchParams({ against });
  if (run !== null) query.set("run", run);
  if (allow.length > 0) query.set("allow", allow.join());
  return (await call(`/reports/${encodeURIComponent(id)}/diff?${query}`, { signal })).body;
}

/** The fragments of a pixel and what each method made of them; `place` is {x, y, run}. */
export async function get_pixel(id, place, signal) {
  return (await call(`/reports/${encodeURIComponent(id)}/pixel?${new URLSearchParams(place)}`, { signal })).body;
}

export async function delete_report(id) {
  await call(`/reports/${encodeURIComponent(id)}`, { method: "DELETE" });
}

/** How many uploaded files are listed: the most that the service returns at once. */
export const MOST_ASSETS = 1000;

/** {assets, newest first; accepts: [{media_type, type, suffixes}]; max_bytes}. */
export async function get_assets() {
  return (await call(`/assets?limit=${MOST_ASSETS}`)).body;
}

/**
 * Uploads a file for specs to refer to; `on_progress` gets fractions up to 1. Returns the service's description of
 * it.
 */
export function upload_asset(file, media_type, on_progress) {
  // fetch does not report the progress of an upload.
  const request = new XMLHttpRequest();
  return new Promise((resolve, reject) => {
    request.upload.addEventListener("progress", ({ loaded, total }) => on_progress(total > 0 ? loaded / total : 1));
    request.addEventListener("error", () => reject(new ApiError(0, { detail: "The file cannot be sent." })));
    request.addEventListener("load", () => {
      const is_json = (request.getResponseHeader("Content-Type") ?? "").includes("json");
      const body = is_json ? JSON.parse(request.responseText) : {};
      if (request.status < 300) resolve(body);
      else reject(new ApiError(request.status, body, null));
    });
    request.open("POST", `${ROOT}/assets?${new URLSearchParams({ name: shortened(file.name) })}`);
    request.setRequestHeader("Content-Type", media_type);
    request.send(file);
  });
}

/** A page of the archive: {reports, next_cursor}. */
export async function list_reports(query, signal) {
  const filled = Object.entries(query).filter(([, value]) => value !== "" && value !== null && value !== undefined);
  return (await call(`/reports?${new URLSearchParams(filled)}`, { signal })).body;
}

/** A number of a spec's reports over time; `query` as in GET /trends. */
export async function get_trend(query, signal) {
  return (await call(`/trends?${new URLSearchParams(query)}`, { signal })).body;
}

/**
 * Follows a report until it is final. `on_progress({progress, stage, status})` is called for each step,
 * `on_connection(connected)` when the connection is lost or back, `on_end()` once. Returns a function that stops listening.
 */
export function follow(id, { on_progress, on_connection, on_end }) {
  const source = new EventSource(`${report_path(id)}/events`);
  const close = () => source.close();
  source.addEventListener("open", () => on_connection(true));
  source.addEventListener("progress", (event) => on_progress(JSON.parse(event.data)));
  for (const end of ["done", "failed", "cancelled"]) {
    source.addEventListener(end, () => {
      close();
      on_end();
    });
  }
  // The browser reconnects by itself as long as the source is not closed.
  source.addEventListener("error", () => {
    if (source.readyState === EventSource.CLOSED) on_end();
    else on_connection(false);
  });
  return close;
}
