// The page: chooses the view for the address.
import { split_hash } from "./address.js";
import { el, set_children } from "./dom.js";
import { accept_drops } from "./drop.js";

/** Each view is loaded when it is shown for the first time. */
const ROUTES = [
  [/^#?\/?$/, async () => (await import("./start_view.js")).show_start],
  [/^#\/new$/, async () => (await import("./compare_view.js")).show_compare],
  [/^#\/reports\/?$/, async () => (await import("./archive_view.js")).show_archive],
  [/^#\/reports\/([^/]+)$/, async () => (await import("./report_page.js")).show_report],
  [/^#\/baselines\/?$/, async () => (await import("./baselines_view.js")).show_baselines],
  [/^#\/trends\/([^/]+)$/, async () => (await import("./trend_view.js")).show_trend],
  [/^#\/diff\/([^/]+)\/([^/]+)$/, async () => (await import("./diff_view.js")).show_diff],
];

class Page {
  #main = document.getElementById("main");
  #leave = null;
  #path = null;
  #on_query = null;

  /** `file`: a dropped file for the start page. */
  async show({ moved = false, file = null } = {}) {
    const { path, query } = split_hash(location.hash);
    if (path === "#main") return;
    // A view that is shown already takes over what "back" and "forward" change in its query.
    if (path === this.#path && !file && this.#on_query) {
      this.#on_query(query);
      return;
    }
    this.#path = path;
    this.#leave?.abort();
    const leave = (this.#leave = new AbortController());
    this.#on_query = null;
    document.documentElement.classList.remove("has-filling");
    this.#mark_current(path);
    const [pattern, load] = ROUTES.find(([one]) => one.test(path)) ?? [/.*/, async () => show_nothing];
    const parts = pattern
      .exec(path)
      .slice(1)
      .map((part) => decodeURIComponent(part));
    const view = await load().catch(() => show_lost);
    if (leave.signal.aborted) return;
    const on_query = (take) => {
      this.#on_query = take;
    };
    view(this.#main, leave.signal, { parts, query, on_query, file });
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

function plain_page(main, title, text, ...actions) {
  document.title = "Sheer";
  set_children(
    main,
    el(
      "section",
      { class: "plain-page" },
      el("h1", {}, title),
      el("p", {}, text),
      el("div", { class: "actions" }, actions),
    ),
  );
}

function show_nothing(main) {
  plain_page(
    main,
    "Not found",
    "There is no such page.",
    el("a", { class: "button", href: "#/" }, "Start"),
    el("a", { class: "button", href: "#/reports" }, "All reports"),
  );
}

/** A part of the page itself could not be loaded. */
function show_lost(main) {
  const again = el("button", { type: "button", onclick: () => location.reload() }, "Load again");
  plain_page(main, "The server is not reachable", "This part of the page could not be loaded.", again);
}

/** The view is loaded anew with the token. */
async function ask_for_token() {
  const { open_token_dialog } = await import("./token_dialog.js");
  open_token_dialog(() => location.reload());
}

const page = new Page();
window.addEventListener("hashchange", () => page.show({ moved: true }));
accept_drops((file) => {
  if (split_hash(location.hash).path !== "#/") history.pushState(null, "", "#/");
  page.show({ moved: true, file });
});
window.addEventListener("sheer-token-wanted", ask_for_token);
page.show();
