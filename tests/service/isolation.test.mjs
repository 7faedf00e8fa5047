// What the service's processes are made of, and what those may do that read files and programs from others.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync, readlinkSync } from "node:fs";
import { test } from "node:test";
import { plain_png } from "./pictures.mjs";
import { assert_problem, lasting, QUICK, until, with_service } from "./service.mjs";

const mapped = (pid) => readFileSync(`/proc/${pid}/maps`, "utf8");
const resident_kb = (pid) => Number(/^VmRSS:\s+(\d+) kB$/m.exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]);

test("the service and its workers load neither OpenGL nor a picture library, and are small", () =>
  with_service({}, async (service) => {
    const report = await (await service.post(QUICK, { Prefer: "wait=60" })).json();
    assert.equal(report.status, "done", service.log);
    assert.equal((await fetch(`${service.origin}/api/v1/reports/${report.id}/diff?against=${report.id}`)).status, 200);
    for (const pid of [service.process.pid, ...service.workers()]) {
      assert.doesNotMatch(mapped(pid), /libOpenImageIO|libEGL|libOSMesa|libglfw|libGL[.X]|libavcodec|libLLVM/);
      assert.ok(resident_kb(pid) < 40_000, `${resident_kb(pid)} KB`);
    }
  }));

const status_field = (pid, name) =>
  new RegExp(`^${name}:\\s+(\\S+)$`, "m").exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1];
const namespace_of = (pid, kind) => readlinkSync(`/proc/${pid}/ns/${kind}`);
const may_have_namespaces = spawnSync("unshare", ["--user", "--net", "true"]).status === 0;

test("a renderer is confined, in namespaces of its own", () =>
  with_service({}, async (service) => {
    await service.submit(lasting(20));
    const renderer = await until(() => service.renderers()[0], "it is rendered");
    // The filter is in place once the device is open.
    await until(() => status_field(renderer, "Seccomp") === "2", "its system calls are filtered");
    assert.equal(status_field(renderer, "NoNewPrivs"), "1");
    for (const kind of may_have_namespaces ? ["user", "pid", "net", "ipc", "mnt", "uts"] : [])
      assert.notEqual(namespace_of(renderer, kind), namespace_of(service.process.pid, kind), kind);
  }));

const OWN_GLSL = { ...QUICK, scene: { ...QUICK.scene, shading: { glsl: "return tint;" } } };

test("without a sandbox, uploads and own GLSL are refused, unless the configuration allows them", async () => {
  const upload = (service) =>
    fetch(`${service.api}/assets?name=a.png`, {
      method: "POST",
      body: plain_png(2, [255, 0, 0]),
      headers: { "Content-Type": "image/png" },
    });
  await with_service({ sandbox: { enabled: false } }, async (service) => {
    for (const response of [await upload(service), await service.post(OWN_GLSL)]) {
      const problem = await assert_problem(response, 403);
      assert.match(problem.detail, /has no sandbox: the configuration switches it off.*sandbox\.required/);
    }
    assert.match(service.log, /there is no sandbox: the configuration switches it off/);
    const report = await (await service.post(QUICK, { Prefer: "wait=60" })).json();
    assert.equal(report.status, "done", service.log);
    const ready = await (await fetch(`${service.origin}/readyz`)).json();
    assert.equal(ready.without_sandbox, "the configuration switches it off");
  });
  await with_service({ sandbox: { enabled: false, required: false } }, async (service) => {
    assert.equal((await upload(service)).status, 201);
    assert.equal((await service.post(OWN_GLSL)).status, 202);
  });
  await with_service({}, async (service) => {
    assert.equal((await upload(service)).status, 201);
    const report = await (await service.post(OWN_GLSL, { Prefer: "wait=60" })).json();
    assert.equal(report.status, "done", service.log);
    assert.equal((await (await fetch(`${service.origin}/readyz`)).json()).without_sandbox, "");
  });
});
