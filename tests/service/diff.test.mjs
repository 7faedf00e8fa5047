// Two reports compared with each other, on the command line and over HTTP.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { copyFileSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { QUICK, lasting, with_service } from "./service.mjs";

const folder = mkdtempSync(join(tmpdir(), "sheer-diff-"));
after(() => rmSync(folder, { recursive: true, force: true }));

const sheer = (...words) => spawnSync(process.env.SHEER, words, { encoding: "utf8" });
const report_in = (name) => JSON.parse(readFileSync(join(folder, name, "report.json"), "utf8"));
const with_layer = (more) => ({ ...QUICK, scene: { type: "layers", layers: [{ ...QUICK.scene.layers[0], ...more }] } });

/** Renders into a folder with this name. */
function compare(name, spec) {
  writeFileSync(join(folder, `${name}.json`), JSON.stringify(spec));
  const run = sheer("compare", join(folder, `${name}.json`), "--out", join(folder, name));
  assert.equal(run.status, 0, run.stderr);
}

function diff(a, b, ...words) {
  return sheer("diff", join(folder, a), join(folder, b), ...words);
}

function edit(name, change) {
  const report = report_in(name);
  change(report);
  writeFileSync(join(folder, name, "report.json"), JSON.stringify(report));
}

test("the same spec again changes nothing", () => {
  compare("a", { ...QUICK, timing: { warmup: 1, rounds: 6 } });
  compare("again", { ...QUICK, timing: { warmup: 1, rounds: 7 } });
  const table = diff("a", "again/report.json");
  assert.equal(table.status, 0, table.stderr + table.stdout);
  assert.match(table.stdout, /\/spec\/timing\/rounds: 6 \| 7\n/);
  assert.match(table.stdout, /^Pictures: 3 identical, 0 different, 0 not examined\./m);
  const json = JSON.parse(diff("a", "again", "--json").stdout);
  assert.deepEqual(
    json.runs[0].results.map((result) => result.label),
    ["b2f", "f2b"],
  );
  assert.equal(json.same_device, true);
  assert.equal(json.runs[0].reference.picture.linear, "identical");
  assert.equal(json.runs[0].results[1].time.b.samples, 7);
});

test("a changed picture and a changed time fail the check", () => {
  compare("blue", with_layer({ color: [0, 0, 1] }));
  compare("b", { ...QUICK, timing: { warmup: 1, rounds: 6 } });
  const blue = report_in("blue").runs[0].results[1].images.color;
  copyFileSync(join(folder, "blue", blue.url), join(folder, "b", "images", "blue.png"));
  edit("b", (report) => {
    report.runs[0].results[1].images.color = { ...blue, url: "images/blue.png" };
  });
  const out = join(folder, "out");
  const run = diff("a", "b", "--json", "--out", out);
  assert.equal(run.status, 1, run.stderr);
  const { picture } = JSON.parse(run.stdout).runs[0].results[1];
  // Half of red compared with half of blue, over black: 128 levels in two channels of all 16 x 16 pixels.
  assert.equal(picture.verdict, "different");
  assert.equal(picture.differing_pixels, 256);
  assert.ok(Math.abs(picture.greatest_levels - 128) <= 1, `${picture.greatest_levels}`);
  assert.ok(picture.flip.mean > 0.5, `${picture.flip.mean}`);
  assert.equal(readFileSync(join(out, picture.flip_picture.url)).subarray(1, 4).toString(), "PNG");
  assert.deepEqual(JSON.parse(readFileSync(join(out, "diff.json"), "utf8")), JSON.parse(run.stdout));
  assert.equal(diff("a", "b", "--out", out).status, 1, "a diff may overwrite another one");

  for (const name of ["a", "again"]) {
    edit(name, (report) => {
      const [base, method] = report.runs[0].results;
      report.runs[0].noise_floor.factor = 1.1;
      base.timing.samples = [10, 10.1, 10.2, 10.3, 10.4, 10.5];
      method.timing.samples = base.timing.samples.map((ms) => (name === "a" ? ms : 1.5 * ms));
    });
  }
  const slower = diff("a", "again");
  assert.equal(slower.status, 1, slower.stdout);
  assert.match(slower.stdout, /^f2b .* slower$/m);
  assert.equal(diff("again", "a").status, 0, "faster is not worse");
});

test("reports that cannot be compared give an error and leave nothing", () => {
  compare("wide", { ...QUICK, image: { width: 32, height: 16 } });
  const out = join(folder, "never");
  const refused = (words, pattern) => {
    const run = sheer("diff", ...words, "--out", out);
    assert.equal(run.status, 2, run.stdout);
    assert.match(run.stderr, pattern);
    assert.equal(existsSync(out), false);
  };
  const at = (name) => join(folder, name);
  refused([at("a"), at("wide")], /\/spec\/image\/width: is 16 in one report and 32 in the other/);
  refused([at("a"), at("blue")], /\/spec\/scene\/layers\/0\/color/);
  refused([at("a"), at("nowhere")], /cannot read .*nowhere/);
  refused([at("a"), at("a.json")], /is not a report/);
  writeFileSync(at("text"), "no JSON");
  refused([at("a"), at("text")], /is not JSON/);
  edit("wide", (report) => {
    delete report.runs[0].results;
    report.spec.image.width = 16;
  });
  refused([at("a"), at("wide")], /^sheer: .*wide\/report\.json is not a report: \/runs\/0\/results is missing$/m);
  edit("wide", (report) => {
    report.runs[0].results = [{ status: 3 }];
  });
  refused(
    [at("a"), at("wide")],
    /wide\/report\.json is not a report: \/runs\/0\/results\/0\/status must be a string, not 3$/m,
  );
  rmSync(join(at("b"), "images", "blue.png"));
  refused([at("a"), at("b")], /cannot read .*blue\.png/);
  assert.equal(sheer("diff", at("a")).status, 2);
  writeFileSync(at("diff.json"), "mine");
  assert.equal(sheer("diff", at("a"), at("a"), "--out", at("")).status, 2, "a file that is not Sheer's is left alone");
  assert.equal(readFileSync(at("diff.json"), "utf8"), "mine");
  const report = sheer("diff", at("a"), at("a"), "--out", at("a"));
  assert.equal(report.status, 2, "and so is a report");
  assert.match(report.stderr, /contains a report\.json of Sheer's/);
  assert.ok(existsSync(at("a/report.json")));
});

test("fields that may differ are allowed by their pointers", () => {
  compare("pale", with_layer({ color: [0, 0, 1], alpha: 0.25 }));
  const offer = diff("a", "pale");
  assert.equal(offer.status, 2);
  assert.match(offer.stderr, /^\/spec\/scene\/layers\/0\/alpha: is 0\.5 in one report and 0\.25 in the other$/m);
  const [, words] = /^to compare them nevertheless: (.*)$/m.exec(offer.stderr);
  assert.equal(words, "--allow /scene/layers/0/alpha --allow /scene/layers/0/color");
  const allowed = diff("a", "pale", ...words.split(" "));
  assert.equal(allowed.status, 1, "the pictures differ");
  assert.match(allowed.stdout, /^\/spec\/scene\/layers\/0\/alpha \(allowed\): 0\.5 \| 0\.25$/m);
  const { differences, runs } = JSON.parse(diff("a", "pale", "--json", "--allow", "/scene").stdout);
  assert.deepEqual(
    differences.filter((one) => one.allowed).map((one) => one.pointer),
    ["/spec/scene/layers/0/alpha", "/spec/scene/layers/0/color"],
  );
  // Half of red compared with a quarter of blue, over black: 128 levels less red, in all 16 x 16 pixels.
  const { picture } = runs[0].results[1];
  assert.equal(picture.differing_pixels, 256);
  assert.ok(Math.abs(picture.greatest_levels - 128) <= 1, `${picture.greatest_levels}`);
  const half = diff("a", "pale", "--allow", "/scene/layers/0/color");
  assert.equal(half.status, 2);
  assert.match(half.stderr, /^to compare them nevertheless: --allow \/scene\/layers\/0\/alpha$/m);
  const no_pointer = diff("a", "pale", "--allow", "scene");
  assert.equal(no_pointer.status, 2);
  assert.match(no_pointer.stderr, /"scene" is not a JSON pointer/);
  compare("wider", { ...QUICK, image: { width: 32, height: 16 } });
  const wider = diff("a", "wider", "--allow", "/image");
  assert.equal(wider.status, 2);
  assert.match(wider.stderr, /pictures of different sizes cannot be compared, even if that is allowed/);
  assert.doesNotMatch(wider.stderr, /nevertheless/);
});

test("over HTTP", async () => {
  await with_service({}, async (service) => {
    const ids = [];
    for (const spec of [QUICK, { ...QUICK, title: "again" }, with_layer({ alpha: 0.25 })]) {
      ids.push((await service.settled(await service.submit(spec))).id);
    }
    const ask = async (a, query, status) => {
      const response = await fetch(`${service.api}/reports/${a}/diff${query}`);
      const body = await response.json();
      assert.equal(response.status, status, JSON.stringify(body));
      return body;
    };
    const same = await ask(ids[0], `?against=${ids[1]}`, 200);
    assert.equal(same.b.id, ids[1]);
    assert.deepEqual(
      same.differences.find((one) => one.pointer === "/spec/title"),
      { pointer: "/spec/title", a: QUICK.title, b: "again" },
    );
    assert.equal(same.summary.pictures.identical, 3);
    assert.equal((await ask(ids[0], `?against=${ids[1]}&run=0`, 200)).runs.length, 1);
    assert.deepEqual(
      (await ask(ids[0], `?against=${ids[1]}&run=1`, 422)).errors.map((error) => error.pointer),
      ["/run"],
    );
    assert.deepEqual(
      (await ask(ids[0], `?against=${ids[2]}`, 422)).errors.map((error) => error.pointer),
      ["/spec/scene/layers/0/alpha"],
    );
    const refused = await ask(ids[0], `?against=${ids[2]}`, 422);
    assert.equal(
      refused.detail,
      "The reports cannot be compared with each other; to compare them nevertheless, " + "allow /scene/layers/0/alpha",
    );
    assert.deepEqual(refused.allow, ["/scene/layers/0/alpha"]);
    for (const allow of [...refused.allow, "/scene", "/methods/1/threshold,/scene/layers"]) {
      const allowed = await ask(ids[0], `?${new URLSearchParams({ against: ids[2], allow })}`, 200);
      assert.deepEqual(
        allowed.differences.filter((one) => one.allowed),
        [{ pointer: "/spec/scene/layers/0/alpha", a: 0.5, b: 0.25, allowed: true }],
        allow,
      );
      assert.deepEqual(allowed.summary.pictures, { identical: 0, different: 3, "not examined": 0 });
    }
    const of_run = await ask(ids[0], `?against=${ids[2]}&run=0&allow=/scene`, 200);
    assert.match(of_run.runs[0].results[0].picture.flip_picture.url, /^data:image\/png/);
    const wrong = await ask(ids[0], `?against=${ids[2]}&allow=/scene,scene`, 422);
    assert.deepEqual(
      wrong.errors.map((error) => error.pointer),
      ["/allow"],
    );
    assert.match(wrong.errors[0].detail, /^"scene" is not a JSON pointer/);
    await ask(ids[0], `?against=${ids[2]}&allow=/${"a".repeat(4000)}`, 400);
    const taller = (await service.settled(await service.submit({ ...QUICK, image: { width: 16, height: 32 } }))).id;
    const other_size = await ask(ids[0], `?against=${taller}&allow=/image`, 422);
    assert.deepEqual(
      other_size.errors.map((error) => error.pointer),
      ["/spec/image/height"],
    );
    assert.match(other_size.errors[0].detail, /pictures of different sizes cannot be compared/);
    assert.equal(other_size.detail, "The reports cannot be compared with each other.");
    assert.equal(other_size.allow, undefined);
    await ask("nothing", `?against=${ids[0]}`, 404);
    await ask(ids[0], "?against=nothing", 404);
    assert.deepEqual(
      (await ask(ids[0], "", 400)).errors.map((error) => error.pointer),
      ["/against"],
    );
    await ask(ids[0], `?against=${ids[1]}&run=-1`, 400);
    const running = await service.submit(lasting(30));
    await ask(ids[0], `?against=${running}`, 409);
    await ask(running, `?against=${ids[0]}`, 409);
    await fetch(`${service.api}/reports/${running}`, { method: "DELETE" });
    await service.settled(running);
  });
});

test("tolerances say what counts as worse", () => {
  compare("red", QUICK);
  compare("darker", with_layer({ color: [0.98, 0, 0] }));
  const allowed = ["--allow", "/scene/layers/0/color"];
  const strict = diff("red", "darker", ...allowed);
  assert.equal(strict.status, 1);
  assert.match(strict.stdout, /^WORSE {2}b2f: its picture differs by a mean FLIP of 0\.\d+, at most 0$/m);
  const mean = JSON.parse(diff("red", "darker", ...allowed, "--json").stdout).runs[0].results[0].picture.flip.mean;
  assert.ok(mean > 0 && mean < 0.5, `${mean}`);
  const tolerant = diff("red", "darker", ...allowed, "--max-flip", `${mean * 1.01}`, "--max-slowdown", "50");
  assert.equal(tolerant.status, 0, tolerant.stdout);
  assert.doesNotMatch(tolerant.stdout, /WORSE/);
  assert.equal(diff("red", "darker", ...allowed, "--max-flip", `${mean * 0.99}`).status, 1);
  for (const wrong of [
    ["--max-flip", "2"],
    ["--max-slowdown", "0.5"],
  ])
    assert.equal(diff("red", "darker", ...wrong).status, 2);
});
