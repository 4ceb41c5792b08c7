// Design: how wide must the base be, and does a tendon help?

import { Chart } from "../chart.js";
import { isRigid, measuresOf, unitOf } from "../choices.js";
import { h, number, scrolled, symbol, tableOf } from "../dom.js";
import { measures } from "../drawn.js";
import { between } from "../form.js";
import { assumed, choices, recordsOf, Remarks, Study, undecided } from "../jobs.js";
import { legend, look } from "../marks.js";
import { t } from "../texts.js";
import { inUnit, titled, unit, valueIn } from "../units.js";

const MODELS = ["2DOF-S", "3DOF-S", "MDOF-S", "2DOF-C", "rigid"];
const YIELDING = ["2DOF-S-BW", "2DOF-C-BW"];
const RUNS = ["scales", "narrowest", "widest", "widths", "tendons", "stiffness"];

// Values in the unit of a kind of quantity, not a number where there are none.
const numbers = (values, quantity = "ratio") => values.map((value) => (value ?? NaN) / unit(quantity).size);

export default function designTab(app) {
  const choice = () => app.state.design;
  const { entry, list, suites } = choices(app, "design");

  const limitStates = app.about.limit_states.filter((each) => each.noun);
  const limit = list("limit", t("Limit state"), limitStates.map((each) => [each.name, t(each.noun)]));
  const rotation = entry("rotation", t("Rotation"), { unit: "rad", name: "rotation", hint: between(1e-4, 1.5, "rad", "rotation") });
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

  const width = { xLabel: titled(t("half width of the base B [{unit}]"), "length"), xName: titled("B [{unit}]", "length") };
  const chart = new Chart({
    label: t("Probability over half width of the base"), yLabel: t("probability"), height: 360, ...width,
  });
  const moments = new Chart({
    label: t("Median base moment over half width"), yLabel: titled("M_b [{unit}]", "moment"), height: 190, zero: true, ...width,
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
  results.append(study.downloads(
    [["figure", t("Figure (SVG)")], ["table", t("Designs (CSV)")]],
    [["design-study", t("Study (TOML)")], ["design-python", t("Python lines")]]));

  function show(answer) {
    for (const each of [...answer.curves, ...answer.answers]) each.tendon = t(each.tendon);
    drawing.hidden = !answer.curves.length;
    const curves = answer.curves.map((curve, i) => ({ ...curve, x: numbers(curve.half_width, "length"), look: look(i) }));
    const found = answer.answers.map((each, i) => ({ ...each, color: look(i).color })).filter(met);
    // Through the width found too: between widths, logarithms of probabilities are interpolated.
    const through = (c) => {
      const ends = found.filter((each) => each.tendon === c.tendon).map((each) => [...numbers([each.half_width], "length"), choice().target]);
      const all = [...numbers(c.probability).map((y, i) => [c.x[i], y]), ...ends].sort(([a], [b]) => a - b);
      return { x: all.map(([x]) => x), y: all.map(([, y]) => y) };
    };
    chart.set({
      yRange: [-0.02, 1.02],
      series: [
        ...curves.map(band).filter(Boolean),
        ...curves.map((c) => ({ ...through(c), label: c.tendon, ...c.look, width: 2 })),
        ...curves.map((c) => (
          { kind: "points", x: c.x, y: numbers(c.probability), color: c.look.color, size: 3 })),
        ...found.map((each) => (
          { kind: "points", x: numbers([each.half_width], "length"), y: [choice().target], color: each.color, hollow: true, size: 7, width: 2 })),
      ],
      hlines: [{ y: choice().target, label: t("acceptable"), color: "muted" }],
      vlines: [
        { x: numbers([answer.present], "length")[0], label: t("present base"), color: "muted", dash: [2, 3] },
        ...found.map((each) => ({ x: numbers([each.half_width], "length")[0], label: `B = ${inUnit(each.half_width, "length", 3)}`, color: each.color })),
      ],
    });
    moments.set({ series: curves.map((c) => (
      { x: c.x, y: numbers(c.median_base_moment, "moment"), label: c.tendon, ...c.look })) });
    keys.replaceChildren(legend(curves.map((c) => ({ label: c.tendon, ...c.look }))));
    if (answer.status !== "done") verdict.textContent = answer.total ? undecided(answer) : "";
    else if (answer.answers.length) verdict.replaceChildren(...answer.answers.map((each) => sentence(each, answer.present, used(each, answer))));
    table.replaceChildren(designs(curves));
    remarks.set([...new Set(answer.notes)].slice(0, 12));
  }

  // A button that gives the structure the width that was found, and its tendon.
  function used(each, { present }) {
    const { structure } = app.state;
    const { B } = measures(structure, { half_width: present, heights: [1] }, app.about.kinds);
    if (!met(each) || !B) return null;
    const take = () => {
      const next = B.set(each.half_width);
      if (each.tendon_of) next.elements = [...(next.elements ?? []), { kind: "tendon", position: 0, ...each.tendon_of }];
      app.change({ structure: next });
      app.go("structure");
    };
    return h("button", { type: "button", onclick: take }, t("Use it"));
  }

  function refresh() {
    suites.refresh();
    limit.setValue(choice().limit);
    measure.setValue(choice().measure);
    const offered = new Set([...(isRigid(app.state.structure) ? ["rigid"] : MODELS), ...(app.state.bouc_wen ? YIELDING : []), choice().model]);
    model.setOptions([...offered].map((label) => [label, label]), choice().model);
    rotation.hidden = choice().limit !== "rotation";
    at.setUnit(unitOf(app.about, choice().measure));
    at.setValue(choice().at);
    const held = (app.state.structure.elements ?? []).length > 0;
    own.hidden = !held;
    tendons.hidden = stiffness.hidden = held;
    study.refresh();
  }
  return { element, refresh, close: (runs) => study.close(runs) };
}

const met = (each) => Number.isFinite(each.half_width) && ["met", "met more than once"].includes(each.outcome);

// The result of a search for one tendon, and a button to use it.
function sentence(each, present, use) {
  const [half, width, now, upper] = [each.half_width, 2 * each.half_width, 2 * present, 2 * each.half_width_upper].map((value) => inUnit(value, "length", 3));
  const values = { half, width, now, upper };
  const enough = each.half_width_upper
    ? t("a base {width} wide (B = {half}) is enough (now {now}; with 95 % confidence, {upper}).", values)
    : t("a base {width} wide (B = {half}) is enough (now {now}).", values);
  const said = {
    met: enough,
    "met more than once": enough,
    "all meet it": t("every base tried is wide enough, from {width} (B = {half}; now {now}).", values),
    "not met": t("no base tried is wide enough (now {now}).", values),
  }[each.outcome];
  return h("p", { "data-tendon": each.tendon, "data-value": each.half_width },
    h("b", {}, `${each.tendon}: `), said, each.note ? h("span", { class: "hint" }, ` ${each.note}`) : null, " ", use);
}

function designs(curves) {
  const head = [t("Tendon"), titled("B [{unit}]", "length"), "h*₁/B", t("Probability"), t("low"), t("high"),
    titled(t("Median M_b [{unit}]"), "moment"), t("Runs")];
  const row = (c, i) => h("tr", {},
    h("th", { scope: "row" }, c.tendon),
    h("td", {}, number(c.x[i])),
    h("td", {}, number(c.aspect_ratio[i], 3)),
    h("td", { "data-value": c.probability[i] }, number(c.probability[i], 3)),
    h("td", {}, number(c.low[i], 3)),
    h("td", {}, number(c.high[i], 3)),
    h("td", {}, valueIn(c.median_base_moment[i], "moment")),
    h("td", {}, String(c.n_runs[i])));
  return tableOf(head.map(symbol), curves.flatMap((c) => c.half_width.map((_, i) => row(c, i))));
}

// The parts of a band where both limits are known.
function band(c) {
  const kept = c.half_width.map((_, i) => i).filter((i) => c.low[i] !== null && c.high[i] !== null);
  if (kept.length < 2) return null;
  const of = (values) => kept.map((i) => values[i]);
  return { kind: "band", x: of(c.x), low: of(c.low), high: of(c.high), color: c.look.color, alpha: 0.14 };
}
