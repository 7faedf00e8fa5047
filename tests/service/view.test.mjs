// `sheer view` on a virtual display, with the key and mouse events of a real keyboard and mouse (XTEST, by xdotool).
import assert from "node:assert/strict";
import { execFileSync, spawn, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { read_png } from "./png.mjs";
import { until } from "./service.mjs";

const folder = mkdtempSync(join(tmpdir(), "sheer-view-"));
let xvfb;
let env;

before(async () => {
  xvfb = spawn("Xvfb", ["-displayfd", "3", "-screen", "0", "1280x1024x24", "-noreset", "-nolisten", "tcp"], {
    stdio: ["ignore", "ignore", "ignore", "pipe"],
  });
  let display = "";
  xvfb.stdio[3].on("data", (text) => {
    display += text;
  });
  await until(() => display.endsWith("\n"), "Xvfb starts");
  env = { ...process.env, DISPLAY: `:${display.trim()}` };
});
after(() => {
  xvfb.kill();
  rmSync(folder, { recursive: true, force: true });
});

const xdotool = (...words) => execFileSync("xdotool", words.map(String), { env, encoding: "utf8" }).trim();

class View {
  async open(spec) {
    const path = join(folder, "spec.json");
    this.screenshot = join(folder, "view.png");
    rmSync(this.screenshot, { force: true });
    writeFileSync(path, JSON.stringify(spec));
    this.process = spawn(process.env.SHEER, ["view", path, "--screenshot", this.screenshot], { env });
    this.output = "";
    for (const stream of [this.process.stdout, this.process.stderr])
      stream.on("data", (text) => {
        this.output += text;
      });
    this.ended = new Promise((resolve) => this.process.on("exit", (code) => resolve(code)));
    await until(() => this.find() || this.process.exitCode !== null, "the window opens");
    assert.equal(this.process.exitCode, null, this.output);
    xdotool("windowfocus", "--sync", this.window);
    return this;
  }

  find() {
    const found = spawnSync("xdotool", ["search", "--onlyvisible", "--name", " ms"], { env, encoding: "utf8" });
    this.window = found.stdout.trim();
    return this.window !== "";
  }

  get title() {
    return xdotool("getwindowname", this.window);
  }

  titled(pattern) {
    return until(() => pattern.test(this.title), `the title is like ${pattern}, not ${this.title}`, 20);
  }

  async picture() {
    rmSync(this.screenshot, { force: true });
    const before_it = this.output.split("Wrote").length;
    xdotool("key", "p");
    await until(() => this.output.split("Wrote").length > before_it, "P writes a picture", 20);
    return read_png(this.screenshot);
  }

  async close() {
    if (this.process.exitCode === null) xdotool("key", "Escape");
    return this.ended;
  }
}

async function with_view(spec, body) {
  const view = new View();
  try {
    await view.open(spec);
    await body(view);
    assert.equal(await view.close(), 0, view.output);
  } finally {
    view.process.kill("SIGKILL");
  }
}

const layer = (depth, color) => ({ rect: [0, 0, 1, 1], depth, color, alpha: 0.5 });
const LAYERS = {
  image: { width: 300, height: 200 },
  // Red in front of green; drawn in the order of submission, green would be over red.
  scene: { type: "layers", layers: [layer(0.25, [1, 0, 0]), layer(0.75, [0, 1, 0])] },
  methods: ["b2f", "unsorted", { id: "f2bd", threshold: 0.5 }],
};
// Half of red, a quarter of green; the other way round; and green discarded if less than 0.625 is left.
const [SORTED, UNSORTED, DISCARDED] = [
  [128, 64, 0],
  [64, 128, 0],
  [128, 0, 0],
];

function assert_color(picture, x, y, color, what) {
  const actual = picture.pixel(x, y);
  assert.ok(
    actual.every((value, i) => Math.abs(value - color[i]) <= 1),
    `${what}: ${actual} for ${color} at ${x}, ${y}`,
  );
}

test("keys choose the method and its threshold", () =>
  with_view(LAYERS, async (view) => {
    await view.titled(/^b2f: [\d.]+ ms - Sheer$/);
    const first = await view.picture();
    assert.deepEqual([first.width, first.height], [300, 200]);
    for (const [x, y] of [
      [0, 0],
      [299, 0],
      [150, 100],
      [0, 199],
      [299, 199],
    ])
      assert_color(first, x, y, SORTED, "b2f");
    xdotool("key", "2");
    await view.titled(/^unsorted: [\d.]+ ms/);
    assert_color(await view.picture(), 150, 100, UNSORTED, "unsorted");
    xdotool("key", "3");
    await view.titled(/^f2bd: [\d.]+ ms, threshold 0\.5 /);
    assert_color(await view.picture(), 150, 100, SORTED, "f2bd");
    xdotool("key", "plus");
    await view.titled(/threshold 0\.625 /);
    assert_color(await view.picture(), 150, 100, DISCARDED, "f2bd with a higher threshold");
    xdotool("key", "Down");
    await view.titled(/threshold 0\.5 /);
    xdotool("key", "minus");
    await view.titled(/threshold 0\.4 /);
    xdotool("key", "0");
    await view.titled(/^exact: /);
    xdotool("key", "9");
    xdotool("key", "h");
    await until(() => view.output.includes("two methods side by side"), "H lists the keys");
    assert.match(view.title, /^exact: /);
  }));

test("the screen is split at the mouse", () =>
  with_view(LAYERS, async (view) => {
    xdotool("mousemove", "--window", view.window, 100, 50);
    xdotool("key", "s");
    await view.titled(/^b2f: [\d.]+ ms \| unsorted: [\d.]+ ms - Sheer$/);
    const first = await view.picture();
    assert_color(first, 97, 10, SORTED, "left of the border");
    assert_color(first, 100, 150, [255, 255, 255], "the border");
    assert_color(first, 103, 190, UNSORTED, "right of the border");
    xdotool("mousemove", "--window", view.window, 200, 50);
    xdotool("key", "shift+2", "key", "1");
    await view.titled(/^unsorted: .* \| b2f: /);
    const second = await view.picture();
    assert_color(second, 197, 100, UNSORTED, "left of the border");
    assert_color(second, 203, 100, SORTED, "right of the border");
    xdotool("key", "s");
    await view.titled(/^unsorted: [\d.]+ ms - Sheer$/);
  }));

test("a method that fails leaves the others on the screen", () =>
  with_view(
    {
      image: { width: 300, height: 200, background: [0, 0, 0] },
      // Planes of leaves intersect, which this form of exact does not support.
      scene: { type: "foliage", trees: 1, planes_per_tree: 20, seed: 2, texture: { size: 32 } },
      methods: ["b2f", { id: "exact", form: "sorted", label: "sorted" }, { id: "f2bd", threshold: 0.5 }],
    },
    async (view) => {
      const surround = [26, 26, 26];
      await view.titled(/^b2f: [\d.]+ ms - Sheer$/);
      const alone = await view.picture();
      xdotool("key", "2");
      await view.titled(/^sorted: not supported here: form sorted needs parallel primitives.* - Sheer$/);
      const failed = await view.picture();
      for (const [x, y] of [
        [0, 0],
        [150, 100],
        [299, 199],
      ])
        assert_color(failed, x, y, surround, "no picture");
      assert.match(view.output, /sorted: not supported here: form sorted needs parallel primitives/);
      // Beside it on a split screen, with a key that changes both sides, and after it.
      xdotool("mousemove", "--window", view.window, 100, 50);
      xdotool("key", "s", "3");
      await view.titled(/^sorted: not supported here: .* \| f2bd: [\d.]+ ms, threshold 0\.5 - Sheer$/);
      xdotool("key", "plus");
      await view.titled(/^sorted: not supported here: .* \| f2bd: [\d.]+ ms, threshold 0\.625 /);
      xdotool("key", "1");
      await view.titled(/^sorted: not supported here: .* \| b2f: [\d.]+ ms - Sheer$/);
      const beside = await view.picture();
      for (let y = 0; y < 200; y += 7) {
        for (const x of [0, 50, 97]) assert_color(beside, x, y, surround, "left of the border");
        for (const x of [103, 160, 299]) assert_color(beside, x, y, alone.pixel(x, y), "right of the border");
      }
      xdotool("key", "shift+1", "s");
      await view.titled(/^b2f: [\d.]+ ms - Sheer$/);
      assert.deepEqual((await view.picture()).bytes, alone.bytes);
    },
  ));

test("the mouse moves the camera around the scene and closer", () =>
  with_view(
    {
      image: { width: 240, height: 200, background: [0.5, 0.6, 0.7] },
      scene: { type: "foliage", trees: 1, planes_per_tree: 60, seed: 2, texture: { size: 32 } },
      methods: ["b2f"],
    },
    async (view) => {
      const background = (picture) => {
        let count = 0;
        for (let i = 0; i < picture.bytes.length; i += 3)
          count += picture.bytes[i] === 128 && picture.bytes[i + 1] === 153;
        return count / (picture.width * picture.height);
      };
      const first = await view.picture();
      assert.ok(background(first) > 0.2 && background(first) < 0.9, `background ${background(first)}`);
      xdotool(
        "mousemove",
        "--window",
        view.window,
        60,
        100,
        "mousedown",
        1,
        "mousemove",
        "--window",
        view.window,
        120,
        120,
        "mouseup",
        1,
      );
      const turned = await view.picture();
      assert.notDeepEqual(turned.bytes, first.bytes);
      xdotool("mousemove", "--window", view.window, 20, 20);
      assert.deepEqual((await view.picture()).bytes, turned.bytes, "nothing turns without a button");
      xdotool("key", "r");
      assert.deepEqual((await view.picture()).bytes, first.bytes, "R resets the camera");
      for (let i = 0; i < 5; ++i) xdotool("click", 4);
      assert.ok(background(await view.picture()) < background(first) - 0.1, "the wheel moves closer");
    },
  ));

test("the last picture is saved", async () => {
  const view = await new View().open(LAYERS);
  xdotool("key", "2");
  await view.titled(/^unsorted/);
  assert.equal(await view.close(), 0, view.output);
  assert_color(read_png(view.screenshot), 20, 30, UNSORTED, "unsorted");
});

test("without a display it says so", () => {
  const { DISPLAY, WAYLAND_DISPLAY, ...without } = process.env;
  const path = join(folder, "spec.json");
  writeFileSync(path, JSON.stringify(LAYERS));
  const ended = spawnSync(process.env.SHEER, ["view", path], { env: without, encoding: "utf8" });
  assert.equal(ended.status, 3);
  assert.match(ended.stderr, /GLFW cannot start: .*DISPLAY/);
  writeFileSync(path, readFileSync(path, "utf8").replace("b2f", "nothing"));
  const wrong = spawnSync(process.env.SHEER, ["view", path], { env: without, encoding: "utf8" });
  assert.equal(wrong.status, 2);
  assert.match(wrong.stderr, /spec\.json is wrong:\n\/methods\/0: /);
});
