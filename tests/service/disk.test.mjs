// Full disks, damaged bytes, and a service that receives SIGHUP.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import {
  copyFileSync,
  cpSync,
  existsSync,
  mkdirSync,
  mkdtempSync,
  readdirSync,
  readFileSync,
  rmSync,
  writeFileSync,
} from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { assert_problem, lasting, QUICK, Service, until, with_service } from "./service.mjs";

/** A separate mount namespace needs root, or a machine that allows user namespaces. */
const UNSHARE = [
  ["unshare", "-m"],
  ["unshare", "-rm"],
].find(([program, ...words]) => spawnSync(program, [...words, "mount", "-t", "tmpfs", "none", "/mnt"]).status === 0);

const small = (seed, size = 96) => ({
  ...QUICK,
  title: `report ${seed}`,
  image: { width: size, height: size },
  scene: { type: "quads", count: 24, seed, shading: "constant" },
});

const pictures_of = (report) =>
  [...JSON.stringify(report).matchAll(/"sha256":"([0-9a-f]{64})","url":"\/api\/v1\/blobs/g)].map(
    ([, sha256]) => sha256,
  );

/** Runs `body` with a service whose data folder is a separate disk, a tmpfs with these options. */
async function on_disk(options, body) {
  const folder = mkdtempSync(join(tmpdir(), "sheer-disk-"));
  const service = new Service({ jobs: { max_queued: 1000 } }, folder);
  mkdirSync(service.data, { recursive: true });
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

/** Whether the service says that its disk is full. */
async function disk_is_full(service) {
  const ready = await fetch(`${service.origin}/readyz`);
  return ready.status === 503 && /disk/.test((await ready.json()).detail);
}

/**
 * Posts reports until one is refused and the service says why; returns the problem. What a running job gives back when it
 * ends may do for some more, so one refusal is not the end.
 */
async function fill(service) {
  let seed = 0;
  return until(
    async () => {
      const response = await service.post(small(++seed), { Prefer: "wait=4" });
      if (response.status !== 507) {
        assert.ok([200, 202].includes(response.status), `${response.status}: ${await response.text()}`);
        return null;
      }
      const problem = await assert_problem(response, 507);
      return (await disk_is_full(service)) && problem;
    },
    "a report is refused, as the disk is full",
    240,
  );
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

/** Each day another of the disks, as one takes a minute; SHEER_DISK chooses, or asks for "all". */
const DISK = process.env.SHEER_DISK ?? String(Math.floor(Date.now() / 86_400_000) % 3);
const reason_to_skip = (index) => {
  if (!UNSHARE) return "no mount namespaces here";
  return DISK !== "all" && DISK !== String(index) && `not today's disk: SHEER_DISK=${index} chooses it`;
};

// With the bytes of other files, so that not many reports fill the disk.
for (const [index, [options, other_bytes]] of [
  ["size=2m", 400 << 10],
  ["size=3m", 1600 << 10],
  ["size=64m,nr_inodes=90", 0],
].entries()) {
  test(`a full disk (${options}) accepts nothing, says so, and works again`, { skip: reason_to_skip(index) }, () =>
    on_disk(options, async (service) => {
      const ballast = join(service.disk, "ballast");
      writeFileSync(ballast, Buffer.alloc(other_bytes));
      const problem = await fill(service);
      assert.match(problem.detail, /disk/);
      assert.equal((await fetch(`${service.origin}/healthz`)).status, 200);
      // What a job that ended has given back may do for a few uploads more.
      let bytes = 0;
      const uploads = [];
      await until(async () => {
        const upload = await fetch(`${service.api}/assets`, {
          method: "POST",
          body: "x".repeat(++bytes),
          headers: { "Content-Type": "application/octet-stream" },
        });
        assert.ok([201, 507].includes(upload.status), String(upload.status));
        if (upload.status === 201) uploads.push((await upload.json()).url);
        return upload.status === 507;
      }, "an upload is refused");

      // The other files keep growing.
      try {
        writeFileSync(ballast, Buffer.alloc(64 << 20));
      } catch (error) {
        assert.equal(error.code, "ENOSPC");
      }
      const before = await all_reports(service);
      assert.ok(
        before.every(({ status }) => ["done", "queued", "running"].includes(status)),
        JSON.stringify(before),
      );
      const done = before.filter(({ status }) => status === "done");
      assert.ok(done.length > 0, "no report was finished at all");
      // A slow machine has more jobs waiting than there will be room for.
      const pending = before.filter(({ status }) => status !== "done");
      const waiting = pending.slice(0, 1);
      for (const { id } of [...done, ...pending.slice(1)]) {
        const { status } = await service.raw("DELETE", `/api/v1/reports/${id}`);
        assert.ok([200, 202, 204].includes(status), `${status} ${service.log}`);
      }
      for (const url of uploads) assert.equal((await fetch(service.origin + url, { method: "DELETE" })).status, 204);
      rmSync(ballast, { force: true });

      // Jobs that waited for room finish, and so do new ones.
      await until(async () => (await fetch(`${service.origin}/readyz`)).status === 200, "there is room again");
      const next = await service.submit(small(1000));
      for (const { id } of [...waiting, { id: next }])
        assert.equal((await service.settled(id)).status, "done", service.log);
      const kept = await all_reports(service);
      const named = new Set();
      for (const { id } of kept) for (const sha256 of pictures_of(await service.report(id))) named.add(sha256);
      const files = readdirSync(join(service.disk, "blobs"), { withFileTypes: true }).flatMap(({ name }) =>
        readdirSync(join(service.disk, "blobs", name)),
      );
      assert.deepEqual(files.sort(), [...named].sort(), "pictures that no report names, or missing ones");
    }),
  );
}

test("a picture with changed bytes is not served, and is restored by the next report that has it", () =>
  with_service({}, async (service) => {
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

test("SIGHUP reloads the log level and ends nothing", () =>
  with_service({ log_level: "error" }, async (service) => {
    const id = await service.submit(lasting(1));
    await service.reached(id, "running");
    writeFileSync(service.config, JSON.stringify({ log_level: "info" }));
    for (const pid of [service.process.pid, ...service.workers(), ...service.renderers()]) process.kill(pid, "SIGHUP");
    await until(() => /SIGHUP: the log level is info/.test(service.log), "the level is read");
    writeFileSync(service.config, "{");
    process.kill(service.process.pid, "SIGHUP");
    await until(() => /SIGHUP: the configuration is not reloaded/.test(service.log), "a wrong file is reported");
    assert.equal((await service.settled(id)).status, "done", service.log);
    assert.doesNotMatch(service.log, /worker .* ended/);
  }));

test("a copy of an idle service has all its reports", () =>
  with_service({}, async (service) => {
    for (let i = 0; i < 3; ++i)
      await (await service.post({ ...QUICK, title: `report ${i}` }, { Prefer: "wait=60" })).json();
    const copy = new Service({ workers: 0 });
    // The worker's last messages may still be arriving, and a copy made while they are written may not even start.
    await until(
      async () => {
        rmSync(copy.data, { recursive: true, force: true });
        mkdirSync(copy.data);
        copyFileSync(join(service.data, "archive.sqlite"), join(copy.data, "archive.sqlite"));
        cpSync(join(service.data, "blobs"), join(copy.data, "blobs"), { recursive: true });
        try {
          await copy.start();
          return (await copy.reports("?status=done")).length === 3;
        } catch (error) {
          assert.match(String(error), /is truncated/);
          return false;
        } finally {
          await copy.stop();
        }
      },
      "the copy has three reports",
      60,
    );
    await copy.end();
  }));

test("an archive without its database is not replaced by a new one", async () => {
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
