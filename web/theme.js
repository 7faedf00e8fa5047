// Light, dark, or the system's choice. A classic script, so that the choice is known before the first paint.
(() => {
  const KEY = "sheer.theme";
  const CHOICES = ["auto", "light", "dark"];
  const NAMES = { auto: "system", light: "light", dark: "dark" };
  const SIGNS = { auto: "◐", light: "○", dark: "●" };

  // Storage is not available to some pages, such as files opened from disk with strict settings.
  const load = () => {
    try {
      return localStorage.getItem(KEY);
    } catch {
      return null;
    }
  };
  const keep = (choice) => {
    try {
      localStorage.setItem(KEY, choice);
    } catch {
      // The choice is then valid for this page only.
    }
  };

  let choice = CHOICES.includes(load()) ? load() : "auto";
  const apply = () => {
    if (choice === "auto") delete document.documentElement.dataset.theme;
    else document.documentElement.dataset.theme = choice;
  };
  apply();

  document.addEventListener("DOMContentLoaded", () => {
    const button = document.getElementById("theme-toggle");
    if (!button) return;
    const show = () => {
      button.textContent = `${SIGNS[choice]} ${NAMES[choice]}`;
      button.setAttribute("aria-label", `Theme: ${button.textContent}`);
    };
    show();
    button.addEventListener("click", () => {
      choice = CHOICES[(CHOICES.indexOf(choice) + 1) % CHOICES.length];
      keep(choice);
      apply();
      show();
    });
  });
})();
