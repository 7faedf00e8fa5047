// From a submitted form to the report, on the page and as a file, with a real service.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { HOSTILE, assert_accessible, assert_shown, at, fill_form, service_tests, table_values } from "./harness.mjs";

const RENDER_MS = 90_000;
const tests = service_tests();
const { page_test, api, post_report } = tests;

page_test("a comparison is submitted, followed and shown", {}, async (page) => {
  await fill_form(page, tests.url());
  await assert_accessible(page, "the form");
  const seen = page.locator("progress").waitFor({ timeout: RENDER_MS });
  await page.getByRole("button", { name: "Run comparison" }).click();
  await seen;
  await page.locator("article.report").waitFor({ timeout: RENDER_MS });
  const report = await api(`/reports/${new URL(page.url()).hash.split("/").pop()}`);
  assert.equal(report.status, "done");
  assert.equal(await page.locator("h1").textContent(), HOSTILE);
  assert.equal(await page.getByText("Software rasteriser").count(), report.device.software ? 1 : 0);
  await assert_accessible(page, "the report");
});

page_test("the tables show the numbers of the report", {}, async (page) => {
  await page.goto(`${tests.url()}/#/reports/${tests.report_id()}`);
  await page.locator("article.report").waitFor();
  const { results } = (await api(`/reports/${tests.report_id()}`)).runs[0];
  const tables = {
    fragments: [
      "fragments.submitted",
      "fragments.shaded",
      "fragments.needed",
      "images.shaded.greatest",
      "fragments.efficiency",
    ],
    timings: [
      "timing.median",
      "timing.mad",
      "timing.min",
      "timing.p95",
      "timing.initialization",
      "timing.finalization",
      "speedup.value",
    ],
    differences: [
      "metrics.signed.mean_abs",
      "metrics.signed.min",
      "metrics.signed.max",
      "metrics.rmse",
      "metrics.psnr",
      "metrics.ssim",
      "metrics.flip.mean",
      "metrics.linear.rmse",
      "metrics.over_backgrounds.rmse",
      "metrics.differing_pixels",
      "metrics.non_finite",
    ],
  };
  for (const [table, paths] of Object.entries(tables)) {
    const shown = await table_values(page, table);
    assert.deepEqual(
      Object.keys(shown),
      results.map((result) => result.label),
    );
    for (const result of results) {
      for (const path of paths) {
        const exact = at(result, path);
        const cell = shown[result.label][path];
        if (exact === null) assert.equal(cell, undefined, `${result.label} ${path}`);
        else {
          assert.equal(Number(cell.exact), exact, `${result.label} ${path}`);
          assert_shown(cell.shown, exact, `${result.label} ${path}`);
        }
      }
    }
  }
});

const loaded = (page) =>
  page.waitForFunction(() =>
    [...document.querySelectorAll(".picture > *")].every(
      (node) => node.dataset.painted || (node.complete && node.naturalWidth > 0),
    ),
  );

/** Red, green and blue of a pixel of the screen, from a screenshot. */
async function screen_pixel(page, x, y) {
  const png = (await page.screenshot({ clip: { x, y, width: 1, height: 1 } })).toString("base64");
  return page.evaluate(async (data) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = document.createElement("canvas");
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    return [...context.getImageData(0, 0, 1, 1).data.slice(0, 3)];
  }, png);
}

page_test("pictures are shown pixel for pixel, side by side and with a slider", {}, async (page) => {
  await page.goto(`${tests.url()}/#/reports/${tests.report_id()}`);
  await page.locator("article.report").waitFor();
  await loaded(page);
  const report = await api(`/reports/${tests.report_id()}`);
  assert.equal(await page.locator("figure.pane").count(), 1 + report.runs[0].results.length);
  for (const kind of ["difference", "flip"]) {
    await page.getByRole("group", { name: "Kind of picture" }).locator(`[data-value=${kind}]`).click();
    await loaded(page);
  }
  await page.getByRole("group", { name: "Kind of picture" }).locator("[data-value=color]").click();
  await page.locator("[data-value=slider]").click();
  await page.getByLabel("Left picture").selectOption({ label: "Reference" });
  await page.getByLabel("Right picture").selectOption({ label: "unsorted" });
  await loaded(page);
  const view = page.locator(".pane-view");
  await view.scrollIntoViewIfNeeded();
  const box = await page.locator(".picture img").first().boundingBox();
  const worst = report.runs[0].results.find(({ label }) => label === "unsorted").metrics.worst_pixel;
  const spot = [
    Math.floor(box.x + ((worst[0] + 0.5) / 96) * box.width),
    Math.floor(box.y + ((worst[1] + 0.5) / 64) * box.height),
  ];
  const divider = page.getByRole("slider", { name: "Line between the two pictures" });
  const read = async (position) => {
    await divider.focus();
    await divider.press(position);
    await page.mouse.move(0, 0);
    return screen_pixel(page, ...spot);
  };
  const left = await read("End");
  const right = await read("Home");
  assert.notDeepEqual(left, right, "the line moves over the spot");
  await page.mouse.move(spot[0] + 0.5, spot[1] + 0.5);
  await page.locator(".pane-value .value").nth(1).waitFor();
  const values = await page.locator(".pane-value .value").allTextContents();
  assert.deepEqual(values, [left.join(" "), right.join(" ")], "the values under the mouse are those on the screen");
  await page.locator(".pane-view").focus();
  await page.keyboard.press("+");
  assert.equal(
    await page
      .locator(".picture img")
      .first()
      .evaluate((image) => getComputedStyle(image).imageRendering),
    "pixelated",
  );
  await assert_accessible(page, "the slider");
});

page_test("the worst pixel can be shown in every pane", {}, async (page) => {
  await page.goto(`${tests.url()}/#/reports/${tests.report_id()}`);
  const result = (await api(`/reports/${tests.report_id()}`)).runs[0].results.find((one) => one.metrics?.worst_pixel);
  const [x, y] = result.metrics.worst_pixel;
  await page.getByRole("button", { name: `Show pixel ${x}, ${y} of ${result.label}` }).click();
  assert.equal(await page.locator(".zoom-value").textContent(), "1600 %");
  assert.equal(
    await page
      .locator(".readout")
      .textContent()
      .then((text) => text.startsWith(`x ${x}, y ${y}`)),
    true,
  );
  const panes = page.locator("figure.pane");
  const middles = new Set();
  for (let index = 0; index < (await panes.count()); ++index) {
    const view = await panes.nth(index).locator(".pane-view").boundingBox();
    const mark = await panes.nth(index).locator(".pixel-mark").boundingBox();
    middles.add(`${Math.round(mark.x + mark.width / 2 - view.x - view.width / 2)}`);
  }
  assert.equal(middles.size, 1, "all panes show the same place");
  assert.ok(Math.abs(Number([...middles][0])) <= 8, "the pixel is in the middle");
});

for (const place of ["served", "opened from a file"]) {
  page_test(`the self-contained report shows the same tables, ${place}`, { origin: undefined }, async (page) => {
    await page.goto(`${tests.url()}/#/reports/${tests.report_id()}`);
    await page.locator("article.report").waitFor();
    const expected = {
      timings: await table_values(page, "timings"),
      differences: await table_values(page, "differences"),
    };
    assert.ok(Object.keys(expected.timings).length > 1);
    const address = `${tests.url()}/api/v1/reports/${tests.report_id()}/report.html`;
    if (place === "served") await page.goto(address);
    else {
      const file = join(tests.folder(), "report.html");
      writeFileSync(file, await (await fetch(address)).text());
      await page.context().setOffline(true);
      await page.goto(`file://${file}`);
    }
    await page.locator("article.report").waitFor();
    assert.deepEqual(await table_values(page, "timings"), expected.timings);
    assert.deepEqual(await table_values(page, "differences"), expected.differences);
    const { device, provenance } = await api(`/reports/${tests.report_id()}`);
    await page.getByText("Details", { exact: true }).click();
    const origin = (await page.locator(".details-row dl").allTextContents()).join(" ");
    const governor = provenance.governor ?? provenance.governor_reason;
    for (const fact of [device.driver, device.cpu, governor, provenance.commit, provenance.rerun])
      assert.ok(origin.includes(fact), fact);
    assert.match(origin, /at the start, .* at the end/);
    assert.match(origin, /without conversion to linear light/);
    assert.equal(await page.locator("h1").textContent(), HOSTILE);
    await loaded(page);
    await page.locator("figure.pane .pane-view").first().hover();
    assert.match(await page.locator(".pane-value .value").first().textContent(), /^\d+ \d+ \d+$/);
  });
}

const without_scripts = { origin: undefined, javaScriptEnabled: false };
page_test("the self-contained report is readable without scripts", without_scripts, async (page) => {
  const file = join(tests.folder(), "plain.html");
  const address = `${tests.url()}/api/v1/reports/${tests.report_id()}/report.html`;
  writeFileSync(file, await (await fetch(address)).text());
  await page.goto(`file://${file}`);
  const { results } = (await api(`/reports/${tests.report_id()}`)).runs[0];
  assert.equal(await page.getByRole("heading", { level: 1 }).textContent(), HOSTILE);
  const table = await page.locator("pre").textContent();
  for (const { label, fragments } of results) {
    assert.ok(table.includes(label), label);
    assert.ok(table.includes(String(fragments.shaded)), label);
  }
  assert.deepEqual(await page.locator("figcaption").allTextContents(), [
    "Reference",
    ...results.map(({ label }) => label),
  ]);
  for (const image of await page.locator("figure img").all()) assert.equal((await image.boundingBox()).width, 96);
});

page_test("a printed report shows every picture and whole tables", {}, async (page) => {
  await page.goto(`${tests.url()}/#/reports/${tests.report_id()}`);
  await loaded(page);
  await page.setViewportSize({ width: 740, height: 1000 }); // about A4 without margins
  await page.emulateMedia({ media: "print" });
  await page.evaluate(() => {
    document.documentElement.dataset.theme = "dark";
  });
  const scheme = () => getComputedStyle(document.documentElement).colorScheme;
  assert.equal(await page.evaluate(scheme), "light", "paper is white");
  assert.equal(await page.locator(".toolbar").isVisible(), false);
  const panes = page.locator("figure.pane img");
  for (const image of await panes.all()) assert.ok((await image.boundingBox()).width > 90);
  const cut = await page.$$eval(".table-box", (boxes) =>
    boxes
      .filter((box) => box.offsetParent && box.scrollWidth > document.documentElement.clientWidth)
      .map((box) => box.ariaLabel),
  );
  assert.deepEqual(cut, []);
});

page_test("a running comparison shows its pictures and can be cancelled", {}, async (page) => {
  const spec = {
    title: "Long one",
    image: { width: 128, height: 128 },
    scene: { type: "quads", count: 64, shading: "4x4-textures" },
    methods: ["b2f", "f2b"],
    timing: { rounds: 1000, max_seconds: 600 },
  };
  const { id } = await post_report(spec);
  await page.goto(`${tests.url()}/#/reports/${id}`);
  const pictures = page.locator(".early img");
  await pictures.nth(2).waitFor();
  assert.deepEqual(await pictures.evaluateAll((all) => all.map(({ alt }) => alt)), ["Reference", "b2f", "f2b"]);
  const drawn = await pictures.evaluateAll((all) =>
    Promise.all(all.map((one) => one.decode().then(() => one.naturalWidth))),
  );
  assert.deepEqual(drawn, [128, 128, 128]);
  await assert_accessible(page, "a running comparison");
  await page.getByRole("button", { name: "Cancel" }).click();
  await page.getByText("This comparison was cancelled.").waitFor({ timeout: RENDER_MS });
  assert.equal((await api(`/reports/${id}`)).status, "cancelled");
  await assert_accessible(page, "a cancelled comparison");
});

page_test("every view fits a narrow window", { viewport: { width: 400, height: 800 } }, async (page) => {
  await page.goto(`${tests.url()}/#/new`);
  await page.getByRole("button", { name: "Layers by hand" }).click();
  await page.getByText("The spec is valid.").waitFor();
  await assert_accessible(page, "the narrow form");
  await page.getByRole("button", { name: "Run comparison" }).click();
  await page.locator("article.report").waitFor({ timeout: RENDER_MS });
  await assert_accessible(page, "the narrow report");
  await page.locator(".pane-view").first().press("Shift+ArrowRight");
  await page.locator(".pane-view").first().press("Enter");
  await page.locator("table.pixel-methods").waitFor({ timeout: RENDER_MS });
  await assert_accessible(page, "a narrow pixel", ".pixel-view");
  await page.goto(`${tests.url()}/#/reports`);
  await page.locator(".entry").first().waitFor();
  await assert_accessible(page, "the narrow archive");
  const [picture, title] = await Promise.all(
    [".thumb", ".entry-title"].map((part) => page.locator(`.entry ${part}`).first().boundingBox()),
  );
  assert.ok(picture.x + picture.width <= title.x, "a title is beside its picture");
  const last = await page.getByRole("navigation").getByRole("link").last().boundingBox();
  assert.ok(last.x + last.width <= 400, "no link is cut off");
});
