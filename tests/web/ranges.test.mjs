// The form, the schema and the service agree on the allowed values of each field.
import assert from "node:assert/strict";
import { field, service_tests } from "./harness.mjs";

const tests = service_tests();
const { page_test, api } = tests;

const spec_schema = async () => (await api("/openapi.json")).components.schemas.Spec;

/** The part of a schema that describes an object of this kind: one of several, or itself. */
function variant(schema, key, value) {
  const all = schema.oneOf ?? schema.anyOf ?? [schema];
  return all.find((one) => one.properties?.[key]?.const === value);
}

/** The schema of the value at a pointer of `spec`. */
function schema_at(root, pointer, spec) {
  let schema = root;
  let value = spec;
  for (const part of pointer.split("/").slice(1)) {
    if (schema.oneOf) schema = "type" in value ? variant(schema, "type", value.type) : variant(schema, "id", value.id);
    if (schema.anyOf) schema = schema.anyOf.find((one) => one.properties);
    schema = schema.type?.includes("array") ? schema.items : schema.properties?.[part];
    assert.ok(schema, `the schema has ${pointer}`);
    value = value?.[part];
  }
  return schema;
}

const is_whole = (schema) => [schema.type].flat().includes("integer");

function fits(schema, value) {
  return (
    (!is_whole(schema) || Number.isInteger(value)) &&
    (schema.enum === undefined || schema.enum.includes(value)) &&
    !(value < schema.minimum) &&
    !(value > schema.maximum) &&
    !(value <= schema.exclusiveMinimum) &&
    !(value >= schema.exclusiveMaximum)
  );
}

/** Values at, inside and outside of every bound, and between whole numbers. */
function probes(schema) {
  const bounds = [schema.minimum, schema.maximum, schema.exclusiveMinimum, schema.exclusiveMaximum];
  const near = bounds
    .filter((bound) => typeof bound === "number")
    .flatMap((bound) => {
      // A browser takes numbers very close to a whole number as whole.
      const step = is_whole(schema) ? 1 / 8 : Math.max(Math.abs(bound), 1) * 1e-9;
      return [bound, bound - step, bound + step, bound - 1, bound + 1];
    });
  return [...new Set([...near, 0, 0.5, 1.5, 2, 3, 4, 1e7, -1e7])];
}

/** Everything of the form that has a range or choices: {pointer, index, count, probes → validity}. */
const inputs_of = (page) =>
  page.$$eval(".spec-form [data-pointer] input[type=number]", (inputs) =>
    inputs.map((input) => {
      const place = input.closest("[data-pointer]");
      const group = [...place.querySelectorAll("input[type=number]")];
      const is_numbers = place.classList.contains("kind-numbers");
      return { pointer: place.dataset.pointer, index: is_numbers ? group.indexOf(input) : null, count: group.length };
    }),
  );

const validities = (page, { pointer, index }, values) =>
  page
    .locator(`${field(pointer)} input[type=number]`)
    .nth(index ?? 0)
    .evaluate((input, tried) => {
      const kept = input.value;
      const valid = tried.map((value) => {
        input.value = String(value);
        return input.checkValidity() && input.value !== "";
      });
      input.value = kept;
      return valid;
    }, values);

const put_spec = async (page, spec) => {
  await page.getByRole("tab", { name: "Spec" }).click();
  await page.getByLabel("Spec as JSON").fill(JSON.stringify(spec));
  await page.getByRole("tab", { name: "Form" }).click();
};
const spec_of = async (page) => JSON.parse(await page.getByLabel("Spec as JSON").inputValue());

/** Opens every optional part of the form, lists and objects, until there is nothing more to open. */
async function open_everything(page) {
  const closed = page.locator(".kind-object .ticked input:not(:checked)");
  while ((await closed.count()) > 0) await closed.first().check();
  const usual = page.getByRole("button", { name: /^Change the \d+ usual entries/ });
  while ((await usual.count()) > 0) await usual.first().click();
}

async function service_refuses(spec, pointer, value) {
  const copy = structuredClone(spec);
  const parts = pointer.split("/").slice(1);
  let owner = copy;
  for (const part of parts.slice(0, -1)) {
    owner[part] ??= {};
    owner = owner[part];
  }
  owner[parts.at(-1)] = value;
  const answer = await api("/specs/validate", {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(copy),
  });
  return (answer.errors ?? []).some((error) => error.pointer === pointer);
}

async function check_numbers(page, root, of_interest) {
  const spec = await spec_of(page);
  const inputs = (await inputs_of(page)).filter(({ pointer }) => of_interest(pointer));
  for (const input of inputs) {
    const own = schema_at(root, input.pointer, spec);
    if (input.index !== null) assert.equal(input.count, own.minItems, `numbers of ${input.pointer}`);
    const schema = input.index === null ? own : own.items;
    const values = probes(schema);
    const expected = values.map((value) => fits(schema, value));
    const what = (index) => `${input.pointer} ${input.index ?? ""} at ${values[index]}`;
    const shown = await validities(page, input, values);
    shown.forEach((valid, index) => assert.equal(valid, expected[index], `the form, ${what(index)}`));
    // The service is asked about single numbers, in lists only in the first entry: later ones may have to be greater.
    if (input.index !== null || /\/[1-9]\d*\/\w+$/.test(input.pointer.replace(/^\/methods\/\d+/, ""))) continue;
    const refused = await Promise.all(values.map((value) => service_refuses(spec, input.pointer, value)));
    refused.forEach((is_refused, index) => assert.equal(is_refused, !expected[index], `the service, ${what(index)}`));
  }
  return inputs.map(({ pointer }) => pointer);
}

/** Every number in a schema, as pointers; lists by their first entry. */
function numbers_in(schema, pointer) {
  if (schema.type?.includes?.("number") || schema.type?.includes?.("integer")) return [pointer];
  if (schema.type?.includes("array"))
    return schema.items?.properties ? numbers_in(schema.items, `${pointer}/0`) : schema.items?.type ? [pointer] : [];
  return Object.entries(schema.properties ?? {}).flatMap(([name, part]) => numbers_in(part, `${pointer}/${name}`));
}

page_test(
  "every number of image and timing has the range of the schema",
  { expected_statuses: [422] },
  async (page) => {
    await page.goto(`${tests.url()}/#/new`);
    await put_spec(page, { image: {}, timing: {}, scene: { type: "quads" }, methods: ["b2f"] });
    const root = await spec_schema();
    const seen = await check_numbers(page, root, (pointer) => /^\/(image|timing)\//.test(pointer));
    const expected = ["image", "timing"].flatMap((name) => numbers_in(root.properties[name], `/${name}`));
    assert.deepEqual([...new Set(seen)].sort(), expected.sort());
    const formats = page.locator(`${field("/image/format")} option`);
    assert.deepEqual(
      await formats.evaluateAll((all) => all.map((one) => one.value)),
      root.properties.image.properties.format.enum,
    );
  },
);

page_test(
  "every number of every scene is in the form and has the range of the schema",
  { expected_statuses: [422] },
  async (page) => {
    await page.goto(`${tests.url()}/#/new`);
    const root = await spec_schema();
    for (const { id, name } of await api("/scenes")) {
      await put_spec(page, { scene: { type: id === "quads" ? "layers" : "quads" }, methods: ["b2f"] });
      await page.getByRole("button", { name, exact: true }).click();
      await open_everything(page);
      const seen = await check_numbers(page, root, (pointer) => pointer.startsWith("/scene/"));
      const expected = numbers_in(variant(root.properties.scene, "type", id), "/scene");
      for (const pointer of expected) assert.ok(seen.includes(pointer), `${id} has an input for ${pointer}`);
    }
  },
);

page_test("every number of every method has the range of the schema", { expected_statuses: [422] }, async (page) => {
  await page.goto(`${tests.url()}/#/new`);
  const root = await spec_schema();
  const methods = await api("/methods");
  await put_spec(page, { scene: { type: "quads" }, methods: methods.map(({ id }) => ({ id })) });
  const seen = await check_numbers(page, root, (pointer) => pointer.startsWith("/methods/"));
  // A method's own texture is only in the JSON of a spec, which the form keeps.
  const expected = methods
    .flatMap(({ id }, index) => numbers_in(variant(root.properties.methods.items, "id", id), `/methods/${index}`))
    .filter((pointer) => !pointer.includes("/texture/"));
  assert.deepEqual([...new Set(seen)].sort(), expected.sort());
});

page_test("a check offers the metrics of the schema", {}, async (page) => {
  await page.goto(`${tests.url()}/#/new`);
  await page.getByRole("button", { name: "+ Add a check" }).click();
  const root = await spec_schema();
  const place = page.locator(`${field("/checks/0/metric")}, ${field("/checks/1/metric")}`).last();
  const offered = await place.locator("option").evaluateAll((all) => all.map((one) => one.value));
  assert.deepEqual(offered, root.properties.checks.items.properties.metric.enum);
  await page.getByText("The spec is valid.").waitFor();
});

page_test(
  "a sweep shows the range of its values, and may have as many axes as the schema allows",
  { expected_statuses: [422] },
  async (page) => {
    await page.goto(`${tests.url()}/#/new`);
    await put_spec(page, { scene: { type: "quads" }, methods: ["b2f", "f2bd"] });
    const root = await spec_schema();
    const add = page.getByRole("button", { name: "+ Add a sweep" });
    await add.click();
    const { minimum, maximum } = variant(root.properties.scene, "type", "quads").properties.count;
    const values = page.locator(field("/sweep/0/values"));
    assert.match(await values.locator(".hint").textContent(), new RegExp(`${minimum} to ${maximum}`));
    const error = page.locator(`${field("/sweep/0")} .error-text:not([hidden])`);
    for (const [text, is_right] of [
      [`${minimum}, ${maximum}`, true],
      [`${minimum}, ${minimum - 1}`, false],
      [`${minimum}`, true],
      [`${maximum + 1}`, false],
      ["4.5", false],
      ["4; 5", false],
    ]) {
      await values.locator("input").fill(text);
      if (is_right) await page.getByText("The spec is valid.").waitFor();
      else await error.waitFor();
    }
    await values.locator("input").fill("4");
    for (let axes = 1; axes < root.properties.sweep.maxItems; ++axes) await add.click();
    assert.equal(await page.locator(".sweep-row").count(), root.properties.sweep.maxItems);
    assert.equal(await add.isVisible(), false);
  },
);

page_test(
  "input that is not a number is refused, never taken as the default",
  { expected_statuses: [422] },
  async (page) => {
    await page.goto(`${tests.url()}/#/new`);
    await put_spec(page, { scene: { type: "quads", count: 8 }, methods: ["b2f"] });
    const input = page.locator(`${field("/scene/count")} input`);
    await input.fill("");
    await page.getByText("The spec is valid.").waitFor();
    assert.equal(await input.getAttribute("placeholder"), "1024", "an empty field shows its default");
    assert.equal((await spec_of(page)).scene.count, undefined);
    await input.pressSequentially("1e");
    await page.locator(`${field("/scene/count")} > .error-text:not([hidden])`).waitFor();
  },
);
