// The tools of the viewer for the kind of picture that is shown: exposure and channels of colors, gain of differences.
import { el, segmented, select, set_children } from "./dom.js";
import { BACKGROUNDS, CHANNELS, GAINS } from "./view_state.js";

function range(label, state, name, limits, text) {
  const value = el("output", {}, text(state.get(name)));
  const input = el("input", {
    type: "range",
    ...limits,
    value: state.get(name),
    oninput: () => {
      state.set({ [name]: Number(input.value) });
      value.textContent = text(Number(input.value));
    },
  });
  return el("label", { class: "tool-range" }, label, input, value);
}

function tone_tools(state, has_opacity, redraw) {
  const stops = (value) => `${value > 0 ? "+" : ""}${value.toFixed(1)}`.replace("-", "−");
  const channels = CHANNELS.filter(([key]) => key !== "a" || has_opacity);
  return [
    range("Exposure", state, "exposure", { min: -6, max: 6, step: 0.5 }, stops),
    range("Gamma", state, "gamma", { min: 0.4, max: 3, step: 0.1 }, (value) => value.toFixed(1)),
    segmented("Channel", channels, state.get("channel"), (channel) => state.set({ channel })),
    has_opacity
      ? el(
          "label",
          {},
          "Over ",
          select({ onchange: (event) => state.set({ over: event.target.value }) }, BACKGROUNDS, state.get("over")),
        )
      : null,
    el(
      "button",
      {
        type: "button",
        class: "small",
        onclick: () => {
          state.reset_tone();
          redraw();
        },
      },
      "Reset",
    ),
  ];
}

function difference_tools(state) {
  return [
    el(
      "label",
      {},
      "Gain ",
      select(
        { onchange: (event) => state.set({ gain: Number(event.target.value) }) },
        [["0", "√ (small and large)"], ...GAINS.map((gain) => [String(gain), `×${gain}`])],
        String(state.get("gain")),
      ),
    ),
    el(
      "label",
      {},
      el("input", {
        type: "checkbox",
        checked: state.get("absolute"),
        onchange: (event) => state.set({ absolute: event.target.checked }),
      }),
      " Absolute",
    ),
  ];
}

/** Fills `place` with the tools for the state's mode; `has_opacity`: whether a picture can be put over other backgrounds. */
export function show_tools(place, state, has_opacity) {
  const tools = { color: tone_tools, difference: difference_tools }[state.get("mode")];
  set_children(
    place,
    tools?.(state, has_opacity, () => show_tools(place, state, has_opacity)),
  );
}
