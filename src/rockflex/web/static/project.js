// The project of the page in one file, and the head of its reports.

import { attempt, send } from "./api.js";
import { h, tooLarge } from "./dom.js";
import { field, fileBox, folded, trouble } from "./form.js";
import { downloads } from "./jobs.js";
import { t } from "./texts.js";

let said = ""; // of the last project that was opened

export function project(app) {
  const entry = ([name, label]) => {
    const input = h("input", { type: "text", maxlength: 120, onchange: () => app.change({ head: { [name]: input.value.trim() } }) });
    return [name, input, field(`head.${name}`, label, input)];
  };
  const entries = [["title", t("Title of the report")], ["project", t("Project")], ["author", t("Author")], ["checker", t("Checked by")]].map(entry);
  const told = h("p", { class: "hint", role: "status" }, said);
  said = "";

  async function take(file) {
    const large = tooLarge(file, app.about.limits.project);
    if (large) app.complain(element, { project: large });
    else await attempt(async () => {
      const { state, left } = await send("/api/project", file);
      said = left.length ? t("Not on the page, and not in projects that it saves: {parts}.", { parts: left.map((part) => t(part)).join(", ") }) : "";
      app.restore({ ...state, tab: app.state.tab });
    }, (error) => app.complain(element, error.errors));
  }

  const element = folded("project", t("Project and report"), entries.map(([, , shown]) => shown));
  element.append(h("div", { class: "field", "data-path": "project" },
    h("p", { class: "hint" }, t("A project is one file with the structure, the record, the alternatives and these texts.")),
    downloads(app, [["project", t("Save the project")]]),
    h("label", { for: "open-project" }, t("Open a project")), fileBox(".rockflex", take, { id: "open-project" }), told, trouble()));
  const refresh = () => entries.forEach(([name, input]) => document.activeElement !== input && (input.value = app.state.head[name] ?? ""));
  return { element, refresh, take };
}
