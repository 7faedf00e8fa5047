// The fields of a spec that are the same for every scene and method, described as the service describes parameters.
// The service has the last word on their ranges.

export const IMAGE_FIELDS = [
  { name: "width", kind: "integer", unit: "px", default: 512, min: 1, max: 4096, summary: "" },
  { name: "height", kind: "integer", unit: "px", default: 512, min: 1, max: 4096, summary: "" },
  {
    name: "format",
    kind: "choice",
    default: "rgba8",
    choices: ["rgba8", "rgba16f", "rgba32f"],
    summary: "what the methods blend into",
  },
  { name: "background", kind: "numbers", default: [0, 0, 0], min: 0, max: 1, summary: "behind everything" },
];

export const TIMING_FIELDS = [
  { name: "warmup", kind: "integer", unit: "frames", default: 1, min: 1, max: 100, summary: "before timing" },
  { name: "rounds", kind: "integer", unit: "frames", default: 10, min: 1, max: 1000, summary: "timed, of each method" },
  {
    name: "max_seconds",
    kind: "number",
    unit: "s",
    default: 60,
    min: 0,
    max: 3600,
    summary: "no round begins after this",
  },
];

/** What a check may hold, named as in the report. */
export const CHECK_METRICS = [
  "flip.mean",
  "flip.p95",
  "flip.max",
  "rmse",
  "psnr",
  "ssim",
  "signed.mean_abs",
  "signed.min",
  "signed.max",
  "linear.rmse",
  "linear.max_abs",
  "over_backgrounds.rmse",
  "differing_pixels",
  "non_finite",
  "speedup",
  "timing.median",
  "timing.min",
  "timing.p95",
  "fragments.submitted",
  "fragments.shaded",
  "fragments.visible",
  "fragments.needed",
  "fragments.efficiency",
  "memory_bytes",
];

export const CHECK_BOUNDS = [
  { name: "min", kind: "number", default: null, summary: "" },
  { name: "max", kind: "number", default: null, summary: "" },
];
