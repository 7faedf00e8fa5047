// The start page: ready comparisons, a file of one's own, and the whole way to the comparison of two reports.
import assert from "node:assert/strict";
import { glb, three_squares } from "../service/glb.mjs";
import { assert_accessible, field, service_tests } from "./harness.mjs";

const RENDER_MS = 90_000;
const tests = service_tests();
const { page_test, api } = tests;

const report_id = (page) => /#\/reports\/([^?]+)/.exec(page.url())[1];

page_test("every ready comparison has a picture, says what it teaches, and can be run or changed", {}, async (page) => {
  await page.goto(tests.url());
  const examples = await api("/specs/examples");
  assert.ok(examples.some(({ id }) => id === "glass"));
  await page.locator(".start-card .chip:visible").first().waitFor();
  for (const { id, spec, teaches } of examples) {
    const card = page.locator(`.start-card[data-id="${id}"]`);
    assert.ok(teaches.length > 20, id);
    assert.equal(await card.locator("h2").textContent(), spec.title);
    assert.equal(await card.locator("p").first().textContent(), teaches);
    await card.scrollIntoViewIfNeeded();
    assert.ok(await card.locator("img").evaluate((img) => img.decode().then(() => img.naturalWidth)), id);
  }
  await assert_accessible(page, "the start page");
  await page.getByRole("button", { name: "Customise Glass on a table" }).click();
  await page.getByText("The spec is valid.").waitFor();
  assert.equal(await page.locator(`${field("/title")} input`).inputValue(), "Glass on a table");
  const { assets } = await api("/assets");
  assert.deepEqual(
    assets.map(({ name, type }) => [name, type]),
    [["glass.glb", "model"]],
  );
});

page_test("the page of the API shows every call, its schemas, and examples", {}, async (page) => {
  await page.goto(tests.url());
  await page.getByRole("link", { name: "API" }).click();
  const call = page.locator("details#acceptReport");
  await call.waitFor();
  const document = await api("/openapi.json");
  const calls = Object.values(document.paths).flatMap(Object.values);
  assert.equal(await page.locator("details.api-item:not([id^=schema-])").count(), calls.length);
  await call.locator("summary").first().click();
  await assert_accessible(page, "the page of the API");
  assert.match(
    await call.locator("pre").last().textContent(),
    /^curl -X PUT --json @body.json 'http.*baselines\/main'/,
  );
  await call.getByRole("link", { name: "Acceptance" }).click();
  const schema = page.locator("#schema-Acceptance pre");
  await schema.waitFor();
  assert.deepEqual(JSON.parse(await schema.textContent()), document.components.schemas.Acceptance);
});

page_test("edits are not replaced without consent", {}, async (page) => {
  await page.goto(`${tests.url()}/#/new`);
  const title = page.locator(`${field("/title")} input`);
  await title.fill("Mine");
  await page.getByRole("link", { name: "Start" }).click();
  page.once("dialog", (dialog) => dialog.dismiss());
  const customise = page.getByRole("button", { name: "Customise Four layers by hand" });
  await customise.click();
  assert.match(page.url(), /#\/$/);
  page.once("dialog", (dialog) => dialog.accept());
  await customise.click();
  await title.waitFor();
  assert.equal(await title.inputValue(), "Four layers by hand");
});

page_test("from a dropped model to the comparison of two of its reports", {}, async (page) => {
  await page.goto(`${tests.url()}/#/reports`);
  await page.locator(".entry").first().waitFor();
  const bytes = [...glb(three_squares())];
  const drop = await page.evaluateHandle((data) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([new Uint8Array(data)], "squares.glb"));
    return transfer;
  }, bytes);
  await page.dispatchEvent("body", "dragover", { dataTransfer: drop });
  assert.ok(await page.locator(".drop-veil").isVisible());
  await page.dispatchEvent("body", "drop", { dataTransfer: drop });
  await page.getByText(/squares\.glb: a model, \d+ triangles/).waitFor();
  await assert_accessible(page, "a dropped model");
  await page.getByRole("button", { name: "Customise squares.glb" }).click();
  for (const name of ["width", "height"]) await page.locator(`${field(`/image/${name}`)} input`).fill("32");
  await page.getByText("The spec is valid.").waitFor();
  await page.getByRole("button", { name: "Run comparison" }).click();
  await page.locator("article.report").waitFor({ timeout: RENDER_MS });
  const first = report_id(page);
  await page.locator(".answer-sentence").waitFor();
  await page.getByRole("button", { name: "Run again" }).click();
  await page.waitForURL((url) => !url.href.includes(first));
  await page.locator("article.report").waitFor({ timeout: RENDER_MS });
  const second = report_id(page);
  await page.getByRole("link", { name: "Reports" }).click();
  for (const id of [first, second]) await page.locator(`.entry[data-id="${id}"] input`).check();
  await page.getByText("Two reports of the same spec are chosen.").waitFor();
  await page.getByRole("button", { name: "Compare", exact: true }).click();
  await page.locator("table.diff tbody tr").first().waitFor();
  assert.equal(await page.locator("table.diff .diff-word").first().textContent(), "identical");
});

page_test("a file that cannot be read says why", { expected_statuses: [422] }, async (page) => {
  await page.goto(tests.url());
  const input = page.getByLabel("Your model, volume or texture");
  await input.setInputFiles({ name: "broken.glb", mimeType: "", buffer: Buffer.from("not a model") });
  await page.getByRole("alert").filter({ hasText: "not accepted" }).waitFor();
  await input.setInputFiles({ name: "notes.xyz", mimeType: "text/plain", buffer: Buffer.from("text") });
  await page.getByRole("status").filter({ hasText: "notes.xyz" }).or(page.getByRole("alert")).first().waitFor();
});

page_test("the answer names a method, its limits change it, and a thumbnail opens the viewer", {}, async (page) => {
  await page.goto(`${tests.url()}/#/reports/${tests.report_id()}`);
  const { results } = (await api(`/reports/${tests.report_id()}`)).runs[0];
  const able = results.filter(({ metrics, speedup }) => metrics.flip.mean <= 0.02 && speedup?.verdict !== "slower");
  const least = Math.min(...able.map(({ fragments }) => fragments.shaded));
  const [baseline] = results;
  const chosen = page.locator(".glance tr.chosen");
  const label = await chosen.getAttribute("data-method");
  const named = results.find((result) => result.label === label);
  const saves = least <= 0.95 * baseline.fragments.shaded;
  assert.equal(named.fragments.shaded, saves ? least : baseline.fragments.shaded);
  assert.ok((await page.locator(".answer-sentence").textContent()).includes(label));
  const box = await page.locator(".answer").boundingBox();
  assert.ok(box.y + box.height < 860, "the answer is seen without scrolling");
  await page.getByLabel("No sorting").check();
  const free = results.filter(({ timing }) => !timing.sort);
  assert.equal(await chosen.count(), free.some(({ metrics }) => metrics.flip.mean <= 0.02) ? 1 : 0);
  await page.getByLabel("No sorting").uncheck();
  await page.getByRole("button", { name: "Show unsorted in the viewer" }).click();
  assert.equal(await page.locator(".big-name.right").textContent(), "unsorted");
});

page_test("a report is handed on: commands, files, menu by keyboard", {}, async (page) => {
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"], { origin: tests.url() });
  await page.goto(`${tests.url()}/#/reports/${tests.report_id()}?mode=flip`);
  const more = page.locator(".menu summary", { hasText: "⋯" });
  await more.focus();
  await page.keyboard.press("Enter");
  await assert_accessible(page, "the menu of a report");
  const copied = () => page.evaluate(() => navigator.clipboard.readText());
  await page.getByRole("button", { name: "Copy as curl" }).click();
  await page.getByRole("button", { name: "Copied" }).waitFor();
  const { spec } = await api(`/reports/${tests.report_id()}`);
  const command = await copied();
  const quoted = /-d '(.*)' http/s.exec(command)[1].replaceAll(`'\\''`, "'");
  assert.deepEqual(JSON.parse(quoted), spec);
  await page.keyboard.press("Escape");
  await page.getByText(/^Save pictures/).click();
  const download = page.waitForEvent("download");
  await page.getByRole("link", { name: "unsorted flip" }).click();
  assert.equal((await download).suggestedFilename(), "unsorted-flip.png");
  assert.equal(await page.getByRole("link", { name: "report.html" }).isVisible(), false);
  await page.getByRole("button", { name: "Copy link" }).click();
  await page.getByRole("button", { name: "Copied" }).first().waitFor();
  assert.match(await copied(), /mode=flip$/);
});

page_test("queue and lost connections are told", { expected_statuses: [503] }, async (page) => {
  const spec = {
    title: "Long",
    image: { width: 256, height: 256 },
    scene: { type: "quads", count: 512, shading: "4x4-textures" },
    methods: ["b2f"],
    timing: { rounds: 1000, max_seconds: 300 },
  };
  const ids = [];
  for (let i = 0; i < 8; ++i) ids.push((await tests.post_report(spec)).id);
  await page.goto(`${tests.url()}/#/reports/${ids.at(-1)}`);
  await page.getByText(/^(\d+th|3rd|2nd|Next) in line, about \d+ (s|min)$/).waitFor();
  await assert_accessible(page, "a queued report");
  for (const id of ids) await fetch(`${tests.url()}/api/v1/reports/${id}`, { method: "DELETE" });
  await page.getByText("This comparison was cancelled.").waitFor();
});
