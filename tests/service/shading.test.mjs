// The user's own shadings: errors in them are reported with their line, and do not affect other jobs.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { assert_problem, QUICK, Service } from "./service.mjs";

const service = new Service({ worker: { time_limit_s: 20 } });
before(() => service.start());
after(() => service.end_well());

const post_json = (path, spec) =>
  fetch(`${service.api}/${path}`, {
    method: "POST",
    body: JSON.stringify(spec),
    headers: { "Content-Type": "application/json" },
  });

const with_body = (glsl) => ({ ...QUICK, scene: { ...QUICK.scene, shading: { glsl } } });

async function finished(spec) {
  const response = await service.post(spec, { Prefer: "wait=60" });
  assert.equal(response.status, 200, service.log);
  return response.json();
}

async function assert_next_job_runs() {
  assert.equal((await finished(QUICK)).status, "done", service.log);
}

test("errors that need no compiler are refused at once", async () => {
  const problem = await assert_problem(await service.post(with_body("return tint;\n#extension all : enable")), 422);
  assert.equal(problem.errors.length, 1);
  assert.equal(problem.errors[0].pointer, "/scene/shading/glsl");
  assert.match(problem.errors[0].detail, /^line 2 has a #/);
  assert.deepEqual(await service.reports(), []);
});

test("a body that compiles gives a report", async () => {
  const report = await finished(with_body("return tint;"));
  assert.equal(report.status, "done", service.log);
  assert.deepEqual(report.spec.scene.shading, { glsl: "return tint;" });
});

test("an error of the compiler is refused with the field and the user's line, before anything is queued", async () => {
  const known = (await service.reports()).length;
  const wrong = with_body("vec4 mine = tint;\nreturn your;");
  for (const path of ["reports", "specs/validate"]) {
    const problem = await assert_problem(await post_json(path, wrong), 422);
    assert.equal(problem.errors.length, 1);
    assert.equal(problem.errors[0].pointer, "/scene/shading/glsl");
    assert.match(problem.errors[0].detail, /^does not compile:\nline 2: .*your/);
  }
  assert.equal((await service.reports()).length, known);
  await assert_next_job_runs();
});

test("the shaders of methods and of a sweep are compiled too, each once", async () => {
  const spec = with_body("return tint;");
  spec.methods = ["b2f", { id: "f2b", label: "new", shading: { glsl: "return tint * 2.0;" } }];
  assert.equal((await post_json("specs/validate", spec)).status, 200);
  spec.methods[1].shading.glsl = "\n\nreturn vec3(1);";
  let problem = await assert_problem(await post_json("specs/validate", spec), 422);
  assert.deepEqual(
    problem.errors.map(({ pointer }) => pointer),
    ["/methods/1/shading/glsl"],
  );
  assert.match(problem.errors[0].detail, /line 3: /);
  spec.methods = ["b2f"];
  spec.sweep = [{ pointer: "/scene/shading/glsl", values: ["return tint;", "return tint.rg;"] }];
  problem = await assert_problem(await post_json("specs/validate", spec), 422);
  assert.deepEqual(
    problem.errors.map(({ pointer }) => pointer),
    ["/sweep/0"],
  );
});

test("a shading that was compiled once is answered at once", async () => {
  const wrong = with_body("return once;");
  await post_json("specs/validate", wrong);
  const begin = performance.now();
  for (let i = 0; i < 20; ++i) await assert_problem(await post_json("specs/validate", wrong), 422);
  assert.ok(performance.now() - begin < 1000, "20 answers from the cache within a second");
});

test("an endless loop fails the job with the field and a pixel", async () => {
  const report = await finished(with_body("while (uv.x > 0.5) {}\nreturn tint;"));
  assert.equal(report.status, "failed");
  assert.match(report.error.detail, /^\/scene\/shading\/glsl: .*pixel \(8, 0\).*4096/);
  await assert_next_job_runs();
});
