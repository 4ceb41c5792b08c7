// Alternatives that are kept: their list, how their demands differ under one record or a set, and their motion beside that of
// the present structure.

import { isRigid, yields } from "./choices.js";
import { clone, decode, h, latest, number, scrolled, symbol, tableOf } from "./dom.js";
import { kindOf } from "./drawn.js";
import { trouble } from "./form.js";
import { downloads, reports } from "./jobs.js";
import { legend } from "./marks.js";
import { t, written } from "./texts.js";
import { unitFor } from "./units.js";

const OWN = ["structure", "models", "impact", "restitution", "bouc_wen", "ground"]; // what an alternative is made of
const WORDS = ["label", "status"]; // of a response, whose other texts are curves
const LOOKS = ["yielded", "fuse", "damper", "clay", "kinetic", "soil"].map((color, i) => ({ color, dash: [[5, 2], [1, 2], [9, 3]][i % 3] }));
const parts = (from) => clone(Object.fromEntries(OWN.filter((name) => from[name] !== undefined).map((name) => [name, from[name]])));

// The name of the next one.
const free = (kept) => [..."ABCDEFG"].find((letter) => kept.every(({ name }) => name !== letter));

// What makes one structure another one, in words: devices that are more or fewer, fields with other values, other options.
export function differences(about, from, to) {
  const said = [];
  const shown = ({ unit, name }, value) => (typeof value === "number" && unit ? `${number(value / unitFor(unit, name).size)} ${unitFor(unit, name).name}` : typeof value === "number" ? number(value) : value === undefined ? "–" : typeof value === "object" ? "…" : String(value));
  const devices = (state) => (state.structure.elements ?? []).map((each) => JSON.stringify(each));
  const without = (all, others) => others.reduce((left, each) => (left.includes(each) ? left.toSpliced(left.indexOf(each), 1) : left), all).map((each) => JSON.parse(each));
  const device = (each) => {
    const { title, fields } = about.elements[each.kind];
    const main = fields.find(({ name, unit }) => unit === "N" && typeof each[name] === "number") ?? fields.find(({ name }) => typeof each[name] === "number" && name !== "position");
    return [t(title), main && shown(main, each[main.name])].filter(Boolean).join(" ");
  };
  const [kind, other] = [kindOf(to.structure, about.kinds), kindOf(from.structure, about.kinds)];
  if (kind !== other) said.push(t(about.kinds[kind].title));
  else for (const spec of about.kinds[kind].fields) {
    const [before, after] = [from.structure[kind][spec.name], to.structure[kind][spec.name]];
    if (JSON.stringify(before) !== JSON.stringify(after)) said.push(`${t(spec.label)} ${shown(spec, before)} → ${shown(spec, after)}`);
  }
  said.push(...without(devices(to), devices(from)).map((each) => `+ ${device(each)}`), ...without(devices(from), devices(to)).map((each) => `− ${device(each)}`));
  for (const { name, label } of about.whole) if (JSON.stringify(from.structure[name]) !== JSON.stringify(to.structure[name])) said.push(t(label));
  for (const [name, title] of [["models", t("Models")], ["ground", t("Ground")], ["impact", t("Impact law")], ["bouc_wen", t("The superstructure yields")]])
    if (JSON.stringify(from[name]) !== JSON.stringify(to[name])) said.push(title);
  return said.join(", ");
}

// The alternatives under a set: what each is, its values for design, how they differ from those of the first, and its checks.
function underSet(app, { columns, demands, records }) {
  const [first] = columns;
  const state = (each) => app.state.alternatives.find(({ name }) => name === each.name) ?? app.state;
  const differs = (each) => (each === first ? "" : each.name === "fixed" && state(each) === app.state ? t("base held down") : differences(app.about, state(first), state(each)));
  const facts = [
    [t("differs by"), differs],
    [t("model"), (each) => (each.name === "fixed" ? "fixed" : each.model)],
    [t("base lifts"), (each) => (each.name === "fixed" ? "–" : t("in {n} of {all} records", { n: each.lifted, all: records }))],
    ...(columns.some(({ fell }) => fell) ? [[t("overturns"), (each) => t("in {n} of {all} records", { n: each.fell, all: records })]] : []),
  ].map(([title, value]) => h("tr", {}, h("th", { scope: "row" }, title), columns.map((each) => h("td", { class: "words" }, value(each)))));
  const rows = demands.map(({ name, symbol: text, unit, size, values }) => h("tr", { "data-demand": name },
    h("th", { scope: "row" }, symbol(unit ? `${t(text)} [${unit}]` : t(text))),
    values.map((value, i) => {
      const percent = i && values[0] > 0 && value !== null ? Math.round(100 * (value / values[0] - 1)) : NaN;
      const more = Number.isFinite(percent) ? ` (${percent > 0 ? "+" : ""}${written(String(percent))} %)` : "";
      return h("td", { "data-name": columns[i].name, "data-value": value }, number(value === null || value === "inf" ? value : value / size) + more);
    })));
  const names = [...new Set(columns.flatMap(({ checks }) => checks.filter(({ ratio }) => ratio !== null).map(({ name }) => name)))];
  const checks = names.map((name) => h("tr", { "data-check": name }, h("th", { scope: "row" }, t("Check: {name}", { name: t(name) })),
    columns.map((each) => {
      const found = each.checks.find((one) => one.name === name && one.ratio !== null);
      return h("td", { "data-name": each.name, "data-value": found?.ratio, class: found?.ok === false ? "overturned" : null }, found ? `${number(found.ratio, 3)} ${found.ok ? t("ok") : t("fails")}` : "–");
    })));
  return [h("h2", {}, t("Alternatives")), h("p", { class: "hint" }, t("Checks with their ratios, and values for design of {n} records; in brackets: compared with {first}.", { n: records, first: first.name })),
    scrolled(t("Alternatives under the set of records"), {}, tableOf([t("demand"), ...columns.map(({ name, present }) => (present ? t("{name} (present)", { name }) : name === "fixed" ? t("fixed base") : name))],
      [...facts, ...checks, ...rows]))];
}

// `show` gets the responses of the kept ones, each with its structure and its look. They are kept, named and compared under one
// record where they are the tab's `own`, and elsewhere under the set of records.
export function alternatives(app, show, own = false) {
  const { alternatives: most } = app.about.limits;
  const put = (kept) => app.change({ alternatives: kept });
  const add = () => put([...app.state.alternatives, { name: free(app.state.alternatives), ...parts(app.state) }]);
  const keep = h("button", { type: "button", id: "keep", onclick: add });
  const list = h("ul", { class: "kept" });
  const table = scrolled(t("Demands of the alternatives"), { id: "differences" });
  const hint = h("p", { class: "hint" });
  const element = h("section", { id: "alternatives", "aria-label": t("Alternatives") });
  const files = downloads(app, reports(app, "comparison", t("Report of all (HTML)"), t("Report of all (PDF)")));
  const under = h("div", { id: "under-set" });
  const next = app.next("response", t("They are compared under a set of records as well, with checks."), { record_set: { shown: true } }, t("Set of records"));
  const managed = h("div", {}, h("h2", {}, t("Alternatives")),
    h("div", { "data-path": "alternatives" }, h("div", { class: "buttons" }, keep), list, trouble()), table, hint, files, next);
  element.append(own ? managed : under);

  // Show what an answer about the set says of them.
  function set({ ready, compared }) {
    if (ready) under.replaceChildren(...(compared ? underSet(app, compared) : []));
  }
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
    Object.assign(next, parts(app.state.alternatives[i]));
    const fits = (label) => (label === "rigid") === isRigid(next.structure) && (next.bouc_wen || !yields(label));
    if (!next.cloud.models.every(fits)) next.cloud.models = [next.models[0]];
    if (!fits(next.design.model)) [next.design.model] = next.models;
    app.restore(next);
  }

  const row = ({ name, ...each }, i) => {
    const input = h("input", { type: "text", maxlength: 40, value: name, "aria-label": t("Name of the alternative"), onchange: () => rename(i, input) });
    const button = (text, run) => h("button", { type: "button", "aria-label": `${text}: ${name}`, onclick: run }, text);
    return h("li", {}, legend([{ label: "", ...LOOKS[i] }]), input, i ? h("span", { class: "hint" }, differences(app.about, app.state.alternatives[0], each)) : null, button(t("Edit again"), () => edit(i)),
      button(t("Remove"), () => {
        put(app.state.alternatives.filter((_, k) => k !== i));
        keep.focus();
      }));
  };

  const load = latest(async () => {
    const { tab, cloud, design, target, head, site, record_set, ...rest } = app.state;
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
    const now = differences(app.about, kept[0] ?? rest, rest);
    hint.textContent = !kept.length ? t("Keep the present structure to compare later ones with it.")
      : !answer.rows.length ? t("The present structure is the one that was kept. Change it to compare.")
        : answer.present ? `${t("{name} is the present structure.", { name: answer.present })} ${now && `${answer.present}: ${now}.`}` : "";
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
    next.hidden = !kept.length;
    under.hidden = !kept.length;
    if (own || !app.state.record_set.shown) load();
  }
  return { element, refresh, set };
}
