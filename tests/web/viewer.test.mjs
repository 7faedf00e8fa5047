// The viewer of a report: layouts, keys, values, tools and the address, tested with a real service.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { inflateSync } from "node:zlib";
import { assert_accessible, CROWDED, service_tests } from "./harness.mjs";

const RENDER_MS = 90_000;
const tests = service_tests();
const { page_test, api, post_report } = tests;

const kind = (page, key) => page.getByRole("group", { name: "Kind of picture" }).locator(`[data-value=${key}]`);
const layout = (page, name) => page.getByRole("group", { name: "Layout" }).getByRole("button", { name, exact: true });
const cell = (page, source, name) => page.locator(`.values tr[data-source="${source}"] [data-kind=${name}]`);

async function open(page, id = tests.report_id(), query = "") {
  await page.goto(`${tests.url()}/#/reports/${id}${query}`);
  await page.locator(".pane-view").first().waitFor();
}

/** Width, height and rows of bytes of a PNG file with 8-bit RGB pixels, read without the page. */
async function png_levels(url) {
  const bytes = Buffer.from(await (await fetch(`${tests.url()}${url}`)).arrayBuffer());
  const [width, height] = [bytes.readUInt32BE(16), bytes.readUInt32BE(20)];
  const parts = [];
  for (let at = 8; at < bytes.length; at += 12 + bytes.readUInt32BE(at))
    if (bytes.toString("latin1", at + 4, at + 8) === "IDAT")
      parts.push(bytes.subarray(at + 8, at + 8 + bytes.readUInt32BE(at)));
  const packed = inflateSync(Buffer.concat(parts));
  const stride = width * 3;
  const rows = [];
  for (let y = 0; y < height; ++y) {
    const filter = packed[y * (stride + 1)];
    const row = Buffer.from(packed.subarray(y * (stride + 1) + 1, (y + 1) * (stride + 1)));
    const above = rows.at(-1) ?? Buffer.alloc(stride);
    for (let i = 0; i < stride; ++i) {
      const [a, b, c] = [row[i - 3] ?? 0, above[i], above[i - 3] ?? 0];
      const distance = [a, b, c].map((one) => Math.abs(a + b - c - one));
      const paeth = distance[0] <= distance[1] && distance[0] <= distance[2] ? a : distance[1] <= distance[2] ? b : c;
      row[i] += [0, a, b, (a + b) >> 1, paeth][filter];
    }
    rows.push(row);
  }
  return { width, height, at: (x, y) => [...rows[y].subarray(x * 3, x * 3 + 3)] };
}

page_test("values of the marked pixel are those of the files and of the service", {}, async (page) => {
  const report = await api(`/reports/${tests.report_id()}`);
  const [run] = report.runs;
  const { x, y } = CROWDED;
  const pixel = await api(`/reports/${tests.report_id()}/pixel?x=${x}&y=${y}`);
  assert.ok(pixel.fragments.length > 2);
  const reference = await png_levels(run.reference.images.color.url);
  await open(page, tests.report_id(), `?pixel=${x},${y}`);
  for (const [index, result] of run.results.entries()) {
    const key = index + 1;
    const picture = await png_levels(result.images.color.url);
    const levels = picture.at(x, y);
    await page.waitForFunction(
      ([place, text]) => document.querySelector(place)?.textContent === text,
      [`.values tr[data-source="${key}"] [data-kind=color]`, levels.join(" ")],
    );
    const floats = (await cell(page, key, "float").textContent()).split(" ").map(Number);
    levels.forEach((level, channel) => assert.ok(Math.abs(floats[channel] - level / 255) < 6e-5, result.label));
    const signed = levels.map((level, channel) => reference.at(x, y)[channel] - level);
    const shown = (await cell(page, key, "difference").textContent()).replaceAll("−", "-").split(" ").map(Number);
    assert.deepEqual(shown, signed, result.label);
    const explained = pixel.methods.find(({ label }) => label === result.label);
    assert.equal(Number(await cell(page, key, "shaded").textContent()), explained.shaded, result.label);
  }
  // The reference is stored in floats, which the page reads from the OpenEXR file itself.
  const exact = (await cell(page, 0, "float").textContent()).split(" ").map(Number);
  pixel.reference.value.slice(0, 3).forEach((value, channel) => assert.ok(Math.abs(exact[channel] - value) < 6e-5));
  assert.match(
    await page.locator(".values .readout").textContent(),
    new RegExp(`x ${x}, y ${y} · overdraw ${pixel.fragments.length}$`),
  );
});

page_test("the mean of FLIP over the map's values is that of the report", {}, async (page) => {
  await open(page);
  const { results } = (await api(`/reports/${tests.report_id()}`)).runs[0];
  await page.getByText("Errors of every method").click();
  const rows = page.locator(".errors-table tbody tr");
  await rows.first().waitFor();
  for (const [index, result] of results.entries()) {
    const values = await rows
      .nth(index)
      .locator("td[data-value]")
      .evaluateAll((cells) => cells.map((one) => Number(one.dataset.value)));
    const [, greatest, flip] = values;
    const { min, max } = result.metrics.signed;
    assert.equal(greatest, Math.max(Math.abs(min), Math.abs(max)), result.label);
    assert.ok(Math.abs(flip - result.metrics.flip.mean) < 0.5 / 255, `${result.label}: ${flip}`);
  }
  await assert_accessible(page, "the errors", ".errors");
  await page.locator(".pane-view").first().scrollIntoViewIfNeeded();
  const box = await page.locator(".pane-view img").first().boundingBox();
  await page.keyboard.down("Shift");
  await page.mouse.move(box.x + box.width * 0.25, box.y + box.height * 0.25);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.5, box.y + box.height * 0.5, { steps: 3 });
  await page.mouse.up();
  await page.keyboard.up("Shift");
  await page.getByText("Errors in x 24 to 48, y 16 to 32").waitFor();
  await page.keyboard.press("Escape");
  await page.getByText("Errors in the whole picture").waitFor();
});

/** A report whose methods' pictures differ in every pixel: one layer, whose color tells the method that drew it. */
const TELLING = {
  title: "Pictures that say which they are",
  image: { width: 64, height: 48, background: [0, 0, 0] },
  scene: { type: "layers", layers: [{ rect: [0, 0, 1, 1], depth: 0.5, color: [1, 1, 1], alpha: 0.5 }] },
  methods: [
    "b2f",
    { id: "alpha_test", label: "white", reference: 0.1 },
    { id: "alpha_test", label: "black", reference: 0.9 },
  ],
  reference: "exact",
  baseline: "b2f",
  timing: { rounds: 1 },
};
const LEVELS = { Reference: 128, b2f: 128, white: 255, black: 0 };

/** The level of a pixel of the screen at a share of the pane. */
async function screen_level(page, share_x) {
  await page.locator(".pane-view").scrollIntoViewIfNeeded();
  const box = await page.locator(".pane-view").boundingBox();
  const clip = { x: box.x + box.width * share_x, y: box.y + box.height * 0.6, width: 1, height: 1 };
  const png = (await page.screenshot({ clip })).toString("base64");
  return page.evaluate(async (data) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const context = document.createElement("canvas").getContext("2d");
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, 1, 1).data[0];
  }, png);
}

async function loaded(page) {
  await page.waitForFunction(() =>
    [...document.querySelectorAll(".picture > *")].every((node) =>
      node.tagName === "CANVAS" ? node.dataset.painted === "true" : node.complete && node.naturalWidth > 0,
    ),
  );
}

page_test("slider, flip and side by side agree on which picture is which", {}, async (page) => {
  const report = await post_report(TELLING, { Prefer: "wait=60" });
  assert.equal(report.status, "done");
  await open(page, report.id);
  await layout(page, "Slider").click();
  for (const [left, right] of [
    ["white", "black"],
    ["black", "white"],
    ["Reference", "black"],
  ]) {
    await page.getByLabel("Left picture").selectOption({ label: left });
    await page.getByLabel("Right picture").selectOption({ label: right });
    await loaded(page);
    assert.equal(await page.locator(".big-name.left").textContent(), left);
    assert.equal(await page.locator(".big-name.right").textContent(), right);
    assert.equal(await screen_level(page, 0.3), LEVELS[left], `${left} is left`);
    assert.equal(await screen_level(page, 0.7), LEVELS[right], `${right} is right`);
  }
  await page.getByRole("button", { name: "Swap the two pictures" }).click();
  await loaded(page);
  assert.equal(await screen_level(page, 0.3), LEVELS.black, "after the swap black is left");
  await page.getByRole("button", { name: "Swap the two pictures" }).click();
  await layout(page, "Flip").click();
  await loaded(page);
  const names = ["Reference", "b2f", "white", "black"];
  for (const [digit, name] of names.entries()) {
    await page.keyboard.press(String(digit));
    assert.equal(await page.locator(".big-name").textContent(), `${digit} ${name}`);
    assert.equal(await screen_level(page, 0.5), LEVELS[name], name);
  }
  await page.locator(".pane-view").focus();
  await page.keyboard.down(" ");
  assert.equal(await page.locator(".big-name").textContent(), "0 Reference");
  assert.equal(await screen_level(page, 0.5), LEVELS.Reference);
  await page.keyboard.up(" ");
  assert.equal(await screen_level(page, 0.5), LEVELS.black);
  await kind(page, "difference").click();
  await page.getByLabel("Gain").selectOption("1");
  await loaded(page);
  // The reference's 128 minus black's 0 is half of the range above mid grey.
  assert.equal(await screen_level(page, 0.5), 128 + Math.trunc((128 / 255) * 127 + 0.5));
  await page.getByLabel("Absolute").check();
  await loaded(page);
  assert.equal(await screen_level(page, 0.5), 128);
  await page.keyboard.press("l");
  const panes = await page.$$eval("figure.pane", (figures) =>
    figures.map((figure) => figure.querySelector(".pane-name").textContent),
  );
  assert.deepEqual(panes, names);
});

page_test("exposure, gamma and channels change what is shown, not what is read", {}, async (page) => {
  const report = await post_report(TELLING, { Prefer: "wait=60" });
  await open(page, report.id, "?layout=flip&shown=1&pixel=10,10");
  const shows = async (level) => {
    await loaded(page);
    assert.equal(await screen_level(page, 0.5), level);
  };
  await shows(128);
  await page.getByLabel("Exposure").fill("-1");
  await shows(64);
  await page.getByLabel("Gamma").fill("2");
  await shows(Math.round(Math.sqrt(128 / 255 / 2) * 255));
  assert.equal(await cell(page, 1, "color").textContent(), "128 128 128");
  await page.getByRole("button", { name: "Reset" }).click();
  await shows(128);
  await assert_accessible(page, "a picture in front of the others", ".viewer");
  // b2f draws a white layer of which half shows, "white" one that hides everything, "black" nothing.
  assert.equal(await cell(page, 1, "opacity").textContent(), (128 / 255).toFixed(3));
  const levels = async () => {
    const shown = [];
    for (const key of ["1", "2", "3"]) {
      await page.keyboard.press(key);
      await loaded(page);
      shown.push(await screen_level(page, 0.5));
    }
    return shown;
  };
  const channel = page.getByRole("group", { name: "Channel" });
  await channel.getByRole("button", { name: "Alpha" }).click();
  assert.deepEqual(await levels(), [128, 255, 0]);
  await channel.getByRole("button", { name: "RGB" }).click();
  await page.getByLabel("Over").selectOption("white");
  assert.deepEqual(await levels(), [255, 255, 255]);
  await page.waitForURL(/over=white/);
  await page.getByLabel("Over").selectOption("black");
  assert.deepEqual(await levels(), [128, 255, 0]);
  await page.reload();
  await page.locator(".pane-view").waitFor();
  assert.equal(await page.getByLabel("Over").inputValue(), "black", "the tools show what the address says");
});

page_test("keys fill the window, change layout and kind, and go to the worst pixels", {}, async (page) => {
  await open(page);
  await page.keyboard.press("f");
  assert.ok(await page.locator(".viewer.filling").isVisible());
  await assert_accessible(page, "the viewer that fills the window", ".viewer");
  await page.keyboard.press("m");
  assert.equal(await kind(page, "difference").getAttribute("aria-pressed"), "true");
  await page.keyboard.press("Escape");
  assert.equal(await page.locator(".viewer.filling").count(), 0);
  await page.keyboard.press("l");
  assert.equal(await layout(page, "Slider").getAttribute("aria-pressed"), "true");
  await page.keyboard.press("4"); // unsorted
  await page.keyboard.press("n");
  const worst = await page.waitForFunction(
    () => /x (\d+), y (\d+)/.exec(document.querySelector(".readout").textContent)?.[0],
  );
  const first = await worst.jsonValue();
  // The worst pixel by the greatest difference of a channel has the extreme of the report's signed differences.
  const { signed } = (await api(`/reports/${tests.report_id()}`)).runs[0].results[3].metrics;
  const extreme = Math.max(Math.abs(signed.min), Math.abs(signed.max));
  await page.waitForFunction(() =>
    /\d/.test(document.querySelector('.values tr[data-source="4"] [data-kind=difference]').textContent),
  );
  const levels = (await cell(page, 4, "difference").textContent()).replaceAll("−", "-").split(" ").map(Number);
  assert.equal(Math.max(...levels.map(Math.abs)), extreme);
  await page.keyboard.press("n");
  await page.waitForFunction((text) => !document.querySelector(".readout").textContent.startsWith(text), first);
  await page.keyboard.press("p");
  await page.waitForFunction((text) => document.querySelector(".readout").textContent.startsWith(text), first);
  await page.keyboard.press("?");
  await page.getByRole("dialog", { name: "Keys of the viewer" }).waitFor();
  await assert_accessible(page, "the sheet of keys", ".key-sheet");
  await page.keyboard.press("Escape");
  await layout(page, "Flip").click();
  const before = await page.locator(".big-name").textContent();
  await page.keyboard.press("c");
  await page.waitForFunction((name) => document.querySelector(".big-name").textContent !== name, before);
  await page.keyboard.press("c");
  await page.keyboard.press("c");
});

page_test("the address keeps what is shown, and back returns to the step before", {}, async (page) => {
  await open(page, tests.report_id(), "?mode=flip&layout=slider&shown=4&zoom=8&at=40,20&pixel=41,21");
  assert.equal(await kind(page, "flip").getAttribute("aria-pressed"), "true");
  assert.equal(await layout(page, "Slider").getAttribute("aria-pressed"), "true");
  assert.equal(await page.getByLabel("Right picture").inputValue(), "4");
  assert.equal(await page.locator(".zoom-value").textContent(), "800 %");
  assert.match(await page.locator(".readout").textContent(), /^x 41, y 21/);
  await kind(page, "shaded").click();
  await page.waitForURL(/mode=shaded/);
  await page.goBack();
  await page.waitForURL(/mode=flip/);
  assert.equal(await kind(page, "flip").getAttribute("aria-pressed"), "true");
  await page.goForward();
  assert.equal(await kind(page, "shaded").getAttribute("aria-pressed"), "true");
  await page.getByRole("button", { name: "Fit the pictures into the panes" }).click();
  await page.waitForURL((url) => !url.href.includes("zoom="));
  await page.getByText("Pictures", { exact: true }).click();
  await page.getByLabel("f2b", { exact: true }).uncheck();
  await page.waitForURL(/kept=/);
  await page.goto("about:blank");
  await open(page, tests.report_id(), "?mode=nothing&layout=9&shown=77&zoom=-3&at=x&kept=8");
  assert.equal(await kind(page, "color").getAttribute("aria-pressed"), "true", "what is unknown is ignored");
});

page_test("a click does not scroll the picture away, and the mark stays above the handle", {}, async (page) => {
  await open(page, tests.report_id(), "?layout=slider");
  const view = page.locator(".pane-view");
  await view.scrollIntoViewIfNeeded();
  const before = await view.boundingBox();
  assert.ok(before.width >= 900, "a slider that the address asks for is as large as one that is chosen");
  await page.mouse.click(before.x + before.width * 0.4, before.y + before.height * 0.5);
  await page.locator("table.pixel-stack").waitFor({ timeout: RENDER_MS });
  assert.deepEqual(await view.boundingBox(), before);
  const [mark, divider] = await page.evaluate(() =>
    [".pixel-mark", ".divider"].map((name) => Number(getComputedStyle(document.querySelector(name)).zIndex)),
  );
  assert.ok(mark > divider);
});

page_test("two fingers zoom about their middle", { hasTouch: true }, async (page) => {
  await open(page, tests.report_id(), "?layout=flip");
  const zoom = async () => parseInt(await page.locator(".zoom-value").textContent(), 10);
  const before = await zoom();
  const view = page.locator(".pane-view");
  await view.scrollIntoViewIfNeeded();
  const box = await view.boundingBox();
  const client = await page.context().newCDPSession(page);
  const touch = (type, ...xs) =>
    client.send("Input.dispatchTouchEvent", {
      type,
      touchPoints: xs.map((x, id) => ({ x: box.x + box.width * x, y: box.y + box.height / 2, id })),
    });
  await touch("touchStart", 0.45, 0.55);
  for (const spread of [0.1, 0.15, 0.2]) await touch("touchMove", 0.5 - spread, 0.5 + spread);
  await touch("touchEnd");
  const after = await zoom();
  assert.ok(after > before * 3 && after < before * 5, `${before} % to ${after} %`);
});

page_test("the self-contained file has the float pictures and the same tools", { origin: undefined }, async (page) => {
  const file = join(tests.folder(), "viewer.html");
  const address = `${tests.url()}/api/v1/reports/${tests.report_id()}/report.html`;
  writeFileSync(file, await (await fetch(address)).text());
  await page.context().setOffline(true);
  await page.goto(`file://${file}#?mode=difference&layout=flip&shown=4&pixel=50,30`);
  await page.locator(".pane-view").waitFor();
  await loaded(page);
  assert.equal(await kind(page, "difference").getAttribute("aria-pressed"), "true");
  await page.waitForFunction(() =>
    /1\.0000$/.test(document.querySelector('.values tr[data-source="0"] [data-kind=float]').textContent),
  );
  await page.keyboard.press("f");
  await page.keyboard.press("m");
  await page.waitForURL(/mode=flip/);
});
