// Ready comparisons to start from.

export const PRESETS = [
  {
    name: "Quick look",
    summary: "64 random quads, 256 × 256, a few seconds",
    spec: {
      title: "Quick look: 64 random quads",
      image: { width: 256, height: 256 },
      scene: { type: "quads", count: 64, shading: "1-texture", texture: { size: 256 } },
      methods: ["b2f", "f2b", { id: "f2bd", threshold: 0.1, label: "F2BD 0.1" }, "unsorted"],
      baseline: "b2f",
      timing: { rounds: 10, max_seconds: 20 },
    },
  },
  {
    name: "Paper, 1024 quads",
    summary: "the SCCG 2010 measurement scene with its three methods and the bound",
    spec: {
      title: "F2BD against B2F, 1024 random quads",
      scene: { type: "quads", distribution: "random", count: 1024, shading: "4x4-textures" },
      methods: ["b2f", "f2b", { id: "f2bd", threshold: 0.01, label: "F2BD 0.01" }, "f2bx"],
      baseline: "b2f",
      checks: [
        { metric: "flip.mean", method: "F2BD 0.01", max: 0.05 },
        { metric: "speedup", method: "F2BD 0.01", min: 1.2 },
      ],
    },
  },
  {
    name: "Layers by hand",
    summary: "three layers whose picture can be worked out on paper",
    spec: {
      title: "Three layers by hand",
      image: { width: 128, height: 128 },
      scene: {
        type: "layers",
        layers: [
          { rect: [0.1, 0.1, 0.7, 0.7], depth: 0.5, color: [1, 0.2, 0.1], alpha: 0.5 },
          { rect: [0.3, 0.3, 0.9, 0.9], depth: 0.25, color: [0.1, 0.6, 1], alpha: 0.5 },
          { rect: [0.2, 0.45, 0.8, 0.55], depth: 0.75, color: [1, 1, 1], alpha: 0.8 },
        ],
      },
      methods: ["b2f", "f2b", { id: "f2bd", threshold: 0 }, "unsorted"],
      baseline: "b2f",
      timing: { rounds: 10 },
    },
  },
];

const id_of = (method) => (typeof method === "string" ? method : method.id);

/** Those that this service can render, without the methods that it lacks. */
export function presets_for(methods, scenes) {
  const known = new Set(methods.map((method) => method.id));
  return PRESETS.filter((preset) => scenes.some((scene) => scene.id === preset.spec.scene.type))
    .map((preset) => {
      const kept = preset.spec.methods.filter((method) => known.has(id_of(method)));
      const names = new Set(kept.map((method) => method.label ?? id_of(method)));
      const checks = preset.spec.checks?.filter((check) => names.has(check.method));
      const spec = { ...preset.spec, methods: kept, ...(checks?.length ? { checks } : {}) };
      if (!names.has(spec.baseline)) delete spec.baseline;
      return { ...preset, spec };
    })
    .filter((preset) => preset.spec.methods.length > 0);
}
