// Which two reports of the archive to compare with each other; the older one is A.
import { get_diff } from "./api.js";
import { el, set_children } from "./dom.js";

const diff_address = ([before, after]) => `#/diff/${encodeURIComponent(before.id)}/${encodeURIComponent(after.id)}`;

export class ArchiveChoice {
  #ids;
  #known = new Map();
  #on_change;
  #text = el("span", { class: "muted", role: "status" });
  #asking = null;
  #asked = null; // the pair about which the service was asked last
  #button = el(
    "button",
    {
      type: "button",
      onclick: () => {
        location.hash = diff_address(this.#pair);
      },
    },
    "Compare",
  );
  element = el("div", { class: "choose-bar" }, this.#button, this.#text);

  /** `ids`: those that are chosen already; `on_change()` after every change of them. */
  constructor(ids, on_change) {
    this.#ids = new Set(ids);
    this.#on_change = on_change;
    this.#show();
  }

  get ids() {
    return [...this.#ids];
  }

  /** Takes note of entries of the list, some of which may be chosen. */
  learn(entries) {
    for (const entry of entries) this.#known.set(entry.id, entry);
    this.#show();
  }

  box(entry) {
    return el("input", {
      type: "checkbox",
      "aria-label": `Choose ${entry.title || "Untitled comparison"} to compare`,
      disabled: entry.status !== "done",
      checked: this.#ids.has(entry.id),
      onchange: (event) => {
        if (event.target.checked) this.#ids.add(entry.id);
        else this.#ids.delete(entry.id);
        this.#show();
        this.#on_change();
      },
    });
  }

  drop(id) {
    if (!this.#ids.delete(id)) return;
    this.#show();
    this.#on_change();
  }

  get #pair() {
    return [...this.#ids]
      .map((id) => this.#known.get(id))
      .filter(Boolean)
      .sort((a, b) => (a.created_at < b.created_at ? -1 : 1));
  }

  #show() {
    const pair = this.#pair;
    const key = pair.map(({ id }) => id).join();
    if (key === this.#asked) return;
    this.#asked = key;
    this.#asking?.abort();
    this.#button.disabled = true;
    if (pair.length === 2) this.#ask(pair);
    else
      this.#text.textContent = `Choose two finished reports of the same spec to see what changed; ${pair.length} chosen.`;
  }

  /** Which differences of specs can be compared is known to the service. */
  async #ask(pair) {
    const mine = (this.#asking = new AbortController());
    this.#text.textContent = "Comparing their specs…";
    try {
      await get_diff(pair[0].id, pair[1].id, {}, mine.signal);
      this.#button.disabled = false;
      this.#text.textContent = "Two reports of the same spec are chosen.";
    } catch (error) {
      if (mine.signal.aborted) return;
      const [first] = error.errors ?? [];
      const why = first ? ` ${first.pointer} ${first.detail}. ` : " ";
      set_children(this.#text, error.message, why, el("a", { href: diff_address(pair) }, "See where they differ"));
    }
  }
}
