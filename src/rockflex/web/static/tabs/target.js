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
  ["ec8", "EN 1998-1:2004"], ["ec8_second", "EN 1998-1-1:2024 (second generation)"],
  ["asce7", "ASCE 7-16 by SDS and SD1"], ["asce7_site", "ASCE 7-16 by site class"], ["table", "a table"],
];
const LONGEST = 20000; // letters of a table
const letters = (text) => [...text].map((letter) => [letter, letter]);
const G = { unit: "g" };
// The fields of each target: label, and a unit and hint, or the options of a list.
const FIELDS = {
  ag: ["a_gR on type A ground", { ...G, hint: "reference peak acceleration" }],
  ground: ["Ground type", letters("ABCDE")],
  type: ["Type of the spectrum", [["1", "1"], ["2", "2, for magnitudes up to 5.5"]]],
  importance: ["Importance factor γ_I", {}],
  s_alpha: ["S_α,RP", { ...G, hint: "plateau on site category A" }],
  s_beta: ["S_β,RP", { ...G, hint: "ordinate at 1 s on site category A" }],
  category: ["Site category", letters("ABCD")],
  sds: ["S_DS", G], sd1: ["S_D1", G], ss: ["S_S", { ...G, hint: "of the maps, at short periods" }],
  s1: ["S_1", { ...G, hint: "of the maps, at 1 s" }],
  site: ["Site class", [...letters("ABCD"), ["default", "D by default"], ["E", "E"]]],
  tl: ["T_L", { unit: "s" }],
  damping: ["Damping ratio", { hint: "of the spectrum, 0.005 to 0.5" }],
  units: ["Unit of S_a", [["", "as in the header"], ["g", "g"], ["m/s2", "m/s²"], ["cm/s2", "cm/s²"]]],
};
const OF = {
  ec8: ["ag", "ground", "type", "importance", "damping"], ec8_second: ["s_alpha", "s_beta", "category", "damping"],
  asce7: ["sds", "sd1", "tl", "mce"], asce7_site: ["ss", "s1", "site", "tl", "mce"], table: ["table", "units", "damping"],
};
const MEASURES = [
  ["component", "each component by itself"], ["geometric mean", "geometric mean of a pair"],
  ["rotd50", "RotD50 of a pair"], ["rotd100", "RotD100 of a pair"],
];
const PATIENCE = 800; // ms before the page says that it is choosing

// `root` returns the element with the fields, which takes messages.
export function target(app, root) {
  const now = () => app.state.target;
  const put = (patch) => app.change({ target: patch });
  const set = (name) => (value) => put({ [name]: value });
  const entry = (name, label, extra = {}) => box(`target.${name}`, label, now()[name], set(name), extra);
  const optional = (name, label, hint) => box(`target.${name}`, label, now()[name],
    (value) => put({ [name]: value === "" ? undefined : value }), { hint: `${hint}; optional` });
  const list = (name, label, options) => select(`target.${name}`, label, options, now()[name], set(name));

  const text = h("textarea", { spellcheck: "false", placeholder: "period (s), sa (g)\n0.0, 0.3\n0.1, 0.75", value: now().table,
    onchange: () => put({ table: text.value }) });
  const made = Object.fromEntries(Object.entries(FIELDS).map(([name, [label, extra]]) => (
    [name, Array.isArray(extra) ? list(name, symbol(label), extra) : entry(name, symbol(label), extra)])));
  made.mce = tableField("target.mce", { type: "flag", label: "MCE_R in place of the design spectrum", help: "", low: null },
    now().mce, set("mce"));
  made.table = h("div", {},
    field("target.table", "Table of the spectrum", text, { hint: "two columns, the period in s and the acceleration" }),
    field("target.file", "or from a file", fileBox(".csv,.txt,.dat,.tsv", read)));
  const kind = list("kind", "Target spectrum", KINDS);
  const source = list("source", "Choose from", []);
  const more = h("details", {}, h("summary", {}, "More options"),
    optional("per_event", "Most records of one earthquake", "a whole number"),
    optional("per_station", "Most records at one station", "a whole number"),
    optional("least_ratio", "Least mean over target", "such as 0.9: all factors are raised together"),
    entry("record_weight", "Weight of the single records", { hint: "0: only the mean counts; 1: only the records" }));

  const period = h("input", { type: "text", inputmode: "decimal", value: "1" });
  const scaled = h("p", { class: "help", id: "scaled", role: "status" });
  const scaling = h("fieldset", {}, h("legend", {}, "Scale the present record"),
    field("target.period", "to the target at the period", period, { unit: "s" }),
    h("div", { class: "buttons" },
      h("button", { type: "button", onclick: () => scale(parseNumber(period.value)) }, "At this period"),
      h("button", { type: "button", onclick: () => scale(null) }, "Over the range")), scaled);
  const form = h("div", { class: "side" },
    h("fieldset", { "data-path": "target" }, h("legend", {}, "Target"), kind, Object.values(made), trouble()),
    h("fieldset", {}, h("legend", {}, "Choice"), source,
      entry("count", "Number of records", { hint: "1 to 60; of pairs, if these are combined" }),
      entry("shortest", "Periods from", { unit: "s" }), entry("longest", "to", { unit: "s" }),
      list("measure", "Spectrum of a record", MEASURES),
      entry("smallest", "Scale factors from", {}), entry("largest", "to", {}), more,
      h("p", { class: "error foot", role: "alert" })),
    scaling);

  const said = h("p", { class: "help", role: "status" });
  const spectra = new Spectra();
  const used = h("p", { class: "help", id: "used", role: "status" });
  const use = h("button", { type: "button", class: "primary", id: "use", onclick: () => {
    app.change(Object.fromEntries(["cloud", "design", "record_set"].map((kind) => [kind, { suites: [CHOSEN] }])));
    used.textContent = t("The set of records on the Response tab, and the Fragility and Design tabs use these records, with these factors times the scale factors given there.");
  } }, "Use as the suite of the studies");
  const results = h("section", { id: "selection", hidden: true }, said, spectra.element, h("div", { class: "buttons" }, use), used,
    app.next("response", t("Next: design for these records."), { record_set: { shown: true, suites: [CHOSEN] } }, t("Set of records")));

  async function read(file) {
    const content = file.size > 4 * LONGEST ? "" : await file.text();
    if (!content || content.length > LONGEST)
      app.complain(root(), { "target.file": `${file.name} has more than ${LONGEST} letters, or none. A spectrum needs some dozens of rows.` });
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
      scaled.textContent = `Scaled by ${number(factor)}; the scale factor is on the Response tab, too.`;
    }, (error) => app.complain(root(), error.errors));
  }

  let asked = "";
  const load = latest(async () => {
    const { record } = app.state;
    const key = JSON.stringify([now(), record.folder, record.vertical]);
    if (key === asked && results.classList.contains("stale")) app.complain(root(), {}); // as it was before a bad value
    results.classList.toggle("stale", key !== asked);
    if (key === asked) return;
    const patience = setTimeout(() => (said.textContent = "Choosing …"), PATIENCE);
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
    load();
  }
  const files = downloads(app, { querySelector: (...a) => root().querySelector(...a), querySelectorAll: (...a) => root().querySelectorAll(...a) },
    [["selection", "Records (CSV)"], ["selection-spectra", "Spectra (CSV)"], ["selection-figure", "Figure (SVG)"],
      ["selection-records", "Scaled records (ZIP)"], ["selection-python", "Python lines"], ["records", "Your records (ZIP)"]]);
  const whole = files.querySelector('[data-file="records"]'); // which the program reads
  results.append(files);
  return { form, results, refresh };
}

const HEAD = ["record", "earthquake", "M", "R [km]", "V_s30 [m/s]", "factor", "misfit", "S_a/target"];

class Spectra {
  constructor() {
    this.chart = new Chart({
      label: "Spectra of the chosen records over the period", yLabel: titled("Sa [{unit}]", "acceleration"), xLabel: t("period [s]"), xName: "T [s]",
      height: 360, xLog: true, yLog: true,
    });
    this.title = h("h2", { id: "target-title" });
    this.facts = h("dl", { class: "values", id: "fit" });
    this.keys = h("div");
    this.rows = scrolled("Records chosen", { id: "chosen" });
    this.notes = h("ul", { class: "notes" });
    this.element = h("div", {}, this.title, this.facts, this.keys, this.chart.element,
      h("p", { class: "hint" }, "Shaded: the range of periods. Band: 16th to 84th percentile of a lognormal distribution. ",
        "Thin lines: the chosen records, scaled."),
      this.notes, this.rows);
  }

  show(answer) {
    const { periods: x, range: [low, high] } = answer;
    this.title.textContent = `${answer.records.length} of ${answer.offered} records for ${answer.target}`;
    this.facts.replaceChildren(...[
      ["misfit", answer.misfit, "of the mean: root mean square of ln(mean/target)"],
      ["least mean/target", answer.least_ratio, "over the range; codes ask for 0.9"],
      ["mean/target at T = 0", answer.zero_period_ratio, "EN 1998-1:2004 asks for 1"],
      ["largest spread", answer.dispersion, "standard deviation of ln S_a"],
    ].map(([name, value, help]) => h("div", {}, h("dt", {}, name), h("dd", { "data-fact": name, "data-value": value }, number(value)),
      h("dd", { class: "hint" }, symbol(help)))));
    const inOwn = (values) => values.map((value) => value / unit("acceleration").size);
    const lines = [
      { y: inOwn(answer.wanted), label: "target", color: "c1", width: 2.2 },
      { y: inOwn(answer.mean), label: "mean", color: "c0", width: 2.2 },
    ].map((each) => ({ x, ...each }));
    this.chart.set({
      spans: [[low, high]],
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
    h("td", {}, `${number(each.least_ratio, 3)} to ${number(each.largest_ratio, 3)}`));
}
