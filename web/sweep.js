// What a sweep varied, and the values of each method along it: from a report's spec and runs, independent of any view.
import { value_at } from "./columns.js";
import { is_number, short_value } from "./format.js";

const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);

function is_same_point(a, b) {
  const fields = Object.keys(a);
  return fields.length === Object.keys(b).length && fields.every((field) => same(a[field], b[field]));
}

function parts_of(pointer) {
  return pointer
    .split("/")
    .slice(1)
    .map((part) => part.replaceAll("~1", "/").replaceAll("~0", "~"));
}

/** A readable name of a swept field: "count", "texture size", "F2BD threshold". */
export function field_name(pointer, spec = {}) {
  const [section, ...rest] = parts_of(pointer);
  const method = section === "methods" ? spec.methods?.[Number(rest[0])] : null;
  if (method) rest[0] = method.label ?? method.id ?? method;
  return rest.join(" ").replaceAll("_", " ") || section || pointer;
}

const LONG_TEXT = 40;

/** A value of a swept field; a program in GLSL is named by its place among those that are compared. */
function stop_text(value, index) {
  const code = value?.glsl ?? value;
  const is_code = typeof code === "string" && (code.includes("\n") || code.length > LONG_TEXT);
  return is_code ? `GLSL ${index + 1}` : short_value(value);
}

/** The axes as specs write them; several devices are one, the slowest. */
function given_axes(spec) {
  const sweep = Array.isArray(spec?.sweep) ? spec.sweep : [];
  return Array.isArray(spec?.device) ? [{ pointer: "/device", values: spec.device }, ...sweep] : sweep;
}

/** The place of a value among the stops of the axis that sets its field. */
function stop_index(pointer, value, spec) {
  for (const { points, pointer: single, values } of given_axes(spec)) {
    const stops = points?.map((point) => point[pointer]) ?? (single === pointer ? values : []);
    const index = stops.findIndex((stop) => same(stop, value));
    if (index >= 0) return index;
  }
  return 0;
}

/** "count 16, texture size 64"; "" if nothing is swept. */
export function point_text(point, spec = {}) {
  return Object.entries(point ?? {})
    .map(([pointer, value]) => `${field_name(pointer, spec)} ${stop_text(value, stop_index(pointer, value, spec))}`)
    .join(", ");
}

/** Fields that are named alike, such as the passes of several methods, as one: [[name, pointers]]. */
function alike(fields, spec) {
  if (fields.length < 3) return fields.map((field) => [field_name(field, spec), [field]]);
  const named = new Map();
  for (const field of fields) {
    const name = parts_of(field).at(-1).replaceAll("_", " ");
    named.set(name, [...(named.get(name) ?? []), field]);
  }
  return [...named];
}

/** The different values that a point gives these fields; "" for none. */
function values_at(point, pointers, index) {
  const given = pointers.filter((pointer) => pointer in point);
  return [...new Set(given.map((pointer) => stop_text(point[pointer], index)))].join("/");
}

/**
 * The axes of `spec.sweep`, after one for several devices: {name, field, fields, points, stops}. `points` are objects of
 * values by pointer; each stop is {value, text}; `value` is the value of the field, `field` its pointer; both are undefined
 * if points set several.
 */
export function axes_of(spec) {
  return given_axes(spec).map((axis) => {
    const points = axis.points ?? axis.values.map((value) => ({ [axis.pointer]: value }));
    const fields = [...new Set(points.flatMap((point) => Object.keys(point)))];
    const named = alike(fields, spec);
    const single = fields.length === 1;
    const stop = (point, index) =>
      single
        ? { value: point[fields[0]], text: stop_text(point[fields[0]], index) }
        : {
            value: undefined,
            text: named
              .map(([, pointers]) => values_at(point, pointers, index))
              .filter((text) => text !== "")
              .join(", "),
          };
    const name = named.map(([one]) => one).join(", ");
    return { name, field: single ? fields[0] : undefined, fields, points, stops: points.map(stop) };
  });
}

/**
 * How the times of the methods (metric "timing.median") or their memory ("memory_bytes") grow along an axis, where the run
 * is on the others: the report's entries for a field of the axis and the rest of the run's point.
 */
export function growth_along(report, axis, run, wanted) {
  const rest = Object.fromEntries(Object.entries(run.point).filter(([field]) => !axis.fields.includes(field)));
  return (report.growth ?? []).filter(
    ({ pointer, at, metric = "timing.median" }) =>
      metric === wanted && axis.fields.includes(pointer) && is_same_point(at, rest),
  );
}

/** For each axis the index of the stop of a run's point, −1 if there is none. */
export function stops_of(axes, point) {
  return axes.map(({ points }) => {
    let found = -1;
    points.forEach((candidate, index) => {
      const fields = Object.entries(candidate);
      if (!fields.every(([field, value]) => same(point?.[field], value))) return;
      if (found < 0 || fields.length > Object.keys(points[found]).length) found = index;
    });
    return found;
  });
}

/**
 * The runs that differ from `chosen` only along one axis: [{stop, run}] in the order of the axis, including `chosen`.
 */
export function runs_along(axes, runs, axis, chosen) {
  const fixed = stops_of(axes, chosen.point);
  return runs
    .map((run) => ({ run, at: stops_of(axes, run.point) }))
    .filter(({ at }) => at.every((stop, index) => index === axis || stop === fixed[index]))
    .map(({ run, at }) => ({ stop: at[axis], run }))
    .sort((a, b) => a.stop - b.stop);
}

/**
 * One entry per method, in the order of the results: {label, points: [{stop, value, interval}]}. `value` is null if it
 * was not measured, `interval` if there is none.
 */
export function series_along(along, path, interval_path) {
  const labels = [...new Set(along.flatMap(({ run }) => run.results.map((result) => result.label)))];
  return labels.map((label) => ({
    label,
    points: along.map(({ stop, run }) => {
      const result = run.results.find((one) => one.label === label);
      const value = result?.status === "ok" ? value_at(result, path) : null;
      const interval = interval_path && result ? value_at(result, interval_path) : null;
      return {
        stop,
        value: is_number(value) ? value : null,
        interval: Array.isArray(interval) && interval.every(is_number) ? interval : null,
      };
    }),
  }));
}
