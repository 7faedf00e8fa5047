// The examples of docs/ci.md: a workflow's steps, and curl and jq alone.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { QUICK, Service } from "./service.mjs";

const page = readFileSync(join(dirname(fileURLToPath(import.meta.url)), "..", "..", "docs", "ci.md"), "utf8");
const folder = mkdtempSync(join(tmpdir(), "sheer-examples-"));
const service = new Service();
before(async () => {
  await service.start();
  symlinkSync(process.env.SHEER, join(folder, "sheer"));
});
after(async () => {
  rmSync(folder, { recursive: true, force: true });
  await service.end_well();
});

/** The code below the comment that names it. */
function example(name) {
  const [, code] = new RegExp(`<!-- example: ${name} -->\n\n\`\`\`\\w+\n(.*?)\`\`\``, "s").exec(page) ?? [];
  assert.ok(code, name);
  return code;
}

const steps = (name) => [...example(name).matchAll(/^ *run: (.*)$/gm)].map(([, command]) => command);

/** Runs a script as CI does; without proxies, which may not know the service. */
function run(script, gate) {
  writeFileSync(join(folder, "gate.json"), JSON.stringify(gate));
  const env = { ...process.env, SHEER_SERVER: service.origin, GITHUB_ACTOR: "ada", no_proxy: "*" };
  env.PATH = `${folder}:${env.PATH}`;
  return spawnSync("bash", ["-eo", "pipefail", "-c", script], { cwd: folder, env, encoding: "utf8" });
}

const checked = (max) => ({ ...QUICK, checks: [{ metric: "flip.mean", method: "f2b", max }] });
const read = (name) => readFileSync(join(folder, name), "utf8");

test("the steps of the workflow pass, accept, and fail", async () => {
  const [gate] = steps("workflow");
  const passed = run(gate, checked(0.5));
  assert.equal(passed.status, 0, passed.stderr);
  assert.match(read("summary.md"), /passed/i);
  const { id } = JSON.parse(read("report/report.json"));
  assert.equal(run(steps("accept")[0], checked(0.5)).status, 0);
  const baseline = await (await fetch(`${service.api}/baselines/main`)).json();
  assert.deepEqual(
    baseline.reports.map(({ report, by, reason }) => [report, by, reason]),
    [[id, "ada", "merged"]],
  );
  const failed = run(gate, { ...checked(0.5), checks: [{ metric: "differing_pixels", method: "f2b", min: 1000 }] });
  assert.equal(failed.status, 1, failed.stderr);
  assert.match(read("junit.xml"), /<failure/);
});

test("curl and jq pass, fail, and refuse a wrong spec", () => {
  const passed = run(example("curl"), checked(0.5));
  assert.equal(passed.status, 0, passed.stderr);
  assert.match(passed.stdout, /^passed: flip\.mean of f2b is 0/);
  assert.match(read("report.html"), /<html/);
  const failed = run(example("curl"), { ...QUICK, checks: [{ metric: "differing_pixels", method: "f2b", min: 1000 }] });
  assert.notEqual(failed.status, 0);
  assert.match(failed.stdout, /^failed: differing_pixels/);
  assert.notEqual(run(example("curl"), { ...QUICK, methods: ["f2x"] }).status, 0);
});

/** The exit code with fresh outputs over those of an earlier run. */
function outputs_of(words, spec) {
  for (const name of ["j.xml", "s.md"]) writeFileSync(join(folder, name), "an earlier run");
  writeFileSync(join(folder, "spec.json"), JSON.stringify(spec));
  const all = ["spec.json", "--junit", "j.xml", "--markdown", "s.md", "-q", ...words.slice(1)];
  const { status, stderr } = spawnSync(process.env.SHEER, [words[0], ...all], { cwd: folder, encoding: "utf8" });
  return { status, stderr, junit: read("j.xml"), summary: read("s.md") };
}

test("every exit code leaves fresh outputs", () => {
  const failing = { ...QUICK, checks: [{ metric: "differing_pixels", method: "f2b", min: 1000 }] };
  // When the time is over there are too few rounds for an interval.
  const open = {
    ...QUICK,
    timing: { warmup: 1, rounds: 1, max_seconds: 0.001 },
    checks: [{ metric: "timing.median", method: "b2f", max: 10_000 }],
    on_undecided: "fail",
  };
  const lost = { ...QUICK, image: { width: 16, height: 16 }, methods: ["f2x"] };
  const server = ["--server", service.origin];
  for (const [code, words, spec, said] of [
    [0, ["compare"], checked(0.5), /passed/i],
    [1, ["compare"], failing, /differing(_|&#95;)pixels/],
    [2, ["compare"], lost, /methods\/0/],
    [3, ["compare", "--device", "no such device"], QUICK, /no such device/],
    [5, ["compare"], open, /undecided/i],
    [0, ["submit", ...server], checked(0.5), /passed/i],
    [1, ["submit", ...server], failing, /differing(_|&#95;)pixels/],
    [1, ["submit", ...server, "--gate"], QUICK, /check/],
    [2, ["submit", ...server], lost, /methods\/0/],
    [4, ["submit", "--server", "http://127.0.0.1:9", "--timeout", "1"], QUICK, /reached/],
    [5, ["submit", ...server], open, /undecided/i],
  ]) {
    const what = `${code} ${words.join(" ")}`;
    const { status, stderr, junit, summary } = outputs_of(words, spec);
    assert.equal(status, code, `${what}: ${stderr}`);
    assert.match(junit, /^<\?xml.*<testsuite/s, what);
    assert.match(summary, /^#+ /, what);
    for (const text of [junit, summary]) {
      assert.doesNotMatch(text, /an earlier run|did not end/, what);
      assert.match(text, said, what);
    }
  }
});
