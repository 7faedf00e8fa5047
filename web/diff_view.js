// The comparison of two reports at #/diff/{a}/{b}: what changed from the first to the second.
// With ?allow=POINTER,... they are compared even if their specs differ there.
import { get_diff } from "./api.js";
import { rows_of, run_table } from "./diff_table.js";
import { el, select, set_children } from "./dom.js";
import { DASH, short_value, when } from "./format.js";
import { ImageViewer } from "./image_viewer.js";
import { PictureData } from "./picture_data.js";
import { point_text } from "./sweep.js";

const FLIP_NOTE = "FLIP between the two pictures: black where no difference is visible, pale yellow for the greatest.";
function viewer_of(row, image) {
  const { a, b, flip_picture } = row.picture;
  const kinds = [
    { key: "color", label: "Color" },
    { key: "difference", label: "Difference", note: "A minus B in 8-bit levels." },
  ];
  if (flip_picture) kinds.push({ key: "flip", label: "FLIP", note: FLIP_NOTE });
  return new ImageViewer({
    width_px: image.width,
    height_px: image.height,
    sources: [
      {
        key: "0",
        label: "A, before",
        name: "A",
        reference: true,
        title: row.label,
        data: new PictureData({ color: { url: a.url } }),
      },
      {
        key: "1",
        label: "B, after",
        title: row.label,
        data: new PictureData({ color: { url: b.url }, ...(flip_picture ? { flip: { url: flip_picture.url } } : {}) }),
      },
    ],
    kinds,
  });
}

/** Fills `place` with the table of a run and the pictures of one of its methods. */
function show_run(place, run, baseline) {
  const rows = rows_of(run, baseline);
  const shown = rows.filter((row) => row.picture);
  const stage = el("div", { class: "run" });
  const show = (row, pixel) => {
    choice.value = String(shown.indexOf(row));
    const viewer = viewer_of(row, run.image);
    set_children(stage, viewer.element);
    if (pixel) viewer.show_pixel(...pixel);
  };
  const choice = select(
    { onchange: () => show(shown[Number(choice.value)]) },
    shown.map((row, index) => [String(index), row.label]),
    "0",
  );
  const show_and_go = (row, pixel) => {
    show(row, pixel);
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    stage.scrollIntoView({ block: "nearest", behavior: calm ? "auto" : "smooth" });
  };
  set_children(
    place,
    run_table(rows, show_and_go),
    shown.length > 0 ? el("label", { class: "point-select" }, "Pictures of", choice) : null,
    stage,
  );
  const changed = shown.find((row) => row.picture.verdict === "different");
  if (shown.length > 0) show(changed ?? shown[0]);
}

function side_facts(name, side) {
  return el(
    "div",
    { class: "diff-side" },
    el("h2", {}, name),
    el("a", { href: `#/reports/${encodeURIComponent(side.id)}` }, side.title || "Untitled comparison"),
    el("p", {}, when(side.created_at)),
    el(
      "p",
      { class: "muted" },
      [side.renderer, `sheer ${side.version} ${side.commit ?? ""}`].filter(Boolean).join(" · "),
    ),
  );
}

const TALLY = [
  ["pictures", "different", "picture", "differs", "differ", "bad"],
  ["pictures", "not examined", "picture", "is not examined", "are not examined", ""],
  ["pictures", "identical", "picture", "is identical", "are identical", ""],
  ["times", "slower", "time", "is slower", "are slower", "bad"],
  ["times", "faster", "time", "is faster", "are faster", "good"],
  ["times", "not resolved", "time", "is not resolved", "are not resolved", ""],
];

function summary_list(summary) {
  const tallies = TALLY.map(([group, verdict, noun, one, many, kind]) => [
    summary[group][verdict],
    noun,
    one,
    many,
    kind,
  ]);
  tallies.push([summary.statuses_changed, "status", "changed", "changed", "bad"]);
  const plural = (noun) => (noun === "status" ? "statuses" : `${noun}s`);
  return el(
    "ul",
    { class: "diff-summary", "aria-label": "Summary" },
    tallies
      .filter(([count]) => count > 0)
      .map(([count, noun, one, many, kind]) =>
        el("li", { class: kind }, count === 1 ? `1 ${noun} ${one}` : `${count} ${plural(noun)} ${many}`),
      ),
  );
}

function value_text(value) {
  return value === null || value === undefined ? DASH : short_value(value);
}

function differences_part({ differences }) {
  if (differences.length === 0) return el("p", { class: "muted" }, "Spec, device and provenance are the same.");
  const row = ({ pointer, a, b, allowed }) =>
    el(
      "tr",
      {},
      el("th", { scope: "row" }, pointer, allowed ? el("span", { class: "muted" }, " (allowed)") : null),
      el("td", {}, value_text(a)),
      el("td", {}, value_text(b)),
    );
  return el(
    "div",
    { class: "table-box", tabindex: "0", role: "region", "aria-label": "Differences of spec, device and provenance" },
    el(
      "table",
      { class: "results diff-fields" },
      el("caption", {}, "Spec, device and provenance"),
      el(
        "thead",
        {},
        el(
          "tr",
          {},
          ["Field", "A", "B"].map((head) => el("th", { scope: "col" }, head)),
        ),
      ),
      el("tbody", {}, differences.map(row)),
    ),
  );
}

/** Warns that pictures were expected to change. */
function allowed_note({ differences }) {
  const pointers = differences.filter((one) => one.allowed).map((one) => one.pointer);
  if (pointers.length === 0) return null;
  return el(
    "p",
    { class: "notice", role: "note" },
    `The two specs describe different pictures, which is allowed here: they differ in ${pointers.join(", ")}.`,
  );
}

function only_in_list(only_in) {
  const texts = ["a", "b"].flatMap((side) => [
    ...only_in[side].methods.map((label) => `Only in ${side.toUpperCase()}: the method ${label}`),
    ...only_in[side].points.map((point) => `Only in ${side.toUpperCase()}: ${point_text(point)}`),
  ]);
  return texts.length > 0
    ? el(
        "ul",
        { class: "muted" },
        texts.map((text) => el("li", {}, text)),
      )
    : null;
}

function diff_address(a, b, allow) {
  const query = allow.length > 0 ? `?allow=${encodeURIComponent(allow.join())}` : "";
  return `#/diff/${encodeURIComponent(a)}/${encodeURIComponent(b)}${query}`;
}

function failure(main, error, all_the_same) {
  document.title = "Sheer";
  set_children(
    main,
    el("h1", {}, error.status === 404 ? "No such report" : "These reports cannot be compared"),
    el("p", { class: "notice error", role: "alert" }, error.message),
    el(
      "ul",
      { class: "diff-errors" },
      (error.errors ?? []).map(({ pointer, detail }) => el("li", {}, el("code", {}, pointer), ` ${detail}`)),
    ),
    all_the_same ? el("p", {}, el("a", { class: "button", href: all_the_same }, "Compare anyway")) : null,
    el("p", {}, el("a", { href: "#/reports" }, "All reports")),
  );
}

/** `allowed` is a comma-separated list of pointers from the address. */
export async function show_diff(main, signal, { parts: [a, b], query }) {
  const allow = query.allow ? query.allow.split(",") : [];
  document.title = "What changed – Sheer";
  set_children(main, el("p", { class: "notice", role: "status" }, "Comparing the reports…"));
  let diff;
  try {
    diff = await get_diff(a, b, { allow }, signal);
  } catch (error) {
    if (signal.aborted) return;
    failure(main, error, error.allow?.length > 0 ? diff_address(a, b, [...allow, ...error.allow]) : null);
    return;
  }
  const place = el("div", { class: "run" });
  const note = el("p", { class: "muted", role: "status" });
  let asked = 0;
  const show = async (index) => {
    const mine = ++asked;
    note.textContent = "Comparing the pictures…";
    try {
      const { runs } = await get_diff(a, b, { run: index, allow }, signal);
      if (signal.aborted || mine !== asked) return;
      note.textContent = "";
      show_run(place, runs[0], diff.a.baseline);
    } catch (error) {
      if (!signal.aborted && mine === asked) set_children(note, el("span", { class: "error-text" }, error.message));
    }
  };
  const points = diff.runs.map((run, index) => [String(index), point_text(run.point)]);
  const judged = diff.same_device
    ? "On one device, B is faster or slower only if its time and its ratio to the baseline agree, because the machine may have been busier during one of the reports."
    : "The reports are from two devices: B is faster or slower by its time alone.";
  set_children(
    main,
    el(
      "article",
      { class: "report", "aria-label": "What changed" },
      el("h1", {}, "What changed"),
      el(
        "div",
        { class: "diff-sides" },
        side_facts("A, before", diff.a),
        side_facts("B, after", diff.b),
        el("a", { class: "button", href: diff_address(b, a, allow) }, "Swap A and B"),
      ),
      summary_list(diff.summary),
      el("p", { class: "notice", role: "note" }, judged),
      allowed_note(diff),
      differences_part(diff),
      only_in_list(diff.only_in),
      points.length > 1
        ? el(
            "label",
            { class: "point-select" },
            "Point",
            select({ onchange: (event) => show(Number(event.target.value)) }, points, "0"),
          )
        : null,
      note,
      place,
    ),
  );
  await show(0);
}
