// Design: how wide must the base be, and does a tendon help?

import { ask, drop, Refusal } from "../api.js";
import { Chart, legend } from "../chart.js";
import { h, latest, number } from "../dom.js";
import { field, parseNumber, select } from "../form.js";

const LOOKS = [{ color: "c0", dash: [] }, { color: "c1", dash: [7, 3] }, { color: "c2", dash: [2, 2] }, { color: "c3", dash: [7, 2, 2, 2] }];
const MEASURES = [
  ["pgv", "PGV, peak ground velocity"], ["pga", "PGA, peak ground acceleration"], ["pgd", "PGD, peak ground displacement"],
  ["sa_t1", "Sa(T₁), spectral acceleration"], ["sd_t1", "Sd(T₁), spectral displacement"], ["arias", "Arias intensity"], ["cav", "CAV"],
];
const UNITS = { pgv: "m/s", pga: "m/s²", pgd: "m", sa_t1: "m/s²", sd_t1: "m", arias: "m/s", cav: "m/s" };
const LIMITS = [["rotation", "a rotation"], ["nominal", "the nominal limit 0.7 atan(B/h*₁)"], ["overturning", "overturning"]];
const MODELS = ["2DOF-S", "3DOF-S", "MDOF-S", "2DOF-C"];
const RUNS = ["suites", "scales", "model", "narrowest", "widest", "widths", "tendons", "stiffness"];

export default function designTab(app) {
  const choice = () => app.state.design;
  const put = (patch) => app.change({ design: patch });
  let token = null;
  let ran = "";
  let answer = null;
  let watching = false;

  const box = (name, read = parseNumber, mode = "decimal") => {
    const input = h("input", { type: "text", inputmode: mode, autocomplete: "off", value: [choice()[name]].flat().join(", "), onchange: () => put({ [name]: read(input.value) }) });
    return input;
  };
  const list = (text) => text.split(/[,;\s]+/).filter(Boolean).map(parseNumber);
  const suites = h("div", { class: "chips", role: "group", "aria-label": "Suites" }, app.about.suites.filter((s) => s !== "el-centro-1940").map((name) => {
    const input = h("input", { type: "checkbox", value: name, checked: choice().suites.includes(name), onchange: () => {
      const next = [...suites.querySelectorAll("input:checked")].map((each) => each.value);
      if (next.length) put({ suites: next });
      else input.checked = true;
    } });
    return h("label", {}, input, name.replace("fema-p695-", ""));
  }));
  const known = MODELS.includes(choice().model) ? MODELS : [...MODELS, choice().model];
  const model = select("design.model", "Model", known.map((m) => [m, m]), choice().model, (value) => put({ model: value }));
  const limit = select("design.limit", "What is not to be exceeded", LIMITS, choice().limit, (value) => put({ limit: value }));
  const measure = select("design.measure", "Strength of the earthquake, by", MEASURES, choice().measure, (value) => put({ measure: value }));
  const rotation = field("design.rotation", "Rotation", box("rotation"), { unit: "rad", hint: "0.0001 to 1.5" });
  const at = field("design.at", "At the level", box("at"), { unit: "m/s", hint: "of this measure, above 0" });
  const target = field("design.target", "Probability that is accepted", box("target"), { hint: "0.0001 to 0.99" });
  const tendons = field("design.tendons", "Initial forces of a tendon in the axis", box("tendons", list, "text"), { unit: "× weight", hint: "up to four, 0 for none" });
  const stiffness = field("design.stiffness", "Stiffness EA/L of the tendon", box("stiffness"), { unit: "L₀ʳ g/B²", hint: "0 to 100; at 1 the moment stays constant while rocking" });
  const own = h("p", { class: "help" }, "The structure has tendons of its own, which it keeps.");
  const search = h("button", { type: "button", class: "primary", id: "search", onclick: start }, "Search");
  const cancel = h("button", { type: "button", id: "stop", disabled: true, onclick: stop }, "Cancel");
  const bar = h("progress", { max: 1, value: 0, "aria-label": "Progress" });
  const status = h("p", { class: "help", id: "design-status", role: "status" }, "No search yet.");
  const foot = h("p", { class: "error foot", role: "alert" });
  const chart = new Chart({ label: "Probability over half the width of the base", yLabel: "probability", xLabel: "half the width of the base B [m]", height: 360, xName: "B [m]" });
  const moments = new Chart({ label: "Median base moment over half the width", yLabel: "M_b [kN m]", xLabel: "half the width of the base B [m]", height: 190, zero: true, xName: "B [m]" });
  const keys = h("div");
  const verdict = h("div", { class: "answer", id: "width", role: "status" }, "How wide must the base be? Search to find out.");
  const notes = h("ul", { class: "notes" });
  const remarks = h("details", { hidden: true }, h("summary", {}, "Remarks on the fits"), notes);
  const table = h("div", { class: "scroll", id: "designs" });
  const results = h("div", { class: "results" }, verdict, keys, chart.element,
    h("p", { class: "hint" }, "Lines: probability that the limit is exceeded at the level of the earthquake, falling over included; bands: 90 % confidence over the recordings; dashed: what is accepted."),
    table, h("h2", {}, "What the structure then carries"), moments.element, h("p", { class: "hint" }, "Median of the largest base moments over all runs."), remarks);
  const element = h("div", { class: "columns" },
    h("form", { class: "side", onsubmit: (event) => event.preventDefault() },
      h("fieldset", {}, h("legend", {}, "Question"), limit, rotation, target, measure, at),
      h("fieldset", {}, h("legend", {}, "Search"), field("design.narrowest", "From", box("narrowest"), { unit: "× present B", hint: "0.2 to 2" }), field("design.widest", "To", box("widest"), { unit: "× present B", hint: "1 to 10" }),
        field("design.widths", "Widths", box("widths"), { hint: "3 to 20" }), own, tendons, stiffness,
        h("div", { class: "field", "data-path": "design.suites" }, h("div", { class: "label" }, "Suites of records"), suites, h("div", { class: "error", role: "alert" })),
        field("design.scales", "Scale factors", box("scales", list, "text"), { hint: "up to five, each from 0.01 to 20" }), model,
        h("div", { "data-path": "design" }, h("div", { class: "buttons" }, search, cancel), bar, status, h("div", { class: "error", role: "alert" })), foot)),
    results);
  results.append(app.downloads(element, [["figure", "Figure (SVG)"], ["table", "Designs (CSV)"], ["design-study", "Study (TOML)"], ["design-python", "Python lines"]],
    (what) => (what.startsWith("design") ? `/api/download/${what}` : `/api/study/design/${token}/${what}`)));

  const key = () => JSON.stringify([app.state.structure, app.state.impact, RUNS.map((name) => choice()[name])]);

  async function start() {
    await stop();
    const wanted = key();
    const found = await app.ask("/api/study/design", element);
    if (!found) return;
    token = found.token;
    ran = wanted;
    watch();
  }

  async function stop() {
    if (!token || !answer || !["waiting", "running"].includes(answer.status)) return;
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
        await new Promise((resolve) => setTimeout(resolve, 500));
      } while (token && app.state.tab === "design" && answer && ["waiting", "running"].includes(answer.status));
    } finally {
      watching = false;
    }
  }

  const load = latest(async () => {
    if (!token) return;
    const asked = token;
    try {
      const found = await ask(`/api/study/design/${asked}`, { state: app.state });
      if (asked !== token) return;
      answer = found;
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
    cancel.disabled = !on;
    bar.value = answer.done / answer.total;
    const said = { waiting: "Waiting for the runs of others.", running: `${answer.done} of ${answer.total} runs`, done: `Done: ${answer.total} runs.`, cancelled: `Cancelled after ${answer.done} of ${answer.total} runs.`, failed: `Failed: ${answer.message}` };
    status.textContent = said[answer.status] + (ran === key() ? "" : " Something was changed since: search again.");
    results.classList.toggle("stale", ran !== key());
    const look = (i) => LOOKS[i % LOOKS.length];
    const met = answer.answers.map((a, i) => ({ ...a, ...look(i) })).filter((a) => a.half_width !== null && a.half_width !== undefined && a.outcome.startsWith("met"));
    chart.set({ yRange: [-0.02, 1.02], series: [
      ...answer.curves.map((c, i) => band(c, look(i))).filter(Boolean),
      ...answer.curves.map((c, i) => ({ x: c.half_width, y: c.probability.map((v) => v ?? NaN), label: c.tendon, ...look(i), width: 2 })),
      ...answer.curves.map((c, i) => ({ kind: "points", x: c.half_width, y: c.probability.map((v) => v ?? NaN), color: look(i).color, size: 3 })),
      ...met.map((a) => ({ kind: "points", x: [a.half_width], y: [choice().target], color: a.color, hollow: true, size: 7, width: 2 })),
    ], hlines: [{ y: choice().target, label: "accepted", color: "muted" }],
    vlines: [{ x: answer.present, label: "present base", color: "muted", dash: [2, 3] }, ...met.map((a) => ({ x: a.half_width, label: `B = ${number(a.half_width, 3)} m`, color: a.color }))] });
    moments.set({ series: answer.curves.map((c, i) => ({ x: c.half_width, y: c.median_base_moment.map((v) => (v ?? NaN) / 1000), label: c.tendon, ...look(i) })) });
    keys.replaceChildren(legend(answer.curves.map((c, i) => ({ label: c.tendon, ...look(i) }))));
    verdict.replaceChildren(...answer.answers.map((a) => h("p", { "data-tendon": a.tendon, "data-value": a.half_width }, sentence(a))));
    table.replaceChildren(h("table", {}, h("thead", {}, h("tr", {}, ["Tendon", "B [m]", "h*₁/B", "Probability", "low", "high", "Median M_b [kN m]", "Runs"].map((t) => h("th", { scope: "col" }, t)))),
      h("tbody", {}, answer.curves.flatMap((c) => c.half_width.map((b, i) => h("tr", {}, h("th", { scope: "row" }, c.tendon), h("td", {}, number(b)), h("td", {}, number(c.aspect_ratio[i], 3)), h("td", { "data-value": c.probability[i] }, number(c.probability[i], 3)),
        h("td", {}, number(c.low[i], 3)), h("td", {}, number(c.high[i], 3)), h("td", {}, number(c.median_base_moment[i] === null ? null : c.median_base_moment[i] / 1000)), h("td", {}, String(c.n_runs[i]))))))));
    notes.replaceChildren(...[...new Set(answer.notes)].slice(0, 12).map((text) => h("li", {}, text)));
    remarks.hidden = !answer.notes.length;
  }

  function sentence(a) {
    const present = `now B = ${number(answer.present, 3)} m`;
    const sure = a.half_width_upper ? `; to be sure at 95 %, ${number(a.half_width_upper, 3)} m` : "";
    const texts = {
      met: `B = ${number(a.half_width, 3)} m is enough (${present}${sure}).`,
      "met more than once": `B = ${number(a.half_width, 3)} m is enough (${present}${sure}).`,
      "all meet it": `every base tried is wide enough, from B = ${number(a.half_width, 3)} m (${present}).`,
      "not met": `no base tried is wide enough (${present}).`,
    };
    return [h("b", {}, `${a.tendon}: `), texts[a.outcome], a.note ? h("span", { class: "hint" }, ` ${a.note}`) : null].filter(Boolean);
  }

  function refresh() {
    limit.setValue(choice().limit);
    measure.setValue(choice().measure);
    model.setValue(choice().model);
    rotation.hidden = choice().limit !== "rotation";
    at.querySelector(".unit").textContent = UNITS[choice().measure];
    const held = (app.state.structure.tendons ?? []).length > 0;
    own.hidden = !held;
    tendons.hidden = stiffness.hidden = held;
    if (token) watch();
    if (answer) load();
  }
  return { element, refresh };
}

// The stretches of a band where both of its limits are known.
function band(c, look) {
  const kept = c.half_width.map((_, i) => i).filter((i) => c.low[i] !== null && c.high[i] !== null);
  if (kept.length < 2) return null;
  return { kind: "band", x: kept.map((i) => c.half_width[i]), low: kept.map((i) => c.low[i]), high: kept.map((i) => c.high[i]), color: look.color, alpha: 0.14 };
}
