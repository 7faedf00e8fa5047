// A new comparison at #/: a form and the same spec as JSON, checked by the service while it is edited.
import {
  get_examples,
  get_methods,
  get_rounds_needed,
  get_scenes,
  get_spec_fields,
  get_suites,
  submit,
  validate,
} from "./api.js";
import { el, set_children, unique_id } from "./dom.js";
import { clear_errors, focus_first_error, show_errors } from "./field_errors.js";
import { json_range } from "./json_position.js";
import { prepared_spec, presets_of } from "./presets.js";
import { SpecForm } from "./spec_form.js";
import { draft_is_edited, first_model, keep_draft, may_replace_draft } from "./spec_model.js";
import { suite_chooser } from "./suite_chooser.js";

const TYPING_PAUSE_MS = 300;

class CompareView {
  #model;
  #form;
  #signal;
  #request = null;
  #typing = null;
  #is_edited = draft_is_edited();
  #text_error = null;
  #state = el("p", { class: "spec-state", role: "status" });
  #text = el("textarea", {
    class: "json",
    spellcheck: "false",
    "aria-label": "Spec as JSON",
    "aria-describedby": "json-errors",
  });
  #text_errors = el("ul", { class: "json-errors", id: "json-errors" });
  #loose_errors = el("ul", { class: "json-errors" });
  #run = el("button", { type: "button", class: "primary", onclick: () => this.#submit() }, "Run comparison");

  constructor({ fields, methods, scenes, suites, examples, rounds_needed }, signal) {
    const presets = presets_of(examples);
    this.#signal = signal;
    const ready = [...presets, ...suites].map(({ spec }) => spec);
    this.#model = first_model(ready, { scene: { type: scenes[0]?.id }, methods: [] });
    this.#form = new SpecForm(this.#model, { fields, methods, scenes, rounds_needed });
    this.#model.addEventListener("edit", () => {
      this.#is_edited = true;
      this.#write_text();
      this.#changed();
    });
    this.#model.addEventListener("replace", () => {
      this.#form.draw();
      this.#changed();
    });
    this.#text.addEventListener("input", () => this.#read_text());
    signal.addEventListener("abort", () => clearTimeout(this.#typing));
    const leaving = (event) => {
      if (this.#is_edited) event.preventDefault();
    };
    window.addEventListener("beforeunload", leaving, { signal });
    this.element = el(
      "div",
      { class: "compare" },
      el("h1", {}, "New comparison"),
      this.#preset_row(presets),
      suite_chooser(suites, (spec) => this.#start_from(spec)),
      this.#tabs(),
      el("div", { class: "submit-bar" }, this.#state, this.#run),
    );
    this.#write_text();
    this.#changed();
  }

  #start_from(spec) {
    if (!may_replace_draft()) return;
    this.#is_edited = false;
    this.#model.start_from(spec);
    this.#write_text();
  }

  async #start_from_preset(preset) {
    try {
      this.#start_from(await prepared_spec(preset));
    } catch (error) {
      this.#show_problem(error);
    }
  }

  #preset_row(presets) {
    return el(
      "div",
      { class: "presets", role: "group", "aria-label": "Start from" },
      presets.map((preset) =>
        el(
          "button",
          {
            type: "button",
            class: "preset",
            onclick: () => this.#start_from_preset(preset),
          },
          el("strong", {}, preset.name),
          el("span", {}, preset.summary),
        ),
      ),
    );
  }

  #tabs() {
    const panels = [
      ["Form", el("div", {}, this.#loose_errors, this.#form.element)],
      [
        "Spec",
        el(
          "div",
          { class: "spec-panel" },
          el(
            "p",
            { class: "hint" },
            "The same comparison as JSON, for sheer compare or the REST interface. Edit it, or paste another.",
          ),
          this.#text,
          this.#text_errors,
        ),
      ],
    ];
    const tabs = panels.map(([name, panel], index) => {
      panel.id = unique_id("panel");
      panel.setAttribute("role", "tabpanel");
      panel.hidden = index !== 0;
      const tab = el(
        "button",
        {
          type: "button",
          role: "tab",
          id: unique_id("tab"),
          "aria-controls": panel.id,
          "aria-selected": String(index === 0),
          tabindex: index === 0 ? "0" : "-1",
          onclick: () => choose(index),
        },
        name,
      );
      panel.setAttribute("aria-labelledby", tab.id);
      return tab;
    });
    const choose = (chosen) => {
      tabs.forEach((tab, index) => {
        tab.setAttribute("aria-selected", String(index === chosen));
        tab.tabIndex = index === chosen ? 0 : -1;
        panels[index][1].hidden = index !== chosen;
      });
    };
    const list = el(
      "div",
      {
        class: "tabs",
        role: "tablist",
        "aria-label": "Ways to write the comparison",
        onkeydown: (event) => {
          if (event.key !== "ArrowLeft" && event.key !== "ArrowRight") return;
          const next = 1 - tabs.findIndex((tab) => tab.tabIndex === 0);
          choose(next);
          tabs[next].focus();
        },
      },
      tabs,
    );
    return el(
      "div",
      { class: "tabbed" },
      list,
      panels.map(([, panel]) => panel),
    );
  }

  #write_text() {
    this.#text_error = null;
    this.#text.value = JSON.stringify(this.#model.spec, null, 2);
  }

  #read_text() {
    this.#is_edited = true;
    try {
      const spec = JSON.parse(this.#text.value);
      this.#text_error = null;
      this.#model.replace(spec);
    } catch (error) {
      clearTimeout(this.#typing);
      this.#request?.abort();
      this.#text_error = error.message;
      this.#show([{ pointer: "", detail: `This is not JSON: ${error.message}` }]);
    }
  }

  #changed() {
    keep_draft(this.#model.spec, this.#model.origin, this.#is_edited);
    clearTimeout(this.#typing);
    this.#typing = setTimeout(() => this.#validate(), TYPING_PAUSE_MS);
  }

  async #validate() {
    this.#request?.abort();
    const request = (this.#request = new AbortController());
    try {
      await validate(this.#model.spec, request.signal);
      if (!request.signal.aborted) this.#show([]);
    } catch (error) {
      if (request.signal.aborted || this.#signal.aborted) return;
      this.#show_problem(error);
    }
  }

  #show_problem(error) {
    this.#show(error.errors?.length > 0 ? error.errors : [{ pointer: "", detail: error.message }]);
  }

  #show(errors) {
    this.#run.disabled = this.#text_error !== null;
    if (errors.length === 0) clear_errors(this.#form.element);
    const loose = show_errors(this.#form.element, errors);
    set_children(
      this.#loose_errors,
      loose.map(({ pointer, detail }) => el("li", {}, pointer ? `${pointer}: ` : "", detail)),
    );
    set_children(
      this.#text_errors,
      errors.map((error) =>
        el(
          "li",
          {},
          error.pointer === ""
            ? error.detail
            : [
                el(
                  "button",
                  { type: "button", class: "link", onclick: () => this.#select(error.pointer) },
                  error.pointer,
                ),
                ` ${error.detail}`,
              ],
        ),
      ),
    );
    if (errors.length > 0) this.#text.setAttribute("aria-invalid", "true");
    else this.#text.removeAttribute("aria-invalid");
    this.#state.className = errors.length > 0 ? "spec-state wrong" : "spec-state right";
    this.#state.textContent =
      errors.length === 0 ? "The spec is valid." : errors.length === 1 ? "1 error" : `${errors.length} errors`;
  }

  /** Selects the part of the text that an error is about. */
  #select(pointer) {
    if (this.#text_error) return;
    const [start, end] = json_range(this.#text.value, pointer);
    this.#text.focus();
    this.#text.setSelectionRange(start, end);
    const line = this.#text.value.slice(0, start).split("\n").length;
    const lines = this.#text.value.split("\n").length;
    this.#text.scrollTop = (this.#text.scrollHeight * line) / lines - this.#text.clientHeight / 2;
  }

  async #submit() {
    clearTimeout(this.#typing);
    this.#request?.abort();
    this.#run.disabled = true;
    this.#state.textContent = "Sending…";
    try {
      const id = await submit(this.#model.spec);
      this.#is_edited = false;
      keep_draft(this.#model.spec, this.#model.origin);
      if (!this.#signal.aborted) location.hash = `#/reports/${encodeURIComponent(id)}`;
    } catch (error) {
      this.#show_problem(error);
      if (error.status === 429) {
        this.#state.textContent = `The queue is full.${error.retry_after_s ? ` Try again in ${error.retry_after_s} s.` : ""}`;
      }
      focus_first_error(this.#form.element);
    }
    this.#run.disabled = this.#text_error !== null;
  }
}

export async function show_compare(main, signal) {
  document.title = "New comparison – Sheer";
  set_children(main, el("p", { class: "muted" }, "Loading…"));
  try {
    // The form also works without specs to start from.
    const none = () => [];
    const [fields, methods, scenes, rounds_needed, suites, examples] = await Promise.all([
      get_spec_fields(),
      get_methods(),
      get_scenes(),
      get_rounds_needed(),
      get_suites().catch(none),
      get_examples().catch(none),
    ]);
    if (!signal.aborted)
      set_children(main, new CompareView({ fields, methods, scenes, rounds_needed, suites, examples }, signal).element);
  } catch (error) {
    if (!signal.aborted)
      set_children(
        main,
        el("h1", {}, "New comparison"),
        el("p", { class: "notice error", role: "alert" }, error.message),
      );
  }
}
