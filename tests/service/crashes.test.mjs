// Processes that die at the worst moment: no report is incomplete, and the next job runs.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { is_alive, lasting, QUICK, Service, until, with_service } from "./service.mjs";

/** Submits a job and waits until it is being rendered; returns its id and the renderer's process id. */
async function running_job(service, seconds) {
  const id = await service.submit(lasting(seconds));
  await until(async () => (await service.report(id)).progress > 0, "there is progress");
  return { id, renderer: service.renderers()[0] };
}

async function assert_next_job_runs(service) {
  const report = await (await service.post({ ...QUICK, title: "next" }, { Prefer: "wait=60" })).json();
  assert.equal(report.status, "done", service.log);
  await until(() => readdirSync(join(service.data, "scratch")).length === 0, "the scratch is cleaned");
}

test("a renderer that is killed is tried once more", () =>
  with_service({}, async (service) => {
    const { id, renderer } = await running_job(service, 2);
    process.kill(renderer, "SIGKILL");
    const report = await service.settled(id);
    assert.equal(report.status, "done", service.log);
    await assert_next_job_runs(service);
  }));

test("a renderer that is killed twice fails cleanly", () =>
  with_service({}, async (service) => {
    const { id, renderer } = await running_job(service, 30);
    process.kill(renderer, "SIGKILL");
    const second = await until(() => service.renderers().find((pid) => pid !== renderer), "the second attempt");
    process.kill(second, "SIGKILL");
    const report = await service.settled(id);
    assert.equal(report.status, "failed");
    assert.deepEqual(report.error, { title: "Rendering failed", detail: "The renderer died (signal 9)." });
    assert.ok(report.finished_at);
    await assert_next_job_runs(service);
  }));

test("a worker that is killed takes its renderer along, and its job goes to the next", () =>
  with_service({}, async (service) => {
    const { id, renderer } = await running_job(service, 2);
    const [worker] = service.workers();
    process.kill(worker, "SIGKILL");
    await until(() => !is_alive(renderer), "the renderer dies with its worker");
    const report = await service.settled(id);
    assert.equal(report.status, "done", service.log);
    assert.notEqual(service.workers()[0], worker);
    await assert_next_job_runs(service);
  }));

test("a worker that hangs loses its job", () =>
  with_service({ workers: 2, jobs: { lease_s: 4, heartbeat_s: 0.4 } }, async (service) => {
    const { id, renderer } = await running_job(service, 2);
    const busy = service.worker_of(renderer);
    process.kill(busy, "SIGSTOP");
    const report = await service.settled(id);
    process.kill(busy, "SIGCONT");
    assert.equal(report.status, "done", service.log);
  }));

test("after the service is killed, queued jobs run and finished reports are there", async () => {
  const service = new Service();
  try {
    await service.start();
    const done = await (await service.post(QUICK, { Prefer: "wait=60" })).json();
    const { id: running, renderer } = await running_job(service, 2);
    const queued = await service.submit({ ...QUICK, title: "queued" });
    const [worker] = service.workers();
    service.process.kill("SIGKILL");
    await service.ended;
    await until(() => !is_alive(worker) && !is_alive(renderer), "worker and renderer end with the service");

    await service.start();
    assert.deepEqual(await service.report(done.id), done);
    const picture = await fetch(service.origin + done.runs[0].reference.images.color.url);
    assert.equal(picture.status, 200);
    assert.equal((await service.settled(running)).status, "done", service.log);
    assert.equal((await service.settled(queued)).status, "done", service.log);
    await assert_next_job_runs(service);
  } finally {
    await service.end();
  }
});

test("a stop ends cleanly and gives the running job back", async () => {
  const service = new Service();
  try {
    await service.start();
    const { id, renderer } = await running_job(service, 3);
    const [worker] = service.workers();
    const waiting = service.post(QUICK, { Prefer: "wait=60" });
    await until(async () => (await service.reports()).length === 2, "the second job is queued");
    assert.deepEqual(await service.stop(), { code: 0, signal: null });
    assert.equal((await waiting).status, 202);
    assert.ok(!is_alive(worker) && !is_alive(renderer));
    await service.start("--workers", "0");
    assert.deepEqual(
      (await service.reports()).map((report) => report.status),
      ["queued", "queued"],
    );
    await service.stop();
    await service.start();
    assert.equal((await service.settled(id)).status, "done");
  } finally {
    await service.end();
  }
});
