// Alternatives that are kept: their list, how their demands differ, and their motion beside that of the present structure.

import { isRigid, yields } from "./choices.js";
import { clone, decode, h, latest, scrolled, symbol, tableOf } from "./dom.js";
import { trouble } from "./form.js";
import { downloads, reports } from "./jobs.js";
import { legend } from "./marks.js";
import { t, written } from "./texts.js";

const OWN = ["structure", "models", "impact", "restitution", "bouc_wen", "ground"]; // what an alternative is made of
const WORDS = ["label", "status"]; // of a response, whose other texts are curves
const LOOKS = ["yielded", "fuse", "damper", "clay", "kinetic", "soil"].map((color, i) => ({ color, dash: [[5, 2], [1, 2], [9, 3]][i % 3] }));
const own = (from) => clone(Object.fromEntries(OWN.filter((name) => from[name] !== undefined).map((name) => [name, from[name]])));

// The name of the next one.
const free = (kept) => [..."ABCDEFG"].find((letter) => kept.every(({ name }) => name !== letter));

// `show` gets the responses of the kept ones, each with its structure and its look.
export function alternatives(app, show) {
  const { alternatives: most } = app.about.limits;
  const put = (kept) => app.change({ alternatives: kept });
  const add = () => put([...app.state.alternatives, { name: free(app.state.alternatives), ...own(app.state) }]);
  const keep = h("button", { type: "button", id: "keep", onclick: add });
  const list = h("ul", { class: "kept" });
  const table = scrolled(t("Demands of the alternatives"), { id: "differences" });
  const hint = h("p", { class: "hint" });
  const element = h("section", { id: "alternatives", "aria-label": t("Alternatives") });
  const files = downloads(app, reports(app, "comparison", t("Report of all (HTML)"), t("Report of all (PDF)")));
  element.append(h("h2", {}, t("Alternatives")),
    h("div", { "data-path": "alternatives" }, h("div", { class: "buttons" }, keep), list, trouble()), table, hint, files);
  let shown = ""; // what determines the table that is shown

  function rename(i, input) {
    const name = input.value.trim();
    const { alternatives: kept } = app.state;
    const taken = kept.some((each, k) => k !== i && each.name === name);
    app.complain(element, name && !taken ? {} : { alternatives: t("A name must not be empty, nor that of another alternative.") });
    if (name && !taken) put(kept.map((each, k) => (k === i ? { ...each, name } : each)));
    else input.value = kept[i].name;
  }

  // Studies go on with models that the structure has.
  function edit(i) {
    const next = clone(app.state);
    for (const name of OWN) delete next[name];
    Object.assign(next, own(app.state.alternatives[i]));
    const fits = (label) => (label === "rigid") === isRigid(next.structure) && (next.bouc_wen || !yields(label));
    if (!next.cloud.models.every(fits)) next.cloud.models = [next.models[0]];
    if (!fits(next.design.model)) [next.design.model] = next.models;
    app.restore(next);
  }

  const row = ({ name }, i) => {
    const input = h("input", { type: "text", maxlength: 40, value: name, "aria-label": t("Name of the alternative"), onchange: () => rename(i, input) });
    const button = (text, run) => h("button", { type: "button", "aria-label": `${text}: ${name}`, onclick: run }, text);
    return h("li", {}, legend([{ label: "", ...LOOKS[i] }]), input, button(t("Edit again"), () => edit(i)),
      button(t("Remove"), () => {
        put(app.state.alternatives.filter((_, k) => k !== i));
        keep.focus();
      }));
  };

  const load = latest(async () => {
    const { tab, cloud, design, target, head, ...rest } = app.state;
    const key = JSON.stringify(rest);
    if (key === shown) return;
    const kept = rest.alternatives;
    const answer = kept.length ? await app.ask("/api/alternatives", element) : { rows: [], kept: [] };
    table.classList.toggle("stale", !answer);
    if (!answer) return;
    shown = key;
    for (const each of answer.kept) {
      const [m] = each.models;
      for (const [name, value] of Object.entries(m)) if (typeof value === "string" && !WORDS.includes(name)) m[name] = decode(value);
      m.label = each.name;
      m.look = LOOKS[kept.findIndex(({ name }) => name === each.name)];
    }
    const cell = ({ text, value }) => h("td", { "data-value": value }, written(text));
    table.hidden = files.hidden = !answer.rows.length;
    table.replaceChildren(answer.rows.length ? tableOf(answer.heads, answer.rows.map(([first, ...others]) => (
      h("tr", {}, h("th", { scope: "row" }, symbol(first.text)), others.map(cell))))) : "");
    hint.textContent = !kept.length ? t("Keep the present structure to compare later ones with it.")
      : !answer.rows.length ? t("The present structure is the one that was kept. Change it to compare.")
        : answer.present ? t("{name} is the present structure.", { name: answer.present }) : "";
    show(answer.kept);
  });

  function refresh() {
    const { alternatives: kept } = app.state;
    keep.textContent = t("Keep as {name}", { name: free(kept) });
    keep.disabled = kept.length >= most - 1; // the present one is compared too
    const key = JSON.stringify([kept, document.documentElement.dataset.theme]);
    if (list.dataset.drawn !== key) {
      list.dataset.drawn = key;
      const controls = () => [...list.querySelectorAll("input, button")];
      const at = controls().indexOf(document.activeElement);
      list.replaceChildren(...kept.map(row));
      controls()[at]?.focus();
    }
    load();
  }
  return { element, refresh };
}
