# Makes a page of docs/results/choosing from reports of every method, one for each scene, all from one device.
# Takes $methods, the output of `sheer methods --json`.
def shown: if . == null then "-" elif . >= 100 then round | tostring elif . >= 10 then . * 10 | round / 10 | tostring
    else . * 100 | round / 100 | tostring end;
def error: if . == null then "-" else . * 10000 | round / 10000 | tostring end;
def cells: "| " + join(" | ") + " |";
def scene: {gltf: "glass"}[.spec.scene.type] // .spec.scene.type;
def rank: {quads: 0, gltf: 1, foliage: 2, particles: 3, volume: 4}[.spec.scene.type];
def size: "\(.spec.image.width) x \(.spec.image.height)";
($methods | map({(.id): .needs_sorting}) | add) as $sorts
| sort_by(rank) | . as $reports
| "# Every method on the ready scenes: \(.[0].device.renderer)

Made by `./dev choosing`; [which method when](../../choosing.md) draws the conclusions. For each scene: a frame's time as a multiple of
`b2f`'s in the same rounds, without sorting, and the mean FLIP error to `exact`. Memory is what the method itself allocates, in bytes for
each pixel of the picture of the first scene.
",
(.[] | "- \(scene): \(.spec.title), \(size) pixels, \(.runs[0].rounds.done) rounds"),
"",
(["method", "sorts", "memory"] + (map([scene, "FLIP"]) | add) | cells, (map("---") | cells)),
(.[0].runs[0].results[] | .label as $name | select($name == .method)
    | ["`\($name)`", (if $sorts[.method] then "yes" else "no" end),
       (if .memory_bytes then .memory_bytes / ($reports[0].spec.image | .width * .height) else null end | shown)]
      + ($reports | map(first((.runs[0].results[] | select(.label == $name)), {status: "left out"})
            | if .status == "ok" then [(if .speedup.value then 1 / .speedup.value | shown else "-" end), (.metrics.flip.mean | error)]
              else [.status, ""] end) | add)
    | cells)
