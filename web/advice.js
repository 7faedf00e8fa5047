// Which method of a run to use, and why: from the report's numbers alone, independent of any view. A count of fragments
// is exact; a time counts only if it is resolved.
import { is_perfect, value_at } from "./columns.js";
import { is_number } from "./format.js";

/** Mean FLIP error up to which a picture passes for the reference's when it is not examined closely. */
export const EYE_LIMIT = 0.02;
/** The share of the baseline's fragments that another method has to save to be worth a change. */
export const LEAST_SAVING = 0.05;
const ERROR_PATH = "metrics.flip.mean";

/** No limits but that on the error. */
export const ANY = { error_limit: EYE_LIMIT, no_sorting: false, memory_limit_bytes: Infinity };

/** Whether a method needs the scene in depth order in every frame; null if it did not run and is not described. */
function sorts(result, methods) {
  if (result.timing) return Boolean(result.timing.sort);
  return methods.find((method) => method.id === result.method)?.needs_sorting ?? null;
}

/** What the choice is made from, for one result. `excluded`: why it may not be chosen, "" if it may. */
function entry_of(result, methods, limits) {
  const entry = {
    result,
    label: result.label,
    error: value_at(result, ERROR_PATH) ?? null,
    is_exact: is_perfect(result),
    is_bound: result.status === "ok" && !result.metrics,
    shaded: value_at(result, "fragments.shaded") ?? null,
    memory_bytes: result.memory_bytes ?? null,
    sorts: sorts(result, methods),
    speed: result.speedup ?? null,
  };
  return { ...entry, excluded: reason_to_exclude(entry, limits) };
}

function reason_to_exclude({ result, error, memory_bytes, ...entry }, limits) {
  if (result.status !== "ok") return result.status;
  if (!is_number(error)) return "an upper bound, not a picture";
  if (result.metrics.non_finite > 0) return "has pixels that are not finite";
  if (error > limits.error_limit) return limits.error_limit > EYE_LIMIT ? "error over the limit" : "visible error";
  if (limits.no_sorting && entry.sorts) return "sorts";
  if (memory_bytes > limits.memory_limit_bytes) return "memory over the limit";
  return "";
}

const first_by = (entries, ...keys) =>
  [...entries].sort((a, b) => keys.map((key) => key(a) - key(b)).find((difference) => difference !== 0) ?? 0)[0];

const speed_rank = ({ speed }) => ({ faster: 0, slower: 2 })[speed?.verdict] ?? 1;

/**
 * The choice for a run: {entries, chosen, by, baseline, closest}. `by` says what it was chosen for: "fragments" or
 * "time" if it is resolved to have less of them than the baseline has, "baseline" if no other method has. `chosen` is null if no
 * method is within the limits; `closest` then has the least error.
 */
export function advise(run, { methods, baseline, software, limits = ANY }) {
  const entries = run.results.map((result) => entry_of(result, methods, limits));
  const of_baseline = entries.find(({ label }) => label === baseline) ?? null;
  const able = run.nothing_drawn ? [] : entries.filter(({ excluded }) => excluded === "");
  const closest = first_by(
    entries.filter(({ error }) => is_number(error)),
    ({ error }) => error,
  );
  const told = (chosen, by) => ({ entries, chosen, by, baseline: of_baseline, closest: closest ?? null });
  if (able.length === 0) return told(null, "none");
  // Fewer fragments are no reason to use what is resolved to be slower.
  const counted = able.filter(({ shaded, speed }) => is_number(shaded) && speed?.verdict !== "slower");
  const by_fragments = first_by(
    counted,
    ({ shaded }) => shaded,
    speed_rank,
    ({ error }) => error,
  );
  const by_time = first_by(
    able.filter(({ speed }) => speed?.verdict === "faster"),
    ({ speed }) => -speed.value,
  );
  const shades_less = by_fragments && by_fragments.shaded <= (1 - LEAST_SAVING) * of_baseline?.shaded;
  if (by_time && !software) return told(by_time, "time");
  if (shades_less) return told(by_fragments, "fragments");
  if (by_time) return told(by_time, "time");
  if (able.includes(of_baseline)) return told(of_baseline, "baseline");
  return told(by_fragments ?? first_by(able, ({ error }) => error), "limits");
}

/** How often each method is chosen over the runs of a sweep, the most frequent first: [[label, count]]. */
export function tally(runs, options) {
  const counts = new Map();
  for (const run of runs) {
    const label = advise(run, options).chosen?.label ?? "none";
    counts.set(label, (counts.get(label) ?? 0) + 1);
  }
  return [...counts].sort((a, b) => b[1] - a[1]);
}
