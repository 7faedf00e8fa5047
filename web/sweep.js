// What a sweep varied, and the values of each method along it: from a report's spec and runs, without a view.
import { value_at } from "./columns.js";
import { is_number, short_value } from "./format.js";

const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);

function parts_of(pointer) {
  return pointer
    .split("/")
    .slice(1)
    .map((part) => part.replaceAll("~1", "/").replaceAll("~0", "~"));
}

/** What a person calls a swept field: "count", "texture size", "F2BD threshold". */
export function field_name(pointer, spec = {}) {
  const [section, ...rest] = parts_of(pointer);
  const method = section === "methods" ? spec.methods?.[Number(rest[0])] : null;
  if (method) rest[0] = method.label ?? method.id ?? method;
  return rest.join(" ").replaceAll("_", " ") || pointer;
}

/** "count 16, texture size 64"; "" where nothing is swept. */
export function point_text(point, spec = {}) {
  return Object.entries(point ?? {})
    .map(([pointer, value]) => `${field_name(pointer, spec)} ${short_value(value)}`)
    .join(", ");
}

/**
 * The axes of `spec.sweep`: {name, points, stops}. `points` are objects of values by pointer; each stop is
 * {value, text}, where `value` is what one field was set to, or undefined where a point sets other fields than the next.
 */
export function axes_of(spec) {
  const sweep = Array.isArray(spec?.sweep) ? spec.sweep : [];
  return sweep.map((axis) => {
    const points = axis.points ?? axis.values.map((value) => ({ [axis.pointer]: value }));
    const fields = [...new Set(points.flatMap((point) => Object.keys(point)))];
    const names = fields.map((field) => field_name(field, spec));
    const single = fields.length === 1;
    const stop = (point) =>
      single
        ? { value: point[fields[0]], text: short_value(point[fields[0]]) }
        : { value: undefined, text: Object.values(point).map(short_value).join(", ") };
    return { name: names.join(", "), points, stops: points.map(stop) };
  });
}

/** For each axis the index of the stop at which a run's point lies, −1 where it lies at none. */
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

/** The runs that differ from `chosen` along one axis only: [{stop, run}] in the order of the axis, `chosen` among them. */
export function runs_along(axes, runs, axis, chosen) {
  const fixed = stops_of(axes, chosen.point);
  return runs
    .map((run) => ({ run, at: stops_of(axes, run.point) }))
    .filter(({ at }) => at.every((stop, index) => index === axis || stop === fixed[index]))
    .map(({ run, at }) => ({ stop: at[axis], run }))
    .sort((a, b) => a.stop - b.stop);
}

/**
 * One entry a method, in the order of the results: {label, points: [{stop, value, interval}]}. `value` is null where it
 * was not measured, `interval` where there is none.
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
