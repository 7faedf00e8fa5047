// Checks a service's answers, and the specs that it accepts, against its own OpenAPI document.
import assert from "node:assert/strict";
import http from "node:http";
import Ajv2020 from "ajv/dist/2020.js";
import add_formats from "ajv-formats";

/** An ajv with the schemas of an OpenAPI document, or of a schema file, unchanged. */
export function new_ajv() {
  const ajv = new Ajv2020({ strict: true, strictTypes: true, allowUnionTypes: true, strictRequired: false });
  add_formats(ajv);
  return ajv;
}

/** The first errors of the last validation as a text. */
export function first_errors(validate, count = 5) {
  return validate.errors
    .slice(0, count)
    .map(({ instancePath, message, params }) => `${instancePath || "/"} ${message} ${JSON.stringify(params)}`)
    .join("\n");
}

const media_type_of = (type) => (type ?? "").split(";")[0].trim();
const is_json = (type) => /^application\/(.+\+)?json$/.test(media_type_of(type));

export class Contract {
  constructor(document) {
    this.document = document;
    this.prefix = document.servers[0].url.replace(/\/$/, "");
    this.ajv = new_ajv();
    this.right = new Set(); // answers that were checked: who waits gets the same one again and again
    for (const keyword of ["openapi", "info", "servers", "security", "tags", "paths", "components"])
      this.ajv.addKeyword(keyword);
    this.ajv.addSchema(document, "api");
    this.paths = Object.keys(document.paths)
      .sort((a, b) => Number(a.includes("{")) - Number(b.includes("{")))
      .map((path) => [new RegExp(`^${path.replaceAll(".", "\\.").replaceAll(/\{\w+\}/g, "[^/]+")}$`), path]);
  }

  /** A validator of the component of this name. */
  component(name) {
    const validate = this.ajv.getSchema(`api#/components/schemas/${name}`);
    assert.ok(validate, `the OpenAPI document has no component ${name}`);
    return validate;
  }

  operation(method, path) {
    const below = path.startsWith(`${this.prefix}/`) ? path.slice(this.prefix.length) : path;
    const found = this.paths.find(([pattern]) => pattern.test(below));
    return found && this.document.paths[found[1]][method.toLowerCase()];
  }

  require(schema, value, what) {
    const [, name] = /^#\/components\/schemas\/(\w+)$/.exec(schema?.$ref) ?? [];
    assert.ok(name, `the OpenAPI document names no component for ${what}`);
    const validate = this.component(name);
    if (!validate(value)) assert.fail(`${what} is no ${name}:\n${first_errors(validate)}`);
  }

  /** A reply that is not described can only be a problem. */
  require_answer({ method, target, status, type, text }) {
    if (!is_json(type) || !text) return;
    const path = target.split("?")[0],
      answer = `${method} ${path} ${status} ${type} ${text}`;
    if (this.right.has(answer)) return;
    const responses = this.operation(method, path)?.responses ?? {};
    const response = responses[status] ?? responses.default;
    const problem = { "application/problem+json": { schema: { $ref: "#/components/schemas/Problem" } } };
    const content = response?.content ?? problem;
    this.require(
      content[media_type_of(type)]?.schema,
      JSON.parse(text),
      `the answer ${status} to ${method} ${path}, ${media_type_of(type)},`,
    );
    this.right.add(answer);
  }

  /** The body of an accepted request. */
  require_request({ method, target, body }) {
    const path = target.split("?")[0];
    const schema = this.operation(method, path)?.requestBody?.content["application/json"]?.schema;
    if (schema && typeof body === "string") this.require(schema, JSON.parse(body), `the body of ${method} ${path}`);
  }

  require_event(data) {
    this.require({ $ref: "#/components/schemas/ReportEvent" }, data, "the data of an event");
  }
}

/** On a separate connection that is closed at once, since some tests count connections. */
function document_of(origin) {
  return new Promise((resolve, reject) => {
    const options = { agent: false, headers: { Connection: "close" } };
    http
      .get(`${origin}/api/v1/openapi.json`, options, (response) => {
        let text = "";
        response.on("data", (chunk) => {
          text += chunk;
        });
        response.on("end", () => resolve(JSON.parse(text)));
      })
      .on("error", reject);
  });
}

const of_programs = new Map();
const of_origins = new Map();

/** From now on, answers fetched from `origin` are checked against the document of `program`, which listens there. */
export async function hold_to_contract(origin, program) {
  if (!of_programs.has(program)) of_programs.set(program, new Contract(await document_of(origin)));
  of_origins.set(origin, of_programs.get(program));
}

/** The contract of the service at the origin of this URL; undefined for others. */
export const contract_at = (url) => of_origins.get(new URL(url).origin);

const real_fetch = globalThis.fetch;

globalThis.fetch = async (input, init = {}) => {
  const response = await real_fetch(input, init);
  const { origin, pathname } = new URL(input.url ?? input);
  const contract = of_origins.get(origin);
  if (!contract) return response;
  const request = { method: init.method ?? input.method ?? "GET", target: pathname };
  if (response.ok) contract.require_request({ ...request, body: init.body });
  const read_text = response.text.bind(response);
  response.text = async () => {
    const text = await read_text();
    const { status, headers } = response;
    contract.require_answer({ ...request, status, type: headers.get("content-type"), text });
    return text;
  };
  response.json = async () => JSON.parse(await response.text());
  return response;
};
