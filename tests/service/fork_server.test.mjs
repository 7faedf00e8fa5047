// Children of the service are forked from a process that has loaded its libraries.
import assert from "node:assert/strict";
import { readFileSync, readlinkSync } from "node:fs";
import { test } from "node:test";
import { children_of, command_line, is_alive, lasting, Service, until } from "./service.mjs";

const status_of = (pid) => {
  const lines = readFileSync(`/proc/${pid}/status`, "utf8").split("\n");
  return Object.fromEntries(lines.map((line) => line.split(/:\s*/)));
};
const fork_servers = (worker) => children_of(worker).filter((pid) => /^fork-server/.test(command_line(pid)[1]));

test("a renderer is forked, confined and limited, and a dead fork server is replaced", async () => {
  const service = new Service({ worker: { memory_limit_bytes: 3221225472 } });
  try {
    await service.start();
    const rendering = async () => {
      const id = await service.submit(lasting(1));
      await service.reached(id, "running");
      await until(() => service.renderers().length === 1, "it renders");
      return { id, renderer: service.renderers()[0] };
    };
    const first = await rendering();
    const [worker] = service.workers(),
      [server] = fork_servers(worker);
    assert.ok(server, "there is no fork server");
    assert.equal(status_of(first.renderer).PPid, String(worker));
    // The same mapping of libraries, not a program that was started.
    const place = (pid) => /^(\S+) r-xp .*libOpenImageIO/m.exec(readFileSync(`/proc/${pid}/maps`, "utf8"))[1];
    assert.equal(place(first.renderer), place(server));
    assert.match(readFileSync(`/proc/${first.renderer}/limits`, "utf8"), /^Max address space +3221225472 /m);
    await until(() => status_of(first.renderer).Seccomp === "2", "calls are confined");
    assert.equal(status_of(first.renderer).NoNewPrivs, "1");
    assert.notEqual(readlinkSync(`/proc/${first.renderer}/ns/pid`), readlinkSync(`/proc/${server}/ns/pid`));

    process.kill(server, "SIGKILL");
    assert.equal((await service.settled(first.id)).status, "done", service.log);
    const second = await rendering();
    const [other] = fork_servers(worker);
    assert.notEqual(other, server);

    // Nothing is left when the service is killed.
    process.kill(service.process.pid, "SIGKILL");
    await until(() => [second.renderer, other, worker].every((pid) => !is_alive(pid)), "all its processes end");
  } finally {
    await service.end();
  }
});
