// `sheer submit` and `sheer baseline`: a pipeline's side of the service.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { createHash } from "node:crypto";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { QUICK, Service, lasting, until } from "./service.mjs";

const service = new Service();
const folder = mkdtempSync(join(tmpdir(), "sheer-submit-"));
before(() => service.start());
after(async () => {
  await service.end_well();
  rmSync(folder, { recursive: true, force: true });
});

const file = (name) => join(folder, name);
const text_of = (name) => readFileSync(file(name), "utf8");

function spec_file(name, spec) {
  writeFileSync(file(name), typeof spec === "string" ? spec : JSON.stringify(spec));
  return file(name);
}

/** Runs the program without blocking the service's pipes; `env` is added to the environment. */
function sheer(words, { env = {}, input = "" } = {}) {
  const clean = { ...process.env, SHEER_SERVER: service.origin, GITHUB_RUN_ID: "", CI_JOB_ID: "", ...env };
  const child = spawn(process.env.SHEER, words, { env: clean });
  let stdout = "";
  let stderr = "";
  child.stdout.on("data", (text) => (stdout += text));
  child.stderr.on("data", (text) => (stderr += text));
  child.stdin.on("error", () => {});
  child.stdin.end(input);
  const ended = new Promise((resolve) => child.on("close", (status) => resolve({ status, stdout, stderr })));
  return Object.assign(ended, { log: () => stderr });
}

const CHECKED = { ...QUICK, checks: [{ metric: "flip.mean", method: "f2b", max: 0.05 }] };

test("submit writes what compare writes", async () => {
  const spec = spec_file("spec.json", CHECKED);
  const out = ["--out", file("out"), "--junit", file("junit.xml"), "--markdown", file("summary.md")];
  const run = await sheer(["submit", spec, ...out, "--gate"]);
  assert.equal(run.status, 0, run.stderr);
  assert.match(run.stderr, /^Report \w{8}-[\w-]+: http:\/\/127/);
  assert.match(run.stdout, /^passed {2}flip\.mean of f2b is 0/m);
  const report = JSON.parse(text_of("out/report.json"));
  assert.equal(report.status, "done");
  const images = report.runs
    .flatMap((one) => [one.reference, ...one.results])
    .flatMap((one) => Object.values(one.images));
  assert.ok(images.length > 4);
  for (const { url, sha256 } of images)
    assert.equal(
      createHash("sha256")
        .update(readFileSync(file(`out/${url}`)))
        .digest("hex"),
      sha256,
    );
  assert.match(text_of("out/report.html"), /^<!doctype html>/i);
  assert.match(text_of("junit.xml"), /failures="0" errors="0"/);
  assert.match(text_of("summary.md"), /^### Sheer: passed: One red layer\n/);
  assert.match(text_of("summary.md"), /\| passed \| flip\.mean of f2b \| 0 \| at most 0\.05 \|/);
  const again = await sheer(["submit", spec, "--out", file("out"), "-q"]);
  assert.deepEqual([again.status, again.stdout, again.stderr], [0, "", ""], "its own files are replaced");
  const compared = await sheer(["compare", spec, "--out", file("local"), "-q"]);
  assert.deepEqual([compared.status, compared.stdout], [0, ""]);
  assert.equal((await sheer(["diff", file("local"), file("out")])).status, 0, "the same pictures");
});

test("standard input and JSON", async () => {
  const run = await sheer(["submit", "-", "--json", "-q"], { input: JSON.stringify(CHECKED) });
  assert.equal(run.status, 0, run.stderr);
  assert.equal(JSON.parse(run.stdout).verdict, "passed");
});

test("a failed check is exit code 1, with annotations and a summary", async () => {
  const spec = spec_file("failing.json", {
    ...QUICK,
    checks: [
      { metric: "flip.mean", method: "f2b", max: 0.05 },
      { metric: "rmse", method: "b2f", min: 0.5 },
    ],
  });
  const env = { GITHUB_STEP_SUMMARY: spec_file("step.md", "before\n") };
  const run = await sheer(["submit", spec, "--github", "-q", "--junit", file("junit.xml")], { env });
  assert.equal(run.status, 1, run.stderr);
  assert.match(run.stdout, /^::error file=\S+failing\.json,title=Sheer::rmse of b2f is 0\S*, wanted at least 0\.5$/m);
  assert.match(text_of("step.md"), /^before\n### Sheer: failed: /);
  assert.match(text_of("step.md"), /1 of 2 checks failed\.\n/);
  const rows = text_of("step.md").match(/^\| (passed|failed) /gm);
  assert.deepEqual(rows, ["| failed ", "| passed "], "those that failed come first");
  assert.match(text_of("junit.xml"), /failures="1"/);
});

test("a gate without checks fails", async () => {
  const spec = spec_file("unchecked.json", QUICK);
  assert.equal((await sheer(["submit", spec, "-q"])).status, 0);
  for (const command of ["submit", "compare"]) {
    const run = await sheer([command, spec, "-q", "--gate", "--junit", file("junit.xml")]);
    assert.equal(run.status, 1, run.stderr);
    assert.match(text_of("junit.xml"), /<failure message="[^"]*the spec has none/);
  }
});

test("a wrong spec is exit code 2, with every field", async () => {
  const spec = spec_file("wrong.json", { ...QUICK, imge: {}, methods: ["b2f", "f2x"] });
  const run = await sheer(["submit", spec, "--junit", file("junit.xml"), "--github"]);
  assert.equal(run.status, 2);
  assert.match(run.stderr, /^\/imge: is not a known field/m);
  assert.match(run.stderr, /^\/methods\/1: there is no method "f2x"/m);
  assert.match(run.stdout, /^::error file=\S+wrong\.json,title=Sheer::The spec is wrong: /);
  assert.match(text_of("junit.xml"), /errors="1"/);
  assert.equal((await sheer(["submit", file("missing.json")])).status, 2);
  assert.equal((await sheer(["submit", spec, "--server", "ftp://x"])).status, 2);
  const shader = { ...QUICK, scene: { ...QUICK.scene, shading: { glsl: "return your;" } } };
  assert.match(
    (await sheer(["submit", spec_file("shader.json", shader)])).stderr,
    /shading\/glsl: does not compile:\nline 1/,
  );
});

test("a server that cannot be reached is exit code 4, after it was tried again", async () => {
  const spec = spec_file("spec.json", QUICK);
  writeFileSync(file("junit.xml"), "an earlier run");
  const run = await sheer([
    "submit",
    spec,
    "--server",
    "http://127.0.0.1:9",
    "--timeout",
    "3",
    "--junit",
    file("junit.xml"),
  ]);
  assert.equal(run.status, 4);
  assert.match(run.stderr, /trying again in 1 s/);
  assert.match(text_of("junit.xml"), /<error message="The server cannot be reached"/);
});

test("a report that takes too long is cancelled", async () => {
  const spec = spec_file("long.json", lasting(60, "too long"));
  const run = await sheer(["submit", spec, "--timeout", "4"]);
  assert.equal(run.status, 4, run.stderr);
  assert.match(run.stderr, /was still running after 4 s, and is cancelled/);
  const [report] = await service.reports("?q=too%20long");
  await service.reached(report.id, "cancelled");
});

test("the same key with the same spec gives the same report", async () => {
  const spec = spec_file("keyed.json", { ...CHECKED, title: "keyed" });
  for (const _ of [1, 2]) assert.equal((await sheer(["submit", spec, "--key", "k1", "-q"])).status, 0);
  const env = { GITHUB_RUN_ID: "7", GITHUB_RUN_ATTEMPT: "1", GITHUB_JOB: "render" };
  for (const _ of [1, 2]) assert.equal((await sheer(["submit", spec, "-q"], { env })).status, 0);
  assert.equal((await service.reports("?q=keyed")).length, 2);
});

test("a restart of the server meanwhile is waited out", async () => {
  const spec = spec_file("restart.json", lasting(3, "over a restart"));
  const run = sheer(["submit", spec, "--out", file("restarted"), "--timeout", "120"]);
  await until(async () => (await service.reports("?q=over%20a%20restart"))[0]?.status === "running", "it is running");
  service.listen = new URL(service.origin).host;
  await service.stop();
  await until(() => run.log().includes("trying again"), "the client notices");
  await service.start();
  const { status, stderr } = await run;
  assert.equal(status, 0, stderr);
  assert.ok(existsSync(file("restarted/report.json")));
  assert.equal((await service.reports("?q=over%20a%20restart")).length, 1, "it is submitted once");
});

test("baselines are accepted, listed, used and forgotten", async () => {
  const spec = spec_file("first.json", { ...CHECKED, title: "first" });
  const { stdout } = await sheer(["submit", spec, "--json", "-q"]);
  const { id } = JSON.parse(stdout);
  const accepted = await sheer(["baseline", "accept", "main", id, "--by", "ada", "--reason", "the first"]);
  assert.equal(accepted.status, 0, accepted.stderr);
  assert.match(accepted.stdout, new RegExp(`^main\n {2}${id} {2}accepted \\S+ by ada: the first {2}"first" on `));
  assert.equal((await sheer(["baseline", "list"])).stdout, accepted.stdout);
  assert.equal(
    JSON.parse((await sheer(["baseline", "list", "main", "--json"])).stdout).baselines[0].reports[0].by,
    "ada",
  );

  const against = { ...CHECKED, against: "baseline:main", tolerance: { max_slowdown: 1000 } };
  const compared = await sheer([
    "submit",
    spec_file("against.json", against),
    "--markdown",
    file("summary.md"),
    "--gate",
  ]);
  assert.equal(compared.status, 0, compared.stdout + compared.stderr);
  assert.match(text_of("summary.md"), new RegExp(`compared with ${id} of main, accepted`));
  assert.match(compared.stdout, /^passed {2}against\.flip\.mean of b2f is 0, at most 0: the pictures are identical$/m);

  const unknown = await sheer(["baseline", "accept", "main", "nothing"]);
  assert.equal(unknown.status, 2);
  assert.match(unknown.stderr, /\/report: there is no such report/);
  assert.equal((await sheer(["baseline", "forget", "main", id])).status, 0);
  assert.equal((await sheer(["baseline", "forget", "main"])).status, 2);
  assert.equal((await sheer(["baseline", "list"])).stdout, "");
  assert.equal((await sheer(["baseline", "list", "--server", "http://127.0.0.1:9"])).status, 4);
});
