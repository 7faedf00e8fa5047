// A PostgreSQL store whose connections are lost: everything goes on by itself.
import assert from "node:assert/strict";
import { test } from "node:test";
import { lasting, needs_postgres, QUICK, until, with_service } from "./service.mjs";

test("a report is done although the connections are lost again and again", needs_postgres, () =>
  with_service({}, async (service) => {
    const id = await service.submit(lasting(3));
    await until(async () => (await service.report(id)).progress > 0, "there is progress");
    const [worker] = service.workers();
    for (let i = 0; i < 5; ++i) {
      service.end_connections();
      await until(async () => (await fetch(`${service.api}/reports/${id}`)).status === 200, "it answers");
    }
    assert.equal((await service.settled(id)).status, "done", service.log);
    service.end_connections();
    const next = await (await service.post(QUICK, { Prefer: "wait=60" })).json();
    assert.equal(next.status, "done", service.log);
    assert.deepEqual(service.workers(), [worker], "the same worker");
  }),
);
