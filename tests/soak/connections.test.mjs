// Thousands of connections that are idle or slow: the service keeps answering, and the slow ones are closed.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { connect } from "node:net";
import { after, before, test } from "node:test";
import { QUICK, Service, sleep, until } from "../service/service.mjs";
import { SIZE } from "./random.mjs";

const COUNT = Math.min(2000 * SIZE, 10_000);
const LIMITS = { header_timeout_s: 2, body_timeout_s: 2, write_timeout_s: 2, idle_timeout_s: 2, event_heartbeat_s: 1 };
const service = new Service({ workers: 0, http: LIMITS });
service.holds_to_contract = false;
before(() => service.start());
after(() => service.end_well());

const memory_mib = () =>
  Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${service.process.pid}/status`, "utf8"))[1]) / 1024;

/** What the kernel holds of the service's answers, sent or not, until the clients have read it. */
const held_mib = () => {
  const port = Number(new URL(service.origin).port).toString(16).toUpperCase().padStart(4, "0");
  return readFileSync("/proc/net/tcp", "utf8")
    .split("\n")
    .map((line) => line.trim().split(/\s+/))
    .filter(([, local]) => local?.endsWith(`:${port}`))
    .reduce((sum, fields) => sum + Number.parseInt(fields[4], 16) / 2 ** 20, 0);
};

/** A client that sends `bytes`, and then nothing; a deaf one does not read either. */
function open(bytes, is_deaf) {
  const socket = connect(new URL(service.origin).port, "127.0.0.1");
  socket.on("connect", () => bytes && socket.write(bytes));
  socket.on("error", () => {});
  socket.on("close", () => {
    socket.is_closed = true;
  });
  if (is_deaf) socket.pause();
  else socket.resume();
  return socket;
}

/** Asks on a new connection, as a balancer does; returns the time in milliseconds. */
async function probe() {
  const begin = performance.now();
  assert.equal((await service.raw("GET", "/healthz", { Connection: "close" })).status, 200);
  return performance.now() - begin;
}

async function crowd(name, bytes, { is_deaf = false, stay = false } = {}) {
  const sockets = [],
    times_ms = [];
  for (let i = 0; i < COUNT; ++i) {
    sockets.push(open(bytes, is_deaf));
    if (i % 100 === 99) times_ms.push(await probe());
  }
  // Whoever is slow is closed; a socket that does not read does not notice it until it writes.
  let most_held_mib = 0;
  for (let i = 0; i < 20; ++i) {
    times_ms.push(await probe());
    most_held_mib = Math.max(most_held_mib, held_mib());
    await sleep(100);
  }
  if (!stay && !is_deaf) await until(() => sockets.every((socket) => socket.is_closed), `${name}: all are closed`, 60);
  for (const socket of sockets) socket.destroy();
  times_ms.sort((a, b) => a - b);
  const at = (part) => times_ms[Math.floor(part * (times_ms.length - 1))].toFixed(1);
  console.log(
    `${COUNT} ${name}: a probe takes ${at(0.5)} ms, at most ${at(1)} ms; ${memory_mib().toFixed(0)} MiB, ` +
      `${most_held_mib.toFixed(0)} MiB on the way`,
  );
  return most_held_mib;
}

test("idle connections", () => crowd("idle connections", ""));
test("slow headers", () => crowd("slow headers", "GET / HTTP/1.1\r\nHost: local"));
test("slow bodies", () =>
  crowd(
    "slow bodies",
    "POST /api/v1/specs/validate HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 99\r\n\r\n{",
  ));
test("uploads that do not end take no memory", async () => {
  await service.raw("GET", "/healthz");
  const before_mib = memory_mib(),
    head =
      "POST /api/v1/assets HTTP/1.1\r\nHost: localhost\r\nContent-Type: image/png\r\nContent-Length: 60000000\r\n\r\n",
    part = Buffer.alloc(10_000_000);
  const sockets = Array.from({ length: 20 }, () => open(head));
  await Promise.all(sockets.map((socket) => new Promise((resolve) => socket.write(part, resolve))));
  const more_mib = memory_mib() - before_mib;
  console.log(`20 uploads of 10 of 60 MB: ${more_mib.toFixed(0)} MiB more`);
  for (const socket of sockets) socket.destroy();
  await probe();
  assert.ok(more_mib < 60, `${more_mib} MiB`);
});
/** Each is owed up to 40 large answers; the service makes one at a time, and the kernel takes a part of it. */
const deaf = () =>
  crowd("clients that do not read", "GET /api/v1/openapi.json HTTP/1.1\r\nHost: localhost\r\n\r\n".repeat(40), {
    is_deaf: true,
  });
test("clients that do not read take memory for one answer each", async () => {
  const seats = 256,
    answer_mib = (await service.raw("GET", "/api/v1/openapi.json")).text.length / 2 ** 20,
    most_mib = memory_mib() + 1.25 * seats * answer_mib;
  const held = [await deaf(), await deaf()];
  assert.ok(Math.max(...held) < seats * answer_mib, `${held} MiB of answers are on the way`);
  assert.ok(memory_mib() < most_mib, `${memory_mib()} of ${most_mib} MiB`);
});
test("streams of events", async () => {
  const id = await service.submit(QUICK);
  await crowd("streams", `GET /api/v1/reports/${id}/events HTTP/1.1\r\nHost: localhost\r\n\r\n`, { stay: true });
  await fetch(`${service.api}/reports/${id}`, { method: "DELETE" });
});
