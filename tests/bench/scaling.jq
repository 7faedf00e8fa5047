# Makes docs/results/scaling.md from the reports of the suites scaling-*.
def cells: "| " + join(" | ") + " |";
def fixed: . * 100 | round / 100 | tostring | if test("\\.") then . + (if test("\\.\\d$") then "0" else "" end) else . + ".00" end;
def law: if . == null then "-" else "\(.exponent | fixed) [\(.ci95[0] | fixed), \(.ci95[1] | fixed)]" end;
def size: if . == null then "-" elif . < 1048576 then "\(. / 1024 | round) KiB" else "\(. / 1048576 | round) MiB" end;
def time: if . == null then "-" elif . >= 100 then round | tostring else . * 10 | round / 10 | tostring end;
def axis: .spec.sweep[0] | if .points then [.points[] | .["/image/width"]] else .values end;
def result($run; $label): .runs[$run].results[]? | select(.label == $label);
"# How time and memory grow

Made by `./dev scaling` from the suites `scaling-primitives`, `scaling-resolution` and `scaling-layers`. The exponent p is that of the
power law n^p that fits the medians of the points best, with an interval of 95 % that includes how badly a power law fits: where a
fixed cost prevails at first, as in the first column of times, p is smaller than in the end.

\(.[0] | "Device: \(.device.renderer), \(.device.driver); sheer \(.provenance.version), commit \(.provenance.commit).")",
(.[] | . as $report | (.runs | length - 1) as $last | axis as $axis
| "
## \(.suite.title)
\(.suite.source): \($axis[0]) to \($axis[-1]), \(.spec.image.width) x \(.spec.image.height) pixels\(if .spec.sweep[0].points then " at first" else "" end).
",
(["method", "time: p [95 %]", "memory: p [95 %]", "ms at \($axis[0])", "ms at \($axis[$last])", "memory at \($axis[$last])"] | cells, (map("---") | cells)),
(.spec.methods[].label as $label
    | [.growth[] | select(.method == $label)] as $laws
    | ["`\($label)`",
       ($laws | map(select(.metric == "timing.median")) | first | law),
       ($laws | map(select(.metric == "memory_bytes")) | first | law),
       (result(0; $label) | .timing.median | time),
       (result($last; $label) | if .status == "ok" then .timing.median | time else .status end),
       (result($last; $label) | .memory_bytes | size)] | cells))
