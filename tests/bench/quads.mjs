// Draws docs/images/quads.svg and writes docs/results/quads.md from the report of tests/bench/quads.json: time against the
// number of quads, and the limit, f2b's time for only the fragments that are needed.
//   node quads.mjs REPORT SVG MARKDOWN
import { readFileSync, writeFileSync } from "node:fs";

const [, , report_file, svg_file, table_file] = process.argv;
const report = JSON.parse(readFileSync(report_file, "utf8"));
const count_of = (run) => run.point["/scene/count"];
const result_of = (run, label) => run.results.find((result) => result.label === label);
const LIMIT = "limit";
const LINES = [
  ["b2f", "back to front", "#6b7280"],
  ["f2bd", "f2bd, discards", "#d97706"],
  ["f2bx", "f2bx, the paper's bound", "#b91c1c"],
  ["f2bh", "f2bh, marks batches", "#1d4ed8"],
  ["f2bg", "f2bg, walks", "#0d9488"],
  [LIMIT, "limit: only what is needed", "#111827"],
];

/** The median time, or the limit: f2b's for only the needed fragments of f2bd. */
function time_ms(run, label) {
  if (label !== LIMIT) return result_of(run, label)?.timing?.median;
  const { submitted, needed } = result_of(run, "f2bd").fragments;
  return (result_of(run, "f2b").timing.median * needed) / submitted;
}

// A place in the picture, both axes logarithmic.
const width = 760,
  height = 430,
  left = 64,
  right = 560,
  top = 46,
  bottom = 372;
const counts = report.runs.map(count_of);
const times = report.runs.flatMap((run) => LINES.map(([label]) => time_ms(run, label)).filter((ms) => ms > 0));
const low_ms = 10 ** Math.floor(Math.log10(Math.min(...times))),
  high_ms = 10 ** Math.ceil(Math.log10(Math.max(...times)));
const along = (value, [from, to], [begin, end]) =>
  begin + ((Math.log(value) - Math.log(from)) / (Math.log(to) - Math.log(from))) * (end - begin);
const x_of = (count) => along(count, [counts[0], counts.at(-1)], [left, right]).toFixed(1);
const y_of = (ms) => along(ms, [low_ms, high_ms], [bottom, top]).toFixed(1);

const decades = [];
for (let ms = low_ms; ms <= high_ms * 1.001; ms *= 10) decades.push(ms);
const name_of_ms = (ms) => (ms >= 1000 ? `${ms / 1000} s` : `${Number(ms.toPrecision(1))} ms`);
const grid = decades
  .map(
    (ms) =>
      `<path d="M${left} ${y_of(ms)}H${right}" stroke="#d1d5db"/><text x="${left - 8}" y="${y_of(ms)}" dy="4" text-anchor="end">${name_of_ms(ms)}</text>`,
  )
  .concat(
    counts.map(
      (count) =>
        `<path d="M${x_of(count)} ${top}V${bottom}" stroke="#e5e7eb"/><text x="${x_of(count)}" y="${bottom + 20}" text-anchor="middle">${count.toLocaleString("en")}</text>`,
    ),
  );

/** Names at the ends of the lines, moved apart. */
function label_places(ends) {
  const places = ends.map(([label, y]) => [label, Number(y)]).sort((a, b) => a[1] - b[1]);
  for (let i = 1; i < places.length; ++i) places[i][1] = Math.max(places[i][1], places[i - 1][1] + 18);
  return new Map(places);
}

const drawn = LINES.map(([label, name, color]) => {
  const points = report.runs.map((run) => [x_of(count_of(run)), time_ms(run, label)]).filter(([, ms]) => ms > 0);
  return { label, name, color, points: points.map(([x, ms]) => [x, y_of(ms)]) };
}).filter(({ points }) => points.length > 0);
const names = label_places(drawn.map(({ label, points }) => [label, points.at(-1)[1]]));
const lines = drawn.map(({ label, name, color, points }) => {
  const dash = label === LIMIT ? ' stroke-dasharray="6 4"' : "";
  const dots = points.map(([x, y]) => `<circle cx="${x}" cy="${y}" r="3.5"/>`).join("");
  return (
    `<g stroke="${color}" fill="none" stroke-width="2"><polyline points="${points.map((at) => at.join(",")).join(" ")}"${dash}/></g>` +
    `<g fill="${color}">${label === LIMIT ? "" : dots}<text x="${right + 12}" y="${names.get(label)}" dy="4">${name}</text></g>`
  );
});
const device = report.device.renderer.replace(/ *[(/].*/, "");
writeFileSync(
  svg_file,
  `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" font-family="system-ui, sans-serif" font-size="13" fill="#374151">
<rect width="${width}" height="${height}" rx="8" fill="#fff"/>
<text x="${left}" y="26" font-size="15" font-weight="600" fill="#111827">Time of a frame against the number of quads, ${device}</text>
${grid.join("\n")}
${lines.join("\n")}
<text x="${(left + right) / 2}" y="${bottom + 42}" text-anchor="middle">quads of random size, 16 texture reads for each fragment, ${report.spec.image.width} × ${report.spec.image.height} px</text>
</svg>
`,
);

const digits = (value, places) => (value === undefined || value === null ? "-" : value.toFixed(places));
const cell = (run, label) => {
  const result = result_of(run, label);
  if (result?.status !== "ok") return result?.status ?? "-";
  const { median, ci95 } = result.timing;
  const interval = ci95 ? ` [${digits(ci95[0], 0)}, ${digits(ci95[1], 0)}]` : "";
  return `${digits(median, median < 100 ? 1 : 0)}${interval} / ${digits(result.fragments.efficiency, 2)}`;
};
const labels = report.runs[0].results.map((result) => result.label);
const rows = report.runs.map((run) => {
  const { submitted, needed } = result_of(run, "f2bd").fragments;
  const share = `${((100 * needed) / submitted).toFixed(1)} %`;
  return `| ${count_of(run).toLocaleString("en")} | ${share} | ${digits(time_ms(run, LIMIT), 1)} | ${labels.map((label) => cell(run, label)).join(" | ")} |`;
});
writeFileSync(
  table_file,
  `# Early discarding against the number of quads

Made by \`./dev quads\` from \`tests/bench/quads.json\`: medians of interleaved rounds in ms, with the interval of 95 % where there
were enough rounds, / efficiency, which is the limit over the method's own time. The limit is \`f2b\`'s time for only the fragments
that are needed. Device: ${report.device.renderer}, ${report.device.driver}; ${report.spec.image.width} x ${report.spec.image.height} pixels; sheer
${report.provenance.version}, commit ${report.provenance.commit}; load at the start ${report.provenance.load.start.map((one) => one.toFixed(1)).join(", ")} on ${report.provenance.cores} cores.

![Time against the number of quads](../images/quads.svg)

| quads | needed | limit | ${labels.map((label) => `\`${label}\``).join(" | ")} |
|---|---|---|${labels.map(() => "---|").join("")}
${rows.join("\n")}
`,
);
