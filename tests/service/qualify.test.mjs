// sheer qualify: what it measures is kept, and later reports of the device quote it.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { QUICK, with_service } from "./service.mjs";

const folder = mkdtempSync(join(tmpdir(), "sheer-qualify-"));
after(() => rmSync(folder, { recursive: true, force: true }));

const sheer = (words, state, input) =>
  spawnSync(process.env.SHEER, words, {
    encoding: "utf8",
    input,
    env: { ...process.env, SHEER_STATE: "", XDG_STATE_HOME: state },
  });

const MEASURE = ["qualify", "--seconds", "1", "--size", "32"];

test("the result is kept for the user, and quoted by sheer compare", () => {
  const compare = () =>
    JSON.parse(sheer(["compare", "-", "--json", "-q"], folder, JSON.stringify(QUICK)).stdout).qualification;
  assert.equal(compare(), null);
  const measured = () => {
    const table = sheer(MEASURE, folder);
    assert.equal(table.status, 0, table.stderr);
    assert.match(table.stdout, /^ +50 % +\d\.\d+x/m);
    assert.match(table.stdout, /A change of nothing was called a change \d+ times in \d+/);
    return JSON.parse(readFileSync(join(folder, "sheer", "qualifications.json"), "utf8"));
  };
  // Half more work is a good deal slower on any device, but a second on a busy one may not show it.
  const shows_it = ([{ slowdowns }]) => slowdowns.at(-1).slowdown > slowdowns[0].slowdown;
  const tries = [measured()];
  while (!shows_it(tries.at(-1)) && tries.length < 5) tries.push(measured());
  assert.ok(shows_it(tries.at(-1)), JSON.stringify(tries));
  const [kept, ...others] = tries.at(-1);
  assert.deepEqual(others, []);
  assert.deepEqual(compare(), kept);
  assert.deepEqual(
    kept.slowdowns.map(({ more_work }) => more_work),
    [0.01, 0.02, 0.05, 0.1, 0.2, 0.5],
  );
  assert.ok(kept.comparisons >= 2 && kept.false_changes <= kept.comparisons);
});

test("one in a service's folder is quoted by the service", () =>
  with_service({}, async (service) => {
    const { status, stdout } = sheer([...MEASURE, "--json", "--data", service.data], join(folder, "other"));
    assert.equal(status, 0);
    const report = await service.settled(await service.submit(QUICK));
    assert.deepEqual(report.qualification, JSON.parse(stdout));
    assert.ok(!existsSync(join(folder, "other")));
  }));
