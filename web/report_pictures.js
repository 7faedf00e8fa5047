// The pictures of a run for the viewer: the kinds that there are, and the files of the reference and of each method.
import { is_number, words } from "./format.js";
import { PictureData } from "./picture_data.js";
import { status_text } from "./report_head.js";

const KIND_ORDER = ["color", "difference", "flip", "overdraw", "shaded", "saturation"];
const KIND_LABELS = { color: "Color", difference: "Difference", flip: "FLIP" };
const COUNT_NOTES = {
  overdraw: "Transparent fragments of each pixel that opaque geometry does not hide",
  shaded: "Fragments of each pixel that the method shaded",
  saturation:
    "The fragment, counted from the front, after which less than the threshold is left; black where that never happens",
};
/** Not shown by itself: other backgrounds and the channel Alpha are made from it. */
const HELPERS = ["opacity"];
/** What is the same for every method. */
const ONCE = ["overdraw"];

export function is_shown(image) {
  return Boolean(image?.media_type?.startsWith("image/") && !image.media_type.includes("exr"));
}

export function kinds_of(run, metrics) {
  const keys = new Set(
    run.results.flatMap((result) =>
      Object.entries(result.images ?? {})
        .filter(([key, image]) => is_shown(image) && !HELPERS.includes(key))
        .map(([key]) => key),
    ),
  );
  keys.add("color");
  const rank = (key) => (KIND_ORDER.includes(key) ? KIND_ORDER.indexOf(key) : KIND_ORDER.length);
  return [...keys]
    .sort((a, b) => rank(a) - rank(b))
    .map((key) => ({
      key,
      label: KIND_LABELS[key] ?? words(key),
      note: metrics.find((metric) => metric.picture === key)?.summary ?? count_note(run, key),
      once: ONCE.includes(key),
    }));
}

/** What the colors of a picture of counts mean; all pictures of a run share one scale. */
function count_note(run, key) {
  const images = run.results.map((result) => result.images?.[key]).filter((image) => is_number(image?.full_scale));
  if (images.length === 0) return undefined;
  const greatest = Math.max(...images.map((image) => image.greatest));
  return `${COUNT_NOTES[key] ?? words(key)}. Greatest: ${greatest}.`;
}

function data_of(images, picture_url) {
  const files = Object.entries(images ?? {})
    .map(([key, image]) => [key, { url: picture_url(image), full_scale: image.full_scale, is_float: !is_shown(image) }])
    .filter(([, { url }]) => url);
  return new PictureData(Object.fromEntries(files));
}

/** The reference first, then the results in their order; the key of each is its number. */
export function sources_of(run, picture_url) {
  const once = run.results.flatMap(({ images }) => Object.entries(images ?? {}).filter(([key]) => ONCE.includes(key)));
  const own = (images) => Object.fromEntries(Object.entries(images ?? {}).filter(([key]) => !ONCE.includes(key)));
  const reference = {
    key: "0",
    label: "Reference",
    reference: true,
    title: run.reference?.method,
    data: data_of({ ...run.reference?.images, ...Object.fromEntries(once) }, picture_url),
    missing: status_text(run.reference) ?? "The report has no reference picture",
  };
  return [
    reference,
    ...run.results.map((result, index) => ({
      key: String(index + 1),
      label: result.label,
      title: result.method,
      data: data_of(own(result.images), picture_url),
      missing: status_text(result) ?? result.metrics_reason ?? "",
    })),
  ];
}
