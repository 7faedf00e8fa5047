// The form of a spec: scene, image, methods, reference, timing and checks, made from the service's self-description.
import { ChecksForm } from "./checks_form.js";
import { el, select, set_children, unique_id } from "./dom.js";
import { form_section } from "./form_section.js";
import { MethodsForm, parameter_fields } from "./methods_form.js";
import { field_frame } from "./field_frame.js";
import { fields_of, new_entry } from "./param_form.js";
import { labels_of, method_object, method_specs } from "./spec_methods.js";
import { same_id } from "./spec_model.js";
import { SweepForm } from "./sweep_form.js";
import { TitleForm } from "./title_form.js";

export class SpecForm {
  #model;
  #fields;
  #methods;
  #scenes;
  #rounds_needed;
  #baseline_place = el("div", { class: "stacked" });
  #title;
  #checks;
  #sweep;
  #left_scenes = new Map(); // by type, to be restored
  #rounds_note = el("p", { class: "warning-text", role: "status" });

  constructor(model, { fields, methods, scenes, rounds_needed }) {
    this.#model = model;
    this.#fields = fields;
    this.#methods = methods;
    this.#scenes = scenes;
    this.#rounds_needed = rounds_needed; // for 1, 2, 3 and more methods
    this.element = el("form", {
      class: "spec-form",
      novalidate: true,
      "aria-label": "Comparison",
      onsubmit: (event) => event.preventDefault(),
    });
    model.addEventListener("edit", () => this.#show_rounds());
    model.addEventListener("leave", () => {
      this.#title.draw();
      this.#checks.draw();
    });
    this.draw();
  }

  /** The description of a field of the spec. */
  #field(name) {
    return this.#fields.find((field) => field.name === name);
  }

  /** Draws everything again after the spec was replaced. */
  draw() {
    this.#left_scenes.clear();
    this.#checks = new ChecksForm(this.#model, this.#field("checks"));
    this.#title = new TitleForm(this.#model, this.#field("title"), () => this.#checks.draw());
    this.#sweep = new SweepForm(this.#model, {
      fields: this.#fields,
      methods: this.#methods,
      scenes: this.#scenes,
      labels: () => labels_of(this.#model),
    });
    const methods = new MethodsForm(this.#model, this.#methods, () => {
      this.#draw_baseline();
      this.#checks.draw();
      this.#sweep.draw();
    });
    const left = [this.#scene_section(), this.#image_section(), this.#timing_section(), this.#sweep.element];
    const right = [methods.element, this.#reference_section(), this.#checks.element];
    set_children(
      this.element,
      this.#title.element,
      el("div", { class: "columns" }, el("div", { class: "column" }, left), el("div", { class: "column" }, right)),
    );
  }

  #scene_section() {
    const id = unique_id("field");
    const type = this.#model.get(["scene", "type"]) ?? "";
    const info = this.#scenes.find((scene) => same_id(scene.id, type));
    const choices = this.#scenes.map((scene) => [scene.id, scene.name]);
    if (!info) choices.unshift([type, type === "" ? "Choose a scene" : `${type} (unknown)`]);
    const input = select({ id, onchange: () => this.#choose_scene(input.value) }, choices, info?.id ?? type);
    const frame = field_frame(
      { name: "type", kind: "choice", summary: info?.summary ?? "" },
      ["scene", "type"],
      input,
      { for_id: id },
    );
    frame.append(this.#scene_pictures(info));
    frame.classList.add("wide");
    return form_section("Scene", "/scene", frame, info ? fields_of(info.parameters, ["scene"], this.#model) : null);
  }

  /** A picture of each scene to choose from. `chosen` may be missing. */
  #scene_pictures(chosen) {
    const button = (scene) =>
      el(
        "button",
        {
          type: "button",
          class: "scene-picture",
          title: scene.summary,
          "aria-pressed": String(scene === chosen),
          onclick: () => this.#choose_scene(scene.id),
        },
        el("img", { src: `thumbnails/${scene.id}.png`, alt: "", width: 96, height: 96 }),
        el("span", {}, scene.name),
      );
    return el("div", { class: "scene-pictures", role: "group", "aria-label": "Scenes" }, ...this.#scenes.map(button));
  }

  /** Each scene has its own parameters, shading and texture; they are restored when it is chosen again. */
  #choose_scene(type) {
    const info = this.#scenes.find((scene) => scene.id === type);
    const old = this.#model.get(["scene"]);
    if (!info || same_id(old?.type, type)) return;
    if (typeof old?.type === "string") this.#left_scenes.set(old.type.toLowerCase(), old);
    this.#model.set(["scene"], this.#left_scenes.get(type) ?? { type, ...new_entry(info.parameters) });
    if (this.#model.get(["suite"]) !== undefined) {
      this.#model.set(["suite"], undefined); // its figures belong to the previous scene
      this.#title.draw();
    }
    const section = this.element.querySelector("[data-pointer='/scene']");
    section.replaceWith(this.#scene_section());
    this.#sweep.draw();
    this.element.querySelector("[data-pointer='/scene'] select").focus();
  }

  #image_section() {
    return form_section("Image", "/image", fields_of(this.#field("image").fields, ["image"], this.#model));
  }

  #timing_section() {
    const fields = fields_of(this.#field("timing").fields, ["timing"], this.#model);
    fields.querySelector("[data-pointer='/timing/rounds'] > .error-text").before(this.#rounds_note);
    this.#show_rounds();
    return form_section("Timing", "/timing", fields);
  }

  #show_rounds() {
    const { fields } = this.#field("timing");
    const rounds = this.#model.get(["timing", "rounds"]) ?? fields.find(({ name }) => name === "rounds").default;
    const methods = method_specs(this.#model).length;
    const needed = this.#rounds_needed[Math.max(methods, 1) - 1];
    const compared = methods > 1 ? `${methods} methods` : "methods";
    const text = rounds < needed ? `Too few rounds: ${rounds}, needs ${needed} to tell ${compared} apart.` : "";
    if (this.#rounds_note.textContent !== text) this.#rounds_note.textContent = text;
  }

  #reference_section() {
    const described = this.#field("reference");
    const place = el("div", { class: "stacked" });
    const draw = () => {
      const reference = method_object(this.#model.get(["reference"]) ?? described.default);
      const info = this.#methods.find((one) => same_id(one.id, reference.id));
      const id = unique_id("field");
      const choices = this.#methods.map((one) => [one.id, one.name]);
      if (!info) choices.unshift([reference.id, reference.id]);
      const input = select(
        {
          id,
          onchange: () => {
            this.#model.set(["reference"], input.value === described.default ? undefined : input.value);
            draw();
            place.querySelector("select").focus();
          },
        },
        choices,
        info?.id ?? reference.id,
      );
      set_children(
        place,
        field_frame({ ...described, kind: "choice" }, ["reference"], input, { for_id: id }),
        info ? parameter_fields(info, ["reference"], this.#model) : null,
      );
    };
    draw();
    this.#draw_baseline();
    return form_section("Reference and baseline", "", place, this.#baseline_place);
  }

  #draw_baseline() {
    const id = unique_id("field");
    const labels = labels_of(this.#model);
    const current = this.#model.get(["baseline"]) ?? "";
    const choices = [["", "default"], ...labels.map((label) => [label, label])];
    if (current !== "" && !labels.includes(current)) choices.push([current, current]);
    const input = select(
      { id, onchange: () => this.#model.set(["baseline"], input.value || undefined) },
      choices,
      current,
    );
    set_children(
      this.#baseline_place,
      field_frame({ ...this.#field("baseline"), kind: "choice" }, ["baseline"], input, {
        for_id: id,
      }),
    );
  }
}
