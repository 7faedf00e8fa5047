// A team's gate, over REST alone: main has an accepted report, and pull requests are judged against it, in which the old
// and the new shader are timed side by side. SHEER_GATE_REPEATS repeats it.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Service } from "./service.mjs";

const REPEATS = Number(process.env.SHEER_GATE_REPEATS ?? 1);
const service = new Service();
before(() => service.start());
after(() => service.end_well());

/** A shading whose time is that of its loop, and whose picture `factor` darkens. */
const shading = (iterations, factor) => ({
  glsl: `vec3 c = tint.rgb;
for (int i = 0; i < ${iterations}; ++i) c = fract(c * 1.7 + 0.13);
return vec4(mix(tint.rgb, c, 0.001) * ${factor.toFixed(2)}, tint.a);`,
});
const MAIN = shading(200, 1);

/** Of main if `change` is what main has. */
const spec_of = (title, change) => ({
  title,
  image: { width: 128, height: 128 },
  scene: { type: "quads", count: 24, shading: MAIN },
  methods: ["b2f", "f2b", { id: "f2b", label: "new", shading: change }],
  timing: { warmup: 1, rounds: 12, max_seconds: 45 },
  checks: [
    { metric: "change.speedup", method: "new", min: 0.9 },
    { metric: "change.flip.mean", method: "new", max: 0.005 },
  ],
  against: "baseline:main",
  under_test: ["/methods/2/shading/glsl"],
  // Times are compared within the report, where both shaders share the state of the machine.
  tolerance: { max_flip: 0.005, max_slowdown: 1000 },
});

async function finished(spec) {
  const response = await service.post(spec, { Prefer: "wait=120" });
  assert.equal(response.status, 200, await response.clone().text());
  const report = await response.json();
  assert.equal(report.status, "done", service.log);
  const text = async (name) => (await fetch(`${service.api}/reports/${report.id}/${name}`)).text();
  return { ...report, junit: await text("junit.xml"), summary: await text("summary.md") };
}

test("a team's pull requests fail, fail and pass with their reasons", { timeout: 3_600_000 }, async () => {
  const main = await finished(spec_of("main", MAIN));
  await fetch(`${service.api}/baselines/main`, {
    method: "PUT",
    body: JSON.stringify({ report: main.id, by: "ada", reason: "the first" }),
    headers: { "Content-Type": "application/json" },
  });
  for (let i = 0; i < REPEATS; ++i) {
    // 30 % slower is a speed of 0.77, well under 0.9.
    const slower = await finished(spec_of("slower", shading(266, 1)));
    assert.equal(slower.verdict, "failed", JSON.stringify(slower.checks));
    assert.match(slower.junit, /name="change\.speedup of new">\s*<failure message="is 0\.\d+, wanted at least 0\.9"/);
    assert.match(slower.summary, /^### Sheer: failed: slower\n/);
    assert.match(slower.summary, /\| failed \| change\.speedup of new \| 0\.\d+ \| at least 0\.9 \|/);

    const darker = await finished(spec_of("darker", shading(200, 0.8)));
    assert.equal(darker.verdict, "failed", JSON.stringify(darker.checks));
    assert.match(darker.junit, /name="change\.flip\.mean of new">\s*<failure/);
    assert.match(darker.junit, /name="against\.flip\.mean of new">\s*<failure/);
    assert.match(darker.summary, /\| failed \| against\.flip\.mean of new \|/);

    const same = await finished(spec_of("same", MAIN));
    assert.equal(same.verdict, "passed", JSON.stringify(same.checks));
    assert.equal(same.against.report, main.id);
    assert.match(same.summary, new RegExp(`compared with ${main.id} of main, accepted \\S+ minutes? ago by ada`));
  }
});
