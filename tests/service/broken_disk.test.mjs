// A disk that fails with EIO, as a real one does. It is a file on a loop device that is smaller than its file system:
// blocks beyond the end cannot be written. This needs root.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import {
  closeSync,
  ftruncateSync,
  mkdirSync,
  mkdtempSync,
  openSync,
  readdirSync,
  readFileSync,
  rmSync,
  writeFileSync,
  writeSync,
} from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { lasting, QUICK, Service, until } from "./service.mjs";

const SIZE_BYTES = 8 << 20,
  BLOCK_BYTES = 1024;

class Disk {
  constructor(folder) {
    this.file = join(folder, "disk");
    writeFileSync(this.file, Buffer.alloc(SIZE_BYTES));
    this.device = execFileSync("losetup", ["--find", "--show", this.file], { encoding: "utf8", stdio: "pipe" }).trim();
    // One group of blocks: the file system's own data comes first, and stays intact.
    execFileSync("mkfs.ext2", ["-q", "-b", String(BLOCK_BYTES), "-m", "0", this.device]);
    const facts = execFileSync("dumpe2fs", [this.device], { encoding: "utf8", stdio: "pipe" });
    this.first_free_block = Number(/^ +Free blocks: (\d+)/m.exec(facts)[1]);
  }

  resize(bytes, tail) {
    const file = openSync(this.file, "r+");
    ftruncateSync(file, bytes);
    if (tail) writeSync(file, tail, 0, tail.length, bytes - tail.length);
    closeSync(file);
    execFileSync("losetup", ["--set-capacity", this.device]);
  }

  fail() {
    const end = this.first_free_block * BLOCK_BYTES;
    this.beyond = readFileSync(this.file).subarray(end);
    this.resize(end);
  }

  mend() {
    this.resize(SIZE_BYTES, this.beyond);
  }

  remove() {
    execFileSync("losetup", ["--detach", this.device]);
  }
}

/** Whether loop devices can be used. */
function can_have_disks() {
  const folder = mkdtempSync(join(tmpdir(), "sheer-loop-"));
  try {
    const disk = new Disk(folder);
    const mounted = spawnSync("unshare", ["-m", "mount", "-t", "ext2", disk.device, folder]);
    disk.remove();
    return mounted.status === 0;
  } catch {
    return false;
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}
const skip = !can_have_disks() && "no loop devices, or no right to mount them";

/** Runs `body` with a service whose folder `name` in the data folder is such a disk. */
async function with_disk_at(name, body) {
  const folder = mkdtempSync(join(tmpdir(), "sheer-broken-"));
  const service = new Service({}, folder);
  const disk = new Disk(folder);
  try {
    mkdirSync(join(service.data, name), { recursive: true });
    // Written synchronously, so that the error is reported at once.
    service.wrapper = [
      "unshare",
      "-m",
      "sh",
      "-c",
      `mount -t ext2 -o sync ${disk.device} ${join(service.data, name)} && exec "$@"`,
      "sh",
    ];
    await service.start();
    service.disk = () => join(`/proc/${service.process.pid}/root`, service.data, name);
    // A worker may have swept it up already.
    rmSync(join(service.disk(), "lost+found"), { recursive: true, force: true });
    await body(service, disk);
    await service.end_well();
  } finally {
    await service.stop();
    disk.remove();
    await service.end();
  }
}

const waits = (service, id) =>
  until(async () => {
    const report = await service.report(id);
    assert.ok(["queued", "running"].includes(report.status), `${JSON.stringify(report)} ${service.log}`);
    return /^waiting: /.test(report.stage) && report;
  }, `report ${id} waits for the disk`);

test("a scratch folder that fails before a job begins", { skip }, () =>
  with_disk_at("scratch", async (service, disk) => {
    assert.equal((await service.settled(await service.submit(QUICK))).status, "done", service.log);
    disk.fail();
    const id = await service.submit(QUICK);
    assert.match((await waits(service, id)).stage, /Input\/output error/);
    assert.match(service.log, /Input\/output error/);
    assert.equal((await fetch(`${service.origin}/healthz`)).status, 200);
    disk.mend();
    assert.equal((await service.settled(id)).status, "done", service.log);
  }),
);

test("a scratch folder that fails while a picture is drawn", { skip }, () =>
  with_disk_at("scratch", async (service, disk) => {
    const id = await service.submit({ ...lasting(2), image: { width: 128, height: 128 } });
    await until(() => service.renderers().length > 0, "it is rendered");
    await until(async () => (await service.report(id)).progress > 0, "it has begun");
    disk.fail();
    assert.match((await waits(service, id)).stage, /Input\/output error/);
    disk.mend();
    assert.equal((await service.settled(id)).status, "done", service.log);
  }),
);

test("an archive that fails loses no report and keeps no picture without a report", { skip }, () =>
  with_disk_at("blobs", async (service, disk) => {
    const first = await service.settled(await service.submit(QUICK));
    assert.equal(first.status, "done", service.log);
    disk.fail();
    const other = { ...QUICK, image: { width: 24, height: 24 } };
    const id = await service.submit(other);
    assert.match((await waits(service, id)).stage, /^waiting: The archive's disk fails\.$/);
    assert.match(service.log, /Input\/output error/);
    assert.equal((await fetch(service.origin + first.runs[0].results[0].images.color.url)).status, 200);
    disk.mend();
    const second = await service.settled(id);
    assert.equal(second.status, "done", service.log);
    const named = new Set(
      [first, second].flatMap((report) =>
        [...JSON.stringify(report).matchAll(/"sha256":"([0-9a-f]{64})","url":"\/api\/v1\/blobs/g)].map(
          ([, sha256]) => sha256,
        ),
      ),
    );
    const kept = readdirSync(service.disk()).flatMap((folder) => readdirSync(join(service.disk(), folder)));
    assert.deepEqual(kept.sort(), [...named].sort());
    for (const sha256 of named) assert.equal((await fetch(`${service.api}/blobs/${sha256}`)).status, 200, sha256);
  }),
);
