// Ready comparisons to start from, as the service has them.
import { words } from "./format.js";

const FIRST = "quick";

function summary_of({ scene = {}, image = {}, methods = [] }) {
  const size = image.width ? `${image.width} × ${image.height} px` : "";
  return [words(scene.type ?? ""), size, `${methods.length} methods`].filter(Boolean).join(", ");
}

/** {name, summary, spec} of the service's examples [{id, spec}]; the quick one comes first. */
export function presets_of(examples) {
  return [...examples]
    .sort((a, b) => Number(b.id === FIRST) - Number(a.id === FIRST))
    .map(({ id, spec }) => ({ name: spec.title || words(id), summary: summary_of(spec), spec }));
}
