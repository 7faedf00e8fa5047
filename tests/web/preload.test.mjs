// The modules that are asked for at once are those that the views import.
import assert from "node:assert/strict";
import { test } from "node:test";
import { existsSync, readFileSync } from "node:fs";

const source = (name) => readFileSync(new URL(`../../web/${name}.js`, import.meta.url), "utf8");

/** The modules that these import statically, themselves included. */
function closure(names) {
  const all = new Set();
  const add = (name) => {
    if (all.has(name)) return;
    all.add(name);
    for (const [, imported] of source(name).matchAll(/^(?:import|export)\b[^;]*?"\.\/(\w+)\.js"/gms)) add(imported);
  };
  names.forEach(add);
  return [...all];
}

/** What preload.js asks for at this address. */
function asked_for(hash) {
  const links = [];
  const document = { createElement: () => ({}), head: { append: (link) => links.push(link) } };
  new Function("location", "document", source("preload"))({ hash }, document);
  assert.ok(links.every(({ rel }) => rel === "modulepreload"));
  return links.map(({ href }) => href.replace(/\.js$/, ""));
}

for (const [hash, views] of [
  ["#/reports/1?mode=flip", ["report_page", "report_view"]],
  ["#/diff/1/2", ["diff_view"]],
  ["#/new", ["compare_view"]],
  ["#/reports", []],
  ["", []],
]) {
  test(`modules of "${hash}"`, () => {
    const expected = closure(["app", ...views]);
    for (const name of expected) assert.ok(existsSync(new URL(`../../web/${name}.js`, import.meta.url)), name);
    assert.deepEqual(asked_for(hash).sort(), expected.sort());
  });
}
