// Disks that are full, bytes that are not what they were, and a service that is told to go on.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { copyFileSync, cpSync, existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { assert_problem, lasting, QUICK, Service, until, with_service } from "./service.mjs";

/** A mount namespace of one's own takes root, or user namespaces that the machine allows. */
const UNSHARE = [["unshare", "-m"], ["unshare", "-rm"]].find(
  ([program, ...words]) => spawnSync(program, [...words, "mount", "-t", "tmpfs", "none", "/mnt"]).status === 0);

const small = (seed, size = 96) => ({
  ...QUICK, title: `report ${seed}`, image: { width: size, height: size },
  scene: { type: "quads", count: 24, seed, shading: "constant" } });

const pictures_of = (report) => [...JSON.stringify(report).matchAll(/"sha256":"([0-9a-f]{64})","url":"\/api\/v1\/blobs/g)].map(([, sha256]) => sha256);

/** Runs `body` with a service whose data folder is a disk of its own, made with these options of tmpfs. */
async function on_disk(options, body) {
  const folder = mkdtempSync(join(tmpdir(), "sheer-disk-"));
  const service = new Service({ jobs: { max_queued: 1000 } }, folder);
  mkdirSync(service.data);
  service.wrapper = [...UNSHARE, "sh", "-c", `mount -t tmpfs -o ${options} none ${service.data} && exec "$@"`, "sh"];
  try {
    await service.start();
    service.disk = `/proc/${service.process.pid}/root${service.data}`;
    await until(async () => (await fetch(`${service.origin}/readyz`)).status === 200, "the service is ready");
    await body(service);
    await service.end_well();
  } finally {
    await service.end();
  }
}

/** Posts reports until one is not taken; gives the problem. */
async function fill(service) {
  for (let seed = 1; seed < 400; ++seed) {
    const response = await service.post(small(seed), { Prefer: "wait=20" });
    if (response.status === 507) return assert_problem(response, 507);
    assert.ok([200, 202].includes(response.status), `${response.status}: ${await response.text()}`);
  }
  return assert.fail("the disk is never full");
}

async function all_reports(service) {
  const reports = [];
  for (let cursor = ""; cursor !== null;) {
    const page = await (await fetch(`${service.api}/reports?limit=100&cursor=${cursor}`)).json();
    reports.push(...page.reports);
    cursor = page.next_cursor;
  }
  return reports;
}

for (const options of ["size=1m", "size=3m", "size=64m,nr_inodes=90"]) {
  test(`a full disk (${options}) takes nothing, says so, and works again`, { skip: !UNSHARE && "no mount namespaces here" }, () =>
    on_disk(options, async (service) => {
      const problem = await fill(service);
      assert.match(problem.detail, /disk/);
      // A report that did not fit is tried again now and then, and the service hopes for the best meanwhile.
      await until(async () => {
        const ready = await fetch(`${service.origin}/readyz`);
        return ready.status === 503 && /disk/.test((await ready.json()).detail);
      }, "the service says that it is not ready");
      assert.equal((await fetch(`${service.origin}/healthz`)).status, 200);
      const upload = await fetch(`${service.api}/assets`, { method: "POST", body: "x", headers: { "Content-Type": "application/octet-stream" } });
      assert.ok([422, 507].includes(upload.status), String(upload.status));

      // What others keep on the disk goes on growing.
      const ballast = join(service.disk, "ballast");
      try {
        writeFileSync(ballast, Buffer.alloc(64 << 20));
      } catch (error) {
        assert.equal(error.code, "ENOSPC");
      }
      const before = await all_reports(service);
      assert.ok(before.every(({ status }) => ["done", "queued", "running"].includes(status)), JSON.stringify(before));
      const done = before.filter(({ status }) => status === "done");
      assert.ok(done.length > 0, "no report was done at all");
      for (const { id } of done) assert.equal((await service.raw("DELETE", `/api/v1/reports/${id}`)).status, 204, service.log);
      rmSync(ballast, { force: true });

      // What waited for room comes through, and so does what is new.
      await until(async () => (await fetch(`${service.origin}/readyz`)).status === 200, "there is room again");
      const next = await service.submit(small(1000));
      for (const { id, status } of [...before, { id: next, status: "queued" }])
        if (status !== "done") assert.equal((await service.settled(id)).status, "done", service.log);
      const kept = await all_reports(service);
      const named = new Set();
      for (const { id } of kept) for (const sha256 of pictures_of(await service.report(id))) named.add(sha256);
      const files = readdirSync(join(service.disk, "blobs"), { withFileTypes: true })
        .flatMap(({ name }) => readdirSync(join(service.disk, "blobs", name)));
      assert.deepEqual(files.sort(), [...named].sort(), "pictures that no report names, or the other way round");
    }));
}

test("a picture with other bytes is not served, and comes back with the next report of it", () => with_service({}, async (service) => {
  const rendered = async () => (await service.post(QUICK, { Prefer: "wait=60" })).json();
  const report = await rendered();
  const { sha256, url } = report.runs[0].results[0].images.color;
  const file = join(service.data, "blobs", sha256.slice(0, 2), sha256);
  const bytes = readFileSync(file);
  bytes[bytes.length - 20] ^= 4;
  writeFileSync(file, bytes);
  for (const path of [url, `/api/v1/reports/${report.id}/report.html`]) {
    const answer = await service.raw("GET", path, { Connection: "close" });
    const problem = await assert_problem(answer, 500);
    assert.match(problem.detail, new RegExp(sha256));
    assert.equal(answer.headers["cache-control"], "no-store");
    assert.equal(answer.headers.etag, undefined);
  }
  assert.match(service.log, new RegExp(sha256));
  await rendered();
  assert.equal((await fetch(service.origin + url)).status, 200);
}));

test("a hang-up reads the log level again and ends nothing", () => with_service({ log_level: "error" }, async (service) => {
  const id = await service.submit(lasting(1));
  await service.reached(id, "running");
  writeFileSync(service.config, JSON.stringify({ log_level: "info" }));
  for (const pid of [service.process.pid, ...service.workers(), ...service.renderers()]) process.kill(pid, "SIGHUP");
  await until(() => /SIGHUP: the log level is info/.test(service.log), "the level is read");
  writeFileSync(service.config, "{");
  process.kill(service.process.pid, "SIGHUP");
  await until(() => /SIGHUP: the configuration is not read again/.test(service.log), "a wrong file is told");
  assert.equal((await service.settled(id)).status, "done", service.log);
  assert.doesNotMatch(service.log, /worker .* ended/);
}));

test("a copy of a service that rests has all its reports", () => with_service({}, async (service) => {
  for (let i = 0; i < 3; ++i) await (await service.post({ ...QUICK, title: `report ${i}` }, { Prefer: "wait=60" })).json();
  const copy = new Service({ workers: 0 });
  // The worker's last words may still be on their way.
  await until(async () => {
    rmSync(copy.data, { recursive: true, force: true });
    mkdirSync(copy.data);
    copyFileSync(join(service.data, "archive.sqlite"), join(copy.data, "archive.sqlite"));
    cpSync(join(service.data, "blobs"), join(copy.data, "blobs"), { recursive: true });
    try {
      await copy.start();
      return (await copy.reports("?status=done")).length === 3;
    } finally {
      await copy.stop();
    }
  }, "the copy has three reports", 5);
  await copy.end();
}));

test("an archive without its database is not begun anew", async () => {
  const service = new Service();
  try {
    await service.start();
    await (await service.post(QUICK, { Prefer: "wait=60" })).json();
    await service.stop();
    rmSync(join(service.data, "archive.sqlite"));
    await assert.rejects(service.start(), /archive\.sqlite is missing/);
    assert.ok(!existsSync(join(service.data, "archive.sqlite")));
  } finally {
    await service.end();
  }
});
