// What stays and what goes when a ready-made spec becomes a different one, and what another scene brings with it.
import assert from "node:assert/strict";
import { assert_accessible, field, service_tests } from "./harness.mjs";

const tests = service_tests();
const { page_test, api, post_report } = tests;

const spec_of = async (page) => JSON.parse(await page.getByLabel("Spec as JSON").inputValue());
const choose_scene = (page, type) => page.locator(`${field("/scene/type")} select`).selectOption(type);
const valid = (page) => page.getByText("The spec is valid.").waitFor();

/** Chooses the ready-made spec with this id on the page. */
async function start_from(page, id) {
  const { spec } = (await api("/specs/examples")).find((one) => one.id === id);
  await page.goto(`${tests.url()}/#/new`);
  await page.locator(".presets button", { hasText: spec.title }).click();
  assert.equal((await spec_of(page)).title, spec.title);
  return spec;
}

page_test("another scene type has its own shading, texture and camera", { expected_statuses: [422] }, async (page) => {
  const scenes = await api("/scenes");
  await page.goto(`${tests.url()}/#/new`);
  const foreign = {
    type: "quads",
    shading: "4-textures-math",
    texture: { image: "smoke", size: 64 },
    count: 5,
    seed: 77,
  };
  for (const { id, parameters } of scenes) {
    if (id === "quads") continue;
    await page.getByRole("tab", { name: "Spec" }).click();
    await page.getByLabel("Spec as JSON").fill(JSON.stringify({ scene: foreign, methods: ["b2f"] }));
    await page.getByRole("tab", { name: "Form" }).click();
    await choose_scene(page, id);
    const { scene } = await spec_of(page);
    const required = parameters.filter((param) => param.required).map((param) => param.name);
    for (const name of Object.keys(scene)) assert.ok(["type", ...required].includes(name), `${id} got ${name}`);
    for (const name of ["shading", "texture"]) {
      const described = parameters.find((param) => param.name === name);
      const shown = page
        .locator(`${field(name === "texture" ? "/scene/texture/image" : "/scene/shading")} select`)
        .first();
      const expected = name === "texture" ? described.default.image : described.default;
      assert.equal(await shown.inputValue(), expected, `${id} ${name}`);
    }
  }
});

page_test("a scene that was left is restored when it is chosen again", {}, async (page) => {
  page.on("dialog", (dialog) => dialog.accept()); // edits may be replaced
  await start_from(page, "foliage");
  const before = (await spec_of(page)).scene;
  await page.locator(`${field("/scene/trees")} input`).fill("2");
  await choose_scene(page, "particles");
  assert.deepEqual((await spec_of(page)).scene, { type: "particles" });
  await choose_scene(page, "foliage");
  assert.deepEqual((await spec_of(page)).scene, { ...before, trees: 2 });
  // A newly started spec has nothing of the previous one.
  await start_from(page, "quick");
  await choose_scene(page, "foliage");
  assert.deepEqual((await spec_of(page)).scene, { type: "foliage" });
});

page_test("title and checks of a ready-made spec are removed with it, and can be restored", {}, async (page) => {
  const ready = await start_from(page, "volume");
  assert.ok(ready.checks.length > 0);
  await page.locator(`${field("/timing/rounds")} input`).fill("9");
  assert.deepEqual(
    (await spec_of(page)).checks,
    ready.checks,
    "the time limit does not make it a different comparison",
  );
  await choose_scene(page, "quads");
  const changed = await spec_of(page);
  assert.equal(changed.title, undefined);
  assert.equal(changed.checks, undefined);
  assert.equal(await page.locator(`${field("/title")} input`).inputValue(), "");
  assert.equal(await page.locator(".check-row").count(), 0);
  const note = page.locator(".left-note");
  assert.ok((await note.textContent()).includes(ready.title));
  await assert_accessible(page, "a form that had a ready-made spec", ".left-note");
  await note.getByRole("button", { name: "Put back" }).click();
  const back = await spec_of(page);
  assert.deepEqual([back.title, back.checks], [ready.title, ready.checks]);
  assert.equal(await page.locator(`${field("/title")} input`).inputValue(), ready.title);
  assert.equal(await note.count(), 0);
  await choose_scene(page, "layers");
  assert.equal((await spec_of(page)).title, ready.title, "what was restored is the user's own");
});

page_test("the user's own title and checks stay", {}, async (page) => {
  const ready = await start_from(page, "volume");
  await page.locator(`${field("/title")} input`).fill("Mine");
  await page.getByRole("button", { name: "+ Add a check" }).click();
  const own = ready.checks.length;
  await page.locator(`${field(`/checks/${own}/max`)} input`).fill("0.25");
  await choose_scene(page, "foliage");
  const { title, checks } = await spec_of(page);
  assert.equal(title, "Mine");
  assert.deepEqual(checks, [{ metric: "flip.mean", method: "b2f", max: 0.25 }]);
  assert.equal(await page.locator(`${field("/checks/0/max")} input`).inputValue(), "0.25");
  assert.doesNotMatch(await page.locator(".left-note").textContent(), /title/);
  await valid(page);
});

page_test("a changed limit of a ready-made check is the user's own", {}, async (page) => {
  await start_from(page, "volume");
  await page.locator(`${field("/checks/0/max")} input`).fill("0.5");
  await page.locator(`${field("/scene/slices")} input`).fill("64");
  const { title, checks } = await spec_of(page);
  assert.equal(title, undefined);
  assert.deepEqual(
    checks.map((check) => check.max),
    [0.5],
  );
});

page_test("a ready-made spec is remembered after a reload and through a report", {}, async (page) => {
  page.on("dialog", (dialog) => dialog.accept()); // edits may be replaced
  const ready = await start_from(page, "layers");
  await page.reload();
  assert.equal(await page.locator(`${field("/title")} input`).inputValue(), ready.title);
  await choose_scene(page, "quads");
  assert.equal((await spec_of(page)).title, undefined);
  const spec = {
    ...ready,
    image: { width: 16, height: 16 },
    methods: ["b2f", "unsorted"],
    checks: [],
    timing: { rounds: 1 },
  };
  const report = await post_report(spec, { Prefer: "wait=60" });
  assert.equal(report.status, "done", JSON.stringify(report));
  await page.goto(`${tests.url()}/#/reports/${report.id}`);
  await page.getByRole("button", { name: "Edit and run" }).click();
  assert.equal(await page.locator(`${field("/title")} input`).inputValue(), ready.title);
  await choose_scene(page, "quads");
  assert.equal((await spec_of(page)).title, undefined);
});

page_test("a published table loses its figures if the scene is changed", {}, async (page) => {
  await page.goto(`${tests.url()}/#/new`);
  await page.getByRole("button", { name: "Fill in" }).click();
  assert.equal(await page.locator(".suite-note").count(), 1);
  await choose_scene(page, "foliage");
  assert.equal((await spec_of(page)).suite, undefined);
  assert.equal(await page.locator(".suite-note").count(), 0);
});

page_test("the form says how many rounds an interval needs, as the report does", {}, async (page) => {
  await start_from(page, "quick");
  const rounds = page.locator(`${field("/timing/rounds")}`);
  const said = rounds.locator(".warning-text");
  const needed = { 2: 6, 3: 7, 4: 7, 5: 8, 7: 8, 8: 9, 13: 9, 14: 10 }; // least n with 2 (methods − 1) / 2^n of at most 0.05
  for (const [count, least] of Object.entries(needed)) {
    const spec = { scene: { type: "quads" }, methods: Array(Number(count)).fill("b2f"), timing: { rounds: least - 1 } };
    await page.getByRole("tab", { name: "Spec" }).click();
    await page.getByLabel("Spec as JSON").fill(JSON.stringify(spec));
    await page.getByRole("tab", { name: "Form" }).click();
    assert.match(
      await said.textContent(),
      new RegExp(`Too few rounds: ${least - 1}, needs ${least} `),
      `${count} methods`,
    );
    await rounds.locator("input").fill(String(least));
    assert.equal(await said.textContent(), "", `${least} rounds for ${count} methods`);
    await page.getByRole("button", { name: "Add Unsorted" }).click();
    assert.equal(
      (await said.textContent()) === "",
      (needed[Number(count) + 1] ?? least) <= least,
      `${count} and one more`,
    );
  }
  await rounds.locator("input").fill("3");
  await assert_accessible(page, "a form with too few rounds", field("/timing/rounds"));

  const methods = ["b2f", "f2b", "f2bd", "unsorted", "exact"];
  const judged = async (count) => {
    const spec = {
      image: { width: 16, height: 16 },
      scene: { type: "quads", count: 4 },
      methods,
      timing: { rounds: count },
    };
    const report = await post_report(spec, { Prefer: "wait=60" });
    return report.runs[0].results.map(({ speedup }) => Array.isArray(speedup.ci95));
  };
  assert.deepEqual(await judged(needed[5]), Array(5).fill(true));
  assert.deepEqual(await judged(needed[5] - 1), Array(5).fill(false));
});
