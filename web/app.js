// The page: chooses the view for the address.
import { split_hash } from "./address.js";
import { show_archive } from "./archive_view.js";
import { show_baselines } from "./baselines_view.js";
import { show_compare } from "./compare_view.js";
import { show_diff } from "./diff_view.js";
import { el, set_children } from "./dom.js";
import { accept_drops } from "./drop.js";
import { show_report } from "./report_page.js";
import { show_start } from "./start_view.js";
import { show_trend } from "./trend_view.js";

const ROUTES = [
  [/^#?\/?$/, show_start],
  [/^#\/new$/, show_compare],
  [/^#\/reports\/?$/, show_archive],
  [/^#\/reports\/([^/]+)$/, show_report],
  [/^#\/baselines\/?$/, show_baselines],
  [/^#\/trends\/([^/]+)$/, show_trend],
  [/^#\/diff\/([^/]+)\/([^/]+)$/, show_diff],
];

class Page {
  #main = document.getElementById("main");
  #leave = null;
  #path = null;
  #on_query = null;

  /** `file`: a dropped file for the start page. */
  show({ moved = false, file = null } = {}) {
    const { path, query } = split_hash(location.hash);
    if (path === "#main") return;
    // A view that is shown already takes over what "back" and "forward" change in its query.
    if (path === this.#path && !file && this.#on_query) {
      this.#on_query(query);
      return;
    }
    this.#path = path;
    this.#leave?.abort();
    this.#leave = new AbortController();
    this.#on_query = null;
    document.documentElement.classList.remove("has-filling");
    this.#mark_current(path);
    const [pattern, view] = ROUTES.find(([one]) => one.test(path)) ?? [/.*/, show_nothing];
    const parts = pattern
      .exec(path)
      .slice(1)
      .map((part) => decodeURIComponent(part));
    const on_query = (take) => {
      this.#on_query = take;
    };
    view(this.#main, this.#leave.signal, { parts, query, on_query, file });
    if (!moved) return;
    window.scrollTo(0, 0);
    this.#main.focus({ preventScroll: true });
  }

  #mark_current(path) {
    for (const link of document.querySelectorAll("header.site nav a")) {
      const of_reports = path.startsWith("#/reports") || path.startsWith("#/diff") || path.startsWith("#/trends");
      const own = ["#/new", "#/baselines"].find((one) => path.startsWith(one));
      const here = of_reports ? "#/reports" : (own ?? "#/");
      if (link.getAttribute("href") === here) link.setAttribute("aria-current", "page");
      else link.removeAttribute("aria-current");
    }
  }
}

function show_nothing(main) {
  document.title = "Sheer";
  set_children(
    main,
    el(
      "section",
      { class: "plain-page" },
      el("h1", {}, "Not found"),
      el("p", {}, "There is no such page."),
      el(
        "div",
        { class: "actions" },
        el("a", { class: "button", href: "#/" }, "Start"),
        el("a", { class: "button", href: "#/reports" }, "All reports"),
      ),
    ),
  );
}

const page = new Page();
window.addEventListener("hashchange", () => page.show({ moved: true }));
accept_drops((file) => {
  if (split_hash(location.hash).path !== "#/") history.pushState(null, "", "#/");
  page.show({ moved: true, file });
});
page.show();
