// Which worker gets a job, and what is known of the workers.
import assert from "node:assert/strict";
import { test } from "node:test";
import { lasting, QUICK, Service, until, with_service } from "./service.mjs";

const LABELLED = { worker: { device: "tried" }, http: { ready_within_s: 60 } };

async function workers_of(service) {
  const response = await fetch(`${service.api}/workers`);
  assert.equal(response.status, 200);
  return (await response.json()).workers;
}

test("workers are listed with their label, driver and job", () =>
  with_service(LABELLED, async (service) => {
    const [worker] = await until(async () => {
      const workers = await workers_of(service);
      return workers.length === 1 && workers[0].driver && workers;
    }, "the worker has rendered its first pixel");
    assert.equal(worker.label, "tried");
    assert.match(worker.driver, /llvmpipe|NVIDIA|AMD|Intel/);
    assert.equal(worker.report, null);
    assert.ok(Date.now() - new Date(worker.last_seen_at) < 60_000);
    const { id } = await (await service.post(lasting(20))).json();
    const busy = await until(async () => (await workers_of(service)).find(({ report }) => report), "it has the job");
    assert.equal(busy.report, id);
    await fetch(`${service.api}/reports/${id}`, { method: "DELETE" });
  }));

test("a spec's device goes to a worker with this label", () =>
  with_service(LABELLED, async (service) => {
    await until(async () => (await workers_of(service)).length === 1, "the worker is there");
    const response = await service.post({ ...QUICK, device: "tried" }, { Prefer: "wait=60" });
    const report = await response.json();
    assert.equal(report.status, "done");
    assert.equal(report.spec.device, "tried");
    const any = await (await service.post(QUICK, { Prefer: "wait=60" })).json();
    assert.ok(!("device" in any.spec));
    assert.notEqual(any.spec_sha256, report.spec_sha256);
  }));

test("without such a worker a report waits and says so at once", async () => {
  const service = new Service(LABELLED);
  try {
    await service.start();
    await until(async () => (await workers_of(service)).length === 1, "the worker is there");
    const response = await service.post({ ...QUICK, device: "other" });
    const queued = await response.json();
    assert.equal(response.status, 202);
    assert.deepEqual(
      queued.notes.map(({ code, where }) => [code, where]),
      [["no-worker", "/device"]],
    );
    assert.match(queued.notes[0].text, /"other"/);
    const after = await (await service.post(QUICK, { Prefer: "wait=60" })).json();
    assert.equal(after.status, "done", "others do not wait for it");
    const waiting = await fetch(`${service.api}/reports/${queued.id}`);
    const etag = waiting.headers.get("ETag");
    assert.equal((await waiting.json()).notes.length, 1);
    await service.stop();

    const labelled = new Service({ worker: { device: "other" } }, service.folder);
    await labelled.start();
    assert.equal((await labelled.settled(queued.id)).status, "done");
    const now = await fetch(`${labelled.api}/reports/${queued.id}`, { headers: { "If-None-Match": etag } });
    assert.equal(now.status, 200);
    await labelled.stop();
  } finally {
    await service.end();
  }
});
