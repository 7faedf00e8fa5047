# The reports of the suites, in their order, to docs/results/paper-tables.md.
def shown: if . == null then "-" elif type == "array" then map(shown) | join(" to ")
    elif (. | fabs) >= 100 then round | tostring else . * 1000 | round / 1000 | tostring end;
def place: to_entries | map("\(.key | sub(".*/"; "")) \(.value)") | join(", ");
"# The paper's tables, measured

Made by `./dev paper` from the seven suites; what they mean is in [paper.md](paper.md). Speedups are over `b2f` of the same
rounds, with the 95 % interval that the number of methods is allowed for.

- Device: \(.[0].device.renderer), \(.[0].device.context) context; sheer \(.[0].provenance.version), commit \(.[0].provenance.commit)
- Published on: \(.[0].suite.device)",
(.[] | .suite as $suite | [.runs[].rounds.done] as $rounds
| "
## \($suite.id | sub("paper-table-"; "Table ")): \($suite.title | ascii_downcase)

\(.spec.image.width) x \(.spec.image.height) pixels, \([$rounds | min, max] | unique | map(tostring) | join(" to ")) rounds a point. `\(.provenance.rerun)`

| at | method | figure | published | measured | 95 % |
|---|---|---|---|---|---|",
($suite.figures[] | "| \(.at | place) | `\(.method)` | \(.metric) | \(.published | shown) | \(.measured | shown) | \(if .ci95 then .ci95 | shown else "" end) |"),
"",
($suite.trends[] | "- **\(.verdict)**: \(.text). (\(.detail))"))
