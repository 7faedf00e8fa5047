// A report's way through the service: posted, followed, read, listed, deleted.
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { existsSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { assert_problem, lasting, QUICK, read_events, Service, sleep, until, with_service } from "./service.mjs";

const sha256 = (bytes) => createHash("sha256").update(bytes).digest("hex");

/** Every picture of a report. */
function pictures(value) {
  if (value === null || typeof value !== "object") return [];
  if (value.sha256 && value.url) return [value];
  return Object.values(value).flatMap(pictures);
}

test("a comparison becomes a report with pictures, and is gone after its deletion", () =>
  with_service({}, async (service) => {
    const posted = await service.post(QUICK);
    assert.equal(posted.status, 202);
    assert.ok(Number(posted.headers.get("retry-after")) >= 1);
    const { id, status, spec, spec_sha256 } = await posted.json();
    assert.equal(posted.headers.get("location"), `/api/v1/reports/${id}`);
    assert.ok(["queued", "running"].includes(status));
    assert.equal(spec.methods[0].id, "b2f");

    const report = await service.settled(id);
    assert.equal(report.status, "done", service.log);
    assert.equal(report.progress, 1);
    assert.equal(report.error, null);
    assert.equal(report.spec_sha256, spec_sha256);
    assert.deepEqual(report.spec, spec);
    assert.ok(Date.parse(report.created_at) <= Date.parse(report.finished_at));
    assert.deepEqual(
      report.runs[0].results.map((result) => [result.method, result.status]),
      [
        ["b2f", "ok"],
        ["f2b", "ok"],
      ],
    );

    const named = pictures(report);
    assert.ok(named.length >= 3);
    for (const picture of named) {
      const response = await fetch(service.origin + picture.url);
      const bytes = Buffer.from(await response.arrayBuffer());
      assert.equal(sha256(bytes), picture.sha256);
      assert.equal(response.headers.get("content-type"), picture.media_type);
      assert.match(response.headers.get("cache-control"), /immutable/);
      const etag = response.headers.get("etag");
      const again = await fetch(service.origin + picture.url, { headers: { "If-None-Match": etag } });
      assert.equal(again.status, 304);
      const head = await fetch(service.origin + picture.url, { method: "HEAD" });
      assert.equal(Number(head.headers.get("content-length")), bytes.length);
    }
    assert.deepEqual(new Set(service.kept("blobs")), new Set(named.map((picture) => picture.sha256)));
    await until(() => readdirSync(join(service.data, "scratch")).length === 0, "the scratch is cleaned");

    const page = await fetch(`${service.api}/reports/${id}/report.html`);
    assert.match(page.headers.get("content-type"), /^text\/html/);
    assert.match(page.headers.get("content-security-policy"), /sandbox/);
    assert.match(await page.text(), /One red layer/);
    const junit = await fetch(`${service.api}/reports/${id}/junit.xml`);
    assert.match(await junit.text(), /^<\?xml[^]*<testsuite/);

    const [line] = await service.reports();
    assert.deepEqual(
      [line.id, line.status, line.title, line.scene, line.methods],
      [id, "done", "One red layer", "layers", ["b2f", "f2b"]],
    );
    assert.equal(line.preview.sha256, report.runs[0].reference.images.color.sha256);

    assert.equal((await fetch(`${service.api}/reports/${id}`, { method: "DELETE" })).status, 204);
    await assert_problem(await fetch(`${service.api}/reports/${id}`), 404);
    await assert_problem(await fetch(service.origin + named[0].url), 404);
    assert.deepEqual(service.kept("blobs"), []);
    assert.deepEqual(await service.reports(), []);
  }));

test("Prefer: wait gives the finished report, or 202 when the time is up", () =>
  with_service({}, async (service) => {
    const finished = await service.post(QUICK, { Prefer: "wait=60" });
    assert.equal(finished.status, 200);
    assert.equal(finished.headers.get("preference-applied"), "wait=60");
    const report = await finished.json();
    assert.equal(report.status, "done");
    assert.equal(finished.headers.get("location"), `/api/v1/reports/${report.id}`);

    const begin = Date.now();
    const late = await service.post(lasting(60), { Prefer: "wait=1" });
    assert.equal(late.status, 202);
    assert.ok(Date.now() - begin >= 1000);
    assert.ok(["queued", "running"].includes((await late.json()).status));
  }));

test("a failed check is a done report that says so", () =>
  with_service({}, async (service) => {
    const spec = { ...QUICK, checks: [{ metric: "flip.mean", method: "b2f", min: 0.9 }] };
    const report = await (await service.post(spec, { Prefer: "wait=60" })).json();
    assert.equal(report.status, "done");
    assert.equal(report.verdict, "failed");
    assert.equal(report.checks[0].passed, false);
  }));

test("a repeated Idempotency-Key gives the same report", () =>
  with_service({}, async (service) => {
    const headers = { "Idempotency-Key": "a1b2" };
    const [first, second] = await Promise.all([service.post(QUICK, headers), service.post(QUICK, headers)]);
    const { id } = await first.json();
    assert.equal((await second.json()).id, id);
    await assert_problem(await service.post({ ...QUICK, title: "other" }, headers), 422);
    assert.equal((await service.reports()).length, 1);
    await service.settled(id);
    const later = await service.post(QUICK, { ...headers, Prefer: "wait=10" });
    assert.equal(later.status, 200);
    assert.equal((await later.json()).id, id);
  }));

test("events report progress and the end, and resume", () =>
  with_service({}, async (service) => {
    const id = await service.submit(lasting(1.5));
    const events = await read_events(await fetch(`${service.api}/reports/${id}/events`));
    assert.ok(events.length >= 3);
    const ids = events.map((event) => Number(event.id));
    assert.deepEqual(
      ids,
      [...ids].sort((a, b) => a - b),
    );
    assert.equal(new Set(ids).size, ids.length);
    assert.ok(events.slice(0, -1).every((event) => event.event === "progress"));
    const fractions = events.map((event) => event.data.progress);
    assert.deepEqual(
      fractions,
      [...fractions].sort((a, b) => a - b),
    );
    assert.ok(events.some((event) => event.data.progress > 0 && event.data.progress < 1 && event.data.stage));
    const last = events.at(-1);
    assert.deepEqual([last.event, last.data.status, last.data.progress], ["done", "done", 1]);
    assert.equal((await service.report(id)).status, "done");

    const resume = (last_id) => fetch(`${service.api}/reports/${id}/events`, { headers: { "Last-Event-ID": last_id } });
    assert.deepEqual(await read_events(await resume(events.at(-2).id)), [last]);
    assert.equal((await resume(last.id)).status, 204);
  }));

test("a stream of events sends signs of life", () =>
  with_service({ http: { event_heartbeat_s: 0.1 }, workers: 0 }, async (service) => {
    const id = await service.submit(QUICK);
    const events = await read_events(await fetch(`${service.api}/reports/${id}/events`), (all) => all.length >= 4);
    assert.equal(events[0].data.status, "queued");
    assert.ok(events.slice(1).every((event) => event.comment));
  }));

test("a queued and a running report can be cancelled", () =>
  with_service({}, async (service) => {
    const running = await service.submit(lasting(60, "runs"));
    const queued = await service.submit(lasting(60, "waits"));
    await service.reached(running, "running");
    const [renderer] = await until(() => service.renderers().length > 0 && service.renderers(), "the renderer runs");
    const events = fetch(`${service.api}/reports/${queued}/events`).then((response) => read_events(response));

    const cancelled = await fetch(`${service.api}/reports/${queued}`, { method: "DELETE" });
    assert.equal(cancelled.status, 200);
    assert.equal((await cancelled.json()).status, "cancelled");
    assert.equal((await events).at(-1).event, "cancelled");

    assert.equal((await fetch(`${service.api}/reports/${running}`, { method: "DELETE" })).status, 202);
    assert.equal((await service.settled(running)).status, "cancelled");
    assert.ok(!service.renderers().includes(renderer));
    assert.equal((await (await service.post(QUICK, { Prefer: "wait=60" })).json()).status, "done");
    await assert_problem(await fetch(`${service.api}/reports/${running}/report.html`), 409);
    assert.equal((await fetch(`${service.api}/reports/${running}`, { method: "DELETE" })).status, 204);
  }));

test("a full queue answers 429 and stores nothing", () =>
  with_service({ workers: 0, jobs: { max_queued: 2 } }, async (service) => {
    await service.submit(QUICK);
    await service.submit(QUICK);
    const full = await service.post(QUICK);
    assert.ok(Number(full.headers.get("retry-after")) >= 1);
    await assert_problem(full, 429);
    assert.equal((await service.reports()).length, 2);
  }));

test("the archive is listed in pages, newest first, and searched", () =>
  with_service({ workers: 0 }, async (service) => {
    for (const title of ["alpha", "beta", "gamma", "alphabet"]) {
      await service.submit({ ...QUICK, title, methods: title === "beta" ? ["unsorted"] : ["b2f"] });
      await sleep(2);
    }
    const titles = (reports) => reports.map((report) => report.title);
    assert.deepEqual(titles(await service.reports()), ["alphabet", "gamma", "beta", "alpha"]);
    assert.deepEqual(titles(await service.reports("?q=ALPHA")), ["alphabet", "alpha"]);
    assert.deepEqual(titles(await service.reports("?method=unsorted")), ["beta"]);
    assert.deepEqual(titles(await service.reports("?scene=quads")), []);
    assert.deepEqual(titles(await service.reports("?status=queued&q=gamma")), ["gamma"]);
    const page = await (await fetch(`${service.api}/reports?limit=3`)).json();
    assert.equal(page.reports.length, 3);
    const rest = await (await fetch(`${service.api}/reports?limit=3&cursor=${page.next_cursor}`)).json();
    assert.deepEqual([titles(rest.reports), rest.next_cursor], [["alpha"], null]);
    const wrong = await assert_problem(await fetch(`${service.api}/reports?limit=0&cursor=x&colour=red`), 400);
    assert.deepEqual(wrong.errors.map((error) => error.pointer).sort(), ["/colour", "/limit"]);
    assert.ok(!existsSync(join(service.data, "scratch")));
  }));

test("the pictures of a report can be looked at while its times are measured", () =>
  with_service({}, async (service) => {
    const { id } = await (await service.post(lasting(300))).json();
    const early = async () => (await fetch(`${service.api}/reports/${id}/early`)).json();
    const { point, pictures: drawn } = await until(async () => {
      const answer = await early();
      return answer.pictures.length > 0 && answer;
    }, "pictures");
    assert.deepEqual(point, {});
    assert.deepEqual(
      drawn.map(({ label }) => label),
      ["Reference", "b2f", "f2b"],
    );
    for (const { url } of drawn) {
      const response = await fetch(service.origin + url);
      assert.equal(response.headers.get("content-type"), "image/png");
      assert.equal(sha256(Buffer.from(await response.arrayBuffer())), url.split("/").pop());
    }
    assert.equal((await fetch(`${service.api}/reports/${id}/early/${"0".repeat(64)}`)).status, 404);
    assert.equal((await fetch(`${service.api}/reports/${id}/early/..%2Fearly.json`)).status, 404);
    await fetch(`${service.api}/reports/${id}`, { method: "DELETE" });
    await until(async () => (await early()).pictures.length === 0, "no pictures after the end");
  }));

test("a report that another process deletes is gone at once, however often it was read", () =>
  with_service({}, async (service) => {
    const id = await service.submit(QUICK);
    await service.settled(id);
    const other = await new Service({ workers: 0 }, service.folder).start();
    const status = async () => (await fetch(`${service.api}/reports/${id}`)).status;
    for (let i = 0; i < 20; ++i) assert.equal(await status(), 200);
    assert.equal((await fetch(`${other.api}/reports/${id}`, { method: "DELETE" })).status, 204);
    assert.equal(await status(), 404);
    await other.stop();
  }));
