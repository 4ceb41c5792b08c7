// Fragility: many records, and the probability of exceeding a limit, updated as runs finish.

import { Chart } from "../chart.js";
import { axisOf, isRigid, measuresOf, models, unitOf } from "../choices.js";
import { h, number, scrolled, tableOf } from "../dom.js";
import { between, select } from "../form.js";
import { assumed, choices, recordsOf, Remarks, Study } from "../jobs.js";
import { legend, look } from "../marks.js";
import { t } from "../texts.js";
import { fromSI, headed, unit, unitFor } from "../units.js";

const CONFIDENCES = [[0.68, "68 %"], [0.8, "80 %"], [0.9, "90 %"], [0.95, "95 %"]];
const FOOT = 1.2e-5; // rad, where runs without rotation are drawn

export default function fragilityTab(app) {
  const choice = () => app.state.cloud;
  const { put, entry, list, suites } = choices(app, "cloud");

  const scales = entry("scales", t("Scale factors"), { many: true, hint: t("up to twenty, each from 0.01 to 20") });
  const labels = models("cloud.models", choice().models, app.about.limits.models, (value) => put({ models: value }));
  const measure = list("measure", t("Intensity measure"), measuresOf(app.about, true));
  const limitStates = app.about.limit_states;
  const limit = list("limit", t("Limit state"), []);
  const bounds = {
    rotation: entry("rotation", t("Rotation"), { unit: "rad", name: "rotation", hint: between(1e-4, 1.5, "rad", "rotation") }),
    drift: entry("drift", t("Drift over the height"), { hint: t("such as 0.01; of the top, relative to the rotating base") }),
    residual_drift: entry("residual_drift", t("Drift left over the height of the story"), { hint: t("such as 0.005") }),
    ductility: entry("ductility", t("Ductility"), { hint: t("largest drift of a story over that at first yield") }),
  };
  const offered = CONFIDENCES.some(([value]) => value === choice().confidence) ? CONFIDENCES
    : [...CONFIDENCES, [choice().confidence, `${number(100 * choice().confidence)} %`]];
  const confidence = select("cloud.confidence", t("Confidence level of the bands"), offered, choice().confidence,
    (value) => put({ confidence: Number(value) }));

  const curves = new Chart({ label: t("Probability over intensity"), yLabel: t("probability"), height: 320, xName: "IM", xLog: true });
  const cloud = new Chart({
    label: t("Rotations of the runs over intensity"), yLabel: headed("max_rotation"), height: 280, xName: "IM", xLog: true, yLog: true,
  });
  const keys = h("div");
  const remarks = new Remarks();
  const table = scrolled(t("Fits"), { id: "fits" });
  const drawing = h("div", { hidden: true },
    h("h2", {}, t("Fragility curves")), keys, curves.element,
    h("p", { class: "hint" }, t("Lines: fitted curves; bands: their confidence, rising with the intensity as the probability does; circles: observed fraction " +
      "in groups of runs of similar intensity.")),
    table,
    h("h2", {}, t("All runs")), cloud.element,
    h("p", { class: "hint" }, t("Overturned runs are drawn at π/2, runs below 0.01 mrad at the bottom.")),
    remarks.element);
  const empty = h("p", { class: "answer" },
    t("A quick look is computed first. Press Run to simulate every record of the suites at every scale factor; the curves appear " +
    "while it runs."));
  const results = h("div", { class: "results" }, empty, drawing);
  const study = new Study(app, "cloud", {
    results, show,
    words: { run: t("Run"), again: t("Run again"), none: t("No run yet."), changed: t("The input has changed: run again.") },
    example: () => ({ models: [choice().models[0]], scales: [...new Set([choice().scales[0], choice().scales.at(-1)])] }),
    key: () => JSON.stringify([assumed(app.state, choice().models), recordsOf(app.state, choice().suites), choice().scales]),
  });
  const element = h("div", { class: "columns" },
    h("form", { class: "side", onsubmit: (event) => event.preventDefault() },
      h("fieldset", {}, h("legend", {}, t("Cloud of runs")), suites, scales, labels, study.element),
      h("fieldset", {}, h("legend", {}, t("Fragility curves")), limit, Object.values(bounds), measure, confidence)),
    results);
  results.append(study.downloads(
    [["figure", t("Rocking and overturning (SVG)")], ["table", t("Runs (CSV)")]],
    [["cloud-study", t("Study (TOML)")], ["cloud-python", t("Python lines")]]));

  function show(answer) {
    const label = axisOf(app.about, choice().measure);
    drawing.hidden = !answer.curves.length;
    empty.hidden = !drawing.hidden;
    curves.options.xLabel = cloud.options.xLabel = label;
    const own = unitFor(unitOf(app.about, choice().measure));
    const { size } = own;
    const all = answer.curves.map((curve, i) => ({ ...curve, look: look(i), im: curve.im.map((value) => value / size) }));
    const fitted = all.filter((curve) => curve.p);
    curves.set({
      yRange: [-0.02, 1.02],
      series: [
        ...fitted.filter((c) => c.low).map((c) => (
          { kind: "band", x: c.im, low: c.low, high: c.high, color: c.look.color, alpha: 0.16 })),
        ...fitted.map((c) => ({ x: c.im, y: c.p, label: c.model, ...c.look, width: 2 })),
        ...all.map((c) => ({
          kind: "points", x: c.observed.map(([im]) => im / size), y: c.observed.map(([, share]) => share),
          color: c.look.color, hollow: true, size: 3.4, width: 1.4,
        })),
      ],
    });
    const turn = unit("rotation").size;
    const at = choice().limit === "rotation" ? choice().rotation : null;
    cloud.set({
      yRange: [1e-5 / turn, 2 / turn],
      series: all.map((c) => ({
        kind: "points", x: c.point_im.map((value) => value / size), y: c.point_rotation.map((v) => Math.max(v, FOOT) / turn),
        color: c.look.color, alpha: 0.55, size: 2.2,
      })),
      hlines: at ? [{ y: at / turn, label: t("limit"), color: "c1" }] : [],
    });
    keys.replaceChildren(legend(all.map((c) => ({ label: c.model, ...c.look }))));
    table.replaceChildren(fits(answer.curves, label, own));
    remarks.set(answer.notes);
  }

  function refresh() {
    suites.refresh();
    labels.setValue(choice().models, app.state);
    measure.setValue(choice().measure);
    const { structure } = app.state;
    const lacking = [...(isRigid(structure) ? ["drift"] : []), ...(structure.stories ? [] : ["residual_drift", "ductility"])];
    const offered = limitStates.filter(({ name }) => name === choice().limit || !lacking.includes(name));
    limit.setOptions(offered.map((each) => [each.name, t(each.clause)]), choice().limit);
    for (const [name, each] of Object.entries(bounds)) each.hidden = choice().limit !== name;
    study.refresh();
  }
  return { element, refresh, close: (runs) => study.close(runs) };
}

function fits(curves, label, own) {
  const head = [t("Model"), t("Runs"), t("Exceeding the limit"), t("Median {measure}", { measure: label })];
  return tableOf(head, curves.map((c) => h("tr", { "data-model": c.model },
    h("th", { scope: "row" }, c.model),
    h("td", { "data-name": "n" }, String(c.n)),
    h("td", { "data-name": "n_exceeding" }, String(c.n_exceeding)),
    h("td", { "data-name": "median", "data-value": c.median }, number(fromSI(c.median, own))))));
}
