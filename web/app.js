// The page: which view the address asks for.
import { show_archive } from "./archive_view.js";
import { show_compare } from "./compare_view.js";
import { show_diff } from "./diff_view.js";
import { el, set_children } from "./dom.js";
import { show_report } from "./report_page.js";

const ROUTES = [
  [/^#?\/?$/, show_compare],
  [/^#\/reports\/?$/, show_archive],
  [/^#\/reports\/([^/?]+)$/, show_report],
  [/^#\/diff\/([^/?]+)\/([^/?]+)$/, show_diff],
];

const main = document.getElementById("main");
let leave = null;

function mark_current(hash) {
  for (const link of document.querySelectorAll("header.site nav a")) {
    const target = link.getAttribute("href");
    const of_reports = hash.startsWith("#/reports") || hash.startsWith("#/diff");
    const current = target === "#/reports" ? of_reports : !of_reports;
    if (current) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  }
}

function route(moved) {
  const hash = location.hash;
  if (hash === "#main") return;
  leave?.abort();
  leave = new AbortController();
  mark_current(hash);
  const found = ROUTES.find(([pattern]) => pattern.test(hash));
  if (!found) {
    set_children(
      main,
      el("h1", {}, "Not here"),
      el("p", {}, "There is no such page. ", el("a", { href: "#/" }, "New comparison")),
    );
    return;
  }
  const [pattern, show] = found;
  show(main, leave.signal, ...pattern.exec(hash).slice(1).map(decodeURIComponent));
  if (!moved) return;
  window.scrollTo(0, 0);
  main.focus({ preventScroll: true });
}

window.addEventListener("hashchange", () => route(true));
route(false);
