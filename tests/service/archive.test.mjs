// The care of an archive by the command line, beside a running service.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import {
  existsSync,
  mkdtempSync,
  readdirSync,
  readFileSync,
  rmSync,
  statSync,
  truncateSync,
  writeFileSync,
} from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { needs_postgres, needs_sqlite, QUICK, Service, until } from "./service.mjs";

const folder = mkdtempSync(join(tmpdir(), "sheer-archive-"));
let service;
let report;

function archive(...words) {
  const { status, stdout, stderr } = spawnSync(process.env.SHEER, ["archive", ...words], {
    encoding: "utf8",
    cwd: folder,
  });
  return { status, stdout, stderr };
}

function files_below(path) {
  return readdirSync(path, { recursive: true })
    .map((name) => join(path, name))
    .filter((name) => statSync(name).isFile());
}

before(async () => {
  service = await new Service().start();
  const made = await service.post({ ...QUICK, title: "to be moved", tags: { branch: "main" } }, { Prefer: "wait=60" });
  report = await made.json();
  assert.equal(report.status, "done");
});

after(async () => {
  await service?.end();
  rmSync(folder, { recursive: true });
});

test("a service's archive is checked, copied and restored while it runs", needs_sqlite, () => {
  const checked = archive("fsck", ...service.place());
  assert.equal(checked.status, 0, checked.stdout + checked.stderr);
  assert.match(checked.stdout, /1 reports, \d+ pictures, 0 uploads, .*: everything is there/);
  assert.equal(archive("gc", ...service.place()).status, 0);
  for (const backup of ["backup", "backup.tar"]) {
    assert.equal(archive("backup", backup, ...service.place()).status, 0);
    assert.equal(archive("backup", backup, ...service.place()).status, 2, "it exists already");
    const restored = archive("restore", backup, "--data", `of-${backup}`);
    assert.equal(restored.status, 0, restored.stdout + restored.stderr);
    assert.match(archive("restore", backup, "--data", `of-${backup}`).stderr, /not empty/);
  }
  assert.ok(!existsSync(join(folder, "backup.tar.folder")));
});

test("damage is an exit code, and a repair moves what is damaged aside", needs_sqlite, () => {
  assert.equal(archive("backup", "hurt", ...service.place()).status, 0);
  const picture = files_below(join(folder, "hurt", "blobs"))[0];
  truncateSync(picture, 10);
  const found = archive("fsck", "--data", "hurt");
  assert.equal(found.status, 1);
  assert.match(found.stdout, /^damaged: picture [0-9a-f]{64}: /m);
  assert.equal(archive("backup", "of-hurt", "--data", "hurt").status, 1);
  const repaired = archive("fsck", "--repair", "--data", "hurt");
  assert.equal(repaired.status, 1, "the picture is still missing");
  assert.match(repaired.stdout, /^repaired: moved to quarantine\//m);
  assert.equal(files_below(join(folder, "hurt", "quarantine")).length, 1);
  // The same report from another archive has the picture.
  assert.equal(archive("export", report.id, ...service.place(), "--out", "whole.zip").status, 0);
  assert.match(archive("import", "whole.zip", "--data", "hurt").stdout, /restored/);
  assert.equal(archive("fsck", "--data", "hurt").status, 0);
});

test("a PostgreSQL store is checked, and what PostgreSQL does itself is refused", needs_postgres, () => {
  const checked = archive("fsck", ...service.place());
  assert.equal(checked.status, 0, checked.stdout + checked.stderr);
  assert.match(checked.stdout, /1 reports, \d+ pictures, 0 uploads, .*: everything is there/);
  assert.equal(archive("gc", ...service.place()).status, 0);
  assert.match(archive("backup", "backup", ...service.place()).stderr, /pg_dump/);
  assert.match(archive("restore", "backup", ...service.place()).stderr, /pg_restore/);
});

test("a report moves to another service", async () => {
  const zip = await fetch(`${service.api}/reports/${report.id}/report.zip`);
  writeFileSync(join(folder, "served.zip"), Buffer.from(await zip.arrayBuffer()));
  const other = await new Service({ workers: 0 }).start();
  try {
    const added = archive("import", "served.zip", ...other.place());
    assert.equal(added.status, 0, added.stderr);
    assert.match(archive("import", "served.zip", ...other.place()).stdout, /there already/);
    const moved = await (await fetch(`${other.api}/reports/${report.id}`)).json();
    assert.deepEqual(moved, report);
    const image = report.runs[0].reference.images.color;
    const bytes = async (at) => Buffer.from(await (await fetch(at.origin + image.url)).arrayBuffer());
    assert.deepEqual(await bytes(other), await bytes(service));
    assert.equal(
      (await other.reports("?q=moved&tag=branch:main&verdict=passed")).length,
      report.verdict === "passed" ? 1 : 0,
    );
    const broken = readFileSync(join(folder, "served.zip"));
    // The first picture's bytes, after the page and the texts.
    const at = broken.indexOf("\x89PNG", broken.indexOf("images/"), "latin1");
    broken[at + 40] ^= 1;
    writeFileSync(join(folder, "broken.zip"), broken);
    const refused = archive("import", "broken.zip", ...other.place());
    assert.equal(refused.status, 2);
    assert.match(refused.stderr, /CRC/);
    writeFileSync(join(folder, "text.zip"), "no zip");
    assert.equal(archive("import", "text.zip", ...other.place()).status, 2);
  } finally {
    await other.end();
  }
});

test("wrong uses are explained", () => {
  assert.match(archive("fsck", "--data", "nowhere").stderr, /no archive in nowhere/);
  assert.ok(!existsSync(join(folder, "nowhere")));
  assert.match(archive("export", "no-such-id", ...service.place()).stderr, /no-such-id/);
  assert.match(archive("prune", ...service.place()).stderr, /no rule/);
  for (const words of [
    ["fsck", "--data", "nowhere"],
    ["export", "x", ...service.place()],
    ["restore", "nowhere"],
    ["frobnicate"],
  ])
    assert.equal(archive(...words).status, 2, words.join(" "));
});

test("a pinned report is kept, and rules in the configuration remove others", async () => {
  const pin = `${service.api}/reports/${report.id}/pin`;
  const put = (body) =>
    fetch(pin, { method: "PUT", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });
  assert.equal((await fetch(pin)).status, 404);
  assert.equal((await put({ who: "me" })).status, 422);
  assert.equal((await put({ by: "me", reason: "the first one" })).status, 201);
  assert.equal((await put({ by: "me", reason: "the best one" })).status, 200);
  assert.equal((await (await fetch(pin)).json()).reason, "the best one");
  assert.equal((await service.reports())[0].pinned, true);
  assert.equal((await fetch(`${service.api}/reports/${report.id}`, { method: "DELETE" })).status, 409);
  assert.match(archive("prune", "--max-reports", "0", ...service.place()).stdout, /0 reports/);
  assert.equal((await fetch(pin, { method: "DELETE" })).status, 204);
  assert.match(archive("prune", "--max-reports", "0", "--dry-run", ...service.place()).stdout, /1 reports .* would be/);
  assert.equal((await service.reports()).length, 1);
  const pruned = await new Service({
    workers: 0,
    archive: { retention: [{ tag: "branch:main", max_reports: 0 }], retention_interval_s: 0.1 },
  }).start();
  try {
    assert.equal(archive("import", "served.zip", ...pruned.place()).status, 0);
    await until(async () => (await pruned.reports()).length === 0, "it is pruned");
  } finally {
    await pruned.end();
  }
});
