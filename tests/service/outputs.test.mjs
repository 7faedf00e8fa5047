// The output of `sheer compare`: complete reports among other files, and a JUnit file that never describes an earlier
// run, however it ends.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import {
  existsSync,
  mkdirSync,
  mkdtempSync,
  readdirSync,
  readFileSync,
  rmSync,
  symlinkSync,
  writeFileSync,
} from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { assert_problem, lasting, QUICK, until, with_service } from "./service.mjs";

const root = mkdtempSync(join(tmpdir(), "sheer-outputs-"));
after(() => rmSync(root, { recursive: true, force: true }));

let folders = 0;

/** A new folder with a spec in it. */
function folder_with(spec) {
  const folder = join(root, String(++folders));
  mkdirSync(folder);
  writeFileSync(join(folder, "spec.json"), typeof spec === "string" ? spec : JSON.stringify(spec));
  return folder;
}

const sheer = (folder, ...words) => spawnSync(process.env.SHEER, words, { encoding: "utf8", cwd: folder });
const text_of = (folder, name) => readFileSync(join(folder, name), "utf8");
const json_of = (folder, name) => JSON.parse(text_of(folder, name));

/** The counts in the first line of a JUnit file. */
function counts(junit) {
  const [, tests, failures, errors] = /tests="(\d+)" failures="(\d+)" errors="(\d+)"/.exec(junit);
  return { tests: Number(tests), failures: Number(failures), errors: Number(errors) };
}

const CHECKED = { ...QUICK, checks: [{ metric: "flip.mean", method: "f2b", max: 1 }] };
const FAILING = { ...QUICK, checks: [{ metric: "fragments.submitted", method: "f2b", max: 1 }] };

/** Two points that take a moment, then one that runs until it is ended; all of them have the same timing. */
const SLOW_END = {
  ...QUICK,
  title: "a slow end",
  image: { width: 64, height: 64 },
  timing: { warmup: 1, rounds: 500, max_seconds: 600 },
  scene: { type: "quads", count: 1, shading: "constant" },
  sweep: [{ pointer: "/scene/count", values: [1, 2, 1024] }],
};
const SLOW = { ...SLOW_END, scene: { ...SLOW_END.scene, count: 1024 }, sweep: [] };

test("other files in a folder are kept, and a report replaces the previous one", () => {
  const folder = folder_with(CHECKED);
  mkdirSync(join(folder, ".git"));
  writeFileSync(join(folder, ".git", "HEAD"), "ref");
  assert.equal(sheer(folder, "compare", "spec.json", "--out", ".").status, 0, "into the spec's own folder");
  assert.equal(json_of(folder, "report.json").verdict, "passed");
  assert.equal(json_of(folder, "spec.json").title, QUICK.title);
  const before = readdirSync(join(folder, "images"));
  writeFileSync(join(folder, "images", "mine.png"), "mine");
  writeFileSync(join(folder, "spec.json"), JSON.stringify({ ...FAILING, methods: ["f2b"] }));
  assert.equal(sheer(folder, "compare", "spec.json", "--out", `${folder}/`).status, 1);
  assert.equal(json_of(folder, "report.json").verdict, "failed");
  assert.equal(text_of(folder, "images/mine.png"), "mine");
  const now = readdirSync(join(folder, "images"));
  assert.ok(
    before.some((name) => name.startsWith("2-f2b")) && !now.some((name) => name.startsWith("2-f2b")),
    String(now),
  );
  assert.equal(text_of(folder, ".git/HEAD"), "ref");
  assert.deepEqual(readdirSync(folder).sort(), [
    ".git",
    ".sheer-manifest.json",
    "images",
    "report.html",
    "report.json",
    "spec.json",
  ]);
});

test("a report.json that is not Sheer's is refused before anything is rendered", () => {
  const folder = folder_with(CHECKED);
  writeFileSync(join(folder, "report.json"), '{"lighthouse": 1}');
  const refused = sheer(folder, "compare", "spec.json", "--out", ".", "--junit", "j.xml");
  assert.equal(refused.status, 2);
  assert.match(refused.stderr, /report\.json already exists/);
  assert.doesNotMatch(refused.stderr, /building the scene/);
  assert.deepEqual(readdirSync(folder).sort(), ["j.xml", "report.json", "spec.json"]);
  assert.deepEqual(counts(text_of(folder, "j.xml")), { tests: 1, failures: 0, errors: 1 });

  // One that Sheer wrote but somebody changed is refused too.
  assert.equal(sheer(folder, "compare", "spec.json", "--out", "out").status, 0);
  writeFileSync(join(folder, "out", "report.html"), "my remarks");
  assert.equal(sheer(folder, "compare", "spec.json", "--out", "out").status, 2);
  assert.equal(text_of(folder, "out/report.html"), "my remarks");
});

test("a failed run leaves the previous report as it is", () => {
  const folder = folder_with(CHECKED);
  assert.equal(sheer(folder, "compare", "spec.json", "--out", "out").status, 0);
  const before = text_of(folder, "out/report.json");
  const broken = { ...QUICK, scene: { ...QUICK.scene, shading: { glsl: "return vec4(nothing_of_this_name);" } } };
  writeFileSync(join(folder, "spec.json"), JSON.stringify(broken));
  const failed = sheer(folder, "compare", "spec.json", "--out", "out", "--junit", "out/junit.xml");
  assert.ok(failed.status >= 2, failed.stderr);
  assert.equal(text_of(folder, "out/report.json"), before);
  assert.deepEqual(readdirSync(join(folder, "out")).sort(), [
    ".sheer-manifest.json",
    "images",
    "junit.xml",
    "report.html",
    "report.json",
  ]);
  assert.equal(counts(text_of(folder, "out/junit.xml")).errors, 1);
});

test("the JUnit file describes this run whatever the exit code", () => {
  const folder = folder_with(CHECKED);
  const run = (spec, ...words) => {
    writeFileSync(join(folder, "j.xml"), '<testsuite tests="1" failures="0" errors="0"/>');
    writeFileSync(join(folder, "spec.json"), typeof spec === "string" ? spec : JSON.stringify(spec));
    const { status, stderr } = sheer(folder, "compare", "spec.json", "--junit", "j.xml", ...words);
    return { status, ...counts(text_of(folder, "j.xml")), junit: text_of(folder, "j.xml"), stderr };
  };
  const passed = run(CHECKED);
  assert.deepEqual([passed.status, passed.tests, passed.failures, passed.errors], [0, 3, 0, 0]);
  const failed = run(FAILING);
  assert.deepEqual([failed.status, failed.failures, failed.errors], [1, 1, 0]);
  for (const spec of ["no JSON", { ...QUICK, methods: ["f2x"] }]) {
    const wrong = run(spec);
    assert.deepEqual([wrong.status, wrong.errors], [2, 1], wrong.stderr);
  }
  assert.match(run({ ...QUICK, methods: ["f2x"] }).junit, /<error [^>]*>\/methods\/0: /);
  assert.deepEqual([run(QUICK, "--bogus").status, run(QUICK, "--bogus").errors], [2, 1]);
  assert.equal(run(QUICK, "--scale", "7").errors, 1);
  const nowhere = run(QUICK, "--device", "no such device");
  assert.deepEqual([nowhere.status, nowhere.errors], [3, 1]);
});

test("a JUnit file that cannot be written, or would overwrite another file, is refused before rendering", () => {
  const folder = folder_with(CHECKED);
  const refuse = (junit, ...words) => {
    const run = sheer(folder, "compare", "spec.json", "--junit", junit, ...words);
    assert.equal(run.status, 2, run.stderr);
    assert.doesNotMatch(run.stderr, /building the scene/);
  };
  refuse("missing/j.xml");
  refuse(".");
  refuse("spec.json");
  symlinkSync("spec.json", join(folder, "link.json"));
  refuse("link.json");
  refuse("out/report.json", "--out", "out");
  refuse("out/images/j.xml", "--out", "out");
  assert.equal(json_of(folder, "spec.json").title, QUICK.title);
  assert.deepEqual(readdirSync(folder).sort(), ["link.json", "spec.json"]);
  assert.equal(sheer(folder, "compare", "spec.json", "--junit", "out/ci/j.xml", "--out", "out").status, 0);
  assert.equal(counts(text_of(folder, "out/ci/j.xml")).failures, 0);
  assert.equal(sheer(folder, "compare", "spec.json", "--junit", "/dev/null").status, 0);
});

/** Ends a comparison with a signal once its log matches `moment`. */
async function end_by(signal, folder, words, moment) {
  const child = spawn(process.env.SHEER, ["compare", "spec.json", ...words], {
    cwd: folder,
    stdio: ["ignore", "pipe", "pipe"],
  });
  let log = "",
    table = "";
  child.stderr.on("data", (text) => {
    log += text;
  });
  child.stdout.on("data", (text) => {
    table += text;
  });
  const ended = new Promise((resolve) => child.on("close", (code, by) => resolve({ code, by })));
  try {
    await until(() => moment.test(log) || child.exitCode !== null, String(moment), 120);
    child.kill(signal);
    return { ...(await ended), log, table };
  } finally {
    child.kill("SIGKILL");
  }
}

for (const [signal, number] of [
  ["SIGINT", 2],
  ["SIGTERM", 15],
  ["SIGHUP", 1],
]) {
  test(`${signal} leaves the previous report, no leftovers, and a JUnit file with an error`, async () => {
    const folder = folder_with(CHECKED);
    assert.equal(sheer(folder, "compare", "spec.json", "--out", "out").status, 0);
    const before = text_of(folder, "out/report.json");
    writeFileSync(join(folder, "spec.json"), JSON.stringify(SLOW));
    const ended = await end_by(signal, folder, ["--out", "out", "--junit", "j.xml"], /timing/);
    assert.deepEqual([ended.code, ended.by], [128 + number, null], ended.log);
    assert.match(ended.log, new RegExp(`ended by ${signal}; no point was finished`));
    assert.equal(text_of(folder, "out/report.json"), before);
    assert.deepEqual(readdirSync(join(folder, "out")).sort(), [
      ".sheer-manifest.json",
      "images",
      "report.html",
      "report.json",
    ]);
    assert.equal(counts(text_of(folder, "j.xml")).errors, 1);
    if (signal !== "SIGINT") return;
    await end_by(signal, folder, ["--out", "new/deep"], /building/);
    assert.equal(existsSync(join(folder, "new")), false, "a folder that was made for it is removed again");
  });
}

test("the finished points of a sweep are kept, and never pass", async () => {
  const folder = folder_with({ ...SLOW_END, checks: [{ metric: "flip.mean", method: "f2b", max: 1 }] });
  const ended = await end_by("SIGTERM", folder, ["--out", "out", "--junit", "j.xml"], /count 1024: timing/);
  assert.equal(ended.code, 143, ended.log);
  assert.match(ended.log, /2 of 3 points were finished: .*out\/report\.html/);
  assert.match(ended.table, /At count 2\n/);
  const report = json_of(folder, "out/report.json");
  assert.deepEqual([report.status, report.verdict, report.points], ["cancelled", "failed", { asked: 3, done: 2 }]);
  assert.deepEqual(
    report.runs.map((run) => run.point),
    [{ "/scene/count": 1 }, { "/scene/count": 2 }],
  );
  assert.ok(report.checks.length === 2 && report.checks.every((check) => check.passed));
  assert.equal(report.notes[0].code, "incomplete");
  for (const run of report.runs)
    for (const result of run.results) assert.ok(existsSync(join(folder, "out", result.images.color.url)));
  assert.deepEqual(counts(text_of(folder, "j.xml")), { tests: 7, failures: 0, errors: 1 });
  assert.equal(existsSync(join(folder, "out", ".sheer-partial")), false);

  // Beside a complete report it is in a separate folder, until there is a complete one again.
  const quick = JSON.stringify(CHECKED),
    slow = text_of(folder, "spec.json");
  writeFileSync(join(folder, "spec.json"), quick);
  assert.equal(sheer(folder, "compare", "spec.json", "--out", "out").status, 0);
  writeFileSync(join(folder, "spec.json"), slow);
  await end_by("SIGINT", folder, ["--out", "out"], /count 1024: timing/);
  assert.equal(json_of(folder, "out/report.json").status, "done");
  assert.equal(json_of(folder, "out/incomplete/report.json").points.done, 2);
  writeFileSync(join(folder, "spec.json"), quick);
  assert.equal(sheer(folder, "compare", "spec.json", "--out", "out").status, 0);
  assert.equal(existsSync(join(folder, "out", "incomplete")), false);
});

test("a point that cannot be rendered leaves the previous ones", () => {
  const pixel = Buffer.from(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==",
    "base64",
  );
  const folder = folder_with({
    ...QUICK,
    scene: { ...QUICK.scene, texture: { image: "a.png", size: 8 }, shading: "1-texture" },
    sweep: [{ pointer: "/scene/texture/image", values: ["a.png", "b.png"] }],
  });
  writeFileSync(join(folder, "a.png"), pixel);
  const failed = sheer(
    root,
    "compare",
    join(folder, "spec.json"),
    "--out",
    join(folder, "out"),
    "--junit",
    join(folder, "j.xml"),
  );
  assert.equal(failed.status, 2, failed.stderr);
  assert.ok(failed.stderr.includes(`looked for it at ${join(folder, "b.png")}`), failed.stderr);
  assert.match(failed.stderr, /1 of 2 points were finished/);
  const report = json_of(folder, "out/report.json");
  assert.deepEqual([report.status, report.verdict, report.runs.length], ["failed", "failed", 1]);
  assert.equal(report.provenance.spec, join(folder, "spec.json"));
  assert.equal(counts(text_of(folder, "j.xml")).errors, 1);
});

test("if killed, it leaves no passing JUnit file; the next run removes what it left", async () => {
  const folder = folder_with({ ...SLOW_END, sweep: [{ pointer: "/scene/count", values: [1, 1024] }] });
  writeFileSync(join(folder, "j.xml"), '<testsuite tests="1" failures="0" errors="0"/>');
  const ended = await end_by("SIGKILL", folder, ["--out", "out", "--junit", "j.xml"], /count 1024: timing/);
  assert.equal(ended.by, "SIGKILL");
  assert.equal(counts(text_of(folder, "j.xml")).errors, 1);
  assert.ok(existsSync(join(folder, "out", ".sheer-partial")));
  writeFileSync(join(folder, "spec.json"), JSON.stringify(CHECKED));
  assert.equal(sheer(folder, "compare", "spec.json", "--out", "out").status, 0);
  assert.deepEqual(readdirSync(join(folder, "out")).sort(), [
    ".sheer-manifest.json",
    "images",
    "report.html",
    "report.json",
  ]);
});

test("two processes do not write into the same folder", async () => {
  const folder = folder_with(SLOW);
  writeFileSync(join(folder, "quick.json"), JSON.stringify(CHECKED));
  let second;
  const child = spawn(process.env.SHEER, ["compare", "spec.json", "--out", "out"], {
    cwd: folder,
    stdio: ["ignore", "ignore", "pipe"],
  });
  try {
    let log = "";
    child.stderr.on("data", (text) => {
      log += text;
    });
    await until(() => log.includes("timing"), "it renders");
    second = sheer(folder, "compare", "quick.json", "--out", "out");
  } finally {
    child.kill("SIGTERM");
    await new Promise((resolve) => child.on("close", resolve));
  }
  assert.equal(second.status, 2);
  assert.match(second.stderr, /another Sheer process is writing into/);
});

test("a log has a line for each stage, and the table a line for each point and the point of each check", () => {
  const folder = folder_with({
    ...QUICK,
    methods: ["b2f", "f2b", "f2bd"],
    timing: { warmup: 1, rounds: 12 },
    sweep: [{ pointer: "/image/width", values: [16, 24] }],
    checks: [{ metric: "fragments.submitted", method: "f2b", max: 300 }],
  });
  const { stdout, stderr, status } = sheer(folder, "compare", "spec.json");
  assert.equal(status, 1, stderr);
  assert.doesNotMatch(stderr, /\r|\u001b/);
  const lines = stderr.trim().split("\n");
  for (const point of ["width 16: ", "width 24: "])
    for (const stage of ["building", "rendering", "warming", "timing", "counting", "measuring"])
      assert.equal(lines.filter((line) => line.includes(point + stage)).length, 1, `${point}${stage}: ${stderr}`);
  assert.match(stdout, /^passed {2}fragments\.submitted of f2b at width 16 is 256, at most 300$/m);
  assert.match(stdout, /^FAILED {2}fragments\.submitted of f2b at width 24 is 384, at most 300$/m);
  assert.match(stdout, /^width 16 +\d+\.\d\dx.* \d+\.\d\dx/m);
  assert.match(stdout, /^f2b is (not resolved to be|faster at|slower at)/m);
  assert.doesNotMatch(stdout, /\de[+-]\d/);
});

test("texts that are not UTF-8 do no harm", () => {
  const folder = folder_with(CHECKED);
  const name = Buffer.concat([Buffer.from(folder), Buffer.from([0x2f, 0x73, 0xff, 0x2e, 0x6a])]);
  writeFileSync(name, JSON.stringify(CHECKED));
  const run = spawnSync("bash", ["-c", `"$0" compare s$'\\xff'.j --out out --junit j.xml`, process.env.SHEER], {
    cwd: folder,
  });
  assert.equal(run.status, 0, String(run.stderr));
  assert.match(json_of(folder, "out/report.json").provenance.rerun, /\ufffd/);
});

const tags = (xml) => [...xml.matchAll(/<(\w+)/g)].map(([, name]) => name);

test("over HTTP a report that failed or was cancelled has a JUnit file with an error", () =>
  with_service({}, async (service) => {
    const junit = async (id) => {
      const response = await fetch(`${service.api}/reports/${id}/junit.xml`);
      assert.equal(response.status, 200, await response.clone().text());
      assert.equal(response.headers.get("content-type"), "application/xml");
      return response.text();
    };
    const title = 'a\u0001b\uffff\ufffe <x> & "q" ]]>';
    const failing = {
      ...QUICK,
      title,
      scene: { ...QUICK.scene, shading: { glsl: "while (uv.x > 0.5) {} return tint;" } },
    };
    const failed = await service.settled(await service.submit(failing));
    assert.equal(failed.status, "failed");
    const xml = await junit(failed.id);
    assert.deepEqual(counts(xml), { tests: 1, failures: 0, errors: 1 });
    assert.ok(xml.includes('name="a\ufffdb\ufffd\ufffd &lt;x> &amp; &quot;q&quot; ]]>"'), xml);
    assert.deepEqual(
      tags(xml).filter((tag) => !tag.startsWith("propert")),
      ["testsuite", "testcase", "error"],
    );
    const running = await service.submit(lasting(60));
    await service.reached(running, "running");
    await assert_problem(await fetch(`${service.api}/reports/${running}/junit.xml`), 409);
    await fetch(`${service.api}/reports/${running}`, { method: "DELETE" });
    await service.reached(running, "cancelled");
    assert.equal(counts(await junit(running)).errors, 1);
    const done = await service.settled(await service.submit({ ...QUICK, title }));
    assert.deepEqual(counts(await junit(done.id)), { tests: 2, failures: 0, errors: 0 });
  }));
