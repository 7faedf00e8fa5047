// The form of a spec: scene, image, methods, reference, timing and checks, made from the service's self-description.
import { el, select, set_children, unique_id } from "./dom.js";
import { field_frame, fields_of, new_entry } from "./param_form.js";
import { pointer_of, same_id } from "./spec_model.js";
import { suite_note } from "./suite_chooser.js";
import { SweepForm } from "./sweep_form.js";

export class SpecForm {
  #model;
  #fields;
  #methods;
  #scenes;
  #rounds_needed;
  #list = el("ol", { class: "method-list" });
  #baseline_place = el("div", { class: "stacked" });
  #checks = el("ol", { class: "check-list" });
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
      this.#draw_title();
      this.#draw_checks();
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
    this.#sweep = new SweepForm(this.#model, {
      fields: this.#fields,
      methods: this.#methods,
      scenes: this.#scenes,
      labels: () => this.#labels,
    });
    const left = el(
      "div",
      { class: "column" },
      this.#scene_section(),
      this.#image_section(),
      this.#timing_section(),
      this.#sweep.element,
    );
    const right = el(
      "div",
      { class: "column" },
      this.#methods_section(),
      this.#reference_section(),
      this.#checks_section(),
    );
    set_children(this.element, this.#title_section(), el("div", { class: "columns" }, left, right));
  }

  /** Labels of the methods, numbered as by the service. */
  get #labels() {
    const taken = new Set();
    const specs = this.#method_specs;
    for (const { label } of specs) if (label) taken.add(label);
    return specs.map(({ id, label }) => {
      if (label) return label;
      let name = id;
      for (let number = 2; taken.has(name); ++number) name = `${id} ${number}`;
      taken.add(name);
      return name;
    });
  }

  get #method_specs() {
    const methods = this.#model.get(["methods"]);
    return (Array.isArray(methods) ? methods : []).map((method) =>
      typeof method === "string" ? { id: method } : (method ?? {}),
    );
  }

  #section(title, pointer, ...children) {
    return el(
      "section",
      { class: "card", "data-pointer": pointer, "aria-label": title },
      el("h2", {}, title),
      children,
      el("p", { class: "error-text", hidden: true }),
    );
  }

  #title_section() {
    const title = { ...this.#field("title"), placeholder: "What is compared" };
    const fields = fields_of([title], [], this.#model);
    fields.append(this.#tags_field());
    return el(
      "section",
      { class: "card title-card", "aria-label": "Title and tags" },
      fields,
      this.#left_note(),
      suite_note(this.#model),
    );
  }

  #draw_title() {
    this.element.querySelector(".title-card").replaceWith(this.#title_section());
  }

  /** What was removed together with the ready-made spec, and a button to restore it. */
  #left_note() {
    const { left } = this.#model;
    if (!left) return null;
    const checks =
      left.checks.length === 1 ? "the check" : left.checks.length > 1 ? `${left.checks.length} checks` : "";
    const what = [left.title ? `the title “${left.title}”` : "", checks].filter(Boolean).join(" and ");
    const put_back = () => {
      this.#model.put_back();
      this.#draw_title();
      this.#draw_checks();
      this.element.querySelector(".title-card input").focus();
    };
    return el(
      "div",
      { class: "left-note", role: "status" },
      `This is now a different comparison, so ${what} of the ready-made one went. `,
      el("button", { type: "button", class: "link", onclick: put_back }, "Put back"),
    );
  }

  #tags_field() {
    const id = unique_id("field");
    const tags = this.#model.get(["tags"]);
    const text = Object.entries(typeof tags === "object" && tags !== null ? tags : {}).map(
      ([name, value]) => `${name}: ${value}`,
    );
    const input = el("input", {
      id,
      type: "text",
      value: text.join(", "),
      placeholder: "branch: main, gpu: none",
      oninput: () => {
        const parts = input.value
          .split(",")
          .map((part) => part.split(":"))
          .filter(([name]) => name.trim() !== "");
        const read = Object.fromEntries(parts.map(([name, ...rest]) => [name.trim(), rest.join(":").trim()]));
        this.#model.set(["tags"], parts.length > 0 ? read : undefined);
      },
    });
    return field_frame({ name: "tags", kind: "text", summary: "name: text, separated by commas" }, ["tags"], input, {
      for_id: id,
    });
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
    return this.#section("Scene", "/scene", frame, info ? fields_of(info.parameters, ["scene"], this.#model) : null);
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
      this.#draw_title();
    }
    const section = this.element.querySelector("[data-pointer='/scene']");
    section.replaceWith(this.#scene_section());
    this.#sweep.draw();
    this.element.querySelector("[data-pointer='/scene'] select").focus();
  }

  #image_section() {
    return this.#section("Image", "/image", fields_of(this.#field("image").fields, ["image"], this.#model));
  }

  #timing_section() {
    const fields = fields_of(this.#field("timing").fields, ["timing"], this.#model);
    fields.querySelector("[data-pointer='/timing/rounds'] > .error-text").before(this.#rounds_note);
    this.#show_rounds();
    return this.#section("Timing", "/timing", fields);
  }

  #show_rounds() {
    const { fields } = this.#field("timing");
    const rounds = this.#model.get(["timing", "rounds"]) ?? fields.find(({ name }) => name === "rounds").default;
    const methods = this.#method_specs.length;
    const needed = this.#rounds_needed[Math.max(methods, 1) - 1];
    const compared = methods > 1 ? `${methods} methods` : "methods";
    const text = rounds < needed ? `Too few rounds: ${rounds}, needs ${needed} to tell ${compared} apart.` : "";
    if (this.#rounds_note.textContent !== text) this.#rounds_note.textContent = text;
  }

  #methods_section() {
    this.#draw_methods();
    const add = this.#methods.map((method) =>
      el(
        "li",
        {},
        el(
          "button",
          {
            type: "button",
            class: "small",
            "aria-label": `Add ${method.name}`,
            onclick: () => {
              this.#put_methods([...(this.#model.get(["methods"]) ?? []), method.id]);
              const card = this.#list.lastElementChild;
              card.querySelector("details")?.setAttribute("open", "");
              card.querySelector("input").focus();
            },
          },
          `+ ${method.name}`,
        ),
        el("p", { class: "hint" }, method.summary),
      ),
    );
    return this.#section(
      "Methods",
      "/methods",
      this.#list,
      el("ul", { class: "add-methods", "aria-label": "Add a method" }, add),
    );
  }

  #put_methods(methods) {
    this.#model.set(["methods"], methods);
    this.#draw_methods();
    this.#draw_baseline();
    this.#draw_checks();
    this.#sweep.draw();
  }

  #draw_methods() {
    set_children(
      this.#list,
      this.#method_specs.map((method, index) => this.#method_card(method, index)),
    );
    if (this.#list.children.length === 0)
      set_children(this.#list, el("li", { class: "empty muted" }, "No methods yet."));
  }

  #method_card(method, index) {
    const info = this.#methods.find((one) => same_id(one.id, method.id));
    const path = ["methods", index];
    const name = info?.name ?? String(method.id);
    const methods = () => this.#model.get(["methods"]);
    const button = (text, label, action, disabled = false) =>
      el(
        "button",
        {
          type: "button",
          class: "quiet small",
          "aria-label": `${label} ${name} (${index + 1})`,
          title: label,
          disabled,
          onclick: action,
        },
        text,
      );
    const label_id = unique_id("field");
    const label = el("input", {
      id: label_id,
      type: "text",
      value: method.label ?? "",
      placeholder: this.#labels[index],
      oninput: () => {
        this.#model.set([...path, "label"], label.value === "" ? undefined : label.value);
        this.#draw_baseline();
        this.#draw_checks();
        this.#sweep.draw();
      },
    });
    const copy = () => {
      const { label: taken, ...rest } = method_object(methods()[index]);
      this.#put_methods(methods().toSpliced(index + 1, 0, Object.keys(rest).length > 1 ? rest : rest.id));
    };
    const move = () => {
      const next = [...methods()];
      [next[index - 1], next[index]] = [next[index], next[index - 1]];
      this.#put_methods(next);
    };
    return el(
      "li",
      { class: "method-card", "data-pointer": pointer_of(path) },
      el(
        "div",
        { class: "method-head" },
        el("strong", {}, name),
        info?.kind ? el("span", { class: "muted kind" }, info.kind) : null,
        el(
          "span",
          { class: "head-buttons" },
          button("↑", "Move up", move, index === 0),
          button("Copy", "Copy", copy),
          button("✕", "Remove", () => this.#put_methods(methods().toSpliced(index, 1))),
        ),
      ),
      info ? el("p", { class: "hint" }, info.summary) : null,
      el(
        "div",
        { class: "fields" },
        field_frame({ name: "label", kind: "text", summary: "" }, [...path, "label"], label, { for_id: label_id }),
      ),
      info ? this.#parameters(info, path) : null,
      el("p", { class: "error-text", hidden: true }),
    );
  }

  /** Folded away until one of them is set. */
  #parameters(info, path) {
    if (info.parameters.length === 0) return null;
    const is_set = info.parameters.some((param) => this.#model.get([...path, param.name]) !== undefined);
    return el(
      "details",
      { class: "parameters", open: is_set },
      el("summary", {}, info.parameters.length === 1 ? "1 parameter" : `${info.parameters.length} parameters`),
      fields_of(info.parameters, path, this.#model),
    );
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
        info ? this.#parameters(info, ["reference"]) : null,
      );
    };
    draw();
    this.#draw_baseline();
    return this.#section("Reference and baseline", "", place, this.#baseline_place);
  }

  #draw_baseline() {
    const id = unique_id("field");
    const current = this.#model.get(["baseline"]) ?? "";
    const choices = [["", "default"], ...this.#labels.map((label) => [label, label])];
    if (current !== "" && !this.#labels.includes(current)) choices.push([current, current]);
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

  #checks_section() {
    this.#draw_checks();
    const add = el(
      "button",
      {
        type: "button",
        class: "small",
        onclick: () => {
          const check = { ...new_entry(this.#field("checks").fields), method: this.#labels[0] ?? "", max: 0.05 };
          this.#model.set(["checks"], [...(this.#model.get(["checks"]) ?? []), check]);
          this.#draw_checks();
          this.#checks.lastElementChild.querySelector("select").focus();
        },
      },
      "+ Add a check",
    );
    return this.#section(
      "Checks",
      "/checks",
      el("p", { class: "hint" }, this.#field("checks").summary),
      this.#checks,
      el("div", { class: "add-row" }, add),
    );
  }

  #draw_checks() {
    const checks = this.#model.get(["checks"]);
    set_children(
      this.#checks,
      (Array.isArray(checks) ? checks : []).map((check, index) => this.#check_row(check ?? {}, index)),
    );
  }

  #check_row(check, index) {
    const path = ["checks", index];
    const described = this.#field("checks").fields;
    const { choices: metrics } = described.find(({ name }) => name === "metric");
    const with_points = (this.#model.get(["sweep"]) ?? []).length > 0 || check.at !== undefined;
    const bounds = described.filter(({ name }) => ["min", "max"].includes(name) || (name === "at" && with_points));
    const pick = (name, choices) => {
      const id = unique_id("field");
      const current = check[name] ?? "";
      const all = choices.includes(current) ? choices : [...choices, current];
      const input = select(
        { id, onchange: () => this.#model.set([...path, name], input.value) },
        all.map((one) => [one, one]),
        current,
      );
      return field_frame({ name, kind: "choice", summary: "" }, [...path, name], input, { for_id: id });
    };
    const fields = fields_of(bounds, path, this.#model);
    fields.prepend(pick("metric", metrics), pick("method", this.#labels));
    return el(
      "li",
      { class: "check-row", "data-pointer": pointer_of(path) },
      fields,
      el(
        "button",
        {
          type: "button",
          class: "quiet small",
          "aria-label": `Remove check ${index + 1}`,
          title: "Remove",
          onclick: () => {
            const left = this.#model.get(["checks"]).toSpliced(index, 1);
            this.#model.set(["checks"], left.length > 0 ? left : undefined);
            this.#draw_checks();
          },
        },
        "✕",
      ),
      el("p", { class: "error-text", hidden: true }),
    );
  }
}

function method_object(method) {
  return typeof method === "string" ? { id: method } : { ...method };
}
