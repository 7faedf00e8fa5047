// Workers of one PostgreSQL store that are killed and stopped at random: no job is lost, and none is done twice.
// SHEER_TROUBLE_S seconds of it; SHEER_SEED repeats a run.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { join } from "node:path";
import { test } from "node:test";
import { needs_postgres, QUICK, Service, sleep, until } from "./service.mjs";

const SECONDS = Number(process.env.SHEER_TROUBLE_S ?? 20);
const WORKERS = 4;
const LEASE_S = 1;
const CONFIG = {
  workers: 0,
  jobs: { lease_s: LEASE_S, heartbeat_s: 0.2, max_attempts: 10, max_queued: 100000 },
  worker: { poll_s: 0.2 },
};

/** Numbers from 0 to 1 that a seed gives. */
function random_of(seed) {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

class Worker {
  constructor(service, number) {
    this.service = service;
    this.number = number;
    this.log = "";
    this.start();
  }

  start() {
    const { program, store, config, folder } = this.service;
    const data = join(folder, `worker-${this.number}`);
    this.process = spawn(
      program,
      ["worker", "--store", store, "--device", "tried", "--data", data, "--config", config],
      { stdio: ["ignore", "ignore", "pipe"] },
    );
    this.process.stderr.on("data", (text) => {
      this.log += text;
    });
    this.ended = new Promise((resolve) => this.process.on("exit", resolve));
  }

  async kill() {
    this.process.kill("SIGKILL");
    await this.ended;
    this.start();
  }

  /** Longer than its lease, or shorter. */
  async pause(ms) {
    this.process.kill("SIGSTOP");
    await sleep(ms);
    this.process.kill("SIGCONT");
  }

  async end() {
    this.process.kill("SIGCONT");
    this.process.kill("SIGTERM");
    await this.ended;
  }
}

test("no job is lost or done twice while workers are killed and stopped", needs_postgres, async (context) => {
  const seed = Number(process.env.SHEER_SEED ?? Date.now() % 1e9);
  const random = random_of(seed);
  context.diagnostic(`seed ${seed}`);
  const service = new Service(CONFIG);
  const workers = [];
  const ids = [];
  const troubles = { kills: 0, pauses: 0 };
  try {
    await service.start();
    for (let i = 0; i < WORKERS; ++i) workers.push(new Worker(service, i));
    const over = Date.now() + SECONDS * 1000;
    const sender = (async () => {
      while (Date.now() < over) {
        const response = await service.post({ ...QUICK, title: `job ${ids.length}`, device: "tried" });
        assert.equal(response.status, 202);
        ids.push((await response.json()).id);
        const waiting = (await service.reports("?status=queued&limit=100")).length;
        await sleep(waiting > 6 ? 500 : 50);
      }
    })();
    while (Date.now() < over) {
      await sleep(300 + 700 * random());
      const worker = workers[Math.floor(random() * WORKERS)];
      if (random() < 0.5) {
        ++troubles.kills;
        await worker.kill();
      } else {
        ++troubles.pauses;
        await worker.pause(random() < 0.5 ? 300 : LEASE_S * 1000 + 500);
      }
    }
    await sender;
    await until(
      async () => {
        const [queued, running] = await Promise.all(
          ["queued", "running"].map((status) => service.reports(`?status=${status}&limit=1`)),
        );
        return queued.length + running.length === 0;
      },
      "every job has ended",
      180,
    );
    const logs = workers.map((worker) => worker.log).join("\n");
    const twice = ids.filter((id) => logs.split(`job ${id} is done`).length > 2);
    const reports = await Promise.all(ids.map((id) => service.report(id)));
    const lost = reports.filter((report) => report.status !== "done");
    context.diagnostic(
      `${ids.length} jobs, ${troubles.kills} workers killed, ${troubles.pauses} stopped, ` +
        `${lost.length} lost, ${twice.length} twice`,
    );
    assert.deepEqual(lost, [], logs);
    assert.deepEqual(twice, [], logs);
    assert.ok(ids.length >= SECONDS / 2, "there were jobs");
    const list = await (await fetch(`${service.api}/reports?status=done&limit=1`)).json();
    assert.equal(list.count, ids.length);
  } finally {
    await Promise.all(workers.map((worker) => worker.end()));
    await service.end();
  }
});
