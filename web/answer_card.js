// The answer of a report: which method to use, and a row for each of them to judge it by.
import { advise, ANY, EYE_LIMIT, tally } from "./advice.js";
import { el, select, set_children } from "./dom.js";
import { DASH, fixed, integer, is_number, memory_text, MIB } from "./format.js";

const ERROR_LIMITS = [0.001, 0.01, EYE_LIMIT, 0.05, 0.1];
const MEMORY_LIMITS_MIB = [1, 4, 16, 64];
const MORE_ROUNDS = 20;

const percent = (share) => `${Math.round(share * 100)} %`;
function error_text({ error, is_exact }) {
  if (is_exact) return "0";
  return is_number(error) ? error.toPrecision(2) : DASH;
}

/** "1.28× [0.77, 1.65]" */
function speed_text({ value, ci95 }) {
  const interval = ci95?.every(is_number) ? ` [${ci95.map((bound) => fixed(bound, 2)).join(", ")}]` : "";
  return `${fixed(value, 2)}×${interval}`;
}

function picture_words({ chosen, baseline }) {
  if (chosen.is_exact) return "identical to the reference";
  const flip = `FLIP ${error_text(chosen)}`;
  if (chosen.error <= EYE_LIMIT || chosen.error <= baseline?.error)
    return baseline && chosen !== baseline
      ? `as good as ${baseline.label} to the eye (${flip})`
      : `as good as the reference to the eye (${flip})`;
  return `within the chosen limit (${flip})`;
}

function work_words({ chosen, baseline }) {
  if (!is_number(chosen.shaded) || !(baseline?.shaded > 0) || chosen === baseline) return "";
  const share = 1 - chosen.shaded / baseline.shaded;
  if (share === 0) return `shades as many fragments as ${baseline.label}`;
  const size = Math.abs(share) < 0.01 ? "under 1 %" : percent(Math.abs(share));
  return `shades ${size} ${share > 0 ? "fewer" : "more"} fragments than ${baseline.label}`;
}

function speed_sentence({ chosen, baseline }) {
  if (!chosen.speed || chosen === baseline) return "";
  const { verdict } = chosen.speed;
  return verdict === "not resolved"
    ? `Speed: not settled, ${speed_text(chosen.speed)}.`
    : `Speed: ${verdict}, ${speed_text(chosen.speed)}.`;
}

/** The method nearest to the reference of those that are within the limits and need no sorting, if the chosen one does. */
function unsorted_sentence({ chosen, entries }) {
  if (!chosen.sorts) return "";
  const free = entries.filter(({ excluded, sorts }) => excluded === "" && sorts === false);
  const [best] = free.sort((a, b) => a.error - b.error);
  return best ? ` Without sorting: ${best.label} (FLIP ${error_text(best)}).` : "";
}

function sentence(advice, run, limits) {
  const { chosen, by, closest, baseline } = advice;
  if (run.nothing_drawn) return [el("strong", {}, "Nothing to compare: "), run.nothing_drawn];
  if (!chosen) {
    const none = el("strong", {}, "No method is within these limits.");
    return closest
      ? [none, ` The closest to the reference is ${closest.label} (FLIP ${error_text(closest)}).`]
      : [none, " No method has a picture that could be compared with the reference."];
  }
  if (by === "baseline")
    return [
      el("strong", {}, `Keep ${baseline.label}`),
      `: no other method with an error of at most ${limits.error_limit} is resolved to be cheaper here.`,
      unsorted_sentence(advice),
    ];
  return [
    el("strong", {}, `Use ${chosen.label}`),
    `: ${[picture_words(advice), work_words(advice)].filter(Boolean).join(", ")}. `,
    speed_sentence(advice),
    unsorted_sentence(advice),
  ];
}

/** A bar with a number; `whisker`: [low, high] in the bar's unit. */
function bar_cell(value, full, text, { whisker = null, missing = "", kind = "" } = {}) {
  if (!is_number(value)) return el("td", { class: "missing", title: missing }, DASH);
  const share = (x) => `${full > 0 ? Math.min(1, Math.max(0, x / full)) * 100 : 0}%`;
  const fill = el("span", { class: "fill" });
  fill.style.width = share(value);
  const line = whisker?.every(is_number) ? el("span", { class: "whisker" }) : null;
  if (line) {
    line.style.left = share(whisker[0]);
    line.style.width = `calc(${share(whisker[1])} - ${share(whisker[0])})`;
  }
  return el(
    "td",
    { class: `bar-cell ${kind}` },
    el("span", { class: "bar-value" }, text),
    el("span", { class: "track", "aria-hidden": "true" }, fill, line),
  );
}

function verdict_words(entry, { chosen, by }) {
  if (entry === chosen) return [by === "baseline" ? "keep this" : "use this", "faster"];
  if (entry.excluded) return [entry.excluded, entry.is_bound ? "muted" : "slower"];
  return [entry.is_exact ? "exact" : "same to the eye", "muted"];
}

export class AnswerCard {
  #options;
  #limits = { ...ANY };
  #run = null;
  #text = el("div", { class: "answer-text" });
  #rows = el("div", {
    class: "answer-rows table-box",
    tabindex: "0",
    role: "region",
    "aria-label": "Methods at a glance",
  });

  /**
   * `options`: {runs, methods, baseline, software, picture_url, on_show(label), on_rounds(rounds)}; without `on_rounds` more
   * rounds are not offered.
   */
  constructor(options) {
    this.#options = options;
    this.element = el("section", { class: "answer", "aria-label": "Answer" }, this.#text, this.#rows, this.#filters());
  }

  /** Shows the answer for one run. */
  show(run) {
    this.#run = run;
    this.#draw();
  }

  get #advice() {
    return advise(this.#run, { ...this.#options, limits: this.#limits });
  }

  #filters() {
    const draw = (change) => (event) => {
      change(event.target);
      this.#draw();
    };
    return el(
      "div",
      { class: "answer-filters", role: "group", "aria-label": "Limits" },
      el(
        "label",
        {},
        "Error at most ",
        select(
          { onchange: draw((input) => (this.#limits.error_limit = Number(input.value))) },
          [...ERROR_LIMITS.map((limit) => [String(limit), `FLIP ${limit}`]), ["Infinity", "any"]],
          String(EYE_LIMIT),
        ),
      ),
      el(
        "label",
        {},
        "Memory at most ",
        select(
          { onchange: draw((input) => (this.#limits.memory_limit_bytes = Number(input.value))) },
          [["Infinity", "any"], ...MEMORY_LIMITS_MIB.map((limit) => [String(limit * MIB), `${limit} MiB`])],
          "Infinity",
        ),
      ),
      el(
        "label",
        {},
        el("input", { type: "checkbox", onchange: draw((input) => (this.#limits.no_sorting = input.checked)) }),
        " No sorting",
      ),
    );
  }

  #rounds_button(advice) {
    const { on_rounds } = this.#options;
    const { chosen, baseline, entries } = advice;
    const is_open = ({ excluded, speed }) => excluded === "" && speed?.verdict === "not resolved";
    const may_settle =
      chosen === baseline ? entries.some((one) => one !== baseline && is_open(one)) : is_open(chosen ?? {});
    if (!on_rounds || !chosen || !may_settle) return null;
    const { asked, needed } = this.#run.rounds ?? { asked: 0, needed: 0 };
    const rounds = Math.max(MORE_ROUNDS, 2 * asked, needed);
    return el("button", { type: "button", onclick: () => on_rounds(rounds) }, `Run ${rounds} rounds`);
  }

  #draw() {
    const advice = this.#advice;
    const { runs, software } = this.#options;
    const over_all = runs.length > 1 ? tally(runs, { ...this.#options, limits: this.#limits }) : [];
    set_children(
      this.#text,
      over_all.length > 0
        ? el(
            "p",
            { class: "answer-tally" },
            `Over ${runs.length} points: `,
            over_all.map(([label, count]) => `${label} at ${count}`).join(", "),
            ". At the point below:",
          )
        : null,
      el(
        "p",
        { class: "answer-sentence" },
        sentence(advice, this.#run, this.#limits),
        " ",
        this.#rounds_button(advice),
      ),
      software
        ? el(
            "p",
            { class: "hint" },
            "Software rasteriser: its times do not predict those on a GPU, so the choice is made by shaded fragments.",
          )
        : null,
    );
    set_children(this.#rows, this.#table(advice));
  }

  #table(advice) {
    const { entries } = advice;
    const { software, baseline } = this.#options;
    const full = (values) => Math.max(0, ...values.filter(is_number));
    const most_shaded = full(entries.map(({ shaded }) => shaded));
    const most_error = full(entries.map(({ error }) => error));
    const ends = ({ timing }) => [timing?.median, timing?.ci95?.[1]];
    const most_ms = full(entries.flatMap(({ result }) => ends(result)));
    const shaded = (entry) => bar_cell(entry.shaded, most_shaded, integer(entry.shaded), { missing: "not counted" });
    const time = ({ result: { timing } }) =>
      bar_cell(timing?.median, most_ms, `${fixed(timing?.median, 2)} ms`, {
        whisker: timing?.ci95,
        missing: "not timed",
      });
    const heads = software ? ["Shaded fragments", "Time"] : ["Time", "Shaded fragments"];
    const cells = software ? [shaded, time] : [time, shaded];
    const head = (name) => el("th", { scope: "col" }, name);
    return el(
      "table",
      { class: "glance" },
      el(
        "thead",
        {},
        el("tr", {}, ["Method", "Verdict", "Error (FLIP)", ...heads, "Speed", "Sorting", "Memory"].map(head)),
      ),
      el(
        "tbody",
        {},
        entries.map((entry) => {
          const [words, kind] = verdict_words(entry, advice);
          const { speed, result } = entry;
          const sort = result.timing?.sort;
          return el(
            "tr",
            { class: entry === advice.chosen ? "chosen" : null, "data-method": entry.label },
            el("th", { scope: "row" }, this.#thumbnail(result), el("span", {}, entry.label)),
            el("td", { class: "judged" }, el("span", { class: `verdict-word ${kind}` }, words)),
            bar_cell(entry.error, most_error, error_text(entry), {
              missing: result.metrics_reason ?? entry.excluded,
              kind: "error",
            }),
            cells.map((cell) => cell(entry)),
            el(
              "td",
              { class: "speed" },
              entry.label === baseline
                ? el("span", { class: "muted" }, "baseline")
                : speed
                  ? [
                      speed_text(speed),
                      el("span", { class: `verdict-word ${speed.verdict.replace(" ", "-")}` }, speed.verdict),
                    ]
                  : DASH,
            ),
            el(
              "td",
              {},
              entry.sorts === null ? DASH : entry.sorts ? (sort ? `${fixed(sort.median, 2)} ms` : "sorts") : "none",
            ),
            el("td", {}, memory_text(entry.memory_bytes)),
          );
        }),
      ),
    );
  }

  #thumbnail(result) {
    const url = result.images?.color ? this.#options.picture_url(result.images.color) : null;
    if (!url) return el("span", { class: "glance-thumb" });
    const label = `Show ${result.label} in the viewer`;
    return el(
      "button",
      {
        type: "button",
        class: "glance-thumb",
        "aria-label": label,
        title: label,
        onclick: () => this.#options.on_show(result.label),
      },
      el("img", { src: url, alt: "", width: 48, height: 36, decoding: "async" }),
    );
  }
}
