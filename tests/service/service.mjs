// Starts the real program for a test, with its own port and folder.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import {
  existsSync,
  mkdirSync,
  mkdtempSync,
  readdirSync,
  readFileSync,
  rmSync,
  symlinkSync,
  writeFileSync,
} from "node:fs";
import http from "node:http";
import { connect } from "node:net";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { contract_at, hold_to_contract } from "./contract.mjs";

const PROGRAM = process.env.SHEER;
assert.ok(PROGRAM, "SHEER must be the path of the program");

export { sleep };

/** A comparison that takes well under a second. */
export const QUICK = {
  title: "One red layer",
  image: { width: 16, height: 16 },
  scene: { type: "layers", layers: [{ rect: [0, 0, 1, 1], depth: 0.5, color: [1, 0, 0], alpha: 0.5 }] },
  methods: ["b2f", "f2b"],
  timing: { warmup: 1, rounds: 1 },
};

/** A comparison that is timed for `seconds`. */
export function lasting(seconds, title = "lasting") {
  return {
    ...QUICK,
    title,
    timing: { warmup: 1, rounds: 1000, max_seconds: seconds },
    image: { width: 512, height: 512 },
    scene: { type: "quads", count: 64, shading: "4x4-textures", texture: { image: "leaf", size: 256 } },
  };
}

/** Repeats `question` until it returns something true. */
export async function until(question, what, limit_s = 60, pause_ms = 50) {
  const deadline = Date.now() + limit_s * 1000;
  while (Date.now() < deadline) {
    const answer = await question();
    if (answer) return answer;
    await sleep(pause_ms);
  }
  assert.fail(`${what}: not within ${limit_s} s`);
}

/** The ids of a process's children. */
export function children_of(pid) {
  const children = [];
  for (const name of readdirSync("/proc").filter((entry) => /^\d+$/.test(entry))) {
    try {
      const [, parent] = /^\d+ \(.*\) \S (\d+)/s.exec(readFileSync(`/proc/${name}/stat`, "utf8"));
      if (Number(parent) === pid) children.push(Number(name));
    } catch {
      // The process has ended meanwhile.
    }
  }
  return children;
}

export function command_line(pid) {
  try {
    return readFileSync(`/proc/${pid}/cmdline`, "utf8").split("\0");
  } catch {
    return [];
  }
}

export function is_alive(pid) {
  try {
    return !/^\d+ \(.*\) [ZX]/s.test(readFileSync(`/proc/${pid}/stat`, "utf8"));
  } catch {
    return false;
  }
}

/** With the URL of a PostgreSQL server here, each service gets a database of its own there. */
const STORE = process.env.SHEER_TEST_STORE;

/** A folder with the compiled shaders of all services, so that not each of them compiles the same ones. */
const SHADERS = process.env.SHEER_TEST_SHADERS;

/** For tests of what only the archive in a folder has. */
export const needs_sqlite = STORE ? { skip: "of the archive in a folder" } : {};
/** The reverse. */
export const needs_postgres = STORE ? {} : { skip: "there is no PostgreSQL server" };

/** The rows that a statement gives, as lines. */
export function ask_server(sql, url = STORE) {
  return execFileSync("psql", ["-q", "-A", "-t", "-v", "ON_ERROR_STOP=1", "-d", url, "-c", sql], {
    stdio: ["ignore", "pipe", "inherit"],
    encoding: "utf8",
    env: { ...process.env, PGOPTIONS: "-c client_min_messages=warning" },
  });
}

export class Service {
  constructor(config = {}, folder = mkdtempSync(join(tmpdir(), "sheer-service-"))) {
    this.folder = folder;
    this.data = join(folder, "data");
    this.config = join(folder, "server.json");
    this.listen = "127.0.0.1:0";
    this.wrapper = []; // a command that starts the program
    this.program = PROGRAM;
    this.holds_to_contract = true; // checks every answer, which takes longer than most answers
    writeFileSync(this.config, JSON.stringify(config));
    if (STORE) this.make_database();
    if (SHADERS && !existsSync(this.data)) {
      mkdirSync(this.data);
      mkdirSync(SHADERS, { recursive: true });
      symlinkSync(SHADERS, join(this.data, "shaders"));
    }
  }

  /** Services with the same folder share it. */
  make_database() {
    this.database = basename(this.folder);
    this.store = STORE.replace(/^(\w+:\/\/[^/]*\/)[^?]*/, `$1${this.database}`);
    if (!ask_server(`SELECT 1 FROM pg_database WHERE datname = '${this.database}'`))
      ask_server(`CREATE DATABASE "${this.database}"`);
  }

  async start(...more_arguments) {
    this.log = "";
    const [program, ...words] = [...this.wrapper, this.program];
    this.process = spawn(
      program,
      [
        ...words,
        "serve",
        "--listen",
        this.listen,
        "--data",
        this.data,
        "--config",
        this.config,
        ...this.store_arguments(),
        ...more_arguments,
      ],
      { stdio: ["ignore", "pipe", "pipe"] },
    );
    this.process.stderr.on("data", (text) => {
      this.log += text;
    });
    this.ended = new Promise((resolve) => this.process.on("exit", (code, signal) => resolve({ code, signal })));
    let output = "";
    this.process.stdout.on("data", (text) => {
      output += text;
    });
    const line = () => /^Sheer listens on (http:\/\/\S+)\n/.exec(output);
    await until(() => line() || this.process.exitCode !== null, "the service listens");
    assert.ok(line(), `the service ended: ${this.log}`);
    this.origin = new URL(line()[1]).origin;
    this.api = `${this.origin}/api/v1`;
    if (this.holds_to_contract) await hold_to_contract(this.origin, this.program);
    return this;
  }

  store_arguments() {
    return this.store ? ["--store", this.store] : [];
  }

  /** The arguments of other commands for the same store. */
  place() {
    return ["--data", this.data, ...this.store_arguments()];
  }

  /** As if the database had been restarted. */
  end_connections() {
    ask_server(`SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = '${this.database}'`);
  }

  /** The names of what the store keeps: `kind` is "blobs", the pictures, or "assets", the uploads. */
  kept(kind) {
    if (this.store) return ask_server(`SELECT sha256 FROM sheer.${kind}`, this.store).split("\n").filter(Boolean);
    const folder = join(this.data, kind);
    if (!existsSync(folder)) return [];
    const files = readdirSync(folder, { recursive: true, withFileTypes: true });
    return files.filter((entry) => entry.isFile()).map((entry) => entry.name);
  }

  async stop() {
    if (this.process.exitCode === null && this.process.signalCode === null) this.process.kill("SIGTERM");
    return this.ended;
  }

  async end() {
    await this.stop();
    if (this.store) ask_server(`DROP DATABASE IF EXISTS "${this.database}" WITH (FORCE)`);
    rmSync(this.folder, { recursive: true, force: true });
  }

  /** Ends a service that should be healthy: a sanitizer's error shows in the exit code. */
  async end_well() {
    const ended = await this.stop();
    await this.end();
    assert.deepEqual(ended, { code: 0, signal: null }, this.log);
  }

  workers() {
    return children_of(this.process.pid).filter((pid) => command_line(pid)[1] === "worker");
  }

  /** The child processes that render jobs, without those that probe. */
  renderers() {
    return this.workers()
      .flatMap(children_of)
      .filter((pid) => command_line(pid).some((word) => word.endsWith("spec.json")));
  }

  /** The worker whose child `renderer` is. */
  worker_of(renderer) {
    return this.workers().find((pid) => children_of(pid).includes(renderer));
  }

  post(spec, headers = {}) {
    const body = typeof spec === "string" ? spec : JSON.stringify(spec);
    return fetch(`${this.api}/reports`, {
      method: "POST",
      body,
      headers: { "Content-Type": "application/json", ...headers },
    });
  }

  async submit(spec) {
    const response = await this.post(spec);
    assert.equal(response.status, 202);
    return (await response.json()).id;
  }

  async report(id) {
    const response = await fetch(`${this.api}/reports/${id}`);
    assert.equal(response.status, 200);
    return response.json();
  }

  async reports(query = "") {
    const response = await fetch(`${this.api}/reports${query}`);
    assert.equal(response.status, 200);
    return (await response.json()).reports;
  }

  /** The report once it is in one of `statuses`. */
  reached(id, ...statuses) {
    return until(
      async () => {
        const report = await this.report(id);
        return statuses.includes(report.status) && report;
      },
      `report ${id} is ${statuses.join(" or ")}`,
      120,
    );
  }

  settled(id) {
    return this.reached(id, "done", "failed", "cancelled");
  }

  /** A request with headers that fetch does not allow. */
  raw(method, path, headers = {}, body = "") {
    return new Promise((resolve, reject) => {
      const request = http.request(this.origin + path, { method, headers }, (response) => {
        let text = "";
        response.on("data", (chunk) => {
          text += chunk;
        });
        response.on("end", () => {
          const { statusCode: status, headers: fields } = response;
          try {
            const type = fields["content-type"];
            contract_at(this.origin)?.require_answer({ method, target: path, status, type, text });
            resolve({ status, headers: fields, text });
          } catch (error) {
            reject(error);
          }
        });
      });
      request.on("error", reject);
      request.end(body);
    });
  }
}

/** Sends raw bytes and reads until the service ends the connection. */
export function talk(service, bytes, limit_ms = 30_000) {
  return new Promise((resolve, reject) => {
    const socket = connect(new URL(service.origin).port, "127.0.0.1", () => socket.write(bytes));
    let text = "";
    socket.setTimeout(limit_ms, () => socket.destroy(new Error("the service does not end the connection")));
    socket.on("data", (chunk) => {
      text += chunk;
    });
    socket.on("close", () => resolve(text));
    socket.on("error", (error) =>
      error.code === "ECONNRESET" || error.code === "EPIPE" ? resolve(text) : reject(error),
    );
  });
}

/** Runs `body` with a running service and ends it whatever happens. */
export async function with_service(config, body) {
  const service = new Service(config);
  try {
    await service.start();
    await body(service);
    await service.end_well();
  } finally {
    await service.end();
  }
}

/** Reads server-sent events until the stream ends or `enough(events)`. */
export async function read_events(response, enough = () => false) {
  assert.equal(response.status, 200);
  assert.match(response.headers.get("content-type"), /^text\/event-stream/);
  const events = [];
  let text = "";
  for await (const chunk of response.body) {
    text += Buffer.from(chunk).toString();
    for (let end; (end = text.indexOf("\n\n")) >= 0; text = text.slice(end + 2)) {
      const event = { comment: text.startsWith(":") };
      for (const line of text.slice(0, end).split("\n")) {
        const [, name, value] = /^(\w*): ?(.*)$/.exec(line) ?? [null, "", ""];
        if (name) event[name] = value;
      }
      if (event.data) {
        event.data = JSON.parse(event.data);
        contract_at(response.url)?.require_event(event.data);
      }
      events.push(event);
    }
    if (enough(events)) break;
  }
  return events;
}

export async function assert_problem(response, status) {
  const text = typeof response.text === "function" ? await response.text() : response.text;
  const type =
    typeof response.headers.get === "function"
      ? response.headers.get("content-type")
      : response.headers["content-type"];
  assert.equal(response.status, status, text);
  assert.equal(type, "application/problem+json");
  const problem = JSON.parse(text);
  assert.equal(problem.status, status);
  assert.ok(problem.title && problem.detail && problem.type);
  return problem;
}
