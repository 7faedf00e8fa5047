// The service's ready-made comparisons to start from.
import { get_assets, get_examples, get_spec_file, list_reports, upload_asset } from "./api.js";
import { media_type_of } from "./asset_field.js";
import { words } from "./format.js";

const FIRST = ["quick", "glass"];
const RECENT = 100;

function summary_of({ scene = {}, image = {}, methods = [] }) {
  const size = image.width ? `${image.width} × ${image.height} px` : "";
  return [words(scene.type ?? ""), size, `${methods.length} methods`].filter(Boolean).join(", ");
}

const rank = ({ id }) => (FIRST.includes(id) ? FIRST.indexOf(id) : FIRST.length);

/** {id, name, summary, teaches, scene, spec, files} for the service's examples; the quick one comes first. */
export function presets_of(examples) {
  return [...examples]
    .sort((a, b) => rank(a) - rank(b))
    .map(({ id, spec, teaches = "", files = [], picture = null }) => ({
      id,
      name: spec.title || words(id),
      summary: summary_of(spec),
      teaches,
      picture,
      scene: spec.scene?.type,
      spec,
      files,
    }));
}

export async function load_presets() {
  return presets_of(await get_examples());
}

/** How long each ready spec took here the last time, in seconds by its title. */
export async function load_durations() {
  const { reports } = await list_reports({ status: "done", limit: RECENT });
  const seconds = new Map();
  for (const { title, created_at, finished_at } of reports)
    if (!seconds.has(title)) seconds.set(title, (new Date(finished_at) - new Date(created_at)) / 1000);
  return seconds;
}

function with_value(spec, pointer, value) {
  const copy = structuredClone(spec);
  const parts = pointer.split("/").slice(1);
  const owner = parts.slice(0, -1).reduce((part, key) => part[key], copy);
  owner[parts.at(-1)] = value;
  return copy;
}

/** The spec of a ready-made comparison as it can be posted: the files that it needs are uploaded. */
export async function prepared_spec({ spec, files }) {
  if (files.length === 0) return spec;
  const { accepts } = await get_assets();
  let ready = spec;
  for (const { pointer, name, url } of files) {
    const file = new File([await get_spec_file(url)], name);
    const { sha256 } = await upload_asset(file, media_type_of(file, accepts), () => {});
    ready = with_value(ready, pointer, sha256);
  }
  return ready;
}

const SCENES = { model: "gltf", volume: "volume", texture: "quads" };
const FIELDS = { model: "model", volume: "volume", texture: "texture" };
const ONLY_IN_EXAMPLE = ["camera", "count"];

/** A comparison of an uploaded file, made from the ready-made one of its kind; null if there is none. */
export function spec_for_file(asset, presets) {
  const preset = presets.find(({ scene }) => scene === SCENES[asset.type]);
  if (!preset) return null;
  const { checks, ...spec } = structuredClone(preset.spec);
  const name = asset.name || `an uploaded ${asset.type}`;
  const field = FIELDS[asset.type];
  const of_file = { model: asset.sha256, volume: { data: asset.sha256 }, texture: { image: asset.sha256, size: 512 } };
  for (const member of asset.type === "model" ? ONLY_IN_EXAMPLE : []) delete spec.scene[member];
  return { ...spec, title: name, scene: { ...spec.scene, [field]: of_file[asset.type] } };
}
