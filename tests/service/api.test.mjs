// The API as programs find it: its description is complete, answers come in the form that was asked for, and all of it
// works below another path.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import http from "node:http";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { gunzipSync, gzipSync } from "node:zlib";
import { contract_at, first_errors } from "./contract.mjs";
import { assert_problem, QUICK, read_events, Service } from "./service.mjs";

const programs = join(dirname(fileURLToPath(import.meta.url)), "..", "node_modules", ".bin");
const ORIGIN = "https://ci.example";
const PREFIX = "/tools/sheer";

const folder = mkdtempSync(join(tmpdir(), "sheer-api-"));
const service = new Service({ path_prefix: PREFIX, cors_origins: [ORIGIN] });
let base, report;
before(async () => {
  await service.start();
  base = service.origin + PREFIX;
  report = await service.settled(await service.submit(QUICK));
  assert.equal(report.status, "done", JSON.stringify(report.error));
});
after(async () => {
  rmSync(folder, { recursive: true, force: true });
  await service.end_well();
});

function run(program, words) {
  const env = { ...process.env, REDOCLY_TELEMETRY: "off", REDOCLY_SUPPRESS_UPDATE_NOTICE: "true", CI: "true" };
  const child = spawn(join(programs, program), words, { cwd: folder, env });
  return new Promise((resolve) => {
    let output = "";
    for (const stream of [child.stdout, child.stderr]) stream.on("data", (text) => (output += text));
    child.on("close", (status) => resolve({ status, output }));
  });
}

test("two linters find neither errors nor warnings in the document", async () => {
  writeFileSync(join(folder, "openapi.json"), JSON.stringify(contract_at(service.origin).document));
  writeFileSync(join(folder, "spectral.yaml"), 'extends: ["spectral:oas"]\n');
  const [redocly, spectral] = await Promise.all([
    run("redocly", ["lint", "--extends", "recommended", "--format", "json", "openapi.json"]),
    run("spectral", ["lint", "--ruleset", "spectral.yaml", "--fail-severity", "hint", "openapi.json"]),
  ]);
  const { totals } = JSON.parse(redocly.output.slice(redocly.output.indexOf("{")).replace(/\}[^}]*$/, "}"));
  assert.deepEqual([totals.errors, totals.warnings, totals.ignored], [0, 0, 0], redocly.output);
  assert.equal(spectral.status, 0, spectral.output);
  assert.match(spectral.output, /No results with a severity/);
});

test("every call has a group, a description and an example of each body, which fits its schema", () => {
  const contract = contract_at(service.origin);
  const { paths, tags, components, servers } = contract.document;
  assert.equal(servers[0].url, PREFIX);
  let checked = 0;
  for (const [path, operations] of Object.entries(paths))
    for (const [method, operation] of Object.entries(operations)) {
      const what = `${method} ${path}`;
      assert.ok(operation.description.length > 10, what);
      assert.ok(
        tags.some(({ name }) => name === operation.tags[0]),
        what,
      );
      for (const body of [operation.requestBody, ...Object.values(operation.responses)])
        for (const [type, { schema, examples }] of Object.entries(body?.content ?? {})) {
          if (!type.endsWith("json")) continue;
          const [name] = Object.keys(examples ?? {});
          if (!name) assert.ok(body === operation.requestBody, `${what} has no example`);
          if (!name) continue;
          const validate = contract.component(/\w+$/.exec(schema.$ref)[0]);
          if (!validate(components.examples[name].value)) assert.fail(`${what} ${name}: ${first_errors(validate)}`);
          ++checked;
        }
    }
  assert.ok(checked > 100, String(checked));
});

test("answers come in an accepted form, or not at all", async () => {
  await assert_problem(await service.raw("GET", "/api/v1/methods", { Accept: "text/csv" }), 406);
  const page = await service.raw("GET", `/api/v1/reports/${report.id}/report.html`, { Accept: "application/json" });
  await assert_problem(page, 406);
  const headers = { "Content-Type": "application/json", "Content-Encoding": "gzip" };
  const refused = await service.raw("POST", "/api/v1/reports", headers, gzipSync(JSON.stringify(QUICK)));
  await assert_problem(refused, 415);
  assert.equal(refused.headers["accept-encoding"], "identity");
});

/** The answer as bytes, without the decoding that fetch does. */
function bytes_of(path, headers, method = "GET") {
  return new Promise((resolve, reject) => {
    const request = http.request(service.origin + path, { method, headers }, (response) => {
      const chunks = [];
      response.on("data", (chunk) => chunks.push(chunk));
      response.on("end", () =>
        resolve({ status: response.statusCode, headers: response.headers, bytes: Buffer.concat(chunks) }),
      );
    });
    request.on("error", reject);
    request.end();
  });
}

test("long answers are compressed where that is accepted, pictures never", async () => {
  const path = `/api/v1/reports/${report.id}`;
  const plain = await bytes_of(path, {});
  const packed = await bytes_of(path, { "Accept-Encoding": "gzip" });
  assert.equal(packed.headers["content-encoding"], "gzip");
  assert.ok(packed.bytes.length < plain.bytes.length / 2);
  assert.deepEqual(gunzipSync(packed.bytes), plain.bytes);
  assert.notEqual(packed.headers.etag, plain.headers.etag);
  const head = await bytes_of(path, { "Accept-Encoding": "gzip" }, "HEAD");
  assert.equal(Number(head.headers["content-length"]), packed.bytes.length);
  const known = { "Accept-Encoding": "gzip", "If-None-Match": packed.headers.etag };
  assert.equal((await bytes_of(path, known)).status, 304);
  const small = await bytes_of("/healthz", { "Accept-Encoding": "gzip" });
  assert.equal(small.headers["content-encoding"], undefined);
  const blob = report.runs[0].results[0].images.color;
  const picture = await bytes_of(`/api/v1/blobs/${blob.sha256}`, { "Accept-Encoding": "gzip" });
  assert.equal(picture.headers["content-encoding"], undefined);
  // If-Match needs a strong comparison, which the ETag of the compressed form passes too.
  const other = await service.settled(await service.submit({ ...QUICK, title: "to be deleted" }));
  const { headers } = await bytes_of(`/api/v1/reports/${other.id}`, { "Accept-Encoding": "gzip" });
  const removed = await bytes_of(`/api/v1/reports/${other.id}`, { "If-Match": headers.etag }, "DELETE");
  assert.equal(removed.status, 204);
});

test("pages of a configured origin may ask and read", async () => {
  const ask = { Origin: ORIGIN, "Access-Control-Request-Method": "POST" };
  const preflight = await service.raw("OPTIONS", "/api/v1/reports", ask);
  assert.equal(preflight.status, 204);
  assert.equal(preflight.headers["access-control-allow-origin"], ORIGIN);
  const events = await bytes_of(`/api/v1/reports/${report.id}/events`, { Origin: ORIGIN });
  assert.equal(events.headers["access-control-allow-origin"], ORIGIN);
  const wrong = new Service({ cors_origins: ["https://ci.example/path"], path_prefix: "sheer/" });
  await assert.rejects(wrong.start(), /\/cors_origins\/0: must be an origin/);
  await wrong.end();
});

test("everything works below a prefix, whether a proxy takes it away or not", async () => {
  const posted = await fetch(`${base}/api/v1/reports`, {
    method: "POST",
    body: JSON.stringify({ ...QUICK, tags: { url: "/api/v1/mine" } }),
    headers: { "Content-Type": "application/json", Prefer: "wait=60" },
  });
  const location = posted.headers.get("location");
  const body = JSON.parse(await posted.text());
  assert.equal(location, `${PREFIX}/api/v1/reports/${body.id}`);
  assert.equal(body.spec.tags.url, "/api/v1/mine");
  const { url } = body.runs[0].results[0].images.color;
  assert.match(url, /^\/tools\/sheer\/api\/v1\/blobs\/[0-9a-f]{64}$/);
  assert.equal((await fetch(service.origin + url)).status, 200);
  const events = await read_events(await fetch(`${service.origin}${location}/events`));
  assert.equal(events.at(-1).event, "done");
  const { reports } = await (await fetch(`${base}/api/v1/reports?limit=1`)).json();
  assert.equal(reports[0].url, location);
  assert.match(reports[0].preview.url, /^\/tools\/sheer\/api/);
  const bare = await fetch(base, { redirect: "manual" });
  assert.deepEqual([bare.status, bare.headers.get("location")], [308, `${PREFIX}/`]);
  const page = await (await fetch(`${base}/`)).text();
  const parts = [...page.matchAll(/(?:src|href)="([\w./-]+\.(?:js|css|svg|html))"/g)];
  assert.ok(parts.length > 10);
  for (const [, part] of parts) assert.equal((await fetch(new URL(part, `${base}/`))).status, 200, part);
  // The prefix was taken away.
  assert.equal((await fetch(`${service.origin}/api/v1/reports/${body.id}`)).status, 200);
  assert.equal((await fetch(`${service.origin}/tools/sheerest/api/v1/reports`)).status, 404);
});
