// The schemas of the OpenAPI document: they are complete, accept what is valid, and refuse what is wrong. contract.mjs
// checks the service's answers in all other tests against them.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { contract_at, first_errors, new_ajv } from "./contract.mjs";
import { plain_png } from "./pictures.mjs";
import { QUICK, Service } from "./service.mjs";

const repository = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
const json_of = (...path) => JSON.parse(readFileSync(join(repository, ...path), "utf8"));

const SWEPT = {
  ...QUICK,
  title: "swept",
  tags: { of: "mutations" },
  methods: ["b2f", { id: "f2bd", threshold: 0.01 }, "f2bx", { id: "ssam", label: "averaged" }],
  timing: { warmup: 1, rounds: 8 },
  sweep: [{ pointer: "/scene/layers/0/alpha", values: [0.5, 0.25] }],
  checks: [{ metric: "flip.mean", method: "f2bd", max: 0.05, at: { "/scene/layers/0/alpha": 0.5 } }],
};

const folder = mkdtempSync(join(tmpdir(), "sheer-schemas-"));
const service = new Service();
let contract, report, other;
before(async () => {
  await service.start();
  contract = contract_at(service.origin);
  report = await service.settled(await service.submit(SWEPT));
  other = await service.settled(await service.submit(SWEPT));
  assert.equal(report.status, "done", JSON.stringify(report.error));
});
after(async () => {
  rmSync(folder, { recursive: true, force: true });
  await service.end_well();
});

const get = async (path) => {
  const response = await fetch(service.api + path);
  assert.equal(response.status, 200, path);
  return response.json();
};

function* values_of(value, pointer = "") {
  yield { pointer, value };
  if (value === null || typeof value !== "object") return;
  for (const [key, inner] of Object.entries(value))
    yield* values_of(inner, `${pointer}/${key.replaceAll("~", "~0").replaceAll("/", "~1")}`);
}

test("every reference leads to a schema, and every JSON answer to a component", () => {
  const { components, paths } = contract.document;
  const references = [...values_of(contract.document)].filter(({ pointer }) => pointer.endsWith("/$ref"));
  assert.ok(references.length > 100);
  for (const { pointer, value } of references) {
    const [, kind, name] = /^#\/components\/(\w+)\/([\w-]+)$/.exec(value) ?? [];
    assert.ok(components[kind]?.[name], `${pointer}: ${value}`);
  }
  for (const name of Object.keys(components.schemas)) contract.component(name);
  for (const [path, operations] of Object.entries(paths))
    for (const [method, { responses }] of Object.entries(operations))
      for (const [status, { content = {} }] of Object.entries(responses))
        for (const [type, { schema }] of Object.entries(content))
          if (/json$/.test(type)) assert.ok(schema.$ref, `${method} ${path} ${status} ${type}`);
});

test("objects are closed: a field that no schema names is refused", () => {
  for (const [name, schema] of Object.entries(contract.document.components.schemas))
    if (schema.type === "object")
      assert.ok("additionalProperties" in schema && schema.additionalProperties !== true, name);
  const validate = contract.component("AnyReport");
  assert.ok(validate(report), validate.errors && first_errors(validate));
  assert.ok(!validate({ ...report, more: 1 }));
});

test("whether a report is done distinguishes its two schemas", async () => {
  const [done, unfinished] = ["Report", "UnfinishedReport"].map((name) => contract.component(name));
  assert.ok(done(report));
  assert.ok(!unfinished(report));
  const { components } = contract.document;
  const statuses = (name) => components.schemas[name].properties.status.enum;
  assert.deepEqual(
    statuses("Report").filter((status) => statuses("UnfinishedReport").includes(status)),
    [],
  );
  assert.deepEqual(statuses("Report").concat(statuses("UnfinishedReport")).sort(), [
    "cancelled",
    "done",
    "failed",
    "queued",
    "running",
  ]);
});

test("every ready-made spec is a Spec, and its normalised form is a NormalisedSpec and still a Spec", async () => {
  const [posted, normalised] = ["Spec", "NormalisedSpec"].map((name) => contract.component(name));
  const folders = ["specs", "suites"].map((name) => join("configs", name));
  const names_in = (each) => readdirSync(join(repository, each)).filter((name) => name.endsWith(".json"));
  const files = folders.flatMap((each) => names_in(each).map((name) => join(each, name)));
  assert.ok(files.length > 10);
  for (const file of files) {
    const read = json_of(file);
    const spec = file.includes("suites") ? read.spec : read;
    assert.ok(posted(spec), `${file}: ${posted.errors && first_errors(posted)}`);
    const answer = await fetch(`${service.api}/specs/validate`, {
      method: "POST",
      body: JSON.stringify(spec),
      headers: { "Content-Type": "application/json" },
    });
    // A spec whose model or volume is a file beside it.
    if (answer.status === 422) continue;
    const filled_in = await answer.json();
    assert.ok(normalised(filled_in), `${file}: ${normalised.errors && first_errors(normalised)}`);
    assert.ok(posted(filled_in), `${file}: ${posted.errors && first_errors(posted)}`);
    assert.ok(!normalised({ ...filled_in, more: 1 }), file);
    assert.ok(!normalised({ ...filled_in, title: undefined }), file);
  }
});

test("a report file fits the schema in configs/schema, however the report ended", () => {
  const validate = new_ajv().compile(json_of("configs", "schema", "report.schema.json"));
  const spec = join(repository, "configs", "specs", "quick.json");
  const { status, stderr } = spawnSync(process.env.SHEER, ["compare", spec, "--out", folder], { encoding: "utf8" });
  assert.ok([0, 1].includes(status), stderr);
  const file = JSON.parse(readFileSync(join(folder, "report.json"), "utf8"));
  assert.ok(validate(file), validate.errors && first_errors(validate));
  assert.ok(validate({ ...file, status: "cancelled" }));
  assert.ok(!validate({ ...file, status: "lost" }));
  assert.ok(validate(report), validate.errors && first_errors(validate));
});

function mutated(value) {
  if (value === null) return {};
  if (Array.isArray(value)) return "text";
  return { number: "text", string: 7, boolean: "true", object: [] }[typeof value];
}

/** Replaces each value in turn by one of another type; returns how many of the changes were refused. */
function count_refused(name, document) {
  const validate = contract.component(name);
  assert.ok(validate(document), `${name}: ${validate.errors && first_errors(validate)}`);
  const taken = [];
  let all = 0;
  const visit = (holder, pointer) => {
    for (const key of Object.keys(holder)) {
      const value = holder[key];
      if (value !== null && typeof value === "object") visit(value, `${pointer}/${key}`);
      holder[key] = mutated(value);
      ++all;
      if (validate(document)) taken.push(`${pointer}/${key}`);
      holder[key] = value;
    }
  };
  visit(document, "");
  return { all, taken };
}

const told = (all, taken) =>
  `${all - taken.length} of ${all} changes refused, ${((100 * (all - taken.length)) / all).toFixed(1)} %`;

test("a value of another type is refused everywhere", async () => {
  const upload = await fetch(`${service.api}/assets?name=plain`, {
    method: "POST",
    body: plain_png(8, [255, 0, 0]),
    headers: { "Content-Type": "image/png" },
  });
  assert.equal(upload.status, 201);
  const [width, height] = [report.spec.image.width, report.spec.image.height];
  const problem = await service.post({ ...QUICK, methods: ["nothing"] });
  const answers = [
    ["report", "AnyReport", report],
    ["report", "NormalisedSpec", report.spec],
    ["list", "ReportList", await get("/reports")],
    ["list", "AssetList", await get("/assets")],
    ["catalog", "MethodList", await get("/methods")],
    ["catalog", "SceneList", await get("/scenes")],
    ["catalog", "MetricList", await get("/metrics")],
    ["catalog", "ColumnList", await get("/columns")],
    ["catalog", "RoundsNeeded", await get("/rounds")],
    ["catalog", "SuiteList", await get("/suites")],
    ["catalog", "FieldList", await get("/specs/fields")],
    ["catalog", "ExampleList", await get("/specs/examples")],
    ["catalog", "DeviceList", await get("/devices")],
    ["problem", "Problem", await problem.json()],
    ["diff", "Diff", await get(`/reports/${report.id}/diff?against=${other.id}&run=0`)],
    ["pixel", "Pixel", await get(`/reports/${report.id}/pixel?x=${width / 2}&y=${height / 2}`)],
  ];
  const kinds = {};
  for (const [kind, name, answer] of answers) {
    const { all, taken } = count_refused(name, answer);
    console.log(`${name}: ${told(all, taken)}`);
    const sum = (kinds[kind] ??= { all: 0, taken: [] });
    sum.all += all;
    sum.taken.push(...taken.map((pointer) => name + pointer));
  }
  const loose = [];
  for (const [kind, { all, taken }] of Object.entries(kinds)) {
    console.log(`every ${kind}: ${told(all, taken)}`);
    if (taken.length > 0.05 * all) loose.push(`${kind}: ${told(all, taken)}; taken were ${taken.join(" ")}`);
  }
  assert.deepEqual(loose, []);
});
