// The choice of a suite, a published table to repeat or a measurement of ours, at the original size or smaller.
import { el, select } from "./dom.js";

const SCALES = [
  ["1", "in full"],
  ["0.5", "1/2"],
  ["0.25", "1/4"],
  ["0.125", "1/8"],
];

/**
 * A suite's spec with the sides of its image, also those of its sweep, times `scale`; scene, textures and so overdraw stay
 * the same.
 */
export function scaled_spec(spec, scale) {
  const side = (length) => Math.max(1, Math.round(length * scale));
  const scaled = ([field, value]) => [field, /^\/image\/(width|height)$/.test(field) ? side(value) : value];
  const sweep = spec.sweep?.map((axis) =>
    axis.points ? { points: axis.points.map((point) => Object.fromEntries(Object.entries(point).map(scaled))) } : axis,
  );
  const image = { ...spec.image, width: side(spec.image.width), height: side(spec.image.height) };
  return { ...spec, image, ...(sweep && { sweep }) };
}

/** Null if the service has no suites. `on_spec(spec)` is called with the chosen spec. */
export function suite_chooser(suites, on_spec) {
  if (suites.length === 0) return null;
  const name = ({ id, title }) => (id.startsWith("paper-table-") ? `Table ${id.slice(12)}: ${title}` : title);
  const hint = el("p", { class: "hint", role: "status" });
  const chosen = () => suites.find((suite) => suite.id === table.value);
  const table = select(
    { onchange: () => tell() },
    suites.map((suite) => [suite.id, name(suite)]),
    suites[0].id,
  );
  const scale = select({ onchange: () => tell() }, SCALES, "0.25");
  const tell = () => {
    const { source, device, spec } = chosen();
    const { width, height } = scaled_spec(spec, Number(scale.value)).image;
    const where = device ? `, measured on ${device}` : "";
    hint.textContent = `${source}${where}. Here at ${width} × ${height} px.`;
  };
  tell();
  return el(
    "div",
    { class: "suite-row", role: "group", "aria-label": "Measure a suite" },
    el("label", {}, "Measure a suite", table),
    el("label", {}, "Image", scale),
    el(
      "button",
      { type: "button", onclick: () => on_spec(scaled_spec(chosen().spec, Number(scale.value))) },
      "Fill in",
    ),
    hint,
  );
}

/** The published figures stay with a spec while it is edited, until they are removed. Null if it has none. */
export function suite_note(model) {
  const suite = model.get(["suite"]);
  if (!suite) return null;
  const leave_out = () => {
    model.set(["suite"], undefined);
    note.remove();
  };
  const note = el(
    "div",
    { class: "suite-note", "data-pointer": "/suite" },
    `The report will show the published figures of ${suite} beside the measured ones. `,
    el("button", { type: "button", class: "link", onclick: leave_out }, "Leave them out"),
    el("p", { class: "error-text", hidden: true }),
  );
  return note;
}
