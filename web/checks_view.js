// The checks of a report: how many passed, what failed or is open first, the rest folded; with which report it was compared,
// and what the looks of its methods change.
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

/** With which accepted report it was compared and why, or why with none. */
function against_part({ against }) {
  if (!against) return null;
  const refused = against.refused ?? [];
  return el(
    "div",
    { class: "against" },
    el("p", {}, `${against.text}.`),
    refused.length === 0
      ? null
      : el(
          "details",
          {},
          el(
            "summary",
            {},
            `${refused.length} accepted ${refused.length === 1 ? "report" : "reports"} not compared with`,
          ),
          el(
            "ul",
            {},
            refused.map(({ report, reason }) => el("li", {}, `${report}: ${reason}`)),
          ),
        ),
  );
}

function change_text({ label, change, change_reason }) {
  if (!change) return `${label}: not known, as ${change_reason}`;
  const { from, identical, metrics, speedup } = change;
  const picture = identical
    ? "the picture is identical"
    : `the picture differs, mean FLIP ${fixed(metrics.flip?.mean, 4)}, ${metrics.differing_pixels} pixels`;
  if (!speedup) return `${from} → ${label}: ${picture}`;
  const interval = speedup.ci95 ? ` [${speedup.ci95.map((end) => fixed(end, 2)).join(", ")}]` : "";
  return `${from} → ${label}: ${picture}; speed ${fixed(speedup.value, 2)}×${interval}, ${speedup.verdict}`;
}

/** What the shadings and textures that methods have of their own change in them; null if there are none. */
export function changes_section(run) {
  const changed = run.results.filter(({ change, change_reason }) => change || change_reason);
  if (changed.length === 0) return null;
  return el(
    "section",
    { class: "checks", "aria-label": "Changes" },
    el("h2", {}, "Changes"),
    el(
      "ul",
      {},
      changed.map((result) => el("li", {}, el("span", {}, change_text(result)))),
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
    against_part(report),
    lines(folds ? open : [...open, ...passed]),
    folds ? el("details", {}, el("summary", {}, `${passed.length} checks that passed`), lines(passed)) : null,
  );
}
