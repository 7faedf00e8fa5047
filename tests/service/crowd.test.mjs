// Many connections, some of which stay idle forever: nobody is locked out.
import assert from "node:assert/strict";
import { readdirSync, readlinkSync } from "node:fs";
import { connect } from "node:net";
import { after, before, test } from "node:test";
import { QUICK, Service, sleep, until } from "./service.mjs";

const SEATS = 24;
const service = new Service({ workers: 0, http: { max_connections: SEATS, max_streams_per_client: 6 } });
before(() => service.start());
after(() => service.end_well());

function open(bytes = "") {
  return new Promise((resolve, reject) => {
    const socket = connect(new URL(service.origin).port, "127.0.0.1", () => {
      if (bytes) socket.write(bytes);
      resolve(socket);
    });
    socket.text = "";
    socket.on("data", (chunk) => {
      socket.text += chunk;
    });
    socket.on("error", reject);
    socket.on("close", () => {
      socket.is_closed = true;
    });
  });
}

/** The number of sockets that the service has open. */
const served = () =>
  readdirSync(`/proc/${service.process.pid}/fd`).filter((fd) => {
    try {
      return readlinkSync(`/proc/${service.process.pid}/fd/${fd}`).startsWith("socket:");
    } catch {
      return false;
    }
  }).length;

async function with_sockets(count, bytes, body) {
  const sockets = [],
    before = served();
  try {
    for (let i = 0; i < count; ++i) sockets.push(await open(bytes));
    await body(sockets);
  } finally {
    for (const socket of sockets) socket.destroy();
    // The next test needs free connections.
    await until(() => served() <= before, "the service has noticed");
  }
}

/** The status of a request on a separate connection. */
const ask = async (path) => (await service.raw("GET", path, { Connection: "close" })).status;

test("idle connections make room for active ones", () =>
  with_sockets(SEATS, "", async (sockets) => {
    assert.equal(await ask("/healthz"), 200);
    await sleep(500); // they no longer count as new
    for (let i = 0; i < 5; ++i) assert.equal(await ask("/api/v1/methods"), 200);
    // Those that waited longest are closed, and no more than necessary.
    await until(() => sockets[0].is_closed, "the first is closed");
    assert.ok(sockets.filter((socket) => socket.is_closed).length <= 5);
    assert.ok(!sockets.at(-1).is_closed);
  }));

test("slow connections do so too", () =>
  with_sockets(SEATS, "GET / HTTP/1.1\r\nHost: ", async () => {
    assert.equal(await ask("/healthz"), 200);
    await until(async () => (await ask("/api/v1/methods")) === 200, "there is room", 10);
  }));

test("each client may have only a few streams of events", async () => {
  const id = await service.submit(QUICK);
  const get = `GET /api/v1/reports/${id}/events HTTP/1.1\r\nHost: localhost\r\n\r\n`;
  await with_sockets(SEATS, get, async (sockets) => {
    await until(() => sockets.every((socket) => socket.text), "all are answered");
    const of = (status) => sockets.filter((socket) => socket.text.startsWith(`HTTP/1.1 ${status} `));
    assert.equal(of(200).length, 6);
    assert.equal(of(429).length, SEATS - 6);
    assert.match(of(429)[0].text, /Retry-After: /);
    assert.equal(await ask("/api/v1/methods"), 200);
    // A request that would wait for a report is answered at once: it is not ready.
    const waiting = await service.post(QUICK, { Prefer: "wait=60", Connection: "close" });
    assert.equal(waiting.status, 202);
    await service.raw("DELETE", `/api/v1/reports/${(await waiting.json()).id}`);
  });
  // Closed ones no longer count.
  await until(async () => {
    const socket = await open(get);
    await until(() => socket.text, "it is answered");
    socket.destroy();
    return socket.text.startsWith("HTTP/1.1 200 ");
  }, "there is room for a stream");
  await service.raw("DELETE", `/api/v1/reports/${id}`);
});

test("if every connection is busy, one is left for probes", async () => {
  // A body that arrives slowly.
  const post = "POST /api/v1/specs/validate HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\n{";
  await with_sockets(SEATS, post, async (sockets) => {
    await sleep(100);
    const is_slow = () => sockets.some((socket) => socket.is_closed); // after ten seconds they make room too
    for (let i = 0; i < 20; ++i) assert.equal(await ask("/healthz"), 200);
    assert.equal(await ask("/readyz"), 503); // no worker
    const other = await ask("/api/v1/methods");
    assert.ok(other === 503 || is_slow(), String(other));
    // Idle connections do not take the place of probes.
    await with_sockets(20, "", async () => assert.equal(await ask("/healthz"), 200));
  });
});

test("the service reports that it is alive while all its threads read specs", async () => {
  const layers = Array.from({ length: 4096 }, () => ({ depth: 0.5 }));
  const axis = (pointer, values) => ({ pointer, values });
  const alphas = Array.from({ length: 128 }, (_, i) => i / 128),
    widths = Array.from({ length: 256 }, (_, i) => i + 1);
  const specs = [[axis("/scene/layers/7/alpha", alphas)], [axis("/image/width", widths)]].map((sweep) =>
    JSON.stringify({ scene: { type: "layers", layers }, methods: ["b2f"], sweep }),
  );
  let pending = 8;
  const answers = Array.from({ length: pending }, async (_, i) => {
    const answer = await service.raw(
      "POST",
      "/api/v1/specs/validate",
      { "Content-Type": "application/json" },
      specs[i % 2],
    );
    --pending;
    return answer.status;
  });
  let asked = 0;
  while (pending > 0) {
    assert.equal(await ask("/healthz"), 200);
    assert.equal(await ask("/api/v1/reports"), 200);
    ++asked;
  }
  for (const status of await Promise.all(answers)) assert.ok([200, 422].includes(status), String(status));
  // It did not wait for the specs.
  assert.ok(asked > 3, String(asked));
});
