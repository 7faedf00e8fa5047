// The service, its workers and their renderers are killed at random moments while eight clients submit: every report
// that was acknowledged ends and never changes, and none is made twice. One fails only if its renderer was killed twice,
// or if all its attempts were.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { test } from "node:test";
import { QUICK, Service, sleep, until } from "../service/service.mjs";
import { Random, SIZE } from "./random.mjs";

const KILLS = 60 * SIZE,
  CLIENTS = 8;
const REASONS = ["The renderer died (signal 9).", "The worker died while it rendered this report."];

/** Submits one comparison after the other until `state.is_over`. Each has a key, with which it is repeated until it is
 * acknowledged. */
async function submit_always(service, client, state) {
  for (let i = 0; !state.is_over; ++i) {
    const key = `${client}-${i}`,
      spec = { ...QUICK, title: key };
    for (let id = null; id === null && !state.has_failed;) {
      const answer = await service.post(spec, { "Idempotency-Key": key }).catch(() => null);
      if (answer?.status === 202) id = (await answer.json().catch(() => ({ id: null }))).id;
      else await sleep(100);
      if (id) state.acknowledged.set(key, id);
    }
    await keep_text_once_ended(service, state.acknowledged.get(key), state);
  }
}

/** Waits until the report has ended, and remembers its bytes. */
async function keep_text_once_ended(service, id, state) {
  while (!state.texts.has(id) && !state.has_failed) {
    const answer = await fetch(`${service.api}/reports/${id}`).catch(() => null);
    const text = await answer?.text().catch(() => null);
    if (text && answer.status === 200 && ["done", "failed"].includes(JSON.parse(text).status))
      state.texts.set(id, text);
    else if (text && answer.status === 404) throw new Error(`${id} was acknowledged and is lost`);
    else await sleep(50);
  }
}

/** Kills one process. Returns the time in milliseconds until the service answers again, or null for other processes. */
async function kill(service, random) {
  if (random.next() < 0.75) {
    const others = random.next() < 0.3 ? () => service.renderers() : () => service.workers();
    const there = await until(() => others().length > 0 && others(), "there is one", 300, 5);
    try {
      process.kill(random.of(there), "SIGKILL");
    } catch (error) {
      if (error.code !== "ESRCH") throw error; // it has ended meanwhile
    }
    return null;
  }
  service.process.kill("SIGKILL");
  await service.ended;
  const begin = performance.now();
  await service.start();
  return performance.now() - begin;
}

test(`${KILLS} kills under ${CLIENTS} clients lose nothing and make nothing twice`, async () => {
  const random = new Random();
  const service = new Service({ workers: 2, jobs: { lease_s: 4, heartbeat_s: 0.4, max_attempts: 10 } });
  const state = { is_over: false, has_failed: false, acknowledged: new Map(), texts: new Map() };
  service.holds_to_contract = false;
  try {
    await service.start();
    service.listen = new URL(service.origin).host;
    const clients = Array.from({ length: CLIENTS }, (_, client) => submit_always(service, client, state));
    const starts_ms = [];
    for (let i = 0; i < KILLS; ++i) {
      await sleep(30 + random.below(300));
      const start_ms = await kill(service, random).catch((error) => assert.fail(`${error.message}\n${service.log}`));
      if (start_ms !== null) starts_ms.push(start_ms);
    }
    state.is_over = true;
    await Promise.all(clients);
    starts_ms.sort((a, b) => a - b);
    const failed = [...state.texts.values()]
      .map((text) => JSON.parse(text))
      .filter(({ status }) => status === "failed");
    for (const { error } of failed) assert.ok(REASONS.includes(error.detail), error.detail);
    console.log(
      `${state.texts.size} reports, ${failed.length} of them failed; ${starts_ms.length} starts, ` +
        `the median ${Math.round(starts_ms[starts_ms.length >> 1])} ms, the longest ${Math.round(starts_ms.at(-1))} ms`,
    );

    for (const [id, text] of state.texts) {
      const answer = await fetch(`${service.api}/reports/${id}`);
      assert.equal(await answer.text(), text, id);
    }
    const ids = new Set(state.acknowledged.values());
    assert.equal(ids.size, state.acknowledged.size);
    assert.ok(ids.size >= CLIENTS);
    const stored = [];
    for (let url = `${service.api}/reports?limit=100`; url;) {
      const answer = await fetch(url);
      stored.push(...(await answer.json()).reports.map((report) => report.id));
      const [, next] = /<([^>]+)>; rel="?next/.exec(answer.headers.get("link") ?? "") ?? [];
      url = next && new URL(next, service.origin).href;
    }
    assert.deepEqual(stored.sort(), [...ids].sort());
    await until(() => service.renderers().length === 0, "nothing is rendered");
    await service.stop();
    const fsck = spawnSync(service.program, ["archive", "fsck", "--data", service.data], { encoding: "utf8" });
    assert.equal(fsck.status, 0, fsck.stdout + fsck.stderr);
  } finally {
    state.is_over = state.has_failed = true;
    await service.end();
  }
});
