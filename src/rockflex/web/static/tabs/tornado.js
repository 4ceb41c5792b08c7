// What matters most: how a demand changes with each number of the structure at both ends of a range.

import { h, ink, number, scrolled, svg, symbol, tableOf } from "../dom.js";
import { box, folded, select } from "../form.js";
import { assumed, recordsOf, Study, undecided } from "../jobs.js";
import { counted, t } from "../texts.js";
import { explainedOutputs, headed, inUnit, outputIn, outputInUnit } from "../units.js";

const DEMANDS = ["max_rotation", "max_top_displacement", "max_total_top_displacement", "max_base_moment", "max_base_shear", "max_horizontal_reaction"];
const ENDS = ["c0", "c1"]; // colours of the low and the high end
const [WIDTH, HEIGHT, BAR] = [100, 24, 8];

export function tornado(app) {
  const put = (patch) => app.change({ tornado: patch });
  const share = box("tornado.share", t("Range of each number, ±"), app.state.tornado.share, (value) => put({ share: value }), { hint: t("0.01 to 0.5 of its value") });
  const demand = select("tornado.demand", t("Demand"), DEMANDS.map((name) => [name, headed(name)]), app.state.tornado.demand, (value) => put({ demand: value }));
  const set = () => app.state.record_set.shown;
  const acting = () => (set() ? [recordsOf(app.state, app.state.record_set.suites), app.state.record_set.scale, app.state.record_set.model] : [app.state.record, app.state.scale]);
  const verdict = h("p", { class: "answer", role: "status" });
  const bars = scrolled(t("What matters most"), { id: "tornado" });
  const hint = h("p", { class: "hint" });
  const results = h("div", {}, verdict, bars, hint);
  const study = new Study(app, "tornado", {
    id: "tornado-", results, show, example: () => null,
    words: { run: t("Vary each number"), again: t("Vary again"), none: t("No runs yet."), changed: t("The input has changed: vary again.") },
    key: () => JSON.stringify([assumed(app.state, app.state.models), set(), acting(), app.state.free_vibration, app.state.tornado]),
    suites: () => (set() ? app.state.record_set.suites : []),
  });
  const files = study.downloads([["figure", t("Figure (SVG)")], ["table", t("Table (CSV)")]], [["tornado-python", t("Python lines")]]);
  const element = folded("tornado", t("What matters most?"),
    h("p", { class: "help" }, t("Each number of the structure, of its ground and of its impact law is set to both ends of its range, the others as they are, and the record or the set of records is run again.")),
    h("div", { class: "pair" }, share, demand), study.element, results, files);
  element.id = "tornado-task";
  element.addEventListener("toggle", () => refresh());

  function show(answer) {
    results.hidden = !answer.ready;
    if (!answer.ready) {
      verdict.textContent = answer.total ? undecided(answer) : "";
      return;
    }
    const [first] = answer.rows;
    const values = { model: answer.model, value: outputInUnit(answer.demand, answer.base, 3), records: counted(answer.n_records, t("{n} record"), t("{n} records")), name: nameOf(app.about, first.name) };
    verdict.textContent = answer.n_records > 1
      ? t("{model}: the median over {records} is {value}. What matters most: {name}.", values)
      : t("{model}: {value} with all numbers as they are. What matters most: {name}.", values);
    bars.replaceChildren(table(answer));
    const said = t("Blue: the number at the low end of its range; orange: at the high end. The line is the value with all numbers as they are.");
    hint.replaceChildren(...symbol(`${said} ${explainedOutputs([answer.demand])}.`));
  }

  function table(answer) {
    const all = [answer.base, ...answer.rows.flatMap(({ values }) => values)];
    const [low, high] = [Math.min(...all), Math.max(...all)];
    const x = (value) => (high > low ? (WIDTH * (value - low)) / (high - low) : WIDTH / 2);
    const change = (value) => (answer.base ? inUnit(value / answer.base - 1, "share", 3) : "–");
    const fell = (count) => (count ? [" ", h("span", { class: "overturned" }, answer.n_records > 1 ? t("{n} overturned", { n: count }) : t("overturned"))] : []);
    const cell = ({ factors, values, overturned }, end) => [
      h("td", {}, `× ${number(factors[end], 3)}`),
      h("td", { "data-end": end, "data-value": values[end] }, outputIn(answer.demand, values[end]), fell(overturned[end])),
      h("td", {}, change(values[end]))];
    const head = [t("number"), t("from low to high"), t("low end"), symbol(headed(answer.demand)), t("change"), t("high end"), symbol(headed(answer.demand)), t("change")];
    return tableOf(head, answer.rows.map((row) => h("tr", { "data-parameter": row.name },
      h("th", { scope: "row" }, nameOf(app.about, row.name)), h("td", {}, drawn(row, x, x(answer.base))), cell(row, 0), cell(row, 1))));
  }

  function refresh() {
    share.setValue(app.state.tornado.share);
    demand.setValue(app.state.tornado.demand);
    results.hidden = !study.answer?.ready;
    if (element.open && element.isConnected) study.refresh();
  }
  return { element, refresh, close: (runs) => study.close(runs) };
}

// Two bars from the value as given to those at both ends.
function drawn({ values }, x, middle) {
  const bar = (value, end) => svg("rect", { x: Math.min(x(value), middle), y: end ? HEIGHT / 2 : HEIGHT / 2 - BAR, width: Math.max(Math.abs(x(value) - middle), 0.4), height: BAR, fill: ink(ENDS[end]) });
  return svg("svg", { viewBox: `-1 0 ${WIDTH + 2} ${HEIGHT}`, preserveAspectRatio: "none", class: "bars", "aria-hidden": "true" },
    ...values.map(bar), svg("line", { x1: middle, x2: middle, y1: 0, y2: HEIGHT, stroke: ink("text"), "vector-effect": "non-scaling-stroke" }));
}

// The label of a number in the forms; of an element with its number from 1.
function nameOf(about, name) {
  if (name === "scale") return t("Scale factor");
  const [last, ...before] = name.split(".").reverse();
  const [, word, place] = /^(\w+)(?:\[(\d+)\])?/.exec(last);
  const label = unitLabel([about.kinds, about.whole, about.elements, about.laws, about.ground], word);
  const own = `${label ? t(label) : word.replaceAll("_", " ")}${place ? ` ${Number(place) + 1}` : ""}`;
  const [owner] = before;
  const element = /^elements\[(\d+)\]$/.exec(owner ?? "");
  if (element) return t("{number}, element {place}", { number: own, place: Number(element[1]) + 1 });
  return own;
}

function unitLabel(part, name) {
  if (part === null || typeof part !== "object") return "";
  if (part.name === name && part.label) return part.label;
  for (const each of Object.values(part)) {
    const found = unitLabel(each, name);
    if (found) return found;
  }
  return "";
}
