// The explanation of a pixel of a report's pictures, chosen by a click or the keyboard.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { assert_accessible, CROWDED, service_tests } from "./harness.mjs";

const { api, folder, page_test, report_id, url } = service_tests();

const RENDER_MS = 90_000;
const stack = "table.pixel-stack tbody tr";
const pane = ".pane-view";

async function open(page) {
  await page.goto(`${url()}/#/reports/${report_id()}`);
  await page.locator(pane).first().waitFor();
}

/** A pixel with more than two fragments, as described by the service. */
async function crowded_pixel() {
  const pixel = await api(`/reports/${report_id()}/pixel?${new URLSearchParams(CROWDED)}`);
  assert.ok(pixel.fragments.length > 2);
  return pixel;
}

/** [x, y] of the title. */
async function shown_pixel(page) {
  await page.locator(stack).first().waitFor();
  return /x (\d+), y (\d+)/
    .exec(await page.locator(".pixel-view h2").textContent())
    .slice(1)
    .map(Number);
}

page_test("a click on a picture shows the fragments under it and the methods' values", {}, async (page) => {
  await open(page);
  assert.equal(await page.locator(".pixel-view").isVisible(), false);
  const expected = await crowded_pixel();
  const box = await page.locator(`${pane} img`).first().boundingBox();
  await page.mouse.click(box.x + ((expected.x + 0.5) / 96) * box.width, box.y + ((expected.y + 0.5) / 64) * box.height);
  assert.deepEqual(await shown_pixel(page), [expected.x, expected.y]);
  // One more for what is behind.
  assert.equal(await page.locator(stack).count(), expected.fragments.length + 1);
  const depths = await page.$$eval(stack, (rows) => rows.map((row) => Number(row.children[1].textContent)));
  expected.fragments.forEach(({ depth }, i) => assert.ok(Math.abs(depths[i] - depth) < 1e-6, `depth ${i}`));
  const labels = await page.$$eval("table.pixel-methods tr[data-label]", (rows) =>
    rows.map((row) => row.dataset.label),
  );
  assert.deepEqual(
    labels,
    expected.methods.map((method) => method.label),
  );
  // Each method explains its value in as many sentences as the service gives.
  const explained = await page.$$eval(".pixel-explained [data-label]", (sections) =>
    sections.map((section) => [section.dataset.label, section.querySelectorAll("dl > div").length]),
  );
  assert.deepEqual(
    explained,
    expected.methods
      .filter((method) => method.explanation?.length > 0)
      .map((method) => [method.label, method.explanation.length]),
  );
  assert.ok(explained.length > 0);
  assert.ok((await page.locator("table.pixel-stack .swatch").count()) === expected.fragments.length + 1);
  await assert_accessible(page, "a pixel");

  await page.getByRole("button", { name: "Close the pixel" }).click();
  assert.equal(await page.locator(".pixel-view").isVisible(), false);
});

page_test("Enter explains the marked pixel, Escape closes the explanation and goes back", {}, async (page) => {
  await open(page);
  const first = page.locator(pane).first();
  await first.focus();
  await page.keyboard.press("Shift+ArrowRight");
  await page.keyboard.press("Shift+ArrowRight");
  await page.keyboard.press("Enter");
  assert.deepEqual(await shown_pixel(page), [49, 32]);
  assert.equal(await page.evaluate(() => document.activeElement.tagName), "H2");
  await page.keyboard.press("Escape");
  assert.equal(await page.locator(".pixel-view").isVisible(), false);
  assert.ok(await first.evaluate((node) => node === document.activeElement));
});

page_test("a drag and a double click choose no pixel", {}, async (page) => {
  await open(page);
  const asked = [];
  page.on("request", (request) => request.url().includes("/pixel?") && asked.push(request.url()));
  const box = await page.locator(pane).first().boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.dblclick(x, y);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 40, y + 10, { steps: 4 });
  await page.mouse.up();
  await page.waitForTimeout(600);
  assert.deepEqual(asked, []);
});

page_test("a pixel that cannot be explained says why", { expected_statuses: [503] }, async (page) => {
  await page.route("**/pixel?*", (route) =>
    route.fulfill({
      status: 503,
      contentType: "application/problem+json",
      body: JSON.stringify({ status: 503, title: "Service Unavailable", detail: "It takes <b>too long</b>." }),
    }),
  );
  await open(page);
  const box = await page.locator(pane).first().boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  assert.equal(await page.locator(".pixel-view [role=alert]").textContent(), "It takes <b>too long</b>.");
});

page_test("the self-contained report does not offer it, and says where it is", { origin: undefined }, async (page) => {
  const html = await (await fetch(`${url()}/api/v1/reports/${report_id()}/report.html`)).text();
  const file = join(folder(), "pixel-report.html");
  writeFileSync(file, html);
  await page.goto(`file://${file}`);
  await page.locator(pane).first().waitFor();
  assert.equal(await page.locator(".pixel-view").count(), 0);
  assert.match(await page.locator(".keys-hint").textContent(), /not in this file: the service's page/);
});

page_test(
  "a file saved with pixels explains the worst of each method and those looked at",
  { origin: undefined, acceptDownloads: true },
  async (page) => {
    await page.goto(`${url()}/#/reports/${report_id()}?pixel=${CROWDED.x},${CROWDED.y}`);
    await page.locator(pane).first().focus();
    await page.keyboard.press("Enter");
    await page.locator(stack).first().waitFor();
    await page.getByLabel("More").click();
    const saving = page.waitForEvent("download", { timeout: RENDER_MS });
    await page.getByRole("button", { name: "report.html with pixels explained" }).click();
    const file = join(folder(), "with-pixels.html");
    await (await saving).saveAs(file);

    await page.context().setOffline(true);
    await page.goto(`file://${file}#?layout=slider&shown=4`);
    await page.locator(pane).first().waitFor();
    const { results } = (await api(`/reports/${report_id()}`)).runs[0];
    const places = await page.getByRole("group", { name: "Pixels explained in this file" }).getByRole("button").all();
    const texts = (await Promise.all(places.map((one) => one.textContent()))).join("; ");
    for (const { label, metrics } of results)
      assert.equal(texts.includes(`worst of`) && texts.includes(label), metrics.flip.mean > 0, `${label} in ${texts}`);
    assert.match(texts, new RegExp(`x ${CROWDED.x}, y ${CROWDED.y} \\(looked at\\)`));

    // The keys lead to the worst pixel of the fourth method, and explain it as the service does.
    await page.keyboard.press("n");
    await page
      .locator(".readout")
      .getByText(/^x \d+/)
      .waitFor();
    await page.locator(pane).first().focus();
    await page.keyboard.press("Enter");
    const [x, y] = await shown_pixel(page);
    assert.match(texts, new RegExp(`x ${x}, y ${y} \\(worst of [^)]*${results[3].label}`));
    const { fragments } = await api(`/reports/${report_id()}/pixel?x=${x}&y=${y}`);
    assert.equal(await page.locator(stack).count(), fragments.length + 1);
    await assert_accessible(page, "a file with pixels", ".viewer");

    await page.locator(pane).first().focus();
    await page.keyboard.press("Shift+ArrowRight");
    await page.keyboard.press("Enter");
    await page.getByRole("alert").getByText("This file does not explain this pixel.").waitFor();
    await page.getByRole("button", { name: `x ${CROWDED.x}, y ${CROWDED.y}` }).click();
    assert.deepEqual(await shown_pixel(page), [CROWDED.x, CROWDED.y]);
  },
);
