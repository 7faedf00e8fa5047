// The control of a field that refers to a file: built-in names, uploaded files, and a button to upload another one.
import { get_assets, MOST_ASSETS, upload_asset } from "./api.js";
import { el, select, set_children, unique_id } from "./dom.js";
import { note_list } from "./notes.js";

const SHOWN_DIGITS = 12;

function caption_of(asset) {
  const size = asset.width && asset.height ? ` (${asset.width} × ${asset.height})` : "";
  return `${asset.name || asset.sha256.slice(0, SHOWN_DIGITS)}${size}`;
}

const RAW = "application/octet-stream";

/** The media type of a file: by the suffix of its name, otherwise as the browser says, otherwise plain bytes. */
export function media_type_of(file, kinds) {
  const name = file.name.toLowerCase();
  const kind =
    kinds.find(({ suffixes }) => suffixes.some((suffix) => name.endsWith(suffix))) ??
    kinds.find(({ media_type }) => media_type === file.type) ??
    kinds.find(({ media_type }) => media_type === RAW);
  if (kind) return kind.media_type;
  if (kinds.length === 0) throw new Error("It is not known which files the service accepts; reload the page.");
  throw new Error(`The name must end with ${kinds.flatMap(({ suffixes }) => suffixes).join(", ")}.`);
}

class AssetControl {
  #param;
  #current;
  #on_change;
  #uploaded = [];
  #kinds = [];
  #max_bytes = Infinity;
  #loaded;
  #select = el("select", { id: unique_id("field"), onchange: () => this.#choose(this.#select.value) });
  #file = el("input", { type: "file", hidden: true, onchange: () => this.#upload() });
  #button = el("button", { type: "button", class: "small", onclick: () => this.#file.click() }, "Upload…");
  #status = el("p", { class: "upload-status", role: "status" });
  #notes = el("div", { class: "asset-notes", "aria-live": "polite" });

  constructor(param, current, on_change) {
    this.#param = param;
    this.#current = current ?? "";
    this.#on_change = on_change;
    this.#button.setAttribute("aria-label", `Upload a ${param.asset_type}`);
    this.element = el("div", { class: "asset" }, this.#select, this.#button, this.#file, this.#status, this.#notes);
    this.#draw();
    this.#loaded = this.#load();
  }

  get id() {
    return this.#select.id;
  }

  async #load() {
    try {
      const { assets, accepts, max_bytes } = await get_assets();
      this.#uploaded = [...this.#uploaded, ...assets.filter(({ type }) => type === this.#param.asset_type)];
      this.#kinds = accepts.filter(({ type }) => type === this.#param.asset_type);
      this.#max_bytes = max_bytes;
      this.#file.accept = this.#kinds.flatMap(({ suffixes, media_type }) => [...suffixes, media_type]).join(",");
      this.#draw();
      if (assets.length === MOST_ASSETS) this.#say(`Only the newest ${MOST_ASSETS} uploaded files are listed.`);
    } catch (error) {
      this.#say(`The uploaded files cannot be listed: ${error.message}`, true);
    }
  }

  #draw() {
    const built_in = (this.#param.choices ?? []).map((name) => [name, name]);
    const uploaded = this.#uploaded.map((asset) => [asset.sha256, caption_of(asset)]);
    const known = [...built_in, ...uploaded].some(([value]) => value === this.#current);
    const choices = [
      known ? null : [this.#current, this.#current === "" ? `Choose a ${this.#param.asset_type}` : this.#current],
      ...built_in,
      uploaded.length > 0 ? { label: "Uploaded", choices: uploaded } : null,
    ].filter(Boolean);
    this.#select.replaceChildren(...select({}, choices).childNodes);
    this.#select.value = this.#current; // moving an option loses the selection
    this.#draw_notes();
  }

  /** Shows what is not read from the chosen file, or read differently. */
  #draw_notes() {
    const { notes = [], media_type } = this.#uploaded.find(({ sha256 }) => sha256 === this.#current) ?? {};
    set_children(
      this.#notes,
      media_type === RAW ? el("p", { class: "hint" }, "It has no header: describe its contents below.") : null,
      note_list(notes),
    );
  }

  #choose(value) {
    this.#current = value;
    this.#draw_notes();
    this.#on_change(value);
    const { media_type } = this.#uploaded.find(({ sha256 }) => sha256 === value) ?? {};
    this.element.dispatchEvent(new CustomEvent("filechosen", { bubbles: true, detail: { bare: media_type === RAW } }));
  }

  #say(text, is_error = false) {
    this.#status.textContent = text;
    this.#status.classList.toggle("error-text", is_error);
  }

  async #upload() {
    const [file] = this.#file.files;
    if (!file) return;
    this.#button.disabled = true;
    try {
      await this.#loaded; // by then it is known what is accepted
      if (file.size > this.#max_bytes) throw new Error(`The file is over the limit of ${this.#max_bytes} bytes.`);
      const asset = await upload_asset(file, media_type_of(file, this.#kinds), (part) =>
        this.#say(part < 1 ? `Uploading ${file.name}: ${Math.round(100 * part)} %` : `Reading ${file.name}`),
      );
      this.#uploaded = [asset, ...this.#uploaded.filter(({ sha256 }) => sha256 !== asset.sha256)];
      this.#say("");
      // Another scene may have been chosen meanwhile.
      if (this.element.isConnected) this.#choose(asset.sha256);
      this.#draw();
    } catch (error) {
      this.#say(error.message, true);
    } finally {
      this.#file.value = "";
      this.#button.disabled = false;
    }
  }
}

/** {element, id of its select}; `on_change(value)` gets a built-in name or the SHA-256 of an uploaded file. */
export function asset_control(param, current, on_change) {
  return new AssetControl(param, current, on_change);
}
