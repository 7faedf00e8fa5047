// The API as a page, from the service's own OpenAPI document.
import { append, el, set_children } from "./dom.js";

const SCHEMAS = "#/components/schemas/";
const EXAMPLES = "#/components/examples/";
const DOCUMENT = "api/v1/openapi.json";

const name_of = (reference, prefix) => reference?.slice(prefix.length);

/** Text in which backquotes mark code. */
function prose(text) {
  const parts = (text ?? "").split("`");
  return el(
    "p",
    {},
    parts.map((part, i) => (i % 2 === 1 ? el("code", {}, part) : part)),
  );
}

/** A block that may be scrolled, so it can have the focus. */
function scrolled(tag, label, ...children) {
  return el(tag, { class: "api-scroll", tabindex: 0, role: "region", "aria-label": label }, children);
}

function table(label, headings, rows) {
  if (rows.length === 0) return null;
  const cells = (tag, row) => row.map((cell) => el(tag, tag === "th" ? { scope: "col" } : {}, cell));
  return scrolled(
    "div",
    label,
    el(
      "table",
      {},
      el("thead", {}, el("tr", {}, cells("th", headings))),
      el(
        "tbody",
        {},
        rows.map((row) => el("tr", {}, cells("td", row))),
      ),
    ),
  );
}

function schema_link(schema) {
  const name = name_of(schema?.$ref ?? schema?.contentSchema?.$ref, SCHEMAS);
  return name ? el("a", { href: `#schema-${name}` }, name) : null;
}

/** The values that a parameter may have, in a few words. */
function values_of({ type, enum: choices, minimum, maximum, default: fallback } = {}) {
  const range = minimum !== undefined && maximum !== undefined ? `${minimum} to ${maximum}` : "";
  const given = fallback !== undefined && fallback !== "" && fallback !== null ? `default ${fallback}` : "";
  return [choices ? choices.join(", ") : [type].flat().join(" or "), range, given].filter(Boolean).join("; ");
}

function example_of(document, content) {
  const [first] = Object.values(content?.examples ?? {});
  const value = document.components.examples[name_of(first?.$ref, EXAMPLES)]?.value;
  if (value === undefined) return null;
  const text = typeof value === "string" ? value : JSON.stringify(value, null, 2);
  return el("details", {}, el("summary", {}, "Example"), scrolled("pre", "Example", text));
}

function contents(document, content = {}) {
  return Object.entries(content).map(([type, body]) =>
    el("div", {}, el("code", {}, type), " ", schema_link(body.schema), example_of(document, body)),
  );
}

function headers_of({ headers = {} }) {
  const names = Object.keys(headers);
  return names.length > 0 ? el("p", { class: "muted" }, `with ${names.join(", ")}`) : null;
}

/** A call that can be pasted into a shell. */
function curl_of(document, method, path, operation) {
  const base = new URL(document.servers[0].url.replace(/\/?$/, "/"), location.href).href.slice(0, -1);
  const filled = path.replace(
    /\{(\w+)\}/g,
    (all, name) => operation.parameters.find((one) => one.name === name).example,
  );
  const needed = (operation.parameters ?? []).filter((one) => one.in === "query" && one.required);
  const query = needed.length > 0 ? `?${needed.map(({ name }) => `${name}=…`).join("&")}` : "";
  const [type] = Object.keys(operation.requestBody?.content ?? {});
  const body =
    { undefined: "", "application/json": " --json @body.json" }[type] ??
    ` -H 'Content-Type: ${type}' --data-binary @FILE`;
  return `curl${method === "get" ? "" : ` -X ${method.toUpperCase()}`}${body} '${base}${filled}${query}'`;
}

function operation_item(document, method, path, operation) {
  const parameters = (operation.parameters ?? []).map((one) => [
    el("code", {}, one.name),
    one.required ? `${one.in}, required` : one.in,
    values_of(one.schema),
    prose(one.description),
  ]);
  const replies = Object.entries(operation.responses).map(([status, reply]) => [
    status,
    el("div", {}, prose(reply.description), headers_of(reply)),
    contents(document, reply.content),
  ]);
  return el(
    "details",
    { class: "api-item", id: operation.operationId },
    el(
      "summary",
      {},
      el("span", { class: "api-method" }, method.toUpperCase()),
      el("code", {}, path),
      el("span", { class: "muted" }, operation.summary),
    ),
    el(
      "div",
      { class: "api-body" },
      prose(operation.description),
      table("Parameters", ["Parameter", "In", "Values", "What it is"], parameters),
      operation.requestBody
        ? el("div", {}, el("h3", {}, "Body"), contents(document, operation.requestBody.content))
        : null,
      table("Answers", ["Status", "When", "Body"], replies),
      scrolled("pre", "As a command", curl_of(document, method, path, operation)),
    ),
  );
}

/** Some schemas have thousands of lines, so each is written when it is opened. */
function schema_item(name, schema) {
  const body = el("div", { class: "api-body" });
  const item = el(
    "details",
    { class: "api-item", id: `schema-${name}` },
    el("summary", {}, el("code", {}, name), el("span", { class: "muted" }, schema.description ?? "")),
    body,
  );
  item.addEventListener("toggle", () => {
    if (item.open && !body.firstChild) append(body, scrolled("pre", `Schema ${name}`, JSON.stringify(schema, null, 2)));
  });
  return item;
}

function open_target() {
  const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (target?.tagName !== "DETAILS") return;
  target.open = true;
  target.scrollIntoView();
}

function page_of(api) {
  const operations = Object.entries(api.paths).flatMap(([path, methods]) =>
    Object.entries(methods).map(([method, operation]) => ({ path, method, operation })),
  );
  const groups = api.tags.map(({ name, description }) =>
    el(
      "section",
      { class: "api-group" },
      el("h2", {}, name),
      el("p", { class: "muted" }, description),
      operations
        .filter(({ operation }) => operation.tags.includes(name))
        .map(({ path, method, operation }) => operation_item(api, method, path, operation)),
    ),
  );
  const schemas = Object.entries(api.components.schemas).map(([name, schema]) => schema_item(name, schema));
  return [
    el("h1", {}, `The API of Sheer ${api.info.version}`),
    el("p", {}, api.info.description, " This page is made from ", el("a", { href: DOCUMENT }, "openapi.json"), "."),
    groups,
    el("section", { class: "api-group" }, el("h2", {}, "Schemas"), schemas),
  ];
}

async function show() {
  const main = document.getElementById("main");
  try {
    const answer = await fetch(DOCUMENT);
    if (!answer.ok) throw new Error(`The service answered ${answer.status}.`);
    set_children(main, page_of(await answer.json()));
    open_target();
  } catch (error) {
    set_children(main, el("p", { class: "notice error" }, `The API cannot be shown: ${error.message}`));
  }
}

window.addEventListener("hashchange", open_target);
show();
