// Tokens: who may do what, on the command line, over HTTP and in a browser's session.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { assert_problem, QUICK, Service, until, with_service } from "./service.mjs";

const PROGRAM = process.env.SHEER;

/** Runs `sheer token ...`; returns {code, out, err}. */
function token(data, ...words) {
  const { status, stdout, stderr } = spawnSync(PROGRAM, ["token", ...words, "--data", data], { encoding: "utf8" });
  return { code: status, out: stdout, err: stderr };
}

function created(data, name, scope, ...quotas) {
  const { code, out, err } = token(data, "create", name, "--scope", scope, ...quotas);
  assert.equal(code, 0, err);
  assert.match(out, /^sheer_[0-9a-f]{64}\n$/);
  return out.trim();
}

const bearer = (secret) => ({ Authorization: `Bearer ${secret}` });

/** Runs `body(service, secrets)` with a service that has a token for each scope. */
async function with_tokens(body) {
  await with_service({}, async (service) => {
    const secrets = Object.fromEntries(
      ["read", "submit", "admin"].map((scope) => [scope, created(service.data, `my-${scope}`, scope)]),
    );
    await body(service, secrets);
  });
}

test("a file keeps only hashes, names are unique, and what is revoked is worthless", () => {
  const data = mkdtempSync(join(tmpdir(), "sheer-tokens-"));
  try {
    const secret = created(data, "ci", "submit");
    const file = join(data, "tokens.json");
    assert.ok(!readFileSync(file, "utf8").includes(secret.slice("sheer_".length)));
    assert.equal(statSync(file).mode & 0o777, 0o600);
    const again = token(data, "create", "ci");
    assert.equal(again.code, 2);
    assert.match(again.err, /there is a token "ci" already/);
    assert.equal(token(data, "create", "two words").code, 2);
    assert.equal(token(data, "create", "x", "--scope", "all").code, 2);
    assert.match(token(data, "list").out, /^ci +submit +\d{4}-/);
    assert.deepEqual(
      JSON.parse(token(data, "list", "--json").out).tokens.map(({ name, scope }) => [name, scope]),
      [["ci", "submit"]],
    );
    assert.equal(token(data, "revoke", "ci").code, 0);
    assert.match(token(data, "revoke", "ci").err, /there is no token "ci"/);
    assert.equal(token(data, "list").out, "");
    writeFileSync(file, '{"tokens": [{"name": "x"');
    assert.match(token(data, "list").err, /tokens\.json/);
    assert.equal(token(data, "create", "y").code, 2, "a damaged file is not replaced");
  } finally {
    rmSync(data, { recursive: true, force: true });
  }
});

test("tokens of a crowd that are made at once are all kept", async () => {
  const data = mkdtempSync(join(tmpdir(), "sheer-tokens-"));
  try {
    const makers = Array.from({ length: 8 }, (_, i) =>
      spawn(PROGRAM, ["token", "create", `t${i}`, "--data", data], { stdio: "ignore" }),
    );
    await Promise.all(makers.map((maker) => new Promise((resolve) => maker.on("exit", resolve))));
    assert.equal(JSON.parse(token(data, "list", "--json").out).tokens.length, makers.length);
  } finally {
    rmSync(data, { recursive: true, force: true });
  }
});

/** What is answered without a token: probes, the page and what it needs to ask for one, the description. */
const OPEN = new Set([
  "GET /healthz",
  "GET /readyz",
  "GET /api/v1/openapi.json",
  "GET /api/v1/session",
  "POST /api/v1/session",
  "DELETE /api/v1/session",
]);
const ADMIN = new Set([
  "PUT /api/v1/baselines/{name}",
  "DELETE /api/v1/baselines/{name}",
  "PUT /api/v1/reports/{id}/pin",
  "DELETE /api/v1/reports/{id}/pin",
]);

test("every call asks for a token with its scope", () =>
  with_tokens(async (service, secrets) => {
    const { paths } = await (await fetch(`${service.api}/openapi.json`)).json();
    let calls = 0;
    for (const [path, operations] of Object.entries(paths))
      for (const method of Object.keys(operations).map((name) => name.toUpperCase())) {
        const call = `${method} ${path}`;
        if (OPEN.has(call)) continue;
        ++calls;
        const target = service.origin + path.replace(/\{\w+\}/g, "x");
        const asked = async (headers) => {
          const response = await fetch(target, { method, headers });
          await response.arrayBuffer();
          return response;
        };
        const bare = await asked({});
        assert.equal(bare.status, 401, call);
        assert.equal(bare.headers.get("WWW-Authenticate"), 'Bearer realm="sheer"', call);
        const unknown = await asked(bearer(`sheer_${"0".repeat(64)}`));
        assert.equal(unknown.status, 401, call);
        assert.match(unknown.headers.get("WWW-Authenticate"), /invalid_token/, call);
        const needed = ADMIN.has(call) ? "admin" : method === "GET" ? "read" : "submit";
        for (const [scope, rank] of [
          ["read", 1],
          ["submit", 2],
          ["admin", 3],
        ]) {
          const { status } = await asked(bearer(secrets[scope]));
          const enough = rank >= { read: 1, submit: 2, admin: 3 }[needed];
          if (enough) assert.ok(![401, 403].includes(status), `${call} with ${scope}: ${status}`);
          else assert.equal(status, 403, `${call} with ${scope}`);
        }
      }
    assert.ok(calls > 30, String(calls));
    for (const path of ["/", "/app.js", "/api.html", "/healthz", "/readyz"])
      assert.notEqual((await fetch(service.origin + path)).status, 401, path);
    assert.equal((await fetch(`${service.origin}/metrics`)).status, 401);
    assert.equal((await fetch(`${service.origin}/metrics`, { headers: bearer(secrets.read) })).status, 200);
  }));

test("a token takes effect at once, is named in the log, and ends at once", () =>
  with_service({}, async (service) => {
    assert.equal((await fetch(`${service.api}/reports`)).status, 200, "without any tokens all is open");
    const secret = created(service.data, "ci", "submit");
    await assert_problem(await service.post(QUICK), 401);
    const posted = await service.post(QUICK, { ...bearer(secret), Prefer: "wait=60" });
    assert.equal(posted.status, 200);
    assert.match(service.log, /audit: "ci" \(submit\) POST \/api\/v1\/reports/);
    const refused = await fetch(`${service.api}/baselines/main`, {
      method: "PUT",
      headers: { ...bearer(secret), "Content-Type": "application/json" },
      body: JSON.stringify({ report: (await posted.json()).id }),
    });
    assert.match((await assert_problem(refused, 403)).detail, /takes a token with the scope admin; "ci" has.*submit/);
    created(service.data, "other", "read");
    assert.equal(token(service.data, "revoke", "ci").code, 0);
    await assert_problem(await service.post(QUICK, bearer(secret)), 401);
    assert.ok(!service.log.includes(secret), "the secret is in the log");
    writeFileSync(join(service.data, "tokens.json"), "{");
    await assert_problem(await fetch(`${service.api}/reports`), 401);
    assert.match(service.log, /nobody is let in, as the tokens cannot be read/);
  }));

test("the command sends the token of a file", () =>
  with_tokens(async (service, secrets) => {
    const spec = join(service.folder, "spec.json"),
      file = join(service.folder, "token");
    writeFileSync(spec, JSON.stringify(QUICK));
    writeFileSync(file, `${secrets.submit}\n`);
    const submit = (...words) =>
      spawnSync(PROGRAM, ["submit", spec, "--server", service.origin, ...words], { encoding: "utf8" });
    assert.equal(submit("--token-file", file).status, 0);
    const without = submit();
    assert.notEqual(without.status, 0);
    assert.match(without.stderr, /asks for a token/);
  }));

test("a session keeps the token in a cookie that scripts and other sites do not get", () =>
  with_tokens(async (service, secrets) => {
    const session = async (method, body, headers = {}) =>
      fetch(`${service.api}/session`, {
        method,
        headers: { ...(body && { "Content-Type": "application/json" }), ...headers },
        body: body && JSON.stringify(body),
      });
    assert.deepEqual(await (await session("GET")).json(), { required: true, name: null, scope: null, quotas: [] });
    await assert_problem(await session("POST", { token: "sheer_no" }), 401);
    await assert_problem(await session("POST", {}), 422);
    const begun = await session("POST", { token: secrets.submit });
    assert.equal(begun.status, 204);
    const cookie = begun.headers.get("Set-Cookie");
    assert.match(cookie, /^sheer_token=sheer_[0-9a-f]{64}; Path=\/; HttpOnly; SameSite=Strict$/);
    const sent = { Cookie: `other=1; ${cookie.split(";")[0]}; last=2` };
    assert.deepEqual(await (await session("GET", undefined, sent)).json(), {
      required: true,
      name: "my-submit",
      scope: "submit",
      quotas: [],
    });
    assert.equal((await service.post(QUICK, sent)).status, 202);
    const foreign = await service.post(QUICK, { ...sent, Origin: "https://evil.example" });
    assert.equal(foreign.status, 403, "pages of other sites may not use the cookie");
    assert.match((await session("DELETE")).headers.get("Set-Cookie"), /^sheer_token=; .*Max-Age=0$/);
  }));

test("the quotas of a token limit its jobs, seconds and uploads, and no other's", () =>
  with_service({ workers: 0 }, async (service) => {
    const secret = created(service.data, "ci", "submit", "--max-jobs", "2", "--max-upload-bytes", "1000");
    const spent = created(service.data, "spent", "submit", "--max-seconds", "0");
    const other = created(service.data, "other", "submit");
    assert.match(
      token(service.data, "list").out,
      /^ci .* at most 2 comparisons that wait or run {2}at most 1000 bytes/,
    );
    assert.equal(token(service.data, "create", "less", "--max-jobs", "-1").code, 2);

    const posted = await service.post(QUICK, { ...bearer(secret), "Idempotency-Key": "one" });
    assert.equal(posted.status, 202);
    const first = await posted.json();
    assert.equal((await service.post(QUICK, bearer(secret))).status, 202);
    const third = await service.post(QUICK, bearer(secret));
    assert.ok(Number(third.headers.get("Retry-After")) >= 1);
    assert.equal(
      (await assert_problem(third, 429)).detail,
      'The quota of "ci" is used up: 2 comparisons that wait or run.',
    );
    const again = await service.post(QUICK, { ...bearer(secret), "Idempotency-Key": "one" });
    assert.equal((await again.json()).id, first.id, "what is known is not new");
    assert.equal((await service.post(QUICK, bearer(other))).status, 202);
    const cancelled = await fetch(`${service.api}/reports/${first.id}`, { method: "DELETE", headers: bearer(secret) });
    assert.ok(cancelled.ok);
    assert.equal((await service.post(QUICK, bearer(secret))).status, 202);

    const never = await service.post(QUICK, bearer(spent));
    assert.match((await assert_problem(never, 429)).detail, /"spent" is used up: 0 seconds of rendering within a day/);

    const upload = (bytes, key) =>
      fetch(`${service.api}/assets`, {
        method: "POST",
        headers: { ...bearer(key), "Content-Type": "image/png" },
        body: Buffer.alloc(bytes, `${bytes}`),
      });
    assert.equal((await upload(600, secret)).status, 422, "no picture, but it was read");
    const large = await upload(401, secret);
    assert.ok(Number(large.headers.get("Retry-After")) > 82_000, "until the hour has left the day");
    assert.match((await assert_problem(large, 429)).detail, /1000 bytes of uploads within a day/);
    assert.equal((await upload(400, secret)).status, 422);
    assert.equal((await upload(5000, other)).status, 422);

    const { quotas } = await (await fetch(`${service.api}/session`, { headers: bearer(secret) })).json();
    assert.deepEqual(
      quotas.map(({ name, limit, used }) => [name, limit, used]),
      [
        ["jobs", 2, 2],
        ["upload_bytes", 1000, 1000],
      ],
    );
  }));

/** In a network namespace of its own, so that nothing is reachable from anywhere. */
const NO_NETWORK = [
  ["unshare", "-n"],
  ["unshare", "-rn"],
].find(([program, ...words]) => spawnSync(program, [...words, "true"]).status === 0);

test(
  "beyond loopback nothing is served without tokens or a proxy",
  { skip: !NO_NETWORK && "no namespaces" },
  async () => {
    const service = new Service();
    try {
      const words = ["serve", "--listen", "0.0.0.0:0", "--data", service.data, "--workers", "0"];
      const refused = spawnSync(NO_NETWORK[0], [...NO_NETWORK.slice(1), PROGRAM, ...words], {
        encoding: "utf8",
        timeout: 60_000,
      });
      assert.equal(refused.status, 2, refused.stderr);
      assert.match(refused.stderr, /0\.0\.0\.0:0 can be reached from other machines, and there are no tokens/);
      const listens = async (...more) => {
        const child = spawn(NO_NETWORK[0], [...NO_NETWORK.slice(1), PROGRAM, ...words, ...more]);
        let out = "",
          err = "";
        child.stdout.on("data", (text) => (out += text));
        child.stderr.on("data", (text) => (err += text));
        const ended = new Promise((resolve) => child.on("exit", resolve));
        await until(() => out.includes("Sheer listens") || child.exitCode !== null, "the service listens");
        child.kill("SIGTERM");
        assert.equal(await ended, 0, err);
      };
      await listens("--behind-proxy");
      created(service.data, "ci", "submit");
      await listens();
    } finally {
      rmSync(service.folder, { recursive: true, force: true });
    }
  },
);
