// The comparison of two reports at #/diff/{a}/{b}: what changed from the first to the second.
// With ?allow=POINTER,... they are compared even if their specs differ there.
import { get_diff } from "./api.js";
import { el, select, set_children } from "./dom.js";
import { column_decimals, DASH, fixed, integer, is_number, short_value, when } from "./format.js";
import { ImageViewer } from "./image_viewer.js";
import { PictureData } from "./picture_data.js";
import { point_text } from "./sweep.js";

const FLIP_NOTE = "FLIP between the two pictures: black where no difference is visible, pale yellow for the greatest.";
const HEADS = [
  ["Picture", ""],
  ["FLIP mean", "number"],
  ["FLIP max", "number"],
  ["Differing px", "number"],
  ["Greatest difference, levels", "number"],
  ["Worst pixel", "number"],
  ["A ms", "number"],
  ["B ms", "number"],
  ["A ÷ B", "number"],
  ["To baseline", "number"],
  ["B is", ""],
];
const PICTURE_COLUMNS = 6;

function number_cell(value, text) {
  return el("td", { class: is_number(value) ? "number" : "number missing", "data-value": value }, text);
}

function interval_text(ci95) {
  return Array.isArray(ci95) ? ci95.map((bound) => fixed(bound, 2)).join("–") : "no interval";
}

function ratio_cell(judged, reason) {
  if (!judged) return el("td", { class: "number missing", title: reason }, DASH);
  return el(
    "td",
    { class: "number", "data-value": judged.value, title: judged.reason },
    `${fixed(judged.value, 2)}×`,
    el(
      "span",
      { class: "interval" },
      interval_text(judged.ci95),
      el("span", { class: `verdict-word ${judged.verdict.replace(" ", "-")}` }, judged.verdict),
    ),
  );
}

/** The first cell of a row: its name, which is a button that shows its pictures. */
function heading(row, on_show) {
  const name = row.picture
    ? el(
        "button",
        { type: "button", class: "link", title: "Show its pictures", onclick: () => on_show(row) },
        row.label,
      )
    : row.label;
  return el(
    "th",
    { scope: "row" },
    el("span", { class: "label" }, name),
    el("span", { class: "caption" }, row.caption),
  );
}

function picture_cells({ picture, missing }, decimals, on_pixel) {
  if (!picture || picture.verdict === "not examined") {
    return el("td", { class: "reason", colspan: PICTURE_COLUMNS }, picture?.reason ?? missing);
  }
  const { flip, differing_pixels, greatest_levels, worst_pixel } = picture;
  const pixel = worst_pixel?.join(", ");
  return [
    el(
      "td",
      {},
      el("span", { class: `diff-word ${picture.verdict}` }, picture.verdict),
      picture.linear === "different" && picture.verdict === "identical"
        ? el("span", { class: "interval" }, "but not its floats")
        : null,
    ),
    number_cell(flip.mean, fixed(flip.mean, decimals.mean)),
    number_cell(flip.max, fixed(flip.max, decimals.max)),
    number_cell(differing_pixels, integer(differing_pixels)),
    number_cell(greatest_levels, integer(greatest_levels)),
    el(
      "td",
      { class: "number" },
      pixel
        ? el("button", { type: "button", class: "link", "aria-label": `Show pixel ${pixel}`, onclick: on_pixel }, pixel)
        : DASH,
    ),
  ];
}

function time_cells(time, decimals) {
  if (!time) return HEADS.slice(PICTURE_COLUMNS).map(() => el("td", { class: "number missing" }, DASH));
  return [
    number_cell(time.a.median, fixed(time.a.median, decimals.ms)),
    number_cell(time.b.median, fixed(time.b.median, decimals.ms)),
    ratio_cell(time.absolute, time.reason),
    ratio_cell(time.relative, time.relative_reason),
    el(
      "td",
      { class: "diff-verdict" },
      el("span", { class: `diff-word ${time.verdict.replace(" ", "-")}` }, time.verdict),
      time.reason ? el("span", { class: "interval" }, time.reason) : null,
    ),
  ];
}

/** Rows of a run: the reference, then the methods. */
function rows_of(run, baseline) {
  const reference = run.reference;
  return [
    { label: "Reference", caption: reference.method.b, picture: reference.picture, missing: "no picture" },
    ...run.results.map((result) => ({
      label: result.label,
      caption: result.label === baseline ? `${result.method} · baseline` : result.method,
      picture: result.picture,
      time: result.time,
      missing: ["a", "b"]
        .map((side) =>
          [`${side.toUpperCase()}: ${result.status[side]}`, result.reason?.[side]].filter(Boolean).join(", "),
        )
        .join("; "),
    })),
  ];
}

function run_table(rows, on_show) {
  const pictures = rows.map((row) => row.picture).filter((picture) => picture?.flip);
  const times = rows.map((row) => row.time).filter(Boolean);
  const decimals = {
    mean: column_decimals(pictures.map((picture) => picture.flip.mean)),
    max: column_decimals(pictures.map((picture) => picture.flip.max)),
    ms: column_decimals(times.flatMap((time) => [time.a.median, time.b.median])),
  };
  const body = rows.map((row) =>
    el(
      "tr",
      { "data-label": row.label },
      heading(row, on_show),
      picture_cells(row, decimals, () => on_show(row, row.picture.worst_pixel)),
      time_cells(row.time, decimals),
    ),
  );
  return el(
    "div",
    { class: "table-box", tabindex: "0", role: "region", "aria-label": "Pictures and times" },
    el(
      "table",
      { class: "results diff" },
      el("caption", {}, "Pictures and times", el("span", { class: "muted" }, " A ÷ B over 1: B is faster")),
      el(
        "thead",
        {},
        el(
          "tr",
          {},
          el("th", { scope: "col" }, "Method"),
          HEADS.map(([head, kind]) => el("th", { scope: "col", class: kind }, head)),
        ),
      ),
      el("tbody", {}, body),
    ),
  );
}

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
