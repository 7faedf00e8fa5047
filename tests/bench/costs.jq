# Google Benchmark's JSON to docs/results/costs.md. Times are medians of the repetitions; ratios are of one run.
def rounded: if . >= 100 then round elif . >= 1 then . * 10 | round / 10 else . * 1000 | round / 1000 end;
(.context.num_cpus) as $cores
| [.benchmarks[] | select(.aggregate_name == "median")] as $all
| def ms($name): first($all[] | select(.run_name | startswith($name)) | .real_time);
def row($name; $key; $size; $yardstick):
    ms($key + "/" + $size) as $ms
    | "| \($name) | \($size | sub("/"; " x ")) | \($ms | rounded) | \($ms / ms($yardstick + "/" + $size) | rounded) |";
first($all[] | select(.run_name | startswith("job/"))) as $job
| ms("metric/flip/1920/1080") as $flip | ms("metric/ssim/1920/1080") as $ssim
| "# The cost of Sheer's own work

Made by `./dev bench` (\($cores) cores of \(.context.mhz_per_cpu) MHz, load \(.context.load_avg[0] | rounded) at the start, medians of 5 interleaved
repetitions). Times are valid only for this machine and load; the ratios are valid on others too.

## Pictures

The unit is reading every value of both pictures once on one core.

| work | size | ms | in units |
|---|---|---|---|",
(("512/512", "1920/1080") as $size
| row("reading both pictures"; "read_both"; $size; "read_both"),
  row("FLIP with its map"; "metric/flip"; $size; "read_both"),
  row("SSIM"; "metric/ssim"; $size; "read_both"),
  row("every metric"; "every_metric"; $size; "read_both"),
  row("PNG"; "png"; $size; "read_both"),
  row("EXR"; "exr"; $size; "read_both")),
"
NVIDIA's reference tool takes 700 to 820 ms for FLIP of 1920 x 1080 on both cores of such a machine: FLIP here takes
\(100 * $flip / 700 | rounded) to \(100 * $flip / 820 | rounded) % of that, SSIM \(100 * $ssim / 700 | rounded) to \(100 * $ssim / 820 | rounded) %.

## Frames

Quads with 4x4 textures, random, 256 x 256 pixels in 32-bit floats; the unit is a frame of `b2f` with as many quads.

| work | quads | ms | in units |
|---|---|---|---|",
(("64", "512") as $count
| row("`b2f`"; "frame/b2f"; $count; "frame/b2f"),
  row("`exact` by lists, the whole frame"; "frame/exact"; $count; "frame/b2f"),
  row("`exact`, sorting and resolving the lists"; "frame/list_resolve"; $count; "frame/b2f")),
(("64", "512", "16384") as $count | "| sorting the primitives in three orders, and upload | \($count) | \(ms("sort_and_upload/" + $count) | rounded) | |"),
"
## A whole job

Four methods, 384 x 384 pixels, 256 quads, timed for up to 3 s, from the spec to the committed report with all its pictures:
\($job.real_time / 1000 | rounded) s, of which \($job.not_rendering_percent | rounded) % is not rendering (metrics, encoding, hashing, commit)."
