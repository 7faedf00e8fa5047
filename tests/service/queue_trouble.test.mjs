// Workers of one PostgreSQL store that are killed, stopped and cut off at random: no job is lost, and none is done twice.
// SHEER_TROUBLE_JOBS and SHEER_TROUBLE_EVERY_S make it longer, SHEER_TROUBLE_CLOCK is a libfaketime.so.1 that sets the first
// worker's clock an hour ahead, SHEER_SEED repeats a run.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { join } from "node:path";
import { test } from "node:test";
import { ask_server, needs_postgres, QUICK, Service, sleep, until } from "./service.mjs";

const JOBS = Number(process.env.SHEER_TROUBLE_JOBS ?? 30);
const EVERY_S = Number(process.env.SHEER_TROUBLE_EVERY_S ?? 0.7);
const CLOCK = process.env.SHEER_TROUBLE_CLOCK;
const WORKERS = 4;
const LEASE_S = 1;
const WAITING = 8;
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
    this.done = 0;
    this.recoveries_ms = [];
    this.start();
  }

  get name() {
    return `worker-${this.number}`;
  }

  start() {
    const { program, store, config, folder } = this.service;
    const data = join(folder, `worker-${this.number}`);
    const named = `${store}&application_name=${this.name}`;
    const wrong_clock = CLOCK && this.number === 0 ? { LD_PRELOAD: CLOCK, FAKETIME: "+1h" } : {};
    this.process = spawn(
      program,
      ["worker", "--store", named, "--device", "tried", "--data", data, "--config", config],
      { stdio: ["ignore", "ignore", "pipe"], env: { ...process.env, ...wrong_clock } },
    );
    this.process.stderr.on("data", (text) => {
      this.log += text;
      if (!String(text).includes(" is done")) return;
      ++this.done;
      if (this.troubled_ms) {
        this.recoveries_ms.push(Date.now() - this.troubled_ms);
        this.troubled_ms = undefined;
      }
    });
    this.ended = new Promise((resolve) => this.process.on("exit", resolve));
  }

  /** Until it has done another job, it has not recovered. */
  async trouble(kind) {
    await this[kind]();
    this.troubled_ms ??= Date.now();
  }

  async kill() {
    this.process.kill("SIGKILL");
    await this.ended;
    this.start();
  }

  async pause(ms = 300) {
    this.process.kill("SIGSTOP");
    await sleep(ms);
    this.process.kill("SIGCONT");
  }

  pause_longer_than_its_lease() {
    return this.pause(LEASE_S * 1000 + 500);
  }

  cut() {
    const { database, store } = this.service;
    ask_server(
      `SELECT pg_terminate_backend(pid) FROM pg_stat_activity
       WHERE datname = '${database}' AND application_name = '${this.name}'`,
      store,
    );
  }

  async end() {
    this.process.kill("SIGCONT");
    this.process.kill("SIGTERM");
    await this.ended;
  }
}

const KINDS = ["kill", "pause", "pause_longer_than_its_lease", "cut"];

test("no job is lost or done twice while workers are in trouble", needs_postgres, async (context) => {
  const seed = Number(process.env.SHEER_SEED ?? Date.now() % 1e9);
  const random = random_of(seed);
  context.diagnostic(`seed ${seed}`);
  const service = new Service(CONFIG);
  const workers = [];
  const ids = [];
  const troubles = Object.fromEntries(KINDS.map((kind) => [kind, 0]));
  const waiting = async (status) => (await service.reports(`?status=${status}&limit=100`)).length;
  try {
    await service.start();
    for (let i = 0; i < WORKERS; ++i) workers.push(new Worker(service, i));
    const began = Date.now();
    let is_sent = false;
    const send = async () => {
      while (ids.length < JOBS) {
        for (let free = WAITING - (await waiting("queued")); free > 0 && ids.length < JOBS; --free) {
          const response = await service.post({ ...QUICK, title: `job ${ids.length}`, device: "tried" });
          assert.equal(response.status, 202);
          ids.push((await response.json()).id);
        }
        await sleep(300);
      }
      is_sent = true;
    };
    // Each kind in turn, so that a short run has all of them, and only after a job is done, so that no job is disturbed ten
    // times on a slow machine.
    const disturb = async () => {
      for (let i = 0, done = 0; !is_sent || i < KINDS.length; ++i) {
        await sleep(EVERY_S * (500 + 1000 * random()));
        const sum = () => workers.reduce((all, worker) => all + worker.done, 0);
        while (!is_sent && sum() === done) await sleep(50);
        done = sum();
        const kind = KINDS[i % KINDS.length];
        ++troubles[kind];
        await workers[Math.floor(random() * WORKERS)].trouble(kind);
      }
    };
    await Promise.all([send(), disturb()]);
    await until(async () => (await waiting("queued")) + (await waiting("running")) === 0, "every job has ended", 180);
    const seconds = (Date.now() - began) / 1000;
    const done = new Map();
    for (const { log } of workers)
      for (const [, id] of log.matchAll(/job (\S+) is done/g)) done.set(id, (done.get(id) ?? 0) + 1);
    const twice = ids.filter((id) => done.get(id) > 1);
    const lost = [];
    for (const id of ids) if ((await service.report(id)).status !== "done") lost.push(id);
    const slowest_s = Math.max(...workers.flatMap((worker) => worker.recoveries_ms)) / 1000;
    context.diagnostic(
      `${ids.length} jobs in ${seconds.toFixed(0)} s, ${JSON.stringify(troubles)}, ${lost.length} lost, ` +
        `${twice.length} twice, slowest recovery of a worker ${slowest_s.toFixed(1)} s`,
    );
    const logs = workers.map((worker) => worker.log.slice(-20_000)).join("\n");
    assert.deepEqual(lost, [], logs);
    assert.deepEqual(twice, [], logs);
    assert.ok(
      KINDS.every((kind) => troubles[kind] > 0),
      "each trouble happened",
    );
    if (JOBS >= 2000) assert.ok(slowest_s < 45, `a worker recovered in ${slowest_s} s`);
    const list = await (await fetch(`${service.api}/reports?status=done&limit=1`)).json();
    assert.equal(list.count, ids.length);
  } finally {
    await Promise.all(workers.map((worker) => worker.end()));
    await service.end();
  }
});
