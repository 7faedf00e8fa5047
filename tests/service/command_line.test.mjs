// The command line as people expect it: wrong words, help, one entry of a list, completion, the manual, progress.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { lasting, QUICK } from "./service.mjs";

const PROGRAM = process.env.SHEER;
const folder = mkdtempSync(join(tmpdir(), "sheer-line-"));
after(() => rmSync(folder, { recursive: true, force: true }));

const sheer = (words, options = {}) => spawnSync(PROGRAM, words, { encoding: "utf8", cwd: folder, ...options });
const bash = (script, options = {}) => spawnSync("bash", ["-c", script], { encoding: "utf8", cwd: folder, ...options });

/** The names of the commands that a help lists. */
const commands_of = (help) =>
  [...help.slice(help.indexOf("Subcommands:")).matchAll(/^ {2}([a-z][\w-]*) /gm)].map(([, name]) => name);

let all_shown;
/** Every command that the help shows, as words. */
const shown = () => (all_shown ??= find_shown());
const find_shown = () =>
  commands_of(sheer(["--help"]).stdout).flatMap((name) => {
    const help = sheer([name, "--help"]).stdout;
    return [[name], ...(help.includes("Subcommands:") ? commands_of(help).map((below) => [name, below]) : [])];
  });

test("a wrong word is named, with what was probably meant", () => {
  for (const [words, message] of [
    [["frobnicate"], /^sheer: there is no command "frobnicate"\nsheer --help lists what there is\n$/],
    [["comapre", "a.json"], /^sheer: there is no command "comapre"; did you mean compare\?/],
    [["compare", "--junti", "x"], /^sheer compare: there is no option --junti; did you mean --junit\?/],
    [["baseline", "acept"], /^sheer baseline: there is no command "acept"; did you mean accept\?/],
    [["methods", "f2db"], /^sheer: there is no "f2db" among the methods; did you mean f2bd\?/],
    [["scenes", "nothing"], /among the scenes; there are .*quads/],
    [[], /^sheer: a command is missing/],
  ]) {
    const { status, stdout, stderr } = sheer(words);
    assert.equal(status, 2, words.join(" "));
    assert.equal(stdout, "");
    assert.match(stderr, message);
  }
});

test("every command's help has an example, whose options exist", () => {
  const commands = shown();
  assert.ok(commands.length > 15, String(commands.length));
  for (const words of commands) {
    const { status, stdout } = sheer([...words, "--help"]);
    assert.equal(status, 0);
    assert.match(stdout, new RegExp(`^Usage: sheer ${words.join(" ")}`, "m"));
    const [, example] = new RegExp(`^Example: sheer ${words.join(" ")}(.*)$`, "m").exec(stdout) ?? [];
    assert.ok(example !== undefined, `${words.join(" ")}: ${stdout}`);
    for (const [option] of example.matchAll(/--[\w-]+/g)) assert.ok(stdout.includes(option), `${words}: ${option}`);
  }
});

test("one method, scene or metric is shown alone", () => {
  const one = sheer(["methods", "F2BD"]).stdout;
  assert.match(one, /^f2bd /);
  assert.match(one, /threshold \(number 0\.?0? to 1/);
  assert.doesNotMatch(one, /^b2f /m);
  assert.deepEqual(
    JSON.parse(sheer(["metrics", "flip", "ssim", "--json"]).stdout).map(({ id }) => id),
    ["flip", "ssim"],
  );
});

test("errors name the file, and - is standard input", () => {
  const wrong = JSON.stringify({ ...QUICK, methods: ["f2x"] });
  writeFileSync(join(folder, "wrong.json"), wrong);
  const { status, stderr } = sheer(["compare", "wrong.json"]);
  assert.equal(status, 2);
  assert.match(stderr, /^wrong\.json is wrong:\n\/methods\/0: /);
  assert.match(sheer(["compare", "-"], { input: wrong }).stderr, /^standard input is wrong:\n\/methods\/0: /);
  const right = sheer(["compare", "-", "--json", "-q"], { input: JSON.stringify(QUICK) });
  assert.equal(right.status, 0, right.stderr);
  assert.equal(JSON.parse(right.stdout).status, "done");
  writeFileSync(join(folder, "server.json"), '{"wrokers": 1}');
  assert.match(sheer(["serve", "--config", "server.json"]).stderr, /server\.json.*\n?.*\/wrokers/);
});

const completed = (line) => {
  const words = line.split(" ");
  const { stdout, stderr } = bash(
    `source <("$SHEER" completion bash); COMP_WORDS=(${words.map((word) => `'${word}'`).join(" ")});
     COMP_CWORD=${words.length - 1}; _sheer; printf '%s\\n' "\${COMPREPLY[@]}"`,
  );
  assert.equal(stderr, "");
  return stdout.trim().split("\n");
};

test("bash completes commands, options, their values, and files", () => {
  assert.deepEqual(completed("sheer comp"), ["compare", "completion"]);
  assert.deepEqual(completed("sheer baseline a"), ["accept"]);
  assert.deepEqual(completed("sheer compare x.json --jun"), ["--junit"]);
  assert.deepEqual(completed("sheer compare --context os"), ["osmesa"]);
  assert.deepEqual(completed("sheer completion "), ["--help", "-h"]);
  assert.ok(completed("sheer ").includes("submit"));
  assert.ok(!completed("sheer ").includes("render"));
  writeFileSync(join(folder, "a-spec.json"), "{}");
  assert.deepEqual(completed("sheer compare a-sp"), ["a-spec.json"]);
});

test("the completions of zsh and fish name every command", () => {
  for (const shell of ["zsh", "fish"]) {
    const { stdout } = sheer(["completion", shell]);
    for (const words of shown()) assert.ok(stdout.includes(words.at(-1)), `${shell} ${words}`);
    const known = bash(`command -v ${shell}`).status === 0;
    if (known) assert.equal(spawnSync(shell, ["-n"], { input: stdout, encoding: "utf8" }).stderr, "");
  }
  assert.equal(sheer(["completion", "tcsh"]).status, 2);
});

test("the manual has a section for each command, and man can show it", () => {
  const page = sheer(["manual"]).stdout;
  for (const words of shown()) assert.ok(page.includes(`.SS sheer ${words.join(" ").replaceAll("-", "\\-")}\n`), words);
  writeFileSync(join(folder, "sheer.1"), page);
  if (bash("command -v groff").status !== 0) return;
  const { stdout, stderr } = bash("groff -man -Tutf8 -ww sheer.1");
  assert.equal(stderr, "");
  // eslint-disable-next-line no-control-regex
  assert.match(stdout.replaceAll(/.\u0008/g, ""), /EXIT STATUS/);
});

test("a terminal shows a bar with the time left, a log gets plain lines", () => {
  writeFileSync(join(folder, "long.json"), JSON.stringify(lasting(5)));
  writeFileSync(join(folder, "short.json"), JSON.stringify(lasting(1)));
  const log = sheer(["compare", "short.json"]);
  assert.equal(log.status, 0, log.stderr);
  // eslint-disable-next-line no-control-regex
  assert.doesNotMatch(log.stdout + log.stderr, /\u001b|\r/);
  assert.match(log.stderr, /^\[ *\d+ %\] timing round/m);
  const screen = bash(`script -qec '"$SHEER" compare long.json' /dev/null`, { env: { ...process.env, TERM: "xterm" } });
  assert.match(screen.stdout, /\[#+\.*\] +\d+ % {2}\d+ s left, .*timing round/);
});

test("only a terminal gets colours, and NO_COLOR none", () => {
  writeFileSync(join(folder, "log.json"), JSON.stringify({ log_level: "info", workers: 0 }));
  writeFileSync(
    join(folder, "serve.sh"),
    `rm -f out.txt
     "$SHEER" serve --listen 127.0.0.1:0 --data data --config log.json >out.txt & service=$!
     until grep -qs listens out.txt; do sleep 0.05; done
     kill -HUP $service; sleep 0.5; kill $service; wait $service`,
  );
  const on_terminal = (env) =>
    bash("script -qec 'bash serve.sh' /dev/null", { env: { ...process.env, TERM: "xterm", ...env } }).stdout;
  assert.match(on_terminal({ NO_COLOR: "" }), /\u001b\[.*SIGHUP/);
  const plain = on_terminal({ NO_COLOR: "1" });
  assert.match(plain, /SIGHUP/);
  assert.doesNotMatch(plain, /\u001b\[/);
  assert.doesNotMatch(bash("bash serve.sh").stderr, /\u001b\[/);
});
