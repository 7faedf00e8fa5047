// Models, textures and volumes uploaded on the page: what it says about them, and what is then in the spec.
import assert from "node:assert/strict";
import { glb, three_squares } from "../service/glb.mjs";
import { png } from "../service/pictures.mjs";
import { assert_accessible, field, service_tests } from "./harness.mjs";

const tests = service_tests();
const { page_test, api, post_report } = tests;

const spec_of = async (page) => JSON.parse(await page.getByLabel("Spec as JSON").inputValue());
const upload = (page, pointer, name, buffer) =>
  page.locator(`${field(pointer)} input[type=file]`).setInputFiles({ name, mimeType: "", buffer });

/** A picture with one row more than its header says, which becomes a note. */
const long_png = () => png(2, 2, 2, Array(3).fill(Buffer.from([1, 2, 3, 4, 5, 6])));

page_test("an uploaded model is drawn in its own colors", { expected_statuses: [422] }, async (page) => {
  await page.goto(`${tests.url()}/#/new`);
  await page.getByRole("button", { name: /Trees of intersecting planes/ }).click();
  await page.locator(`${field("/scene/type")} select`).selectOption("gltf");
  await upload(page, "/scene/model", "squares.glb", glb(three_squares()));
  await page.locator(`${field("/scene/model")} option`, { hasText: "squares.glb" }).waitFor({ state: "attached" });
  for (const name of ["width", "height"]) await page.locator(`${field(`/image/${name}`)} input`).fill("32");
  await page.getByText("The spec is valid.").waitFor();
  const { scene } = await spec_of(page);
  assert.deepEqual(Object.keys(scene).sort(), ["model", "type"]);
  await page.getByRole("button", { name: "Run comparison" }).click();
  await page.locator("article.report").waitFor({ timeout: 90_000 });
  const report = await api(`/reports/${new URL(page.url()).hash.split("/").pop()}`);
  assert.equal(report.spec.scene.shading, "material");
});

page_test("a raw volume is described in the form", { expected_statuses: [422] }, async (page) => {
  await page.goto(`${tests.url()}/#/new`);
  await page.locator(`${field("/scene/type")} select`).selectOption("volume");
  const bytes = Buffer.alloc(4 * 3 * 2 * 2, 100);
  await upload(page, "/scene/volume/data", "block.raw", bytes);
  await page
    .locator(`${field("/scene/volume/data")} .asset-notes`)
    .getByText("no header")
    .waitFor();
  const raw = page.getByLabel("Set the raw");
  assert.equal(await raw.isChecked(), true, "a file without a header needs it");
  for (const [index, side] of [4, 3, 2].entries())
    await page
      .locator(`${field("/scene/volume/raw/size")} input`)
      .nth(index)
      .fill(String(side));
  await page.locator(`${field("/scene/volume/raw/voxel")} select`).selectOption("uint16");
  await page
    .locator(`${field("/scene/volume/raw/spacing")} input`)
    .nth(2)
    .fill("2.5");
  await page.getByText("The spec is valid.").waitFor();
  await assert_accessible(page, "a form with a raw volume");
  const { scene } = await spec_of(page);
  assert.deepEqual(scene.volume.raw, { size: [4, 3, 2], voxel: "uint16", spacing: [1, 1, 2.5] });
  const spec = { image: { width: 16, height: 16 }, scene, methods: ["b2f"], timing: { rounds: 1 } };
  const report = await post_report(spec, { Prefer: "wait=60" });
  assert.equal(report.status, "done", JSON.stringify(report.error));
  await page
    .locator(`${field("/scene/volume/raw/size")} input`)
    .nth(1)
    .fill("2.5");
  await page
    .locator(`${field("/scene/volume/raw/size")} > .error-text`)
    .getByText("whole number")
    .waitFor();
  await page.locator(`${field("/scene/volume/data")} select`).selectOption("head");
  assert.equal(await raw.isChecked(), false, "the head does not need it");
  await page.getByText("The spec is valid.").waitFor();
});

page_test(
  "what is not read from a file is listed beside it, after the upload and whenever it is chosen",
  { expected_statuses: [422] },
  async (page) => {
    const model = three_squares();
    model.json.extensionsUsed = ["KHR_materials_clearcoat", "KHR_lights_punctual"];
    model.json.materials[1].extensions = { KHR_materials_clearcoat: { clearcoatFactor: 1 } };
    model.json.extensions = { KHR_lights_punctual: { lights: [{ type: "point" }] } };
    model.json.nodes[0].extensions = { KHR_lights_punctual: { light: 0 } };
    const files = [
      ["gltf", "/scene/model", "noted.glb", glb(model)],
      ["foliage", "/scene/texture/image", "long.png", long_png()],
    ];
    await page.goto(`${tests.url()}/#/new`);
    for (const [type, pointer, name, bytes] of files) {
      await page.locator(`${field("/scene/type")} select`).selectOption(type);
      await upload(page, pointer, name, bytes);
      await page.locator(`${field(pointer)} option`, { hasText: name }).waitFor({ state: "attached" });
      const asset = (await api("/assets?limit=1")).assets[0];
      const shown = () => page.locator(`${field(pointer)} .asset-notes li`).allTextContents();
      const expected = (asset.notes ?? []).map(({ where, text }) => `${where ?? ""}${text}`);
      assert.deepEqual(await shown(), expected, name);
      await page.reload();
      await page.locator(`${field(pointer)} option`, { hasText: name }).waitFor({ state: "attached" });
      assert.deepEqual(await shown(), expected, `${name} after a reload`);
      if (type === "foliage") {
        assert.ok(expected.length > 0, "the picture has notes");
        await page.locator(`${field(pointer)} select`).selectOption("leaf");
        assert.deepEqual(await shown(), [], "notes disappear with their file");
      }
    }
    await assert_accessible(page, "a form with notes");
  },
);

// Raw volumes, since nothing has to be decoded.
page_test(
  "every uploaded file is listed, even if there are over a hundred",
  { expected_statuses: [422] },
  async (page) => {
    const posted = [];
    for (let index = 0; index < 101; ++index) {
      const answer = await fetch(`${tests.url()}/api/v1/assets?name=raw-${index}.raw`, {
        method: "POST",
        headers: { "Content-Type": "application/octet-stream" },
        body: Buffer.alloc(8, index),
      });
      assert.equal(answer.status, 201);
      posted.push((await answer.json()).sha256);
    }
    await page.goto(`${tests.url()}/#/new`);
    await page.locator(`${field("/scene/type")} select`).selectOption("volume");
    const options = page.locator(`${field("/scene/volume/data")} option`, { hasText: /^raw-\d+\.raw/ });
    await options.nth(posted.length - 1).waitFor({ state: "attached" });
    assert.equal(await options.count(), posted.length);
    const oldest = options.filter({ hasText: /^raw-0\.raw/ });
    await page.locator(`${field("/scene/volume/data")} select`).selectOption(await oldest.getAttribute("value"));
    const { scene } = await spec_of(page);
    assert.ok(JSON.stringify(scene.volume.data).includes(posted[0]), JSON.stringify(scene.volume));
  },
);
