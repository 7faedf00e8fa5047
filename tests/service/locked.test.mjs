// Another process holds the write lock of the archive's database: only writers wait.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { join } from "node:path";
import { test } from "node:test";

import { QUICK, read_events, sleep, with_service } from "./service.mjs";

const HELD_S = 2;
const PROMPT_MS = 200;

/** Holds the write lock until `release` is called. */
async function lock(file) {
  const client = spawn("sqlite3", [file], { stdio: ["pipe", "pipe", "inherit"] });
  client.stdin.write("BEGIN IMMEDIATE;\nSELECT 'held';\n");
  const [said] = await once(client.stdout, "data");
  assert.equal(said.toString(), "held\n");
  return {
    release: async () => {
      client.stdin.end("ROLLBACK;\n");
      await once(client, "exit");
    },
  };
}

const median = (numbers) => [...numbers].sort((a, b) => a - b)[Math.floor(numbers.length / 2)];

test("a locked database delays neither probes nor readers nor streams", { timeout: 120_000 }, async () => {
  await with_service({ workers: 0, http: { threads: 1, event_heartbeat_s: 0.05 } }, async (service) => {
    const id = await service.submit(QUICK);
    const heard_at = [];
    const controller = new AbortController();
    const stream = await fetch(`${service.api}/reports/${id}/events`, { signal: controller.signal });
    const reading = read_events(stream, () => {
      heard_at.push(performance.now());
      return false;
    }).catch((error) => assert.equal(error.name, "AbortError"));

    const held = await lock(join(service.data, "archive.sqlite"));
    const begin = performance.now();
    let written = false;
    const writing = service.post(QUICK).finally(() => {
      written = true;
    });
    const probes_ms = [];
    const reads_ms = [];
    while (performance.now() - begin < HELD_S * 1000) {
      for (const [url, times_ms] of [
        [`${service.origin}/healthz`, probes_ms],
        [`${service.api}/reports/${id}`, reads_ms],
      ]) {
        const asked_at = performance.now();
        assert.equal((await fetch(url)).status, 200);
        times_ms.push(performance.now() - asked_at);
      }
      await sleep(20);
    }
    const end = performance.now();
    assert.ok(!written, "the writer waits for the lock");
    await held.release();
    assert.equal((await writing).status, 202);
    controller.abort();
    await reading;

    const heard = heard_at.filter((time) => time >= begin && time <= end);
    const gaps_ms = heard.slice(1).map((time, i) => time - heard[i]);
    assert.ok(median(probes_ms) < PROMPT_MS, `/healthz took ${median(probes_ms)} ms`);
    assert.ok(median(reads_ms) < PROMPT_MS, `a report took ${median(reads_ms)} ms`);
    assert.ok(median(gaps_ms) < PROMPT_MS, `signs of life came every ${median(gaps_ms)} ms`);
  });
});
