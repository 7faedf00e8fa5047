// The checks of a report: how many passed, what failed or is open first, the rest folded.
import { el } from "./dom.js";
import { fixed, is_number } from "./format.js";
import { point_text } from "./sweep.js";

const MARKS = { failed: "✗ failed", undecided: "? undecided", passed: "✓ passed" };
const ORDER = Object.keys(MARKS);
const MOST_UNFOLDED = 4;

const outcome_of = (check) => check.outcome ?? (check.passed ? "passed" : "failed");

function bound_text(check) {
  const bounds = [
    is_number(check.min) ? `at least ${check.min}` : null,
    is_number(check.max) ? `at most ${check.max}` : null,
  ];
  return bounds.filter(Boolean).join(" and ");
}

function check_line(check, spec) {
  const asked = spec?.checks?.find((one) => one.metric === check.metric && one.method === check.method);
  const point = point_text(check.at, spec);
  const outcome = outcome_of(check);
  return el(
    "li",
    { class: outcome },
    el("span", { class: "check-mark" }, MARKS[outcome]),
    el("span", {}, `${check.metric} of ${check.method}${point ? ` at ${point}` : ""}`),
    el(
      "span",
      { class: "muted" },
      `${bound_text({ ...asked, ...check })}; is ` +
        (is_number(check.value) ? fixed(check.value, 4) : (check.reason ?? "not measured")) +
        (is_number(check.value) && check.reason ? `: ${check.reason}` : ""),
    ),
  );
}

/** Null if there are none. */
export function checks_section(report) {
  const checks = report.checks ?? [];
  if (checks.length === 0) return null;
  const by_outcome = ORDER.map((outcome) => checks.filter((check) => outcome_of(check) === outcome));
  const [failed, undecided, passed] = by_outcome;
  const lines = (some) =>
    el(
      "ul",
      {},
      some.map((check) => check_line(check, report.spec)),
    );
  const open = [...failed, ...undecided];
  const folds = passed.length > MOST_UNFOLDED;
  const counts = [
    `${passed.length} of ${checks.length} passed`,
    undecided.length > 0 ? `${undecided.length} undecided` : "",
  ];
  return el(
    "section",
    { class: "checks", "aria-label": "Checks" },
    el("h2", {}, "Checks: ", counts.filter(Boolean).join(", ")),
    lines(folds ? open : [...open, ...passed]),
    folds ? el("details", {}, el("summary", {}, `${passed.length} checks that passed`), lines(passed)) : null,
  );
}
