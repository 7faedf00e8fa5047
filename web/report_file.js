// The self-contained file of a report with some pixels explained. The service makes the file without them, in an instant,
// since each pixel has to be drawn again.
import { get_pixel, get_report_html } from "./api.js";
import { el } from "./dom.js";
import { worst_of } from "./paint.js";
import { patiently } from "./patience.js";
import { sources_of } from "./report_pictures.js";

const MOST_BYTES = 1e6; // of one explanation: a pixel may have a hundred thousand fragments

/** {x, y, run, why} for the worst pixel of each method, each pixel once. */
async function worst_places(report, run) {
  const [reference, ...methods] = sources_of(report.runs[run], (image) => image.url);
  const places = new Map();
  for (const { label, data } of methods) {
    if (!data.has("color") || !reference.data.has("color")) continue;
    const pixel = worst_of(...(await Promise.all([reference.data.load("color"), data.load("color")])));
    if (!pixel) continue;
    const [x, y] = pixel;
    const known = places.get(`${x} ${y}`);
    if (known) known.why += `, ${label}`;
    else places.set(`${x} ${y}`, { x, y, run, why: `worst of ${label}` });
  }
  return [...places.values()];
}

/** JSON for a script block: without a <, nothing in it can end the block. */
const block_json = (value) => JSON.stringify(value).replaceAll("<", "\\u003c");

function save(text, name) {
  const link = el("a", { href: URL.createObjectURL(new Blob([text], { type: "text/html" })), download: name });
  link.click();
  URL.revokeObjectURL(link.href);
}

/**
 * Saves the file with the worst pixel of each method of a run, and those of `seen`: [{x, y, run, pixel}], which the user has
 * looked at. `tell(text)` is called as it goes on.
 */
export async function save_with_pixels(report, run, seen, tell) {
  tell("Reading the pictures…");
  const html = get_report_html(report.id);
  const places = (await worst_places(report, run)).map((place) => ({
    ...place,
    pixel: seen.find((one) => one.x === place.x && one.y === place.y && one.run === run)?.pixel,
  }));
  for (const [index, place] of places.entries()) {
    tell(`Explaining pixel ${index + 1} of ${places.length}…`);
    // One that can no longer be drawn, or takes too long, is left out.
    place.pixel ??= await patiently(() => get_pixel(report.id, { x: place.x, y: place.y, run })).catch(() => null);
  }
  const is_place = (one) => places.some(({ x, y, run: of }) => x === one.x && y === one.y && of === one.run);
  const all = [...places, ...seen.filter((one) => !is_place(one)).map((one) => ({ ...one, why: "looked at" }))];
  const kept = all.filter(({ pixel }) => pixel && JSON.stringify(pixel).length <= MOST_BYTES);
  const block = `<script type="application/json" id="sheer-pixels">${block_json(kept)}</script>\n`;
  const text = await html;
  const end = text.lastIndexOf("</body>");
  // Before the module that reads it.
  const before = text.lastIndexOf('<script type="module"', end);
  save(text.slice(0, before) + block + text.slice(before), `sheer-${report.id}.html`);
}
