// Random requests: each is answered or dropped, none crashes the service. The seeds are fixed, so that failures can be
// reproduced.
import assert from "node:assert/strict";
import { connect } from "node:net";
import { after, before, test } from "node:test";
import { QUICK, Service } from "./service.mjs";

const service = new Service({ workers: 0, http: { header_timeout_s: 1, body_timeout_s: 1, drain_bytes: 4096 } });
before(() => service.start());
after(() => service.end_well());

/** Marsaglia's xorshift, 32 bits. */
class Random {
  constructor(seed) {
    this.state = seed;
  }
  below(end) {
    let x = this.state;
    x ^= x << 13;
    x ^= x >>> 17;
    x ^= x << 5;
    this.state = x >>> 0;
    return this.state % end;
  }
  of(list) {
    return list[this.below(list.length)];
  }
}

const SCENES = [
  QUICK.scene,
  { type: "quads", count: 3 },
  { type: "particles", count: 9 },
  { type: "volume" },
  { type: "foliage" },
];
const VALUES = [
  null,
  true,
  0,
  -1,
  0.5,
  1e308,
  2 ** 53,
  "",
  "b2f",
  "x".repeat(300),
  "\u{1f32f}/~",
  [],
  [1, 2, 3],
  {},
  { a: { b: [] } },
  { glsl: "return vec4(1); {" },
  { id: "f2bd", threshold: [] },
];

function change(random, document) {
  for (let i = 1 + random.below(3); i > 0; --i) {
    const places = [];
    const collect = (value) => {
      if (value === null || typeof value !== "object") return;
      for (const key of Object.keys(value)) {
        places.push([value, key]);
        collect(value[key]);
      }
    };
    collect(document);
    const [holder, key] = random.of(places);
    if (random.below(4) > 0) holder[key] = structuredClone(random.of(VALUES));
    else if (Array.isArray(holder)) holder.splice(Number(key), 1);
    else delete holder[key];
    if (document.scene === undefined && document.methods === undefined) break;
  }
  return document;
}

test("changed specs are accepted or refused", async () => {
  const random = new Random(20240501);
  const statuses = new Set();
  for (let i = 0; i < 400; ++i) {
    const spec = {
      ...structuredClone(QUICK),
      tags: { a: "b" },
      reference: "exact",
      sweep: [{ pointer: "/image/width", values: [8, 9] }],
      checks: [{ metric: "rmse", method: "b2f", max: 1 }],
      scene: structuredClone(random.of(SCENES)),
    };
    let body = JSON.stringify(change(random, spec));
    if (i % 8 === 0) body = body.slice(0, random.below(body.length)) + random.of(["", "\0", "{", "\u00ff"]);
    const answer = await service.raw("POST", "/api/v1/specs/validate", { "Content-Type": "application/json" }, body);
    assert.ok(answer.status === 200 || answer.status === 400 || answer.status === 422, `${answer.status}: ${body}`);
    statuses.add(answer.status);
  }
  assert.deepEqual([...statuses].sort(), [200, 400, 422]);
});

const BASES = [
  "GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n",
  'GET /api/v1/reports?limit=3&q=a%20b&tag=x:y HTTP/1.1\r\nHost: localhost\r\nIf-None-Match: "a", W/"b"\r\nConnection: close\r\n\r\n',
  "HEAD / HTTP/1.1\r\nHost: localhost\r\nAccept: */*\r\nConnection: close\r\n\r\n",
  "DELETE /api/v1/reports/01900000-0000-7000-8000-000000000000 HTTP/1.1\r\nHost: localhost\r\nIf-Match: *\r\nConnection: close\r\n\r\n",
  "GET /api/v1/reports/x/pixel?x=1&y=2 HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n",
  "OPTIONS * HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n",
  "GET http://localhost/api/v1/methods HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n",
  "POST /api/v1/specs/validate HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 2\r\nConnection: close\r\n\r\n{}",
  "POST /api/v1/specs/validate HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\nConnection: close\r\n\r\n2;a=b\r\n{}\r\n0\r\nX: y\r\n\r\n",
  "POST /api/v1/reports HTTP/1.1\r\nHost: localhost\r\nPrefer: wait=0\r\nIdempotency-Key: k\r\nExpect: 100-continue\r\nContent-Length: 3\r\nConnection: close\r\n\r\n[1]",
  "POST /api/v1/assets?name=a HTTP/1.1\r\nHost: localhost\r\nContent-Type: image/x-nothing\r\nContent-Length: 4\r\nConnection: close\r\n\r\nabcd",
];
const PIECES = [
  "\r\n",
  "\n",
  "\r",
  "\0",
  ":",
  " ",
  "\t",
  "HTTP/1.1",
  "HTTP/9.9",
  "Host: a\r\n",
  "Content-Length: 7\r\n",
  "Content-Length: -1\r\n",
  "Transfer-Encoding: chunked\r\n",
  "Transfer-Encoding: gzip\r\n",
  "Expect: x\r\n",
  "Upgrade: h2c\r\n",
  "Range: bytes=0-0\r\n",
  "Connection: keep-alive\r\n",
  "%00",
  "%",
  "/../",
  "?",
  "#",
  "a".repeat(3000),
  "\xff\xfe",
  "0\r\n\r\n",
  "ffffffffffffffff\r\n",
];

function scratch(random, bytes) {
  let text = bytes;
  for (let i = 1 + random.below(3); i > 0; --i) {
    const at = random.below(text.length + 1);
    const kind = random.below(5);
    if (kind === 0) text = text.slice(0, at) + String.fromCharCode(random.below(256)) + text.slice(at + 1);
    if (kind === 1) text = text.slice(0, at) + random.of(PIECES) + text.slice(at);
    if (kind === 2) text = text.slice(0, at) + text.slice(at + 1 + random.below(12));
    if (kind === 3) text = text.slice(0, at) + text.slice(at, at + random.below(60)) + text.slice(at);
    if (kind === 4) text += random.of(BASES);
  }
  return Buffer.from(text, "latin1");
}

/** The answer until the service ends the connection, of which we close our half. */
function exchange(bytes) {
  return new Promise((resolve) => {
    const socket = connect(new URL(service.origin).port, "127.0.0.1", () => socket.end(bytes));
    let text = "";
    socket.setTimeout(20_000, () => {
      text += "\nHTTP/1.1 999 it hangs";
      socket.destroy();
    });
    socket.on("data", (chunk) => {
      text += chunk.toString("latin1");
    });
    socket.on("close", () => resolve(text));
    socket.on("error", () => {});
  });
}

test("changed raw requests are answered or dropped", async () => {
  const random = new Random(7);
  const statuses = new Map();
  for (let i = 0; i < 1000; i += 8) {
    const batch = Array.from({ length: 8 }, () => scratch(random, random.of(BASES)));
    const answers = await Promise.all(batch.map(exchange));
    for (let j = 0; j < batch.length; ++j) {
      for (const [, code] of answers[j].matchAll(/(?:^|\n)HTTP\/1\.1 (\d+) /g)) {
        const status = Number(code);
        assert.ok(
          status < 500 || ([501, 503, 505].includes(status) && !(status === 503 && !/readyz/.test(batch[j]))),
          `${status} for ${JSON.stringify(batch[j].toString("latin1"))}`,
        );
        statuses.set(status, (statuses.get(status) ?? 0) + 1);
      }
    }
    assert.equal(service.process.exitCode, null, service.log);
  }
  // Otherwise the test would not try requests.
  for (const status of [200, 400, 404]) assert.ok(statuses.get(status) > 20, `${status}: ${statuses.get(status)}`);
  assert.equal((await fetch(`${service.origin}/healthz`)).status, 200);
  for (const { id } of await service.reports()) await fetch(`${service.api}/reports/${id}`, { method: "DELETE" });
});
