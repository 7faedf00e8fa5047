// A client in TypeScript: its types are made from the service's document, and it reads a report without a cast.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import openapi_types, { astToString } from "openapi-typescript";
import { with_service } from "./service.mjs";

const compiler = join(dirname(fileURLToPath(import.meta.url)), "..", "node_modules", "typescript", "bin", "tsc");

const CLIENT = `
import type { paths } from "./service";
type Answer = paths["/api/v1/reports/{id}"]["get"]["responses"][200]["content"]["application/json"];
export async function median(url: string): Promise<number | undefined> {
  const report: Answer = await (await fetch(url)).json();
  if (report.status !== "done") throw new Error(report.stage);
  const time: number | undefined = report.runs[0]?.results[0]?.timing?.median;
  return time;
}
`;

function compile(folder, client) {
  writeFileSync(join(folder, "client.ts"), client);
  const options = ["--noEmit", "--strict", "--noUncheckedIndexedAccess", "--target", "es2022", "--module", "es2022"];
  const words = [compiler, ...options, "--moduleResolution", "bundler", "client.ts"];
  return spawnSync(process.execPath, words, { cwd: folder, encoding: "utf8" });
}

test("types made from the document fit a report", async () => {
  const folder = mkdtempSync(join(tmpdir(), "sheer-client-"));
  try {
    await with_service({ workers: 0 }, async ({ api }) => {
      const document = await (await fetch(`${api}/openapi.json`)).json();
      writeFileSync(join(folder, "service.d.ts"), astToString(await openapi_types(document)));
    });
    const right = compile(folder, CLIENT);
    assert.equal(right.status, 0, right.stdout);
    const wrong = compile(folder, CLIENT.replace("timing?.median", "timing?.average"));
    assert.match(wrong.stdout, /'average' does not exist/);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
});
