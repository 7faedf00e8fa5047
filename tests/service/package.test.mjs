// What the packages and the container contain, without building them: ./dev package --try does that.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { chmodSync, existsSync, mkdtempSync, mkdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";
import { QUICK } from "./service.mjs";

const PROGRAM = process.env.SHEER;
const repository = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
const folder = mkdtempSync(join(tmpdir(), "sheer-package-"));
after(() => rmSync(folder, { recursive: true, force: true }));

const run = (program, words, options = {}) => spawnSync(program, words, { encoding: "utf8", ...options });
const read = (...path) => readFileSync(join(repository, ...path), "utf8");

/** The values of an instruction in the last stage of the Containerfile. */
function container(instruction) {
  const stage = read("Containerfile")
    .split(/^FROM /m)
    .at(-1)
    .replaceAll("\\\n", "");
  return [...stage.matchAll(new RegExp(`^${instruction} (.*)$`, "gm"))].map(([, value]) => value);
}

test("each package has its program, and sheer all that belongs to it", () => {
  const install = (component) => {
    const words = ["--install", dirname(PROGRAM), "--component", component, "--prefix", "/usr"];
    const { status, stderr } = run("cmake", words, { env: { ...process.env, DESTDIR: join(folder, component) } });
    assert.equal(status, 0, stderr);
    return (path) => join(folder, component, path);
  };
  const sheer = install("sheer");
  for (const path of [
    "usr/bin/sheer",
    "etc/sheer/server.json",
    "usr/lib/systemd/system/sheer.service",
    "usr/share/sheer/configs/specs/quick.json",
    "usr/share/doc/sheer/docs/ci.md",
  ])
    assert.ok(existsSync(sheer(path)), path);
  assert.ok(!existsSync(sheer("usr/bin/sheer-bench")));
  const bench = install("sheer-bench");
  assert.ok(existsSync(bench("usr/bin/sheer-bench")));
  assert.ok(!existsSync(bench("usr/bin/sheer")) && !existsSync(bench("etc")));
});

test("the service of systemd starts what the package has, and is kept from the rest of the system", () => {
  const unit = read("cmake", "package", "sheer.service");
  const [, line] = /^ExecStart=\/usr\/bin\/sheer (serve .*)$/m.exec(unit);
  const { stdout } = run(PROGRAM, ["serve", "--help"]);
  for (const [option] of line.matchAll(/--[\w-]+/g)) assert.ok(stdout.includes(option), option);
  for (const setting of ["DynamicUser=yes", "ProtectSystem=strict", "NoNewPrivileges=yes", "CapabilityBoundingSet="])
    assert.ok(unit.includes(`\n${setting}\n`), setting);
  if (run("systemd-analyze", ["--version"]).status !== 0) return;
  const file = join(folder, "sheer.service");
  writeFileSync(file, unit.replaceAll("/usr/bin/sheer", PROGRAM));
  const { stdout: told } = run("systemd-analyze", ["security", "--offline=yes", file]);
  const exposure = /exposure level for .*: ([\d.]+)/.exec(told);
  if (exposure) assert.ok(Number(exposure[1]) < 3, exposure[0]);
});

test("the container renders as nobody, with a root that is read-only, into /out", (t) => {
  const [user] = container("USER")[0].split(":");
  assert.ok(Number(user) > 0);
  assert.deepEqual(JSON.parse(container("ENTRYPOINT")[0]), ["/usr/bin/sheer"]);
  assert.deepEqual(container("WORKDIR"), ["/out"]);
  const out = join(folder, "out");
  mkdirSync(out);
  chmodSync(out, 0o777);
  writeFileSync(join(out, "spec.json"), JSON.stringify(QUICK));
  const variables = container("ENV")[0]
    .split(" ")
    .flatMap((one) => ["--setenv", ...one.split("=")]);
  const sandbox = [
    "--unshare-all",
    "--uid",
    user,
    "--gid",
    user,
    "--ro-bind",
    "/usr",
    "/usr",
    "--symlink",
    "usr/lib",
    "/lib",
  ];
  sandbox.push("--symlink", "usr/lib64", "/lib64", "--symlink", "usr/bin", "/bin", "--ro-bind", "/etc", "/etc");
  sandbox.push(
    "--proc",
    "/proc",
    "--dev",
    "/dev",
    "--tmpfs",
    "/tmp",
    "--ro-bind",
    PROGRAM,
    "/tmp/sheer",
    "--ro-bind",
    `${PROGRAM}-render`,
    "/tmp/sheer-render",
    "--bind",
    out,
    "/out",
  );
  sandbox.push("--remount-ro", "/", "--chdir", "/out", "--clearenv", ...variables);
  const inside = (words) => run("bwrap", [...sandbox, ...words]);
  if (inside(["/bin/true"]).status !== 0) return t.skip("bubblewrap does not work here");
  assert.notEqual(inside(["/bin/sh", "-c", "echo > /file"]).status, 0);
  const { status, stderr } = inside(["/tmp/sheer", "compare", "spec.json", "--out", "report"]);
  assert.equal(status, 0, stderr);
  assert.equal(JSON.parse(readFileSync(join(out, "report", "report.json"), "utf8")).status, "done");
  assert.ok(statSync(join(out, "report", "report.html")).size > 10_000);
});
