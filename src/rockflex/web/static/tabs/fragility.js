// Fragility: many records, and the probability that a limit is passed, as it comes.

import { ask, drop, Refusal } from "../api.js";
import { Chart, legend } from "../chart.js";
import { h, latest, number } from "../dom.js";
import { field, models, parseNumber, select } from "../form.js";

const LOOKS = [{ color: "c0", dash: [] }, { color: "c1", dash: [7, 3] }, { color: "c2", dash: [2, 2] }, { color: "c3", dash: [7, 2, 2, 2] }];
const MEASURES = [
  ["pgv", "PGV, peak ground velocity"], ["pga", "PGA, peak ground acceleration"], ["pgd", "PGD, peak ground displacement"], ["sa_t1", "Sa(T₁), spectral acceleration"],
  ["sd_t1", "Sd(T₁), spectral displacement"], ["arias", "Arias intensity"], ["cav", "CAV"], ["relative_pga", "PGA/(g tan α)"], ["relative_pgv", "p PGV/(g tan α)"],
];
const LIMITS = [["rocking", "it rocks (θ > 0.1 mrad)"], ["rotation", "the rotation exceeds …"], ["nominal", "the nominal limit 0.7 atan(B/h*₁)"], ["overturning", "it overturns"]];

export default function fragilityTab(app) {
  const choice = () => app.state.cloud;
  const put = (patch) => app.change({ cloud: patch });
  let token = null;
  let ran = "";
  let answer = null;
  let watching = false;

  const foot = h("p", { class: "error foot", role: "alert" });
  const suites = h("div", { class: "chips", role: "group", "aria-label": "Suites" }, app.about.suites.filter((s) => s !== "el-centro-1940").map((name) => {
    const box = h("input", { type: "checkbox", value: name, checked: choice().suites.includes(name), onchange: () => {
      const next = [...suites.querySelectorAll("input:checked")].map((each) => each.value);
      if (next.length) put({ suites: next });
      else box.checked = true;
    } });
    return h("label", {}, box, name.replace("fema-p695-", ""));
  }));
  const scales = h("input", { type: "text", autocomplete: "off", value: choice().scales.join(", "), onchange: () => put({ scales: scales.value.split(/[,;\s]+/).filter(Boolean).map(parseNumber) }) });
  const chips = models("cloud.models", choice().models, app.about.limits.models, (value) => put({ models: value }));
  const measure = select("cloud.measure", "Intensity measure", MEASURES, choice().measure, (value) => put({ measure: value }));
  const limit = select("cloud.limit", "What is asked: that", LIMITS, choice().limit, (value) => put({ limit: value }));
  const rotation = h("input", { type: "text", inputmode: "decimal", autocomplete: "off", value: choice().rotation, onchange: () => put({ rotation: parseNumber(rotation.value) }) });
  const rotationField = field("cloud.rotation", "Rotation", rotation, { unit: "rad", hint: "0.0001 to 1.5" });
  const level = select("cloud.level", "Confidence of the bands", [[0.9, "90 %"], [0.95, "95 %"], [0.68, "68 %"]], choice().level, (value) => put({ level: Number(value) }));
  const run = h("button", { type: "button", class: "primary", id: "run", onclick: start }, "Run");
  const cancel = h("button", { type: "button", id: "cancel", disabled: true, onclick: stop }, "Cancel");
  const bar = h("progress", { max: 1, value: 0, "aria-label": "Progress" });
  const status = h("p", { class: "help", id: "status", role: "status" }, "No run yet.");
  const curves = new Chart({ label: "Probability over intensity", yLabel: "probability", xLabel: "", height: 320, xName: "IM", xLog: true });
  const cloud = new Chart({ label: "Rotations of the runs over intensity", yLabel: "θ_max [rad]", xLabel: "", height: 280, xLog: true, yLog: true, noReadout: true });
  const keys = h("div");
  const notes = h("ul", { class: "notes" });
  const remarks = h("details", { hidden: true }, h("summary", {}, "Remarks on the fits"), notes);
  const table = h("div", { class: "scroll", id: "fits" });
  const results = h("div", { class: "results" }, h("h2", {}, "Fragility curves"), keys, curves.element,
    h("p", { class: "hint" }, "Lines: fitted curves; bands: their confidence; dots: share of runs in groups of neighbouring intensities."),
    table, h("h2", {}, "All runs"), cloud.element, h("p", { class: "hint" }, "Runs that overturned stand at π/2; runs below 0.01 mrad stand at the foot."), remarks);
  const element = h("div", { class: "columns" },
    h("form", { class: "side", onsubmit: (event) => event.preventDefault() },
      h("fieldset", {}, h("legend", {}, "Cloud of runs"), h("div", { class: "field", "data-path": "cloud.suites" }, h("div", { class: "label" }, "Suites of records"), suites, h("div", { class: "error", role: "alert" })),
        field("cloud.scales", "Scale factors", scales, { hint: "up to twenty, each from 0.01 to 20" }), chips,
        h("div", { "data-path": "cloud" }, h("div", { class: "buttons" }, run, cancel), bar, status, h("div", { class: "error", role: "alert" })), foot),
      h("fieldset", {}, h("legend", {}, "Reading"), limit, rotationField, measure, level)),
    results);
  const files = (what) => (what.startsWith("cloud") ? `/api/download/${what}` : `/api/study/cloud/${token}/${what}`);
  results.append(app.downloads(element, [["figure", "Figure (SVG)"], ["table", "Runs (CSV)"], ["cloud-study", "Study (TOML)"], ["cloud-python", "Python lines"]], files));

  const key = () => JSON.stringify([app.state.structure, app.state.impact, choice().suites, choice().scales, choice().models]);

  async function start() {
    await stop();
    const wanted = key();
    const found = await app.ask("/api/study/cloud", element);
    if (!found) return;
    token = found.token;
    ran = wanted;
    watch();
  }

  async function stop() {
    if (!token || !answer || ["done", "cancelled", "failed"].includes(answer.status)) return;
    try {
      await drop(`/api/job/${token}`);
    } catch (error) {
      if (!(error instanceof Refusal)) throw error;
    }
  }

  async function watch() {
    if (watching) return;
    watching = true;
    try {
      do {
        await load();
        await new Promise((resolve) => setTimeout(resolve, 350));
      } while (token && app.state.tab === "fragility" && answer && ["waiting", "running"].includes(answer.status));
    } finally {
      watching = false;
    }
  }

  const load = latest(async () => {
    if (!token) return;
    try {
      answer = await ask(`/api/study/cloud/${token}`, { state: app.state });
      app.complain(element, {});
    } catch (error) {
      if (!(error instanceof Refusal)) throw error;
      app.complain(element, error.errors);
      if (error.status === 404) token = answer = null;
      return;
    }
    show();
  });

  function show() {
    const on = ["waiting", "running"].includes(answer.status);
    run.textContent = on ? "Run again" : "Run";
    cancel.disabled = !on;
    bar.value = answer.done / answer.total;
    const said = { waiting: "Waiting for the runs of others.", running: `${answer.done} of ${answer.total} runs`, done: `Done: ${answer.total} runs.`, cancelled: `Cancelled after ${answer.done} of ${answer.total} runs.`, failed: `Failed: ${answer.message}` };
    status.textContent = said[answer.status];
    results.classList.toggle("stale", ran !== key());
    if (ran !== key()) status.textContent += " Something was changed since: run again.";
    const name = MEASURES.find(([m]) => m === choice().measure)[1].split(",")[0];
    const label = answer.unit ? `${name} [${answer.unit}]` : name;
    curves.options.xLabel = cloud.options.xLabel = label;
    const look = (i) => LOOKS[i % LOOKS.length];
    const drawn = answer.curves.filter((c) => c.p);
    curves.set({ yRange: [-0.02, 1.02], series: [
      ...drawn.filter((c) => c.low).map((c) => ({ kind: "band", x: c.im, low: c.low, high: c.high, color: look(answer.curves.indexOf(c)).color, alpha: 0.16 })),
      ...drawn.map((c) => ({ x: c.im, y: c.p, label: c.model, ...look(answer.curves.indexOf(c)), width: 2 })),
      ...answer.curves.map((c, i) => ({ kind: "points", x: c.observed.map((o) => o[0]), y: c.observed.map((o) => o[1]), color: look(i).color, hollow: true, size: 3.4, width: 1.4 })),
    ] });
    const at = { rocking: 1e-4, rotation: choice().rotation }[choice().limit];
    cloud.set({ yRange: [1e-5, 2], series: answer.curves.map((c, i) => ({ kind: "points", x: c.point_im, y: c.point_rotation.map((v) => Math.max(v, 1.2e-5)), color: look(i).color, alpha: 0.55, size: 2.2 })),
      hlines: at ? [{ y: at, label: "limit", color: "c1" }] : [] });
    keys.replaceChildren(legend(answer.curves.map((c, i) => ({ label: c.model, ...look(i) }))));
    table.replaceChildren(h("table", {}, h("thead", {}, h("tr", {}, ["Model", "Runs", "Beyond the limit", `Median ${label}`].map((t) => h("th", { scope: "col" }, t)))),
      h("tbody", {}, answer.curves.map((c) => h("tr", { "data-model": c.model }, h("th", { scope: "row" }, c.model), h("td", { "data-name": "n" }, String(c.n)), h("td", { "data-name": "n_exceeding" }, String(c.n_exceeding)), h("td", { "data-name": "median", "data-value": c.median }, number(c.median)))))));
    notes.replaceChildren(...answer.notes.map((text) => h("li", {}, text)));
    remarks.hidden = !answer.notes.length;
  }

  function refresh() {
    chips.setValue(choice().models);
    measure.setValue(choice().measure);
    limit.setValue(choice().limit);
    rotationField.hidden = choice().limit !== "rotation";
    if (token) watch();
    if (answer) load();
  }
  return { element, refresh };
}
