// A target spectrum, and the records that are chosen and scaled for it.

import { ask, attempt } from "../api.js";
import { Chart } from "../chart.js";
import { CHOSEN, GIVEN, suitesOf } from "../choices.js";
import { h, latest, number, scrolled, symbol, tableOf } from "../dom.js";
import { box, field, fileBox, parseNumber, select, tableField, trouble } from "../form.js";
import { downloads } from "../jobs.js";
import { legend } from "../marks.js";
import { t } from "../texts.js";
import { titled, unit } from "../units.js";

const KINDS = [
  ["ec8", "EN 1998-1:2004"], ["ec8_second", t("EN 1998-1-1:2024 (second generation)")],
  ["asce7", t("ASCE 7-16 by SDS and SD1")], ["asce7_site", t("ASCE 7-16 by site class")], ["table", t("a table")],
];
const LONGEST = 20000; // letters of a table
const letters = (text) => [...text].map((letter) => [letter, letter]);
const G = { unit: "g" };
// The fields of each target: label, and a unit and hint, or the options of a list.
const FIELDS = {
  ag: [t("a_gR on type A ground"), { ...G, hint: t("reference peak acceleration") }],
  ground: [t("Ground type"), letters("ABCDE")],
  type: [t("Type of the spectrum"), [["1", "1"], ["2", t("2, for magnitudes up to 5.5")]]],
  importance: [t("Importance factor γ_I"), {}],
  s_alpha: ["S_α,RP", { ...G, hint: t("plateau on site category A") }],
  s_beta: ["S_β,RP", { ...G, hint: t("ordinate at 1 s on site category A") }],
  category: [t("Site category"), letters("ABCD")],
  sds: ["S_DS", G], sd1: ["S_D1", G], ss: ["S_S", { ...G, hint: t("of the maps, at short periods") }],
  s1: ["S_1", { ...G, hint: t("of the maps, at 1 s") }],
  site: [t("Site class"), [...letters("ABCD"), ["default", t("D by default")], ["E", "E"]]],
  tl: ["T_L", { unit: "s" }],
  damping: [t("Damping ratio"), { hint: t("of the spectrum, 0.005 to 0.5") }],
  units: [t("Unit of S_a"), [["", t("as in the header")], ["g", "g"], ["m/s2", "m/s²"], ["cm/s2", "cm/s²"]]],
};
const OF = {
  ec8: ["ag", "ground", "type", "importance", "damping"], ec8_second: ["s_alpha", "s_beta", "category", "damping"],
  asce7: ["sds", "sd1", "tl", "mce"], asce7_site: ["ss", "s1", "site", "tl", "mce"], table: ["table", "units", "damping"],
};
const MEASURES = [
  ["component", t("each component by itself")], ["geometric mean", t("geometric mean of a pair")],
  ["rotd50", t("RotD50 of a pair")], ["rotd100", t("RotD100 of a pair")],
];
const PATIENCE = 800; // ms before the page says that it is choosing

// `root` returns the element with the fields, which takes messages.
export function target(app, root) {
  const now = () => app.state.target;
  const put = (patch) => app.change({ target: patch });
  const set = (name) => (value) => put({ [name]: value });
  const entry = (name, label, extra = {}) => box(`target.${name}`, label, now()[name], set(name), extra);
  const optional = (name, label, hint) => box(`target.${name}`, label, now()[name],
    (value) => put({ [name]: value === "" ? undefined : value }), { hint: `${hint}; ${t("optional")}` });
  const list = (name, label, options) => select(`target.${name}`, label, options, now()[name], set(name));

  const text = h("textarea", { spellcheck: "false", placeholder: "period (s), sa (g)\n0.0, 0.3\n0.1, 0.75", value: now().table,
    onchange: () => put({ table: text.value }) });
  const made = Object.fromEntries(Object.entries(FIELDS).map(([name, [label, extra]]) => (
    [name, Array.isArray(extra) ? list(name, symbol(label), extra) : entry(name, symbol(label), extra)])));
  made.mce = tableField("target.mce", { type: "flag", label: t("MCE_R in place of the design spectrum"), help: "", low: null },
    now().mce, set("mce"));
  made.table = h("div", {},
    field("target.table", t("Table of the spectrum"), text, { hint: t("two columns, the period in s and the acceleration") }),
    field("target.file", t("or from a file"), fileBox(".csv,.txt,.dat,.tsv", read)));
  const kind = list("kind", t("Target spectrum"), KINDS);
  const source = list("source", t("Choose from"), []);
  const more = h("details", {}, h("summary", {}, t("More options")),
    optional("per_event", t("Most records of one earthquake"), t("a whole number")),
    optional("per_station", t("Most records at one station"), t("a whole number")),
    optional("least_ratio", t("Least mean over target"), t("such as 0.9: all factors are raised together")),
    entry("record_weight", t("Weight of the single records"), { hint: t("0: only the mean counts; 1: only the records") }));

  const period = h("input", { type: "text", inputmode: "decimal", value: "1" });
  const scaled = h("p", { class: "help", id: "scaled", role: "status" });
  const scaling = h("fieldset", {}, h("legend", {}, t("Scale the present record")),
    field("target.period", t("to the target at the period"), period, { unit: "s" }),
    h("div", { class: "buttons" },
      h("button", { type: "button", onclick: () => scale(parseNumber(period.value)) }, t("At this period")),
      h("button", { type: "button", onclick: () => scale(null) }, t("Over the range"))), scaled);
  const [from, to] = [entry("shortest", t("Periods from"), { unit: "s" }), entry("longest", t("to"), { unit: "s" })];
  const suit = () => suitPeriods(app, () => root());
  const form = h("div", { class: "side" },
    h("fieldset", { "data-path": "target" }, h("legend", {}, t("Target")), kind, Object.values(made), trouble()),
    h("fieldset", {}, h("legend", {}, t("Choice")), source,
      entry("count", t("Number of records"), { hint: t("1 to 60; of pairs, if these are combined") }),
      from, to, h("div", { class: "buttons" }, h("button", { type: "button", id: "periods", onclick: () => suit() }, t("From 0.2 T₁ to the rocking period"))),
      list("measure", t("Spectrum of a record"), MEASURES),
      entry("smallest", t("Scale factors from"), {}), entry("largest", t("to"), {}), more,
      h("p", { class: "error foot", role: "alert" })),
    scaling);

  const said = h("p", { class: "help", role: "status" });
  const spectra = new Spectra();
  const used = h("p", { class: "help", id: "used", role: "status" });
  const use = h("button", { type: "button", class: "primary", id: "use", onclick: () => {
    app.change(Object.fromEntries(["cloud", "design", "record_set"].map((kind) => [kind, { suites: [CHOSEN] }])));
    used.textContent = t("The set of records on the Response tab, and the Fragility and Design tabs use these records, with these factors times the scale factors given there.");
  } }, t("Use as the suite of the studies"));
  const results = h("section", { id: "selection", hidden: true }, said, spectra.element, h("div", { class: "buttons" }, use), used,
    app.next("response", t("Next: design for these records."), { record_set: { shown: true, suites: [CHOSEN] } }, t("Set of records")));

  async function read(file) {
    const content = file.size > 4 * LONGEST ? "" : await file.text();
    if (!content || content.length > LONGEST)
      app.complain(root(), { "target.file": t("{name} has more than {most} letters, or none. A spectrum needs some dozens of rows.", { name: file.name, most: LONGEST }) });
    else {
      text.value = content;
      put({ table: content });
    }
  }

  async function scale(at) {
    scaled.textContent = "";
    await attempt(async () => {
      const { factor } = await ask("/api/factor", { state: app.state, period: at });
      app.complain(root(), {});
      app.change({ scale: factor });
      scaled.textContent = t("Scaled by {factor}; the scale factor is on the Response tab, too.", { factor: number(factor) });
    }, (error) => app.complain(root(), error.errors));
  }

  let asked = "";
  const load = latest(async () => {
    const { record } = app.state;
    const key = JSON.stringify([now(), record.folder, record.vertical, app.state.structure]);
    if (key === asked && results.classList.contains("stale")) app.complain(root(), {}); // as it was before a bad value
    results.classList.toggle("stale", key !== asked);
    if (key === asked) return;
    const patience = setTimeout(() => (said.textContent = t("Choosing …")), PATIENCE);
    const answer = await app.ask("/api/selection", root());
    clearTimeout(patience);
    said.textContent = "";
    if (!answer) return;
    asked = key;
    results.classList.remove("stale");
    results.hidden = false;
    used.textContent = "";
    spectra.show(answer);
  });

  function refresh() {
    source.setOptions(suitesOf(app, [], true), now().source);
    for (const [name, control] of Object.entries(made)) control.hidden = !OF[now().kind].includes(name);
    whole.hidden = now().source !== GIVEN;
    from.setValue(now().shortest);
    to.setValue(now().longest);
    load();
  }
  const files = downloads(app,
    [["selection", t("Records (CSV)")], ["selection-spectra", t("Spectra (CSV)")], ["selection-figure", t("Figure (SVG)")],
      ["selection-records", t("Scaled records (ZIP)")], ["selection-python", t("Python lines")], ["records", t("Your records (ZIP)")]]);
  const whole = files.querySelector('[data-file="records"]'); // which the program reads
  results.append(files);
  return { form, results, refresh };
}

// Choose records for the periods that matter: from a fifth of the first to that of rocking.
export async function suitPeriods(app, root) {
  const found = await app.ask("/api/periods", root());
  if (found) app.change({ target: found });
  return found;
}

const HEAD = [t("record"), t("earthquake"), "M", "R [km]", "V_s30 [m/s]", t("factor"), t("misfit"), t("S_a/target")];

class Spectra {
  constructor() {
    this.chart = new Chart({
      label: t("Spectra of the chosen records over the period"), yLabel: titled("Sa [{unit}]", "acceleration"), xLabel: t("period [s]"), xName: "T [s]",
      height: 360, xLog: true, yLog: true,
    });
    this.title = h("h2", { id: "target-title" });
    this.facts = h("dl", { class: "values", id: "fit" });
    this.keys = h("div");
    this.rows = scrolled(t("Records chosen"), { id: "chosen" });
    this.notes = h("ul", { class: "notes" });
    this.element = h("div", {}, this.title, this.facts, this.keys, this.chart.element,
      h("p", { class: "hint" }, t("Shaded: the range of periods. Band: 16th to 84th percentile of a lognormal distribution. " +
        "Thin lines: the chosen records, scaled.")),
      this.notes, this.rows);
  }

  show(answer) {
    const { periods: x, range: [low, high] } = answer;
    this.title.textContent = t("{n} of {offered} records for {target}", { ...answer, n: answer.records.length });
    this.facts.replaceChildren(...[
      [t("misfit"), answer.misfit, t("of the mean: root mean square of ln(mean/target)")],
      [t("least mean/target"), answer.least_ratio, t("over the range; codes ask for 0.9")],
      [t("mean/target at T = 0"), answer.zero_period_ratio, t("EN 1998-1:2004 asks for 1")],
      [t("largest spread"), answer.dispersion, t("standard deviation of ln S_a")],
    ].map(([name, value, help]) => h("div", {}, h("dt", {}, name), h("dd", { "data-fact": name, "data-value": value }, number(value)),
      h("dd", { class: "hint" }, symbol(help)))));
    const inOwn = (values) => values.map((value) => value / unit("acceleration").size);
    const lines = [
      { y: inOwn(answer.wanted), label: t("target"), color: "c1", width: 2.2 },
      { y: inOwn(answer.mean), label: t("mean"), color: "c0", width: 2.2 },
    ].map((each) => ({ x, ...each }));
    this.chart.set({
      spans: [[low, high]],
      vlines: answer.first_period ? [{ x: answer.first_period, label: `T₁ = ${number(answer.first_period, 3)} s`, color: "muted" }] : [],
      series: [
        ...(answer.singles.length > 1 ? [{ kind: "band", x, low: inOwn(answer.low), high: inOwn(answer.high), color: "c0", alpha: 0.16 }] : []),
        ...answer.singles.map((y) => ({ x, y: inOwn(y), color: "muted", width: 0.8, alpha: 0.7 })),
        ...lines,
      ],
    });
    this.keys.replaceChildren(legend(lines));
    this.notes.replaceChildren(...answer.notes.map((text) => h("li", {}, text)));
    this.rows.replaceChildren(tableOf(HEAD.map(symbol), answer.records.map(row)));
  }
}

function row(each) {
  const where = [each.event, each.year, each.station].filter((part) => part !== null).join(", ");
  return h("tr", { "data-record": each.record },
    h("th", { scope: "row" }, each.record), h("td", {}, where || "–"), h("td", {}, number(each.magnitude)),
    h("td", {}, number(each.distance_km)), h("td", {}, number(each.vs30)),
    h("td", { "data-name": "factor", "data-value": each.factor }, number(each.factor)),
    h("td", { "data-name": "misfit", "data-value": each.misfit }, number(each.misfit, 3)),
    h("td", {}, t("{low} to {high}", { low: number(each.least_ratio, 3), high: number(each.largest_ratio, 3) })));
}
