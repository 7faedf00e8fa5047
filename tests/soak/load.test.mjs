// 64 clients ask for one report without a pause while a job is rendered: no error, and the memory does not grow.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { connect } from "node:net";
import { test } from "node:test";
import { lasting, QUICK, Service } from "../service/service.mjs";
import { SIZE } from "./random.mjs";

const CLIENTS = 64,
  SECONDS = 6 * SIZE;

/** Sends the request again as soon as it is answered; counts answers by their first line. */
function ask_always(port, request, answer_bytes, counts, state) {
  return new Promise((resolve, reject) => {
    const socket = connect(port, "127.0.0.1", () => socket.write(request));
    let pending = 0;
    socket.on("data", (chunk) => {
      if (pending === 0) {
        const line = chunk.toString("latin1", 0, 15);
        counts.set(line, (counts.get(line) ?? 0) + 1);
      }
      pending += chunk.length;
      if (pending < answer_bytes) return;
      pending -= answer_bytes;
      if (pending !== 0) reject(new Error("an answer of another length"));
      if (state.is_over) socket.end();
      else socket.write(request);
    });
    socket.on("error", reject);
    socket.on("close", () => (state.is_over ? resolve() : reject(new Error("a connection was closed"))));
  });
}

/** The bytes of one whole answer. */
function length_of_answer(port, request) {
  return new Promise((resolve) => {
    const socket = connect(port, "127.0.0.1", () => socket.write(request));
    let text = "";
    socket.on("data", (chunk) => {
      text += chunk.toString("latin1");
      const head_length = text.indexOf("\r\n\r\n") + 4,
        [, body_length] = /Content-Length: (\d+)\r\n/i.exec(text) ?? [];
      if (head_length > 4 && text.length === head_length + Number(body_length)) {
        socket.destroy();
        resolve(text.length);
      }
    });
  });
}

test(`${CLIENTS} clients for ${SECONDS} s while a job is rendered`, async () => {
  const service = new Service();
  service.holds_to_contract = false;
  const memory_mib = () =>
    Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${service.process.pid}/status`, "utf8"))[1]) / 1024;
  try {
    await service.start();
    const { id } = await service.settled(await service.submit(QUICK));
    const job = await service.submit(lasting(SECONDS));
    const port = new URL(service.origin).port;
    const request = `GET /api/v1/reports/${id} HTTP/1.1\r\nHost: localhost\r\nX-Request-Id: load\r\n\r\n`;
    const bytes = await length_of_answer(port, request);
    const state = { is_over: false },
      counts = new Map(),
      memories = [memory_mib()];
    const clients = Array.from({ length: CLIENTS }, () => ask_always(port, request, bytes, counts, state));
    const every = setInterval(() => memories.push(memory_mib()), 500);
    setTimeout(() => {
      state.is_over = true;
    }, SECONDS * 1000);
    await Promise.all(clients).finally(() => clearInterval(every));
    const asked = counts.get("HTTP/1.1 200 OK") ?? 0;
    assert.deepEqual([...counts.keys()], ["HTTP/1.1 200 OK"]);
    assert.ok(asked > 100 * SECONDS, String(asked));
    const middle = memories[memories.length >> 1],
      last = memories.at(-1);
    console.log(
      `${Math.round(asked / SECONDS)} answers of ${bytes} bytes a second; memory ${memories[0].toFixed(0)}, ` +
        `${middle.toFixed(0)}, ${last.toFixed(0)} MiB at the beginning, in the middle and at the end`,
    );
    assert.ok(last < middle + 16, memories.join(" "));
    assert.equal((await service.settled(job)).status, "done", service.log);
    await service.end_well();
  } finally {
    await service.end();
  }
});
