// Design: how wide must the base be, and does a tendon help?

import { Chart } from "../chart.js";
import { measuresOf, unitOf } from "../choices.js";
import { h, number, scrolled, symbol, tableOf } from "../dom.js";
import { assumed, choices, recordsOf, Remarks, Study } from "../jobs.js";
import { legend, look } from "../marks.js";
import { t } from "../texts.js";

const MODELS = ["2DOF-S", "3DOF-S", "MDOF-S", "2DOF-C", "rigid"];
const YIELDING = ["2DOF-S-BW", "2DOF-C-BW"];
const RUNS = ["scales", "narrowest", "widest", "widths", "tendons", "stiffness"];
const WIDTH = "half width of the base B [m]";

const numbers = (values) => values.map((value) => value ?? NaN);

export default function designTab(app) {
  const choice = () => app.state.design;
  const { entry, list, suites } = choices(app, "design");

  const limitStates = app.about.limit_states.filter((each) => each.noun);
  const limit = list("limit", t("Limit state"), limitStates.map((each) => [each.name, t(each.noun)]));
  const rotation = entry("rotation", t("Rotation"), { unit: "rad", hint: t("0.0001 to 1.5") });
  const target = entry("target", t("Acceptable probability"), { hint: t("0.0001 to 0.99") });
  const measure = list("measure", t("Intensity measure"), measuresOf(app.about, false));
  const at = entry("at", t("Intensity"), { unit: unitOf(app.about, choice().measure), hint: t("value of this measure, above 0") });
  const narrowest = entry("narrowest", t("From"), { unit: t("× present B"), hint: t("0.2 to 2") });
  const widest = entry("widest", t("To"), { unit: t("× present B"), hint: t("1 to 10") });
  const widths = entry("widths", t("Widths"), { hint: t("3 to 20") });
  const own = h("p", { class: "help" }, t("The structure already has elements at its base; they stay unchanged."));
  const tendons = entry("tendons", t("Initial forces of a central tendon"),
    { many: true, unit: t("× weight"), hint: t("up to four, 0 for none") });
  const stiffness = entry("stiffness", t("Stiffness EA/L of the tendon"),
    { unit: "L₀ʳ g/B²", hint: t("0 to 100; at 1 the moment stays constant while rocking") });
  const scales = entry("scales", t("Scale factors"), { many: true, hint: t("up to five, each from 0.01 to 20") });
  const model = list("model", t("Model"), []);

  const chart = new Chart({
    label: t("Probability over half width of the base"), yLabel: t("probability"), xLabel: WIDTH, height: 360, xName: "B [m]",
  });
  const moments = new Chart({
    label: t("Median base moment over half width"), yLabel: "M_b [kN m]", xLabel: WIDTH, height: 190, zero: true, xName: "B [m]",
  });
  const keys = h("div");
  const verdict = h("div", { class: "answer", id: "width", role: "status" }, t("A quick look is computed first. Press Search to find how wide the base must be."));
  const remarks = new Remarks();
  const table = scrolled(t("Designs"), { id: "designs" });
  const drawing = h("div", { hidden: true }, keys, chart.element,
    h("p", { class: "hint" }, t("Lines: probability of exceeding the limit at this intensity, overturning included; " +
      "bands: 90 % confidence over the recordings; dashed: acceptable probability.")),
    table,
    h("h2", {}, t("Base moment")), moments.element,
    h("p", { class: "hint" }, t("Median over all runs of the largest base moment.")),
    remarks.element);
  const results = h("div", { class: "results" }, verdict, drawing);
  const study = new Study(app, "design", {
    results, show,
    words: { run: t("Search"), again: t("Search again"), none: t("No search yet."), changed: t("The input has changed: search again.") },
    example: () => ({ widths: 4, tendons: choice().tendons.slice(0, 1), scales: choice().scales.slice(-1) }),
    key: () => JSON.stringify([assumed(app.state, [choice().model]), recordsOf(app.state, choice().suites), RUNS.map((name) => choice()[name])]),
  });
  const element = h("div", { class: "columns" },
    h("form", { class: "side", onsubmit: (event) => event.preventDefault() },
      h("fieldset", {}, h("legend", {}, t("Target")), limit, rotation, target, measure, at),
      h("fieldset", {}, h("legend", {}, t("Search")),
        narrowest, widest, widths, own, tendons, stiffness, suites, scales, model, study.element)),
    results);
  results.append(study.downloads(element,
    [["figure", t("Figure (SVG)")], ["table", t("Designs (CSV)")]],
    [["design-study", t("Study (TOML)")], ["design-python", t("Python lines")]]));

  function show(answer) {
    for (const each of [...answer.curves, ...answer.answers]) each.tendon = t(each.tendon);
    drawing.hidden = !answer.curves.length;
    const curves = answer.curves.map((curve, i) => ({ ...curve, look: look(i) }));
    const met = answer.answers.map((each, i) => ({ ...each, color: look(i).color }))
      .filter((each) => Number.isFinite(each.half_width) && ["met", "met more than once"].includes(each.outcome));
    chart.set({
      yRange: [-0.02, 1.02],
      series: [
        ...curves.map(band).filter(Boolean),
        ...curves.map((c) => ({ x: c.half_width, y: numbers(c.probability), label: c.tendon, ...c.look, width: 2 })),
        ...curves.map((c) => (
          { kind: "points", x: c.half_width, y: numbers(c.probability), color: c.look.color, size: 3 })),
        ...met.map((each) => (
          { kind: "points", x: [each.half_width], y: [choice().target], color: each.color, hollow: true, size: 7, width: 2 })),
      ],
      hlines: [{ y: choice().target, label: t("acceptable"), color: "muted" }],
      vlines: [
        { x: answer.present, label: t("present base"), color: "muted", dash: [2, 3] },
        ...met.map((each) => ({ x: each.half_width, label: `B = ${number(each.half_width, 3)} m`, color: each.color })),
      ],
    });
    moments.set({ series: curves.map((c) => (
      { x: c.half_width, y: numbers(c.median_base_moment).map((v) => v / 1000), label: c.tendon, ...c.look })) });
    keys.replaceChildren(legend(curves.map((c) => ({ label: c.tendon, ...c.look }))));
    if (answer.answers.length)
      verdict.replaceChildren(...answer.answers.map((each) => sentence(each, answer.present)));
    table.replaceChildren(designs(answer.curves));
    remarks.set([...new Set(answer.notes)].slice(0, 12));
  }

  function refresh() {
    suites.refresh();
    limit.setValue(choice().limit);
    measure.setValue(choice().measure);
    const offered = new Set([...MODELS, ...(app.state.bouc_wen ? YIELDING : []), choice().model]);
    model.setOptions([...offered].map((label) => [label, label]), choice().model);
    rotation.hidden = choice().limit !== "rotation";
    at.querySelector(".unit").textContent = unitOf(app.about, choice().measure);
    const held = (app.state.structure.elements ?? []).length > 0;
    own.hidden = !held;
    tendons.hidden = stiffness.hidden = held;
    study.refresh();
  }
  return { element, refresh, close: () => study.close() };
}

// The result of a search for one tendon.
function sentence(each, present) {
  const half = `B = ${number(each.half_width, 3)} m`;
  const width = `${number(2 * each.half_width, 3)} m`;
  const now = `now ${number(2 * present, 3)} m`;
  const sure = each.half_width_upper ? `; with 95 % confidence, ${number(2 * each.half_width_upper, 3)} m` : "";
  const said = {
    met: `a base ${width} wide (${half}) is enough (${now}${sure}).`,
    "met more than once": `a base ${width} wide (${half}) is enough (${now}${sure}).`,
    "all meet it": `every base tried is wide enough, from ${width} (${half}; ${now}).`,
    "not met": `no base tried is wide enough (${now}).`,
  }[each.outcome];
  return h("p", { "data-tendon": each.tendon, "data-value": each.half_width },
    h("b", {}, `${each.tendon}: `), said, each.note ? h("span", { class: "hint" }, ` ${each.note}`) : null);
}

function designs(curves) {
  const head = ["Tendon", "B [m]", "h*₁/B", "Probability", "low", "high", "Median M_b [kN m]", "Runs"];
  const row = (c, i) => h("tr", {},
    h("th", { scope: "row" }, c.tendon),
    h("td", {}, number(c.half_width[i])),
    h("td", {}, number(c.aspect_ratio[i], 3)),
    h("td", { "data-value": c.probability[i] }, number(c.probability[i], 3)),
    h("td", {}, number(c.low[i], 3)),
    h("td", {}, number(c.high[i], 3)),
    h("td", {}, number(c.median_base_moment[i] === null ? null : c.median_base_moment[i] / 1000)),
    h("td", {}, String(c.n_runs[i])));
  return tableOf(head.map(symbol), curves.flatMap((c) => c.half_width.map((_, i) => row(c, i))));
}

// The parts of a band where both limits are known.
function band(c) {
  const kept = c.half_width.map((_, i) => i).filter((i) => c.low[i] !== null && c.high[i] !== null);
  if (kept.length < 2) return null;
  const of = (values) => kept.map((i) => values[i]);
  return { kind: "band", x: of(c.half_width), low: of(c.low), high: of(c.high), color: c.look.color, alpha: 0.14 };
}
