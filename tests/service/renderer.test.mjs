// What a failing renderer sends to its worker, and what goes only to the log.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { QUICK } from "./service.mjs";

/**
 * Renders `spec` into `out`, a name in a folder with a file `taken`; returns the messages, the log and the exit code.
 */
function render(spec, out) {
  const folder = mkdtempSync(join(tmpdir(), "sheer-renderer-"));
  try {
    writeFileSync(join(folder, "spec.json"), JSON.stringify(spec));
    writeFileSync(join(folder, "taken"), "");
    const run = spawnSync(process.env.SHEER, ["render", join(folder, "spec.json"), "--out", join(folder, out)], {
      encoding: "utf8",
    });
    return {
      messages: run.stdout
        .trim()
        .split("\n")
        .map((line) => JSON.parse(line)),
      log: run.stderr,
      code: run.status,
      folder,
      output: run.stdout,
    };
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

test("our own errors are reported field by field", () => {
  const { messages, code } = render({ ...QUICK, methods: ["f2x"], image: { width: 0 } }, "out");
  assert.equal(code, 2);
  assert.equal(messages.at(-1).error.kind, "spec");
  assert.deepEqual(
    messages
      .at(-1)
      .error.errors.map((error) => error.pointer)
      .sort(),
    ["/image/width", "/methods/0"],
  );
});

test("an error of the host is reported in general terms and logged in full", () => {
  const { messages, log, code, folder, output } = render(QUICK, "taken/out");
  assert.equal(code, 3);
  assert.deepEqual(messages.at(-1).error, {
    kind: "render",
    detail: "An error within the renderer; the service's log has the details.",
    errors: [],
  });
  assert.ok(!output.includes(folder), output);
  assert.ok(log.includes(join(folder, "taken")), log);
});
