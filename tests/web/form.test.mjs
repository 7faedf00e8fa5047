// The form of a new comparison, tested with a real service.
import assert from "node:assert/strict";
import { plain_png } from "../service/pictures.mjs";
import { HOSTILE, assert_accessible, field, fill_form, service_tests } from "./harness.mjs";

const tests = service_tests();
const { page_test, api } = tests;

// A slow page may be checked while no model or volume is chosen yet.
page_test("the form has the parameters that the service describes", { expected_statuses: [422] }, async (page) => {
  await page.goto(`${tests.url()}/#/new`);
  const [methods, scenes] = await Promise.all([api("/methods"), api("/scenes")]);
  for (const method of methods) await page.getByRole("button", { name: `Add ${method.name}`, exact: true }).click();
  const cards = page.locator(".method-list > li");
  const present = await cards.count();
  for (const [index, method] of methods.entries()) {
    const card = cards.nth(present - methods.length + index);
    for (const param of method.parameters) {
      const pointer = `/methods/${present - methods.length + index}/${param.name}`;
      assert.equal(await card.locator(field(pointer)).count(), 1, `${method.id} ${param.name}`);
    }
  }
  for (const scene of scenes) {
    const picture = page.getByRole("button", { name: scene.name, exact: true });
    assert.ok(await picture.locator("img").evaluate((img) => img.decode().then(() => img.naturalWidth)), scene.id);
    await picture.click();
    assert.equal(await page.locator(`${field("/scene/type")} select`).inputValue(), scene.id);
    assert.equal(
      await page.getByRole("button", { name: scene.name, exact: true }).getAttribute("aria-pressed"),
      "true",
    );
    for (const param of scene.parameters)
      assert.equal(await page.locator(field(`/scene/${param.name}`)).count(), 1, `${scene.id} ${param.name}`);
  }
});

page_test("errors are shown at the field and in the spec", { expected_statuses: [422] }, async (page) => {
  await fill_form(page, tests.url());
  await page.locator(`${field("/scene/count")} input`).fill("0");
  const error = page.locator(`${field("/scene/count")} > .error-text`);
  await error.waitFor();
  assert.match(await error.textContent(), /1.*65536/);
  assert.equal(await page.locator(`${field("/scene/count")} input`).getAttribute("aria-invalid"), "true");
  await assert_accessible(page, "a form with an error");
  await page.getByRole("tab", { name: "Spec" }).click();
  await page.getByRole("button", { name: "/scene/count" }).click();
  assert.equal(await page.evaluate(() => getSelection().toString()), "0");
  await page.getByLabel("Spec as JSON").fill("{ not JSON");
  await page.getByRole("tabpanel", { name: "Spec" }).getByText("This is not JSON").waitFor();
  assert.equal(await page.getByRole("button", { name: "Run comparison" }).isDisabled(), true);
});

page_test("form and spec are kept in sync", {}, async (page) => {
  await fill_form(page, tests.url());
  await page.getByRole("tab", { name: "Spec" }).click();
  const text = page.getByLabel("Spec as JSON");
  const spec = JSON.parse(await text.inputValue());
  assert.equal(spec.title, HOSTILE);
  assert.equal(spec.scene.count, 24);
  assert.deepEqual(spec.tags, { branch: "main", note: "a:b" });
  const pasted = {
    title: "Pasted",
    scene: { type: "layers", layers: [{ depth: 0.5, alpha: 0.25 }] },
    methods: ["b2f", { id: "f2bd", threshold: 0.25, label: "mine" }, "b2f"],
  };
  await text.fill(JSON.stringify(pasted));
  await page.getByRole("tab", { name: "Form" }).click();
  assert.equal(await page.locator(`${field("/title")} input`).inputValue(), "Pasted");
  assert.equal(await page.locator(`${field("/methods/1/threshold")} input`).inputValue(), "0.25");
  assert.equal(await page.locator(`${field("/scene/layers/0/alpha")} input`).inputValue(), "0.25");
  assert.equal(await page.locator(`${field("/methods/2/label")} input`).getAttribute("placeholder"), "b2f 2");
  await page.locator(`${field("/scene/layers/0/alpha")} input`).fill("0.75");
  await page.getByRole("tab", { name: "Spec" }).click();
  assert.equal(JSON.parse(await text.inputValue()).scene.layers[0].alpha, 0.75);
  await page.getByText("The spec is valid.").waitFor();
});

page_test("the spec of a report can be used again", {}, async (page) => {
  await page.goto(`${tests.url()}/#/reports/${tests.report_id()}`);
  await page.getByRole("button", { name: "Edit and run" }).click();
  assert.equal(await page.locator(`${field("/title")} input`).inputValue(), HOSTILE);
  assert.equal(await page.locator(`${field("/image/height")} input`).inputValue(), "64");
  await page.getByText("The spec is valid.").waitFor();
});

page_test("the theme is kept", {}, async (page) => {
  await page.goto(`${tests.url()}/#/reports`);
  const background = () => page.evaluate(() => getComputedStyle(document.documentElement).backgroundColor);
  const light = await background();
  await page.getByRole("button", { name: /^Theme/ }).click();
  await page.getByRole("button", { name: /^Theme/ }).click();
  const dark = await background();
  assert.notEqual(dark, light);
  await page.reload();
  assert.equal(await background(), dark);
});

page_test("a camera is in the spec while its box is ticked", {}, async (page) => {
  await page.goto(`${tests.url()}/#/new`);
  await page.locator(`${field("/scene/type")} select`).selectOption("foliage");
  const box = page.getByLabel("Set the camera");
  assert.equal(await box.isChecked(), false);
  const camera = async () => {
    await page.getByRole("tab", { name: "Spec" }).click();
    const spec = JSON.parse(await page.getByLabel("Spec as JSON").inputValue());
    await page.getByRole("tab", { name: "Form" }).click();
    return spec.scene.camera;
  };
  assert.equal(await camera(), undefined);
  await box.check();
  assert.deepEqual(await camera(), {});
  const height = page.getByLabel("Eye y", { exact: true });
  assert.equal(await height.inputValue(), "3");
  await height.fill("9");
  assert.deepEqual(await camera(), { eye: [4, 9, 6] });
  await height.fill("3");
  assert.deepEqual(await camera(), {});
  await assert_accessible(page, "a form with a camera");
  await box.uncheck();
  assert.equal(await camera(), undefined);
});

page_test("the usual entries of a list are added to the spec when they are edited", {}, async (page) => {
  await page.goto(`${tests.url()}/#/new`);
  await page.locator(`${field("/scene/type")} select`).selectOption("volume");
  const transfer = async () => {
    await page.getByRole("tab", { name: "Spec" }).click();
    const spec = JSON.parse(await page.getByLabel("Spec as JSON").inputValue());
    await page.getByRole("tab", { name: "Form" }).click();
    return spec.scene.transfer;
  };
  assert.equal(await transfer(), undefined);
  await page.getByRole("button", { name: /^Change the \d+ usual entries of transfer$/ }).click();
  const usual = await transfer();
  assert.ok(usual.length > 2);
  assert.deepEqual(Object.keys(usual[0]).sort(), ["alpha", "color", "value"]);
  await page.getByRole("button", { name: "Remove Transfer 1", exact: true }).click();
  assert.deepEqual(await transfer(), usual.slice(1));
  await assert_accessible(page, "a form with a list");
});

page_test("a texture is uploaded from its field and used", { expected_statuses: [422] }, async (page) => {
  await fill_form(page, tests.url());
  const texture = page.locator(field("/scene/texture/image"));
  const choice = texture.locator("select");
  assert.equal(await choice.inputValue(), "leaf");
  const status = texture.getByRole("status");
  const upload = (name, buffer) =>
    texture.locator("input[type=file]").setInputFiles({ name, mimeType: "image/png", buffer });

  await upload("fake.jpg", plain_png(2, [1, 2, 3]));
  await status.getByText("is a PNG, not a JPEG").waitFor();
  assert.equal(await choice.inputValue(), "leaf");
  await assert_accessible(page, "a form with a refused upload");

  await texture
    .locator("input[type=file]")
    .setInputFiles({ name: "a.txt", mimeType: "text/plain", buffer: Buffer.from("a") });
  await status.getByText("must end with .png").waitFor();

  const name = `${"ö<b>".repeat(60)}.png`;
  await upload(name, plain_png(2, [9, 8, 7]));
  await choice.getByText("(2 × 2)").waitFor({ state: "attached" });
  const sha256 = await choice.inputValue();
  assert.match(sha256, /^[0-9a-f]{64}$/);
  assert.equal(await status.textContent(), "");
  const { assets } = await api("/assets");
  assert.deepEqual([assets[0].sha256, assets[0].width], [sha256, 2]);
  assert.ok(name.startsWith(assets[0].name) && assets[0].name.length > 100);
  await page.getByText("The spec is valid.").waitFor();
  await page.getByRole("tab", { name: "Spec" }).click();
  const text = page.getByLabel("Spec as JSON");
  const spec = JSON.parse(await text.inputValue());
  assert.equal(spec.scene.texture.image, sha256);
  await text.fill(JSON.stringify({ ...spec, scene: { ...spec.scene, texture: { image: "0".repeat(64) } } }));
  await page.getByRole("tab", { name: "Form" }).click();
  await texture.locator(":scope > .error-text").getByText("no asset with this SHA-256").waitFor();
  await choice.selectOption("leaf");
  await page.getByText("The spec is valid.").waitFor();
});

page_test("the user's own shading is written in the form", { expected_statuses: [422] }, async (page) => {
  await fill_form(page, tests.url());
  const shading = page.locator(field("/scene/shading"));
  const choice = shading.locator("select");
  const source = page.locator(`${field("/scene/shading/glsl")} textarea`);
  assert.equal(await source.count(), 0);
  await choice.selectOption({ label: "own GLSL" });
  assert.match(await source.inputValue(), /return vec4\(/);
  const valid = page.getByText("The spec is valid.");
  await valid.waitFor();
  await source.fill("return tint;\n#define x");
  const error = page.locator(`${field("/scene/shading/glsl")} > .error-text`);
  await error.filter({ hasText: "line 2 has a #" }).waitFor();
  const numbers = page.locator(`${field("/scene/shading/glsl")} .line-numbers`);
  const marked = () => numbers.locator(".wrong").allTextContents();
  assert.deepEqual(await marked(), ["2"]);
  // What only the compiler finds.
  await source.fill("float a = 1.0;\nvec4 b = a * tints;\n\nreturn b + c;");
  await error.filter({ hasText: "line 4: " }).waitFor();
  assert.deepEqual(await marked(), ["2", "4"]);
  assert.match(await numbers.locator(".wrong").first().getAttribute("title"), /^line 2: .*tints/);
  assert.equal(await numbers.locator("span").count(), 4);
  await assert_accessible(page, "a program with errors");
  assert.equal(await shading.locator(":scope > .error-text").isHidden(), true);
  const body = "return tint * vec4(uv, 1.0, 1.0);";
  await source.fill(body);
  await error.waitFor({ state: "hidden" });
  await assert_accessible(page, "a form with the user's own shading");
  await page.getByRole("tab", { name: "Spec" }).click();
  const text = page.getByLabel("Spec as JSON");
  assert.deepEqual(JSON.parse(await text.inputValue()).scene.shading, { glsl: body });
  await page.getByText("The spec is valid.").waitFor();
  await page.getByRole("tab", { name: "Form" }).click();
  assert.equal(await source.inputValue(), body);
  await choice.selectOption("constant");
  assert.equal(await source.count(), 0);
  await page.getByRole("tab", { name: "Spec" }).click();
  assert.equal(JSON.parse(await text.inputValue()).scene.shading, "constant");
});
