// The trend of a spec at #/trends/SPEC: a number of its reports over time, and where its level changed. A change is compared by
// a click: the last report before it with the first one after it.
import { AddressWriter } from "./address.js";
import { get_trend } from "./api.js";
import { el, select, set_children, svg } from "./dom.js";
import { integer, when } from "./format.js";
import { make_scale, tick_text, value_axis } from "./scales.js";

const WIDTH = 960;
const HEIGHT = 280;
const LEFT = 64;
const RIGHT = 12;
const TOP = 28;
const BOTTOM = 28;
const MOST_MARKS = 1500; // points; a longer trend is only a line

const diff_path = ({ before, after }) => `#/diff/${encodeURIComponent(before)}/${encodeURIComponent(after)}`;

function change_text({ level_before, level_after }, unit) {
  const ratio = level_before.median === 0 ? "" : ` (× ${tick_text(level_after.median / level_before.median)})`;
  const number = (level) => `${tick_text(level.median)}${unit ? ` ${unit}` : ""}`;
  return `${number(level_before)} → ${number(level_after)}${ratio}`;
}

function chart(trend) {
  const { values, change_points, unit } = trend;
  const ends = values.flatMap(({ value, low, high }) => [value, low ?? value, high ?? value]);
  const axis = value_axis("linear", ends);
  const x = make_scale("linear", [0, Math.max(1, values.length - 1)], [LEFT, WIDTH - RIGHT]);
  const y = make_scale("linear", axis.domain, [HEIGHT - BOTTOM, TOP]);
  const ticks = axis.ticks.map((tick) => [
    svg("line", { class: "grid", x1: LEFT, x2: WIDTH - RIGHT, y1: y(tick), y2: y(tick) }),
    svg("text", { class: "tick", x: LEFT - 8, y: y(tick) + 4, "text-anchor": "end" }, tick_text(tick)),
  ]);
  const band = values.every(({ low, high }) => low !== null && high !== null)
    ? svg("path", {
        class: "trend-band",
        d: `M${[
          ...values.map(({ high }, i) => `${x(i)} ${y(high)}`),
          ...values.map(({ low }, i) => `${x(i)} ${y(low)}`).reverse(),
        ].join("L")}Z`,
      })
    : null;
  const line = svg("path", {
    class: "trend-line",
    d: `M${values.map(({ value }, i) => `${x(i)} ${y(value)}`).join("L")}`,
  });
  const marks =
    values.length > MOST_MARKS
      ? []
      : values.map(({ report, value, created_at }, i) =>
          svg(
            "a",
            { href: `#/reports/${encodeURIComponent(report)}`, "aria-label": `Report of ${when(created_at)}` },
            svg("circle", { class: "trend-mark", cx: x(i), cy: y(value), r: 3 }),
            svg("title", {}, `${tick_text(value)} ${unit}, ${when(created_at)}`),
          ),
        );
  const changes = change_points.map((change) => {
    const at = (x(change.index - 1) + x(change.index)) / 2;
    return svg(
      "a",
      {
        href: diff_path(change),
        class: "trend-change",
        "aria-label": `Compare around the change ${change_text(change, unit)}`,
      },
      svg("line", { x1: at, x2: at, y1: TOP, y2: HEIGHT - BOTTOM }),
      svg("rect", { class: "trend-target", x: at - 7, width: 14, y: TOP, height: HEIGHT - BOTTOM - TOP }),
      svg("title", {}, change_text(change, unit)),
    );
  });
  const days = [values[0], values.at(-1)].map(({ created_at }, i) =>
    svg(
      "text",
      { class: "tick", x: i === 0 ? LEFT : WIDTH - RIGHT, y: HEIGHT - 8, "text-anchor": i === 0 ? "start" : "end" },
      when(created_at),
    ),
  );
  const name = svg(
    "text",
    { class: "tick", x: LEFT - 8, y: TOP - 14 },
    unit ? `${trend.metric}, ${unit}` : trend.metric,
  );
  return svg(
    "svg",
    {
      class: "trend-chart",
      viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
      role: "group",
      "aria-label": `${trend.metric} of ${trend.method}`,
    },
    ticks,
    name,
    band,
    line,
    marks,
    changes,
    days,
  );
}

function chart_box(trend) {
  const label = `${trend.metric} of ${trend.method}`;
  return el("div", { class: "trend-box", tabindex: "0", role: "region", "aria-label": label }, chart(trend));
}

function change_list({ change_points, values, unit }) {
  if (change_points.length === 0) return el("p", { class: "muted" }, "No change of its level was found.");
  return el(
    "ul",
    { class: "trend-changes", "aria-label": "Changes" },
    change_points
      .toReversed()
      .map((change) =>
        el(
          "li",
          {},
          `${when(values[change.index].created_at)}: ${change_text(change, unit)} `,
          el("a", { class: "button small", href: diff_path(change) }, "Compare"),
        ),
      ),
  );
}

/** `context`: {parts: [spec_sha256], query, on_query}, see app.js. */
export function show_trend(main, signal, { parts: [spec_sha256], query, on_query }) {
  document.title = "Trend · Sheer";
  const address = new AddressWriter(signal);
  let wanted = query;
  const controls = el("div", { class: "filters" });
  const body = el("div", {});
  set_children(main, el("section", { class: "trend" }, el("h1", {}, "Trend of a spec"), controls, body));

  const choose = (name, label, choices, current) =>
    choices.length < 2
      ? null
      : select(
          {
            "aria-label": label,
            onchange: (event) => {
              wanted = { ...wanted, [name]: event.target.value };
              address.write(wanted, true);
              load();
            },
          },
          choices.map((choice) => [choice, choice]),
          current,
        );

  function draw(trend) {
    const count = trend.values.length;
    set_children(
      controls,
      choose("metric", "Metric", trend.metrics, trend.metric),
      choose("method", "Method", trend.methods, trend.method),
      choose("point", "Point of the sweep", trend.points, trend.point),
    );
    const missing = trend.missing > 0 ? `, ${integer(trend.missing)} without this value` : "";
    set_children(
      body,
      el(
        "p",
        { class: "muted", role: "status" },
        `${integer(count)} ${count === 1 ? "report" : "reports"}${missing} on ${trend.device || "no device"}`,
      ),
      count > 1 ? [chart_box(trend), change_list(trend)] : null,
      count === 1 ? el("p", {}, "A trend begins with the second report of this spec on this device.") : null,
    );
  }

  async function load() {
    try {
      const trend = await get_trend({ ...wanted, spec_sha256 }, signal);
      if (!signal.aborted) draw(trend);
    } catch (error) {
      if (!signal.aborted) set_children(body, el("p", { class: "notice error", role: "alert" }, error.message));
    }
  }

  on_query((changed) => {
    wanted = changed;
    load();
  });
  load();
}
