// One call that writes to the disk fails, or its process is killed there: the call is any of those between a submission
// and the report. A report that was acknowledged is done in the end, whatever failed, and the archive is sound.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { closeSync, mkdirSync, openSync, readSync, writeFileSync, writeSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { QUICK, Service, sleep, until } from "../service/service.mjs";
import { Random, SIZE } from "./random.mjs";

const FAULTS = 60 * SIZE;
const EIO = 5,
  ENOSPC = 28,
  KILL = 0;

/** The file that tests/faulty_disk reads: calls so far, the one that fails, how. */
class Plan {
  constructor(folder) {
    this.path = join(folder, "plan");
    writeFileSync(this.path, Buffer.alloc(12));
    this.file = openSync(this.path, "r+");
  }

  arm(fails, error) {
    const bytes = Buffer.from(new Int32Array([0, fails, error]).buffer);
    writeSync(this.file, bytes, 0, bytes.length, 0);
  }

  calls() {
    const bytes = Buffer.alloc(4);
    readSync(this.file, bytes, 0, 4, 0);
    return bytes.readInt32LE();
  }

  close() {
    closeSync(this.file);
  }
}

/** A job of its own: other pictures than those before, so that they are written. */
const job = (number) => ({
  ...QUICK,
  title: `job ${number}`,
  image: { width: 16, height: 16, background: [(number % 251) / 250, (number % 13) / 12, 0] },
});

const has_ended = (service) => service.process.exitCode !== null || service.process.signalCode !== null;

/** Submits until it is acknowledged, and starts the service again if it was killed. */
async function acknowledged(service, spec, key) {
  for (;;) {
    const answer = await service.post(spec, { "Idempotency-Key": key }).catch(() => null);
    if (answer?.status === 202) return (await answer.json()).id;
    if (answer) assert.ok([503, 507].includes(answer.status), `${answer.status} ${await answer.text()} ${service.log}`);
    await restart_if_killed(service);
    await sleep(50);
  }
}

async function restart_if_killed(service) {
  if (!has_ended(service)) return;
  assert.equal(service.process.signalCode, "SIGKILL", service.log);
  await service.start();
}

async function done(service, id) {
  return until(
    async () => {
      await restart_if_killed(service);
      const answer = await fetch(`${service.api}/reports/${id}`).catch(() => null);
      if (!answer) return null;
      const report = await answer.json();
      assert.ok(!["failed", "cancelled"].includes(report.status), `${JSON.stringify(report.error)} ${service.log}`);
      return answer.status === 200 && report.status === "done" && report;
    },
    `report ${id} is done`,
    120,
    50,
  );
}

test(`${FAULTS} single faults of the disk lose no report`, async () => {
  const random = new Random();
  const service = new Service({ jobs: { lease_s: 4, heartbeat_s: 0.4, max_attempts: 10 } });
  mkdirSync(service.data, { recursive: true });
  const plan = new Plan(service.folder);
  service.wrapper = [
    "env",
    `LD_PRELOAD=${process.env.FAULTY_DISK}`,
    `SHEER_FAULT_FILE=${plan.path}`,
    `SHEER_FAULT_FOLDER=${service.data}`,
  ];
  service.holds_to_contract = false;
  try {
    await service.start();
    service.listen = new URL(service.origin).host;
    await done(service, await acknowledged(service, job(0), "0"));
    plan.arm(0, 0);
    await done(service, await acknowledged(service, job(1), "1"));
    const calls = plan.calls();
    console.log(`${calls} calls that write, from a submission to the report`);
    assert.ok(calls > 20, String(calls));
    let struck = 0;
    for (let i = 0; i < FAULTS; ++i) {
      const number = i + 2,
        at = 1 + random.below(calls),
        error = random.of([EIO, ENOSPC, KILL]);
      plan.arm(at, error);
      const id = await acknowledged(service, job(number), String(number));
      const report = await done(service, id).catch((failure) =>
        assert.fail(`call ${at}, error ${error}: ${failure.message}\n${service.log}`),
      );
      if (plan.calls() >= at) ++struck;
      plan.arm(0, 0);
      await restart_if_killed(service);
      for (const { sha256, url } of Object.values(report.runs[0].results[0].images)) {
        const picture = await fetch(service.origin + url);
        assert.equal(picture.status, 200, `${sha256} after call ${at}, error ${error}`);
      }
    }
    console.log(`${struck} of ${FAULTS} faults struck`);
    assert.ok(struck > FAULTS / 2);
    assert.equal((await service.reports(`?limit=1`)).length, 1);
    await until(() => service.renderers().length === 0, "nothing is rendered");
    await service.stop();
    const fsck = spawnSync(service.program, ["archive", "fsck", "--data", service.data], { encoding: "utf8" });
    assert.equal(fsck.status, 0, fsck.stdout + fsck.stderr);
  } finally {
    plan.close();
    await service.end();
  }
});
