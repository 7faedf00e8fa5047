// Numbers of reports over time, reports that are reused, and what the service says of itself.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { assert_problem, QUICK, Service, until } from "./service.mjs";

let service;
const reports = [];
const spec = { ...QUICK, title: "followed", tags: { branch: "main" } };

before(async () => {
  service = await new Service({ access_log: "json" }).start();
  for (let i = 0; i < 3; ++i) {
    const made = await service.post(spec, { Prefer: "wait=60" });
    reports.push(await made.json());
  }
});

after(() => service?.end_well());

const trend = async (query = "") => {
  const response = await fetch(`${service.api}/trends?spec_sha256=${reports[0].spec_sha256}${query}`);
  return response.status === 200 ? response.json() : assert_problem(response, response.status);
};

test("a trend has a value of each report, oldest first", async () => {
  const answer = await trend("&metric=timing.median&method=b2f&tag=branch:main");
  assert.deepEqual(
    answer.values.map(({ report, value }) => [report, value]),
    reports.map(({ id, runs }) => [id, runs[0].results.find(({ label }) => label === "b2f").timing.median]),
  );
  assert.equal(answer.unit, "ms");
  assert.equal(answer.device, reports[0].device.renderer);
  assert.deepEqual([answer.change_points, answer.missing], [[], 0]);
  assert.ok(answer.metrics.includes("fragments.shaded") && answer.methods.includes("b2f"));
  const exact = await trend("&metric=fragments.shaded&limit=2");
  assert.deepEqual(
    exact.values.map(({ report }) => report),
    reports.slice(1).map(({ id }) => id),
  );
  assert.ok(exact.values.every(({ value, low, high }) => value === low && value === high));
});

test("a trend of nothing is empty, and wrong questions are refused", async () => {
  const none = await (await fetch(`${service.api}/trends?spec_sha256=${"0".repeat(64)}`)).json();
  assert.deepEqual([none.values, none.change_points, none.metrics], [[], [], []]);
  assert.deepEqual((await trend("&tag=branch:other")).values, []);
  assert.equal((await trend("&metric=beauty")).errors[0].pointer, "/metric");
  await assert_problem(await fetch(`${service.api}/trends`), 400);
});

test("with reuse, a report is answered from the archive", async () => {
  const reused = await service.post({ ...spec, reuse: true });
  assert.equal(reused.status, 200);
  const report = await reused.json();
  assert.equal(report.id, reports.at(-1).id);
  assert.equal(reused.headers.get("sheer-reused"), report.finished_at);
  assert.equal(reused.headers.get("location"), `/api/v1/reports/${report.id}`);
  assert.ok(!("reuse" in report.spec));
  const another = await service.post({ ...spec, title: "new", reuse: true });
  assert.equal(another.status, 202);
  const { id, spec_sha256 } = await another.json();
  await service.settled(id);
  // The wish does not change what is compared.
  const same = await service.post({ ...spec, title: "new" });
  assert.equal((await same.json()).spec_sha256, spec_sha256);
  const wrong = await assert_problem(await service.post({ ...spec, reuse: "yes" }), 422);
  assert.equal(wrong.errors[0].pointer, "/reuse");
});

test("every answer has a request id, and every request a line of JSON in the log", async () => {
  const given = await fetch(`${service.api}/methods`, { headers: { "X-Request-Id": "build-7.b2" } });
  assert.equal(given.headers.get("x-request-id"), "build-7.b2");
  const made = (await fetch(`${service.api}/nothing`, { headers: { "X-Request-Id": "a b" } })).headers.get(
    "x-request-id",
  );
  assert.match(made, /^[0-9a-f]{16}$/);
  const lines = () =>
    service.log
      .split("\n")
      .filter((line) => line.startsWith("{"))
      .map((line) => JSON.parse(line));
  await until(() => lines().some(({ request_id }) => request_id === made), "the line is written");
  const line = lines().find(({ request_id }) => request_id === "build-7.b2");
  assert.deepEqual(
    [line.method, line.target, line.route, line.status],
    ["GET", "/api/v1/methods", "/api/v1/methods", 200],
  );
  assert.ok(line.seconds >= 0);
  const unknown = lines().find(({ request_id }) => request_id === made);
  assert.deepEqual([unknown.route, unknown.status], ["other", 404]);
});

test("the metrics count requests and jobs", async () => {
  const response = await fetch(`${service.origin}/metrics`);
  assert.equal(response.status, 200);
  assert.match(response.headers.get("content-type"), /^text\/plain/);
  const text = await response.text();
  const value = (name) =>
    Number(
      text
        .split("\n")
        .find((line) => line.startsWith(name))
        ?.split(" ")
        .at(-1),
    );
  assert.ok(value('sheer_http_requests_total{method="POST",route="/api/v1/reports",status="200"}') >= 4);
  assert.ok(value('sheer_http_requests_total{method="POST",route="/api/v1/reports",status="422"}') >= 1);
  assert.ok(value('sheer_reports{status="done"}') >= 4);
  assert.ok(value('sheer_archive_bytes{part="pictures"}') > 0);
  assert.equal(value("sheer_leases_lost_total"), 0);
  assert.match(text, /sheer_job_seconds_total\{stage="[a-z]+"\}/);
  assert.match(text, /sheer_http_request_seconds_bucket\{route="\/api\/v1\/trends",le="0.1"\}/);
});
