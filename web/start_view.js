// The start page at #/: what Sheer does, ready comparisons, and a place for a file of one's own.
import { get_assets, submit, upload_asset } from "./api.js";
import { media_type_of } from "./asset_field.js";
import { el, set_children } from "./dom.js";
import { integer } from "./format.js";
import { note_list } from "./notes.js";
import { load_durations, load_presets, prepared_spec, spec_for_file } from "./presets.js";
import { keep_draft, may_replace_draft } from "./spec_model.js";

const WITHOUT_HEADER = "application/octet-stream";

function duration_text(seconds) {
  if (seconds === undefined) return "not run here yet";
  const rounded = Math.max(1, Math.round(seconds));
  return rounded < 120 ? `${rounded} s here` : `${Math.round(rounded / 60)} min here`;
}

function open_report(id) {
  location.hash = `#/reports/${encodeURIComponent(id)}`;
}

function open_form(spec) {
  if (!may_replace_draft()) return;
  keep_draft(spec, spec);
  location.hash = "#/new";
}

/** Buttons to run a comparison or to change it first; `load` returns its spec. */
function run_buttons(name, load, on_error) {
  const guarded = (action) => async (event) => {
    event.target.disabled = true;
    try {
      action(await load());
    } catch (error) {
      on_error(error);
    }
    event.target.disabled = false;
  };
  const run = guarded((spec) => submit(spec).then(open_report, on_error));
  return el(
    "div",
    { class: "actions" },
    el("button", { type: "button", class: "primary", "aria-label": `Run ${name}`, onclick: run }, "Run"),
    el("button", { type: "button", "aria-label": `Customise ${name}`, onclick: guarded(open_form) }, "Customise"),
  );
}

function card(preset, on_error) {
  const picture = preset.picture
    ? el("img", { src: preset.picture, alt: "", width: 320, height: 200, loading: "lazy", decoding: "async" })
    : el("div", { class: "no-picture" });
  const time = el("span", { class: "chip", hidden: true });
  const node = el(
    "li",
    { class: "start-card", "data-id": preset.id },
    picture,
    el(
      "div",
      { class: "start-card-text" },
      el("h2", {}, preset.name),
      el("p", {}, preset.teaches),
      el("p", { class: "hint" }, preset.summary, " ", time),
    ),
    run_buttons(preset.name, () => prepared_spec(preset), on_error),
  );
  return { node, preset, time };
}

/** What an upload contains, in a few words. */
function asset_text(asset) {
  const facts = [
    asset.triangles !== undefined ? `${integer(asset.triangles)} triangles` : null,
    asset.materials !== undefined ? `${integer(asset.materials)} materials` : null,
    asset.size ? `${asset.size.join(" × ")} voxels` : null,
    asset.width ? `${asset.width} × ${asset.height} px` : null,
  ];
  return [`${asset.name}: a ${asset.type}`, ...facts.filter(Boolean)].join(", ");
}

/** What Run does with it. */
function plan_text({ methods, image }) {
  const labels = methods.map((method) => method.label ?? method.id ?? method);
  const size = image?.width ? ` at ${image.width} × ${image.height} px` : "";
  return `Run draws it by ${labels.join(", ")}${size}, and says which of them to use.`;
}

/** The place where a file is dropped or chosen, and what can then be done with it. */
class OwnFile {
  #presets;
  #input = el("input", {
    type: "file",
    class: "visually-hidden",
    "aria-label": "Your model, volume or texture",
    onchange: () => this.take(this.#input.files[0]),
  });
  #status = el("div", { class: "own-status", role: "status" });
  element;

  constructor(presets) {
    this.#presets = presets;
    this.element = el(
      "section",
      { class: "own-file", "aria-label": "Your own file" },
      el(
        "label",
        { class: "drop-zone" },
        this.#input,
        el("strong", {}, "Your model, volume or texture: drop it here"),
        el("span", { class: "muted" }, "or click to choose it: .glb, .gltf, .nrrd, .raw, .png, .jpg, .exr"),
      ),
      this.#status,
    );
  }

  async take(file) {
    if (!file) return;
    const say = (...nodes) => set_children(this.#status, ...nodes);
    const fail = (error) => say(el("p", { class: "notice error", role: "alert" }, error.message));
    try {
      const { accepts, max_bytes } = await get_assets();
      if (file.size > max_bytes) throw new Error(`The file is over the limit of ${max_bytes} bytes.`);
      const asset = await upload_asset(file, media_type_of(file, accepts), (part) =>
        say(part < 1 ? `Uploading ${file.name}: ${Math.round(100 * part)} %` : `Reading ${file.name}…`),
      );
      const spec = spec_for_file(asset, this.#presets);
      if (!spec) throw new Error(`There is no ready comparison for a ${asset.type}: choose it in the form.`);
      const needs_form = asset.media_type === WITHOUT_HEADER;
      say(
        el(
          "div",
          { class: "own-ready" },
          el("p", {}, el("strong", {}, asset_text(asset))),
          el("p", { class: "hint" }, plan_text(spec)),
          note_list(asset.notes ?? []),
          needs_form
            ? [
                el("p", {}, "It has no header, so the form has to say what it contains."),
                el("button", { type: "button", class: "primary", onclick: () => open_form(spec) }, "Describe it"),
              ]
            : run_buttons(asset.name, async () => spec, fail),
        ),
      );
      this.#status.querySelector("button").focus();
    } catch (error) {
      fail(error);
    }
    this.#input.value = "";
  }
}

/** `file`: one that was dropped elsewhere on the page, or null. */
export async function show_start(main, signal, { file = null } = {}) {
  document.title = "Sheer";
  const trouble = el("div", { "aria-live": "polite" });
  const fail = (error) => set_children(trouble, el("p", { class: "notice error", role: "alert" }, error.message));
  const list = el("ul", { class: "start-cards", "aria-label": "Ready comparisons" });
  const place = el("div");
  set_children(
    main,
    el(
      "div",
      { class: "start" },
      el("h1", {}, "Which way to draw transparency?"),
      el(
        "p",
        { class: "lead" },
        "Sheer renders a scene with several transparency methods, times them, compares each picture with an exact reference, " +
          "and says which method to use.",
      ),
      trouble,
      place,
      list,
      el(
        "p",
        {},
        el("a", { href: "#/new" }, "Write a comparison of your own"),
        " with every option, or repeat a published table.",
      ),
    ),
  );
  try {
    const presets = await load_presets();
    if (signal.aborted) return;
    const own = new OwnFile(presets);
    set_children(place, own.element);
    const cards = presets.map((preset) => card(preset, fail));
    set_children(
      list,
      cards.map(({ node }) => node),
    );
    if (file) own.take(file);
    const seconds = await load_durations();
    for (const { preset, time } of cards) {
      time.textContent = duration_text(seconds.get(preset.spec.title));
      time.hidden = false;
    }
  } catch (error) {
    if (!signal.aborted) fail(error);
  }
}
