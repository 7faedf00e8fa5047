// Walks a view by the Tab key alone.
import assert from "node:assert/strict";

const MOST_STOPS = 600;

/** Before the page's scripts: remembers what listens to clicks. */
export function watch_listeners(page) {
  return page.addInitScript(() => {
    globalThis.listens_to_clicks = new Set();
    const add = EventTarget.prototype.addEventListener;
    EventTarget.prototype.addEventListener = function (type, ...rest) {
      if (["click", "dblclick", "pointerdown"].includes(type) && this instanceof Element)
        globalThis.listens_to_clicks.add(this);
      return add.call(this, type, ...rest);
    };
  });
}

/** In the page: notes each element that gets the focus, and whether it shows that it has it. */
function begin_walk() {
  const outlined = (style) => style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 1;
  const shows_focus = (node) =>
    node.matches(":focus-visible") &&
    ([undefined, "::before", "::after"].some((part) => outlined(getComputedStyle(node, part))) ||
      outlined(getComputedStyle(node.parentElement)));
  const in_window = (box) => box.bottom > 0 && box.right > 0 && box.top < innerHeight && box.left < innerWidth;
  const name = (node) => {
    const text = node.getAttribute("aria-label") ?? node.textContent.trim().slice(0, 40);
    return `${node.tagName.toLowerCase()}${node.className ? `.${String(node.className.baseVal ?? node.className)}` : ""} “${text}”`;
  };
  const walk = (globalThis.walk = { reached: new Set(), faults: [], ended: false, name });
  walk.listener = ({ target }) => {
    // After the last element the focus begins anew.
    if (walk.reached.has(target)) walk.ended ||= target === walk.reached.values().next().value;
    walk.reached.add(target);
    if (!shows_focus(target)) walk.faults.push(`${name(target)} does not show the focus`);
    if (!in_window(target.getBoundingClientRect())) walk.faults.push(`${name(target)} has the focus out of sight`);
  };
  document.addEventListener("focusin", walk.listener);
  document.activeElement?.blur();
}

/** In the page: {missed, faults, count} of the walk. */
function end_walk() {
  const { reached, faults, name, listener } = globalThis.walk;
  document.removeEventListener("focusin", listener);
  const modal = [...document.querySelectorAll("dialog:modal")].at(-1) ?? document;
  const interactive =
    "button, a[href], input, select, textarea, summary, [tabindex], [contenteditable], " +
    "[role=button], [role=link], [role=slider], [role=tab], [role=checkbox], [role=menuitem]";
  const visible = (node) => node.checkVisibility({ checkVisibilityCSS: true }) && node.getClientRects().length > 0;
  const wanted = [...modal.querySelectorAll(interactive)].filter((node) => visible(node) && !node.disabled);
  // Of tabs only the chosen one is a stop, and the arrows lead to the others; -1 also marks places for the script's own focus.
  const stops = wanted.filter((node) => node.getAttribute("tabindex") !== "-1");
  const own = [...globalThis.listens_to_clicks].filter(
    (node) => modal.contains(node) && visible(node) && !node.disabled,
  );
  // A list may listen for the buttons in it, a label for its input.
  const served = (node) =>
    node.role === "tab" || stops.some((stop) => node === stop || node.contains(stop) || stop.contains(node));
  return {
    count: stops.length,
    faults,
    missed: [
      ...stops.filter((node) => !reached.has(node)).map((node) => `${name(node)} is not reached`),
      ...own
        .filter((node) => !served(node))
        .map((node) => `${name(node)} listens to clicks and has no place in the walk`),
    ],
  };
}

/** Asserts that Tab reaches everything that can be clicked in what is shown, and that each shows the focus. */
export async function assert_walkable(page, what) {
  await page.evaluate(begin_walk);
  for (let i = 0; i < MOST_STOPS; ++i) {
    await page.keyboard.press("Tab");
    if (i % 16 === 15 && (await page.evaluate(() => globalThis.walk.ended))) break;
  }
  const { count, faults, missed } = await page.evaluate(end_walk);
  assert.deepEqual([...new Set([...missed, ...faults])], [], `${what}, ${count} stops`);
  assert.ok(count > 1, `${what} has ${count} stops`);
}
