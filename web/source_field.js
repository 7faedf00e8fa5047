// A text area for a program: its lines are numbered, and those that an error names are marked.
import { el, set_children } from "./dom.js";

/** [[line, message]] for an error of the service: "line 2 has a #", or "line 3: ...", one on each of its lines. */
function lines_of_error(text) {
  return text
    .split("\n")
    .map((part) => [/\bline (\d+)/.exec(part), part])
    .filter(([found]) => found)
    .map(([found, part]) => [Number(found[1]), part]);
}

/** `input`: the text area. {element, mark(error): marks the lines that the text of an error names}. */
export function numbered_lines(input) {
  const numbers = el("div", { class: "line-numbers", "aria-hidden": "true" });
  const element = el("div", { class: "numbered" }, numbers, input);
  let messages = new Map();
  const draw = () => {
    const count = input.value.split("\n").length;
    set_children(
      numbers,
      Array.from({ length: count }, (_, index) => {
        const message = messages.get(index + 1);
        return el("span", { class: message ? "wrong" : null, title: message }, index + 1);
      }),
    );
    numbers.scrollTop = input.scrollTop;
  };
  input.setAttribute("wrap", "off");
  input.addEventListener("scroll", () => {
    numbers.scrollTop = input.scrollTop;
  });
  input.addEventListener("input", draw);
  draw();
  return {
    element,
    mark(error) {
      messages = new Map();
      for (const [line, message] of lines_of_error(error))
        messages.set(line, [messages.get(line), message].filter(Boolean).join("\n"));
      draw();
    },
  };
}
