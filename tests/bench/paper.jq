# Makes docs/results/paper-tables.md from the suites' reports: a column for each device, in the order of the input.
def shown: if . == null then "-" elif type == "array" then map(shown) | join(" to ")
    elif (. | fabs) >= 100 then round | tostring else . * 1000 | round / 1000 | tostring end;
def place: to_entries | map("\(.key | sub(".*/"; "")) \(.value)") | join(", ");
def cells: "| " + join(" | ") + " |";
# "llvmpipe (LLVM 15.0.6, 256 bits)" becomes llvmpipe in the heading of a column.
def short: .device.renderer | sub(" *[(/].*"; "");
"# The paper's tables, measured

Made by `./dev paper` from the seven suites; [paper.md](paper.md) explains them. Speedups are over `b2f` of the same rounds,
with a 95 % interval that is corrected for the number of methods.

- Published on: \(.[0].suite.device)",
(reduce .[] as $report ([]; if any(.[]; .device == $report.device) then . else . + [$report] end)
    | .[] | "- \(short): \(.device.renderer), \(.device.gl_version), \(.device.context) context; sheer \(.provenance.version), commit \(.provenance.commit)"),
(group_by(.suite.id)[] | . as $reports | .[0].suite as $suite
| "
## \($suite.id | sub("paper-table-"; "Table ")): \($suite.title | ascii_downcase)
",
(.[] | [.runs[].rounds.done] as $rounds
    | "- \(short): \(.spec.image.width) x \(.spec.image.height) pixels, \([$rounds | min, max] | unique | map(tostring) | join(" to ")) rounds per point. `\(.provenance.rerun)`"),
"",
(["at", "method", "figure", "published"] + map("\(short)", "95 %") | cells, (map("---") | cells)),
(range($suite.figures | length) as $i | $suite.figures[$i]
    | [(.at | place), "`\(.method)`", .metric, (.published | shown)]
      + ($reports | map(.suite.figures[$i] | (.measured | shown), (if .ci95 then .ci95 | shown else "" end))) | cells),
"",
(range($suite.trends | length) as $i | $suite.trends[$i].text as $text | $reports
    | if length == 1 then .[0].suite.trends[$i] | "- **\(.verdict)**: \(.text). (\(.detail))"
      else "- \($text).", (.[] | "  - \(short): **\(.suite.trends[$i].verdict)**. (\(.suite.trends[$i].detail))") end))
