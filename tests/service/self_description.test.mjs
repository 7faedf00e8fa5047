// The service's self-description, and the page.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { assert_problem, QUICK, Service, until } from "./service.mjs";

const service = new Service();
before(() => service.start());
after(() => service.end_well());

const get_json = async (path) => {
  const response = await fetch(service.api + path);
  assert.equal(response.status, 200);
  assert.equal(response.headers.get("content-type"), "application/json");
  return response.json();
};

test("methods, scenes and devices", async () => {
  const methods = await get_json("/methods");
  assert.ok(
    methods.some((method) => method.id === "f2bd" && method.parameters.some((each) => each.name === "threshold")),
  );
  const scenes = await get_json("/scenes");
  assert.deepEqual(
    scenes
      .map((scene) => scene.id ?? scene.type)
      .filter((id) => ["layers", "quads"].includes(id))
      .sort(),
    ["layers", "quads"],
  );
  const devices = await get_json("/devices");
  assert.ok(devices.some((device) => device.renderer));
});

/** Uploads the files that a ready-made spec needs, and names them in it by their SHA-256. */
async function upload_files(spec, files) {
  for (const { pointer, name, url } of files) {
    const bytes = await (await fetch(`${service.origin}${url}`)).arrayBuffer();
    const answer = await fetch(`${service.api}/assets?name=${name}`, {
      method: "POST",
      body: bytes,
      headers: { "Content-Type": "model/gltf-binary" },
    });
    assert.equal(answer.status, 201, name);
    const parts = pointer.split("/").slice(1);
    const owner = parts.slice(0, -1).reduce((part, key) => part[key], spec);
    assert.equal(owner[parts.at(-1)], name);
    owner[parts.at(-1)] = (await answer.json()).sha256;
  }
}

test("ready-made specs can be posted once their files are uploaded", async () => {
  const examples = await get_json("/specs/examples");
  assert.ok(examples.some((example) => example.id === "quick"));
  assert.ok(examples.some(({ id, files }) => id === "glass" && files.length === 1));
  for (const { id, spec, files, teaches, picture } of examples) {
    assert.ok(teaches.length > 0, id);
    const { status, headers } = await fetch(`${service.origin}${picture}`);
    assert.deepEqual([status, headers.get("content-type")], [200, "image/jpeg"], id);
    await upload_files(spec, files);
    const answer = await fetch(`${service.api}/specs/validate`, {
      method: "POST",
      body: JSON.stringify(spec),
      headers: { "Content-Type": "application/json" },
    });
    assert.equal(answer.status, 200, `${id}: ${await answer.text()}`);
  }
});

test("the OpenAPI document describes the existing calls", async () => {
  const document = await get_json("/openapi.json");
  assert.equal(document.openapi, "3.1.0");
  assert.ok(document.components.schemas.Spec.properties.scene);
  for (const [path, operations] of Object.entries(document.paths)) {
    const url = service.origin + path.replace("{id}", "0").replace("{sha256}", "0").replace("{name}", "0");
    const options = await fetch(url, { method: "OPTIONS" });
    assert.equal(options.status, 204, path);
    const allowed = options.headers
      .get("allow")
      .split(", ")
      .filter((method) => !["HEAD", "OPTIONS"].includes(method));
    assert.deepEqual(
      allowed.sort(),
      Object.keys(operations)
        .map((method) => method.toUpperCase())
        .sort(),
      path,
    );
  }
});

test("the service is alive, and ready once a worker has rendered", async () => {
  assert.equal((await fetch(`${service.origin}/healthz`)).status, 200);
  await until(async () => (await fetch(`${service.origin}/readyz`)).status === 200, "the service is ready");
});

test("a service without workers is alive but not ready", async () => {
  const idle = new Service({ workers: 0 });
  try {
    await idle.start();
    assert.equal((await fetch(`${idle.origin}/healthz`)).status, 200);
    await assert_problem(await fetch(`${idle.origin}/readyz`), 503);
  } finally {
    await idle.end();
  }
});

test("the page comes with its parts and a strict policy", async () => {
  const page = await fetch(`${service.origin}/`);
  assert.equal(page.status, 200);
  assert.match(page.headers.get("content-type"), /^text\/html/);
  assert.equal(page.headers.get("x-content-type-options"), "nosniff");
  const policy = page.headers.get("content-security-policy");
  assert.match(policy, /default-src 'self'/);
  assert.doesNotMatch(policy, /unsafe/);
  const again = await fetch(`${service.origin}/`, { headers: { "If-None-Match": page.headers.get("etag") } });
  assert.equal(again.status, 304);
  const parts = [...(await page.text()).matchAll(/(?:src|href)="(\/?[\w./-]+\.(?:js|css|svg))"/g)].map(
    (match) => match[1],
  );
  assert.ok(parts.length > 0);
  const types = { js: /^text\/javascript/, css: /^text\/css/, svg: /^image\/svg\+xml/ };
  for (const part of parts) {
    const response = await fetch(new URL(part, `${service.origin}/`));
    assert.equal(response.status, 200, part);
    assert.match(response.headers.get("content-type"), types[part.split(".").pop()]);
  }
});

test("a port that is in use gives an error that says so", async () => {
  const other = new Service();
  other.listen = new URL(service.origin).host;
  await assert.rejects(other.start(), /cannot listen/);
  assert.equal((await other.ended).code, 2);
  await other.end();
});

test("a wrong configuration names its fields", async () => {
  const wrong = new Service({ wrokers: 1, http: { threads: 0 } });
  await assert.rejects(
    wrong.start(),
    (error) => /\/wrokers/.test(error.message) && /\/http\/threads/.test(error.message),
  );
  await wrong.end();
});

test("many simultaneous requests are all answered", async () => {
  const answers = await Promise.all(Array.from({ length: 100 }, () => fetch(`${service.api}/methods`)));
  assert.ok(answers.every((answer) => answer.status === 200));
  const ids = await Promise.all(Array.from({ length: 20 }, () => service.submit(QUICK)));
  assert.equal(new Set(ids).size, 20);
  for (const id of ids) await fetch(`${service.api}/reports/${id}`, { method: "DELETE" });
});

test("one connection too many gets an error, but can still ask whether the service is alive", async () => {
  const small = new Service({ http: { max_connections: 1 }, workers: 0 });
  try {
    await small.start();
    const id = await small.submit(QUICK);
    const held = await fetch(`${small.api}/reports/${id}/events`);
    assert.equal((await small.raw("GET", "/healthz", { Connection: "close" })).status, 200);
    await assert_problem(await small.raw("GET", "/api/v1/methods", { Connection: "close" }), 503);
    await held.body.cancel();
    await until(
      async () => (await small.raw("GET", "/api/v1/methods", { Connection: "close" })).status === 200,
      "there is room again",
    );
  } finally {
    await small.end();
  }
});
