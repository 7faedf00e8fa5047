// The user's own shadings: errors in them are reported with their line, and do not affect other jobs.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { assert_problem, QUICK, Service } from "./service.mjs";

const service = new Service({ worker: { time_limit_s: 20 } });
before(() => service.start());
after(() => service.end_well());

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

test("an error of the compiler fails the job with the field and the user's line", async () => {
  const report = await finished(with_body("vec4 mine = tint;\nreturn your;"));
  assert.equal(report.status, "failed");
  assert.equal(report.error.title, "The spec is wrong");
  assert.match(report.error.detail, /^\/scene\/shading\/glsl: does not compile:\nline 2: .*your/);
  await assert_next_job_runs();
});

test("an endless loop fails the job with the field and a pixel", async () => {
  const report = await finished(with_body("while (uv.x > 0.5) {}\nreturn tint;"));
  assert.equal(report.status, "failed");
  assert.match(report.error.detail, /^\/scene\/shading\/glsl: .*pixel \(8, 0\).*4096/);
  await assert_next_job_runs();
});
