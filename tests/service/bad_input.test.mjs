// Input that the service refuses: it says what is wrong and stores nothing.
import assert from "node:assert/strict";
import { connect } from "node:net";
import { after, before, test } from "node:test";
import { assert_problem, QUICK, Service, sleep, talk } from "./service.mjs";

const service = new Service({
  workers: 0,
  allowed_hosts: ["sheer.test"],
  http: { header_timeout_s: 0.5, body_timeout_s: 0.5 },
});
before(() => service.start());
after(() => service.end_well());

function validate(spec) {
  return fetch(`${service.api}/specs/validate`, {
    method: "POST",
    body: JSON.stringify(spec),
    headers: { "Content-Type": "application/json" },
  });
}

async function assert_nothing_stored() {
  assert.deepEqual(await service.reports(), []);
}

const QUADS = { type: "quads", count: 16 };
const bad_specs = [
  ["an unknown field", { ...QUICK, colour: "red" }, "/colour"],
  ["an unknown field within", { ...QUICK, image: { width: 16, heigth: 16 } }, "/image/heigth"],
  ["a wrong type", { ...QUICK, image: { width: "wide" } }, "/image/width"],
  ["no quads", { ...QUICK, scene: { ...QUADS, count: 0 } }, "/scene/count"],
  ["too many quads", { ...QUICK, scene: { ...QUADS, count: 1e9 } }, "/scene/count"],
  ["no width", { ...QUICK, image: { width: 0 } }, "/image/width"],
  ["too high", { ...QUICK, image: { height: 100000 } }, "/image/height"],
  ["an unknown method", { ...QUICK, methods: ["b2f", "magic"] }, "/methods/1"],
  ["no methods", { ...QUICK, methods: [] }, "/methods"],
  ["an unknown scene", { ...QUICK, scene: { type: "dream" } }, "/scene/type"],
  ["no scene", { methods: ["b2f"] }, "/scene"],
  ["no object", [], ""],
  ["null", null, ""],
  ["a number for an image", { ...QUICK, image: 1 }, "/image"],
  ["a number for the timing", { ...QUICK, timing: 1 }, "/timing"],
  ["a list for a scene", { ...QUICK, scene: [] }, "/scene"],
  ["numbers for layers", { ...QUICK, scene: { type: "layers", layers: [1, "x"] } }, "/scene/layers/1"],
  ["a text for checks", { ...QUICK, checks: "x" }, "/checks"],
];

for (const [name, spec, pointer] of bad_specs) {
  test(`422 for ${name}`, async () => {
    const problem = await assert_problem(await service.post(spec), 422);
    const named = problem.errors.map((error) => error.pointer);
    assert.ok(named.includes(pointer) || named.some((each) => pointer && each.startsWith(`${pointer}/`)), named.join());
    assert.ok(problem.errors.every((error) => error.detail));
    assert.deepEqual((await assert_problem(await validate(spec), 422)).errors, problem.errors);
    await assert_nothing_stored();
  });
}

test("422 for a key that occurs twice", async () => {
  const twice = JSON.stringify(QUICK).replace('"width":16', '"width":16,"width":17');
  const problem = await assert_problem(await service.post(twice), 422);
  assert.deepEqual(
    problem.errors.map((error) => error.pointer),
    ["/image/width"],
  );
  await assert_nothing_stored();
});

test("a hundred errors are listed and all are counted", async () => {
  const spec = {
    ...QUICK,
    scene: { type: "layers", layers: Array.from({ length: 4096 }, () => ({ depth: "x", alpha: 2 })) },
  };
  const response = await service.post(spec);
  const problem = await assert_problem(response, 422);
  assert.equal(problem.errors.length, 100);
  assert.equal(problem.error_count, 8192);
});

test("every wrong field is named at once", async () => {
  const spec = { ...QUICK, spam: 1, methods: ["magic"], image: { width: -1, height: "x" } };
  const problem = await assert_problem(await service.post(spec), 422);
  const pointers = new Set(problem.errors.map((error) => error.pointer));
  for (const pointer of ["/spam", "/image/width", "/image/height"]) assert.ok(pointers.has(pointer), pointer);
  assert.ok([...pointers].some((pointer) => pointer.startsWith("/methods/0")));
});

test("validation fills in the defaults", async () => {
  const response = await validate(QUICK);
  assert.equal(response.status, 200);
  const spec = await response.json();
  assert.deepEqual([spec.image.format, spec.reference.id ?? spec.reference], ["rgba8", "exact"]);
  assert.deepEqual(await (await validate(spec)).json(), spec);
  await assert_nothing_stored();
});

for (const [name, body] of [
  ["no JSON", "{"],
  ["nothing", ""],
  ["broken UTF-8", Buffer.from([0x22, 0xff, 0x22])],
  ["something after its end", `${JSON.stringify(QUICK)}\0{`],
  ["deep nesting", "[".repeat(500_000)],
  ["a huge number", '{"a": 1e999}'],
]) {
  test(`400 for ${name}`, async () => {
    const response = await fetch(`${service.api}/reports`, {
      method: "POST",
      body,
      headers: { "Content-Type": "application/json" },
    });
    await assert_problem(response, 400);
    await assert_nothing_stored();
  });
}

test("413 for 10 MB, which the sender can read", async () => {
  for (let i = 0; i < 5; ++i) await assert_problem(await service.post(" ".repeat(10_000_000)), 413);
  const chunked = await service.raw(
    "POST",
    "/api/v1/reports",
    { "Transfer-Encoding": "chunked" },
    "x".repeat(2_000_000),
  );
  await assert_problem(chunked, 413);
  const just_over = await service.post(" ".repeat((1 << 20) + 1));
  await assert_problem(just_over, 413);
  await assert_problem(await service.post(" ".repeat(1 << 20)), 400);
  await assert_nothing_stored();
});

test("415 for another type", async () => {
  await assert_problem(await service.post(QUICK, { "Content-Type": "text/plain" }), 415);
  await assert_nothing_stored();
});

test("404 and 405", async () => {
  for (const path of [
    "/api/v1/nothing",
    "/nothing.html",
    "/api/v1/reports/x",
    "/api/v1/blobs/x",
    "/..%2f..%2fetc/passwd",
  ])
    await assert_problem(await fetch(service.origin + path), 404);
  const put = await fetch(`${service.api}/reports`, { method: "PUT" });
  assert.match(put.headers.get("allow"), /POST.*GET/);
  await assert_problem(put, 405);
  const options = await fetch(`${service.api}/reports`, { method: "OPTIONS" });
  assert.equal(options.status, 204);
  assert.match(options.headers.get("allow"), /POST/);
});

test("pages from other sites are refused", async () => {
  const json = { "Content-Type": "application/json" };
  const post = (headers) => service.raw("POST", "/api/v1/reports", { ...json, ...headers }, JSON.stringify(QUICK));
  await assert_problem(await post({ Origin: "http://evil.example" }), 403);
  await assert_problem(await post({ Origin: "null" }), 403);
  await assert_problem(await post({ "Sec-Fetch-Site": "cross-site" }), 403);
  const rebound = `evil.example:${new URL(service.origin).port}`;
  await assert_problem(await post({ Host: rebound, Origin: `http://${rebound}` }), 421);
  await assert_problem(await service.raw("GET", "/api/v1/reports", { Host: rebound }), 421);
  await assert_problem(await service.raw("DELETE", "/api/v1/reports/x", { Origin: "http://evil.example" }), 403);
  assert.equal((await service.raw("GET", "/healthz", { Host: rebound })).status, 200);
  assert.equal((await service.raw("GET", "/readyz", { Host: "10.42.0.7" })).status, 503);
  assert.equal((await service.raw("GET", "/api/v1/methods", { Host: "localhost" })).status, 200);
  assert.equal((await service.raw("GET", "/api/v1/methods", { Host: "sheer.test" })).status, 200);
  await assert_nothing_stored();
});

test("a request that is not HTTP gets 400, one that is too long 431, one that is too slow nothing", async () => {
  assert.match(await talk(service, "nonsense\r\n\r\n"), /^HTTP\/1.1 400 /);
  assert.equal(await talk(service, "GET / HTTP/1.1\r\nHost: localhost\r\n"), "");
  assert.equal(
    await talk(service, "POST /api/v1/reports HTTP/1.1\r\nHost: localhost\r\nContent-Length: 10\r\n\r\n{"),
    "",
  );
  assert.match(
    await talk(service, `GET / HTTP/1.1\r\nHost: localhost\r\nX: ${"x".repeat(20_000)}\r\n\r\n`),
    /^HTTP\/1.1 431 /,
  );
  const smuggled =
    "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 4\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n";
  assert.match(await talk(service, smuggled), /^HTTP\/1.1 400 /);
  assert.equal((await fetch(`${service.origin}/healthz`)).status, 200);
});

test("a transfer encoding other than chunked ends the connection, and nothing after it is a request", async () => {
  const post = (encoding) =>
    `POST /api/v1/specs/validate HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: ${encoding}\r\n\r\n`;
  const next = "GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n";
  for (const [encoding, status] of [
    ["xchunked", 501],
    ["gzip, chunked", 501],
    ["chunked, chunked", 400],
    ["", 400],
  ]) {
    const socket_text = await talk(service, post(encoding) + next);
    assert.deepEqual(socket_text.match(/HTTP\/1.1 \d+/g), [`HTTP/1.1 ${status}`], encoding);
  }
});

test("a target in absolute form is reduced to its path, and a request must have a host", async () => {
  const end = "Connection: close\r\n\r\n";
  assert.match(
    await talk(service, `GET http://localhost/healthz HTTP/1.1\r\nHost: localhost\r\n${end}`),
    /^HTTP\/1.1 200 /,
  );
  assert.match(
    await talk(service, `GET http://sheer.test/api/v1/methods HTTP/1.1\r\nHost: x\r\n${end}`),
    /^HTTP\/1.1 200 /,
  );
  assert.match(
    await talk(service, `GET http://evil.example/api/v1/methods HTTP/1.1\r\nHost: localhost\r\n${end}`),
    /^HTTP\/1.1 421 /,
  );
  assert.match(await talk(service, `GET /healthz HTTP/1.1\r\n${end}`), /^HTTP\/1.1 400 /);
  assert.match(await talk(service, "GET /healthz HTTP/1.0\r\n\r\n"), /^HTTP\/1.1 200 /);
  assert.match(await talk(service, `GET /healthz HTTP/2.0\r\nHost: localhost\r\n${end}`), /^HTTP\/1.1 (400|505) /);
});

test("a malformed request after a HEAD gets the reason", async () => {
  const text = await talk(service, "HEAD /healthz HTTP/1.1\r\nHost: localhost\r\n\r\nnonsense\r\n\r\n");
  const [first, second] = text.split("\r\n\r\nHTTP/1.1 400 ");
  assert.match(first, /^HTTP\/1.1 200 /);
  assert.match(second, /"status":400/);
});

test("a deletion with an unsatisfied condition cancels nothing", async () => {
  const id = await service.submit(QUICK),
    path = `/api/v1/reports/${id}`;
  await assert_problem(await service.raw("DELETE", path, { "If-None-Match": "*" }), 412);
  await assert_problem(await service.raw("DELETE", path, { "If-Match": '"x"' }), 412);
  assert.equal((await service.report(id)).status, "queued");
  const { headers } = await service.raw("GET", path);
  assert.equal((await service.raw("DELETE", path, { "If-Match": headers.etag })).status, 200);
  assert.equal((await service.raw("DELETE", path)).status, 204);
  await assert_problem(await service.raw("DELETE", "/api/v1/assets/a"), 404);
});

test("pipelined requests are answered in order", async () => {
  const get = (path) => `GET ${path} HTTP/1.1\r\nHost: localhost\r\n`;
  const text = await talk(
    service,
    `${get("/healthz")}\r\n${get("/nothing")}\r\n${get("/healthz")}Connection: close\r\n\r\n`,
  );
  assert.deepEqual(text.match(/HTTP\/1.1 \d+/g), ["HTTP/1.1 200", "HTTP/1.1 404", "HTTP/1.1 200"]);
});

test("a client that disconnects in the middle of an answer causes no harm", async () => {
  const id = await service.submit(QUICK);
  for (const path of ["/api/v1/openapi.json", `/api/v1/reports/${id}/events`]) {
    for (let i = 0; i < 20; ++i) {
      const socket = connect(new URL(service.origin).port, "127.0.0.1");
      socket.write(`GET ${path} HTTP/1.1\r\nHost: localhost\r\n\r\n`);
      await sleep(5);
      socket.resetAndDestroy();
    }
  }
  assert.equal((await fetch(`${service.origin}/healthz`)).status, 200);
  for (let i = 0; i < 2; ++i) await fetch(`${service.api}/reports/${id}`, { method: "DELETE" });
});
