// A program with an additional method, scene and metric (tests/made_up): each appears wherever the others do, although
// only its own files name it.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { cpSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";
import { Service } from "./service.mjs";

const program = process.env.SHEER_MADE_UP;
assert.ok(program, "SHEER_MADE_UP must be the path of the program with made-up entries");

const repository = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
const spec = join(repository, "tests", "made_up", "specs", "made-up.json");
const folder = mkdtempSync(join(tmpdir(), "sheer-made-up-"));
after(() => rmSync(folder, { recursive: true, force: true }));

const run = (...words) => spawnSync(program, words, { encoding: "utf8", cwd: folder });
const text_of = (...path) => readFileSync(join(folder, ...path), "utf8");

// The white layer lets 60 % of the black show through: 0.4 * 255 = 102 levels; at half the opacity 51.
const REDNESS = { b2f: 102, made_up_method: 51 };

test("the terminal lists them with their parameters", () => {
  for (const [command, id, parameter] of [
    ["methods", "made_up_method", "whim"],
    ["scenes", "made_up_scene", "veil"],
    ["metrics", "made_up_metric", "redness"],
  ]) {
    const text = run(command).stdout;
    assert.match(text, new RegExp(`^${id}\\b`, "m"), command);
    if (command !== "metrics") assert.match(text, new RegExp(`\\b${parameter}\\b`), command);
    const found = JSON.parse(run(command, "--json").stdout).find((one) => one.id === id);
    assert.ok(found, command);
    if (found.parameters) assert.equal(found.parameters[0].name, parameter);
  }
});

test("a comparison of them has the metric in its table, its report and its checks", () => {
  const { status, stdout, stderr } = run("compare", spec, "--out", "out");
  assert.equal(status, 0, stdout + stderr);
  const [head, ...rows] = stdout.split("\n").slice(stdout.split("\n").findIndex((line) => /\bmedian ms\b/.test(line)));
  // In order, so after those of the signed difference, which are single words here.
  const heads = head.split(/ {2,}/);
  assert.equal(heads.indexOf("redness"), heads.indexOf("max d") + 1);
  const end = head.indexOf("redness") + "redness".length;
  for (const [label, level] of Object.entries(REDNESS)) {
    const row = rows.find((line) => line.startsWith(`${label} `));
    assert.ok(row?.slice(0, end).endsWith(` ${level}.0`), row);
  }
  assert.match(stdout, /^passed {2}made_up_metric of made_up_method is 51/m);
  const report = JSON.parse(text_of("out", "report.json"));
  assert.deepEqual(
    Object.fromEntries(report.runs[0].results.map(({ label, metrics }) => [label, metrics.made_up_metric])),
    REDNESS,
  );
  assert.equal(report.spec.scene.veil, 0.4);
});

test("documents and schema have them", () => {
  for (const path of ["docs", "configs", "tests/render"])
    cpSync(join(repository, path), join(folder, "repository", path), { recursive: true });
  const { status, stderr } = run("docs", "repository");
  assert.equal(status, 0, stderr);
  assert.match(text_of("repository/docs/methods.md"), /^## Made-up method\n`made_up_method`: /m);
  assert.match(text_of("repository/docs/methods.md"), /^\| `\/whim` \| changes nothing \|/m);
  assert.match(text_of("repository/configs/README.md"), /^### Scene `made_up_scene`\n/m);
  assert.match(text_of("repository/configs/README.md"), /^\| `\/scene\/veil` \| opacity of the layer \|/m);
  assert.match(text_of("repository/docs/metrics.md"), /^\| `made_up_metric` \| Σ red \/ pixels \|/m);
  const schema = text_of("repository/configs/schema/spec.schema.json");
  for (const id of ["made_up_method", "made_up_scene", "made_up_metric"]) assert.ok(schema.includes(`"${id}"`), id);
});

test("the service describes them and renders their ready-made spec", async () => {
  const service = new Service();
  service.program = program;
  try {
    await service.start();
    const get = async (path) => (await fetch(`${service.api}${path}`)).json();
    assert.ok((await get("/methods")).some(({ id }) => id === "made_up_method"));
    assert.ok((await get("/scenes")).some(({ id }) => id === "made_up_scene"));
    const [field] = (await get("/metrics")).find(({ id }) => id === "made_up_metric").fields;
    assert.deepEqual(field.column, { head: "Redness", better: "higher", digits: 3, note: null });
    assert.match(JSON.stringify(await get("/openapi.json")), /"made_up_metric"/);
    const ready = (await get("/specs/examples")).find(({ spec }) => spec.title === "Made up");
    assert.ok(ready);
    const report = await service.settled(await service.submit(ready.spec));
    assert.equal(report.verdict, "passed", JSON.stringify(report));
    await service.end_well();
  } finally {
    await service.end();
  }
});
