// What the service refuses: it says what is wrong and stores nothing.
import assert from "node:assert/strict";
import { connect } from "node:net";
import { after, before, test } from "node:test";
import { assert_problem, QUICK, Service, sleep } from "./service.mjs";

const service = new Service({ workers: 0, allowed_hosts: ["sheer.test"], http: { header_timeout_s: 0.5, body_timeout_s: 0.5 } });
before(() => service.start());
after(() => service.end_well());

function validate(spec) {
  return fetch(`${service.api}/specs/validate`, { method: "POST", body: JSON.stringify(spec),
                                                  headers: { "Content-Type": "application/json" } });
}

async function assert_nothing_stored() { assert.deepEqual(await service.reports(), []); }

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

for (const [name, body] of [["no JSON", "{"], ["nothing", ""], ["broken UTF-8", Buffer.from([0x22, 0xff, 0x22])],
                            ["a deep nest", "[".repeat(500_000)], ["a huge number", '{"a": 1e999}']]) {
  test(`400 for ${name}`, async () => {
    const response = await fetch(`${service.api}/reports`, { method: "POST", body, headers: { "Content-Type": "application/json" } });
    await assert_problem(response, 400);
    await assert_nothing_stored();
  });
}

test("413 for 10 MB, which the sender gets to read", async () => {
  for (let i = 0; i < 5; ++i) await assert_problem(await service.post(" ".repeat(10_000_000)), 413);
  const chunked = await service.raw("POST", "/api/v1/reports", { "Transfer-Encoding": "chunked" }, "x".repeat(2_000_000));
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
  for (const path of ["/api/v1/nothing", "/nothing.html", "/api/v1/reports/x", "/api/v1/blobs/x", "/..%2f..%2fetc/passwd"])
    await assert_problem(await fetch(service.origin + path), 404);
  const put = await fetch(`${service.api}/reports`, { method: "PUT" });
  assert.match(put.headers.get("allow"), /POST.*GET/);
  await assert_problem(put, 405);
  const options = await fetch(`${service.api}/reports`, { method: "OPTIONS" });
  assert.equal(options.status, 204);
  assert.match(options.headers.get("allow"), /POST/);
});

test("pages of other sites are refused", async () => {
  const json = { "Content-Type": "application/json" };
  const post = (headers) => service.raw("POST", "/api/v1/reports", { ...json, ...headers }, JSON.stringify(QUICK));
  await assert_problem(await post({ Origin: "http://evil.example" }), 403);
  await assert_problem(await post({ Origin: "null" }), 403);
  await assert_problem(await post({ "Sec-Fetch-Site": "cross-site" }), 403);
  const rebound = `evil.example:${new URL(service.origin).port}`;
  await assert_problem(await post({ Host: rebound, Origin: `http://${rebound}` }), 421);
  await assert_problem(await service.raw("GET", "/api/v1/reports", { Host: rebound }), 421);
  await assert_problem(await service.raw("DELETE", "/api/v1/reports/x", { Origin: "http://evil.example" }), 403);
  assert.equal((await service.raw("GET", "/healthz", { Host: "localhost" })).status, 200);
  assert.equal((await service.raw("GET", "/healthz", { Host: "sheer.test" })).status, 200);
  await assert_nothing_stored();
});

/** Sends bytes as they are and reads until the service ends the connection. */
function talk(bytes) {
  return new Promise((resolve, reject) => {
    const socket = connect(new URL(service.origin).port, "127.0.0.1", () => socket.write(bytes));
    let text = "";
    socket.on("data", (chunk) => { text += chunk; });
    socket.on("close", () => resolve(text));
    socket.on("error", reject);
  });
}

test("what is not HTTP gets 400, what is too long 431, what is too slow nothing", async () => {
  assert.match(await talk("nonsense\r\n\r\n"), /^HTTP\/1.1 400 /);
  assert.equal(await talk("GET / HTTP/1.1\r\nHost: localhost\r\n"), "");
  assert.equal(await talk("POST /api/v1/reports HTTP/1.1\r\nHost: localhost\r\nContent-Length: 10\r\n\r\n{"), "");
  assert.match(await talk(`GET / HTTP/1.1\r\nHost: localhost\r\nX: ${"x".repeat(20_000)}\r\n\r\n`), /^HTTP\/1.1 431 /);
  const smuggled = "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 4\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n";
  assert.match(await talk(smuggled), /^HTTP\/1.1 400 /);
  assert.equal((await fetch(`${service.origin}/healthz`)).status, 200);
});

test("requests sent ahead are answered in order", async () => {
  const get = (path) => `GET ${path} HTTP/1.1\r\nHost: localhost\r\n`;
  const text = await talk(`${get("/healthz")}\r\n${get("/nothing")}\r\n${get("/healthz")}Connection: close\r\n\r\n`);
  assert.deepEqual(text.match(/HTTP\/1.1 \d+/g), ["HTTP/1.1 200", "HTTP/1.1 404", "HTTP/1.1 200"]);
});

test("a reader that goes away in the middle harms nobody", async () => {
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
