// Baselines over REST: main has an accepted report, and pull requests are compared with it.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { assert_problem, QUICK, Service } from "./service.mjs";

const service = new Service();
before(() => service.start());
after(() => service.end_well());

const url = (name = "") => `${service.api}/baselines${name}`;
const send = (method, where, body) =>
  fetch(where, { method, body: JSON.stringify(body), headers: { "Content-Type": "application/json" } });
const layer = (color) => ({ type: "layers", layers: [{ ...QUICK.scene.layers[0], color }] });

// The pictures matter here, so any slowdown is tolerated: a frame of 16 x 16 pixels is too short to be timed well.
const GATED = {
  ...QUICK,
  against: "baseline:main",
  timing: { warmup: 1, rounds: 8 },
  tolerance: { max_flip: 0, max_slowdown: 1000 },
};

async function finished(spec) {
  const response = await service.post(spec, { Prefer: "wait=60" });
  assert.equal(response.status, 200, await response.clone().text());
  const report = await response.json();
  assert.equal(report.status, "done", service.log);
  return report;
}

let first;

test("without an accepted report the gate fails and says so", async () => {
  first = await finished(GATED);
  assert.equal(first.verdict, "failed");
  assert.deepEqual(first.against, {
    asked: "baseline:main",
    report: null,
    accepted_at: null,
    text: "baseline:main has no accepted report",
    refused: [],
  });
  assert.equal(first.checks.at(-1).reason, "there is no report to compare with: baseline:main has no accepted report");
});

test("a report is accepted by name, with who and why", async () => {
  await assert_problem(await fetch(url("/main")), 404);
  const put = await send("PUT", url("/main"), { report: first.id, by: "ada", reason: "the first" });
  assert.equal(put.status, 201);
  const baseline = await put.json();
  assert.equal(baseline.name, "main");
  assert.equal(baseline.reports[0].report, first.id);
  assert.equal(baseline.reports[0].by, "ada");
  assert.equal(baseline.reports[0].reason, "the first");
  assert.match(baseline.reports[0].device, / on /);
  assert.equal((await send("PUT", url("/main"), { report: first.id })).status, 200, "accepted again");
  assert.deepEqual(
    (await (await fetch(url())).json()).baselines.map(({ name, reports }) => [name, reports.length]),
    [["main", 1]],
  );
});

test("the same again passes, and the choice is explained", async () => {
  const report = await finished({ ...GATED, title: "a pull request that changes nothing" });
  assert.equal(report.verdict, "passed", JSON.stringify(report.checks));
  assert.equal(report.against.report, first.id);
  assert.match(report.against.text, new RegExp(`^compared with ${first.id} of main, accepted 0 minutes ago, because`));
  assert.deepEqual(
    report.checks.map(({ metric, method, outcome }) => `${metric} ${method} ${outcome}`),
    ["against.flip.mean b2f passed", "against.flip.mean f2b passed", "against.slowdown f2b passed"],
  );
  const junit = await (await fetch(`${service.api}/reports/${report.id}/junit.xml`)).text();
  assert.match(junit, /against\.slowdown of f2b/);
});

test("a changed picture fails, if the change is what is under test", async () => {
  const darker = { ...GATED, scene: layer([0.5, 0, 0]) };
  const refused = await finished(darker);
  assert.equal(refused.against.report, null);
  assert.deepEqual(refused.against.refused[0].differing, ["/scene/layers/0/color"]);
  assert.equal(refused.verdict, "failed");
  const report = await finished({ ...darker, under_test: ["/scene/layers/0/color"] });
  assert.equal(report.against.report, first.id);
  assert.match(report.against.text, /except for \/scene\/layers\/0\/color$/);
  assert.equal(report.verdict, "failed");
  const check = report.checks.find(({ metric, method }) => metric === "against.flip.mean" && method === "b2f");
  assert.equal(check.outcome, "failed");
  assert.equal(check.reason, "256 pixels differ");
});

test("a report may be named instead of a baseline", async () => {
  const report = await finished({ ...GATED, against: first.id });
  assert.equal(report.verdict, "passed");
  assert.match(report.against.text, new RegExp(`^compared with ${first.id}, because`));
});

test("wrong names and reports are refused", async () => {
  const errors = async (spec) => (await assert_problem(await service.post(spec), 422)).errors.map((e) => e.pointer);
  assert.deepEqual(await errors({ ...GATED, against: "01nothing" }), ["/against"]);
  assert.deepEqual(await errors({ ...GATED, against: "baseline:a b" }), ["/against"]);
  assert.deepEqual(await errors({ ...GATED, under_test: ["scene"] }), ["/under_test/0"]);
  assert.deepEqual(await errors({ ...GATED, against: null, under_test: ["/scene"] }), ["/under_test"]);
  await assert_problem(await send("PUT", url("/a%20b"), { report: first.id }), 422);
  await assert_problem(await send("PUT", url("/main"), {}), 422);
  await assert_problem(await send("PUT", url("/main"), { report: "nothing" }), 422);
  await assert_problem(await send("PUT", url("/main"), { report: first.id, extra: 1 }), 422);
  const queued = await service.submit({
    ...GATED,
    timing: { warmup: 1, rounds: 1000 },
    image: { width: 512, height: 512 },
  });
  await assert_problem(await send("PUT", url("/main"), { report: queued }), 409);
  await fetch(`${service.api}/reports/${queued}`, { method: "DELETE" });
});

test("an accepted report cannot be deleted until it is forgotten", async () => {
  const where = `${service.api}/reports/${first.id}`;
  const problem = await assert_problem(await fetch(where, { method: "DELETE" }), 409);
  assert.match(problem.detail, /forget it there first/);
  await assert_problem(await fetch(url("/main?report=nothing"), { method: "DELETE" }), 404);
  assert.equal((await fetch(url(`/main?report=${first.id}`), { method: "DELETE" })).status, 204);
  await assert_problem(await fetch(url("/main"), { method: "DELETE" }), 404);
  assert.equal((await fetch(where, { method: "DELETE" })).status, 204);
});
