// Compares the model of warps with the paper's tables and with what GPUs measured: docs/results/model-tables.md.
//   node model.mjs PAPER_TABLES REPORT...   prints the page
// The reports are those of the suites paper-table-*; the measured columns come from docs/results/paper-tables.md.
import { readFileSync } from "node:fs";

const [, , tables_file, ...report_files] = process.argv;

/** The rows of paper-tables.md by table, place, method and figure: {"NVIDIA H100": "10.349"}; llvmpipe is left out. */
function measured_rows(text) {
  const rows = new Map();
  let table = "",
    heads = [];
  for (const line of text.split("\n")) {
    table = /^## (Table \d)/.exec(line)?.[1] ?? table;
    if (!line.startsWith("| ")) continue;
    const cells = line
      .split("|")
      .slice(1, -1)
      .map((cell) => cell.trim());
    if (cells[0] === "at") heads = cells;
    const devices = heads.slice(4).map((head, index) => [head, cells[index + 4]]);
    const gpus = devices.filter(([head]) => head !== "95 %" && head !== "llvmpipe");
    rows.set([table, cells[0], cells[1].replaceAll("`", ""), cells[2]].join(), Object.fromEntries(gpus));
  }
  return rows;
}

const place_text = (at) =>
  Object.entries(at)
    .map(([pointer, value]) => `${pointer.replace(/.*\//, "")} ${value}`)
    .join(", ");
const digits = (value) => (Number.isFinite(value) ? value.toFixed(2) : "-");
const median = (values) => {
  const sorted = [...values].sort((a, b) => a - b);
  const middle = sorted.length / 2;
  return sorted.length % 2 ? sorted[Math.floor(middle)] : (sorted[middle - 1] + sorted[middle]) / 2;
};

const measured = measured_rows(readFileSync(tables_file, "utf8"));
const rows = [];
let gpus = [];
for (const file of report_files) {
  const report = JSON.parse(readFileSync(file, "utf8"));
  const table = report.suite.id.replace("paper-table-", "Table ");
  for (const { at, method, metric, published } of report.suite.figures) {
    if (metric !== "speedup" || typeof published !== "number") continue;
    const run = report.runs.find(({ point }) => Object.entries(at).every(([key, value]) => point[key] === value));
    const model = run?.results.find(({ label }) => label === method)?.fragments?.model_speedup;
    const found = measured.get([table, place_text(at), method, metric].join()) ?? {};
    gpus = Object.keys(found).length > 0 ? Object.keys(found) : gpus;
    rows.push({ table, place: place_text(at), method, published, model, found });
  }
}

/** How far the model is from the others, as a factor: the median over the rows, and the share within a factor of 1.5. */
function distance(chosen, value_of) {
  const factors = chosen
    .map((row) => [row.model, value_of(row)])
    .filter(([model, value]) => model > 0 && value > 0)
    .map(([model, value]) => Math.exp(Math.abs(Math.log(model / value))));
  if (factors.length === 0) return "-";
  const near = factors.filter((factor) => factor <= 1.5).length;
  return `${digits(median(factors))}, ${near} of ${factors.length}`;
}

const methods = [...new Set(rows.map(({ method }) => method))];
const summary = methods.map((method) => {
  const chosen = rows.filter((row) => row.method === method);
  const columns = gpus.map((gpu) => distance(chosen, ({ found }) => Number(found[gpu])));
  return `| \`${method}\` | ${distance(chosen, ({ published }) => published)} | ${columns.join(" | ")} |`;
});
const first = JSON.parse(readFileSync(report_files[0], "utf8"));
console.log(`# The model of warps, compared with measurements: the figures

Made by \`./dev model\`; [model.md](model.md) says where it fits. \`model\` is the speedup over \`b2f\` that follows from counting warps alone, with no time measured
([assumptions](../measuring.md#warps-and-a-model)); the fragments were counted on ${first.device.renderer.replace(/ *[(/].*/, "")}, which draws primitives one after the
other, so every discard comes in time. \`published\` is the paper's figure (${first.suite.device}), the others are those of
[paper-tables.md](paper-tables.md).

## How far apart
The median factor between model and measurement, and how many rows are within a factor of 1.5.

| method | published | ${gpus.join(" | ")} |
|---|---|${gpus.map(() => "---|").join("")}
${summary.join("\n")}

## All rows

| table | at | method | model | published | ${gpus.join(" | ")} |
|---|---|---|---|---|${gpus.map(() => "---|").join("")}
${rows.map(({ table, place, method, published, model, found }) => `| ${table.slice(6)} | ${place} | \`${method}\` | ${digits(model)} | ${published} | ${gpus.map((gpu) => found[gpu] ?? "-").join(" | ")} |`).join("\n")}`);
