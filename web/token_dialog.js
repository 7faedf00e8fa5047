// Asks for a token, if the service wants one.
import { begin_session } from "./api.js";
import { el, unique_id } from "./dom.js";

/** `on_done()`: the service has taken the token. Opened once, however many requests were refused. */
export function open_token_dialog(on_done) {
  if (document.querySelector("dialog.token")) return;
  const id = unique_id("token");
  const input = el("input", { id, type: "password", autocomplete: "off", required: true, spellcheck: "false" });
  const trouble = el("p", { class: "error-text", role: "alert", hidden: true });
  const submit = el("button", { type: "submit", class: "primary" }, "Continue");
  const send = async (event) => {
    event.preventDefault();
    submit.disabled = true;
    try {
      await begin_session(input.value.trim());
      dialog.close();
      on_done();
    } catch (error) {
      trouble.textContent = error.message;
      trouble.hidden = false;
      input.select();
    }
    submit.disabled = false;
  };
  const title = el("h2", { id: `${id}-title` }, "This service asks for a token");
  const dialog = el(
    "dialog",
    { class: "token", "aria-labelledby": title.id },
    el(
      "form",
      { onsubmit: send },
      title,
      el(
        "p",
        { class: "muted" },
        "Whoever runs it makes one with ",
        el("code", {}, "sheer token create NAME"),
        ". This browser keeps it until it is closed.",
      ),
      el("label", { for: id }, "Token"),
      input,
      trouble,
      el("div", { class: "actions" }, submit),
    ),
  );
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
}
