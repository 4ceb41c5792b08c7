// A set of records as one result: the peaks of each, their statistics, the value for design, and the checks.

import { Chart } from "./chart.js";
import { checksTable, seeCheck, verdictOf } from "./checks.js";
import { explained } from "./choices.js";
import { decode, h, number, scrolled, symbol, tableOf } from "./dom.js";
import { select } from "./form.js";
import { assumed, choices, recordsOf, reports, Study } from "./jobs.js";
import { legend } from "./marks.js";
import { suitPeriods } from "./tabs/target.js";
import { counted, t } from "./texts.js";
import { explainedOutputs, headed, inUnit, unit } from "./units.js";

const rules = () => [
  ["ec8", t("EN 1998-1: the mean of 7 and more records, the worst of 3 to 6")],
  ["asce7", t("ASCE 7-16: the mean of 11 and more, none overturns")],
  ["asce7-ii", t("ASCE 7-16, Risk Categories I and II: one may overturn")],
  ["", t("none: the worst record")],
];
const statistics = () => [
  ["mean", t("mean"), { color: "c0", width: 1.6, dash: [12, 5] }],
  ["worst", t("worst"), null],
  ["median", t("median"), { color: "c2", dash: [6, 4] }],
  ["fractile_84", t("84 %"), { color: "c3", dash: [2, 3] }],
  ["design", t("for design"), { color: "c1", width: 4.5 }],
];

const WORDS = { run: t("Simulate"), again: t("Simulate again"), none: t("No simulation yet."), changed: t("The input has changed: simulate again.") };
const modelOf = ({ models, record_set: { model } }) => (models.includes(model) ? model : models[0]);

// What determines the runs of a set, those of the alternatives included.
function keyOfSet({ state }) {
  const { record_set: { suites, scale } } = state;
  return JSON.stringify([assumed(state, [modelOf(state)]), recordsOf(state, suites), scale, state.free_vibration, state.alternatives]);
}

// Its form, and its results; `compared` takes each answer as well.
export function recordSet(app, compared) {
  const choice = () => app.state.record_set;
  const label = () => modelOf(app.state);
  const { entry, list, suites } = choices(app, "record_set");
  const model = list("model", t("Model"), []);
  const rule = list("rule", t("Value for design"), rules());
  const shown = select("demand", t("Demand drawn"), [], "max_rotation", () => drawPeaks());
  const chart = new Chart({ label: t("Peaks of the records"), xLabel: t("record, as numbered in the table"), xName: t("record"), height: 240, zero: true });
  const over = new Chart({ label: t("Rotations under all records over time"), yLabel: headed("rotation"), xLabel: t("time [s]"), xName: "t [s]", height: 200, symmetric: true });
  const [keys, overKeys, tables] = [h("div"), h("div"), h("div")];
  const [head, warned] = [h("p", { class: "answer" }), h("div", { class: "warning", role: "alert" })];
  const drawing = h("div", { hidden: true }, head, warned, shown, keys, chart.element, overKeys, over.element, tables);
  const beside = h("div"); // the alternatives
  const longer = h("p", { class: "buttons" }, h("button", { type: "button", id: "longer", onclick: async () => {
    if (await suitPeriods(app, () => results.closest(".columns"))) study.run.click();
  } }, t("Choose records from 0.2 T₁ to the rocking period")));
  const results = h("div", { class: "results", id: "record-set" }, drawing, beside);
  const study = new Study(app, "record_set", {
    results, show, words: WORDS, example: () => null, key: () => keyOfSet(app),
  });
  const form = h("fieldset", {}, h("legend", {}, t("Set of records")), suites,
    h("p", { class: "hint" }, t("The records for the target are those of the Earthquake tab, with their factors.")),
    entry("scale", t("Scale factor of all records"), { hint: "0.01–20" }), model, rule, study.element);
  results.append(study.downloads([...reports(app, "report", t("Report (HTML)"), t("Report (PDF)")), ...reports(app, "comparison", t("Report of all (HTML)"), t("Report of all (PDF)")), ["figure", t("Figure (SVG)")], ["table", t("Peaks (CSV)")]],
    [["record_set-python", t("Python lines")]]));
  const ofAll = reports(app, "comparison", t("Report of all (HTML)"), t("Report of all (PDF)")).map(([what]) => results.querySelector(`[data-file="${what}"]`));
  let view = null;
  let due = false; // whether the friction is asked for

  function show(answer) {
    drawing.hidden = !answer.ready && !view;
    if (!answer.ready) return;
    compared(answer);
    if (answer.friction_due && !due) study.run.click(); // the friction of the same runs, which stay in sight
    due = answer.friction_due;
    view = answer;
    const now = shown.querySelector("select").value || "max_rotation";
    const names = view.demands.map((each) => each.name);
    shown.setOptions(view.demands.map((each) => [each.name, plain(each)]), names.includes(now) ? now : names[0]);
    const see = (name) => seeCheck(tables, name);
    verdictOf(head, summary(view), view.checks, { overturns: view.records.some(({ status }) => status === "overturned"), see });
    warned.replaceChildren(...view.warnings.map((text) => h("p", {}, text)), ...(view.short ? [longer] : []));
    warned.hidden = !view.warnings.length;
    drawPeaks();
    drawRotations();
    tables.replaceChildren(
      h("h2", {}, t("Statistics of {model}", { model: view.model })), scrolled(t("Statistics"), { id: "statistics" }, ofDemands(view)), h("p", { class: "hint" }, symbol(`${explainedOutputs(view.demands.map((each) => each.name))}.`)),
      ...[...new Set(view.demands.map((each) => each.reason))].map((reason) => h("p", { class: "hint" }, t("For design: {reason}.", { reason }))),
      checksTable(view.checks, t("the set")),
      h("h2", {}, t("Records")), scrolled(t("Peaks of each record"), { id: "of-records" }, ofRecords(view)));
  }

  function drawPeaks() {
    const each = view.demands.find(({ name }) => name === shown.querySelector("select").value);
    const x = view.records.map((_, i) => i + 1);
    const ends = [0.5, x.length + 0.5];
    const lines = statistics().toReversed().filter(([name, , look]) => look && Number.isFinite(each[name]))
      .map(([name, text, look]) => ({ x: ends, y: ends.map(() => each[name] / each.size), label: text, ...look }));
    const fell = (i) => view.records[i].status === "overturned";
    const points = (kept, color) => ({ kind: "points", color, size: 4, x: x.filter((_, i) => kept(i)),
      y: each.peaks.filter((_, i) => kept(i)).map((value) => value / each.size) });
    chart.options.yLabel = plain(each);
    chart.set({ xRange: ends, series: [...lines, points((i) => !fell(i), "text"), points(fell, "error")] });
    keys.replaceChildren(legend(lines));
  }

  function drawRotations() {
    const all = view.records.map((each) => ({ x: decode(each.t), y: decode(each.rotation).map((v) => v / unit("rotation").size), color: "muted", width: 0.7, alpha: 0.6 }));
    const peaks = view.demands.find(({ name }) => name === "max_rotation")?.peaks ?? [];
    const worst = peaks.indexOf(Math.max(...peaks));
    over.element.hidden = overKeys.hidden = worst < 0;
    if (worst < 0) return;
    const top = { ...all[worst], color: "c0", width: 1.6, alpha: 1, label: view.records[worst].name };
    const fell = view.records.some((each) => each.status === "overturned");
    const limit = fell ? 1.2 * Math.max(...peaks.filter((_, i) => view.records[i].status !== "overturned"), 1e-3) / unit("rotation").size : null;
    over.set({ series: [...all, top], ...(limit ? { yRange: [-limit, limit] } : {}) });
    overKeys.replaceChildren(legend([top, { ...all[0], label: t("the other records") }]));
  }

  function refresh() {
    suites.refresh();
    model.setOptions(app.state.models.map((each) => [each, explained(each)]), label());
    rule.setValue(choice().rule);
    for (const each of ofAll) each.hidden = !app.state.alternatives.length;
    study.refresh();
  }
  return { form, results, beside, refresh, close: (runs) => study.close(runs) };
}

export const OF_STANDING = ["max_rotation", "max_top_displacement", "max_total_top_displacement"]; // what one that falls has not
const plain = ({ symbol: text, unit: name }) => (name ? `${t(text)} [${name}]` : t(text));

function summary({ demands, records, model, checks, fixed_moment: fixed }) {
  const fell = records.filter((each) => each.status === "overturned").length;
  const rotation = demands.find(({ name }) => name === "max_rotation");
  const values = { model, records: counted(records.length, t("{n} record"), t("{n} records")), fell, value: number(rotation?.design / rotation?.size, 3), unit: rotation?.unit };
  const rocks = records.filter(({ status }) => status === "rocking").length;
  const first = fell ? t("It overturns in {fell} of {records}.", values)
    : rocks ? t("It rocks in {rocks} of {records}, and none overturns it.", { ...values, rocks }) : t("It does not rock in any of {records}.", values);
  const turned = checks.rows.find(({ name }) => name === "rotation");
  const share = !fell && Number.isFinite(turned?.ratio) && t("its rotation for design is {value} {unit}, {share} of the limit", { ...values, share: inUnit(turned.ratio, "share", 3) });
  const moment = demands.find(({ name }) => name === "max_base_moment")?.design;
  const less = moment > 0 && fixed > 0 && t("the base moment {share} of that with the base held down", { share: inUnit(moment / fixed, "share", 3) });
  const more = [share, less].filter(Boolean).join(", ");
  return [first, more ? t("{model}: {facts}.", { model, facts: more }) : ""];
}

function ofDemands({ demands }) {
  const cell = (each) => ([name]) => h("td", { "data-name": name, "data-value": each[name] }, number(each[name] === "inf" ? each[name] : each[name] === null ? null : each[name] / each.size));
  return tableOf([t("demand"), ...statistics().map(([, text]) => text)],
    demands.map((each) => h("tr", { "data-demand": each.name }, h("th", { scope: "row" }, symbol(plain(each))), statistics().map(cell(each)))));
}

function ofRecords({ demands, records }) {
  const listed = demands.filter((each) => each.listed);
  return tableOf([t("no."), t("record"), t("outcome"), t("factor"), ...listed.map((each) => symbol(plain(each)))],
    records.map((each, i) => h("tr", { "data-record": each.name }, h("td", {}, String(i + 1)), h("th", { scope: "row" }, each.name),
      h("td", { class: each.status }, t(each.status.replace("_", " "))), h("td", {}, number(each.scale, 3)),
      listed.map((demand) => h("td", { "data-name": demand.name, "data-value": demand.peaks[i] }, each.status === "overturned" && OF_STANDING.includes(demand.name) ? "–" : number(demand.peaks[i] / demand.size))))));
}
