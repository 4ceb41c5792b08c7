// Response: the rocking structure, animated with its response histories, its peaks and its assumptions.

import { bracket } from "../axes.js";
import { overTime } from "../chart.js";
import { yields } from "../choices.js";
import { decode, h, latest, number, scrolled, symbol, tableOf } from "../dom.js";
import { select, slider } from "../form.js";
import { making } from "../jobs.js";
import { legend, looks } from "../marks.js";
import { Player } from "../stage.js";
import { t } from "../texts.js";
import { Elements, Energy, Loop } from "./energy.js";
import { runs } from "./runs.js";

const EDGES = [["left_edge", t("{model}, left")], ["right_edge", t("{model}, right")]];
// Name, axis, factor, title, height, and the curves of each model where there are several.
const PANELS = [
  ["rotation", "θ [mrad]", 1000, "Rotation", 150],
  ["slip", "slip [mm]", 1000, "Slip of the base", 118],
  ["edges", "edges [mm]", 1000, "Rise of the edges", 118, EDGES],
  ["displacement", "", 1, "Displacement of the top", 118],
  ["element", "F [kN]", 1e-3, "Force of an element", 118, [["element_force", "{model}"]]],
  ["base_moment", "M_b [kN m]", 1e-3, "Base moment", 118],
  ["base_shear", "V_b [kN]", 1e-3, "Base shear", 134],
];
const DISPLACEMENTS = [
  ["total_top_displacement", t("relative to the ground"), "u_top total [m]"],
  ["top_displacement", t("relative to the rotating base"), "u_top relative [m]"],
];
const SERIES = ["rotation", ...DISPLACEMENTS.map(([key]) => key), "base_moment", "base_shear", "slip", "left_edge", "right_edge", "element_force"];
const OTHERS = ["t", "uplifted", "points", "element_elongation", "heave"];
const FILES = [
  ["report", t("Report (HTML)")], ["figure", t("Figure (SVG)")], ["energy", t("Energy (SVG)")],
  ["peaks", t("Peaks (CSV)")], ["histories", t("Histories (CSV)")],
  ["study", t("Study (TOML)")], ["python", t("Python lines")], ["record", t("Record (CSV)")],
];

const PATIENCE = 1500; // ms before the page says that it is computing
const FIRST = t("Computing … The first run after an installation compiles the kernels, which takes some fifteen seconds.");

export default function responseTab(app) {
  let view = null;
  const player = new Player(follow, app.about.elements);
  const scale = slider("scale", t("Scale factor"), { low: 0.01, high: 20, log: true }, app.state.scale,
    (value) => app.change({ scale: value }));
  const options = runs(app, () => view?.suggested_yield);
  const onpick = (time) => player.go(time);
  const charts = overTime(PANELS.map(([, yLabel, , name, height, parts]) => (
    { label: t("{quantity} over time", { quantity: name }), yLabel, height, firstOnTop: true, onpick, symmetric: !parts })));
  const panels = PANELS.map(([key, , , , , parts = [[key, "{model}"]]], i) => [key, charts[i], parts]);
  const loop = new Loop({ label: t("Base moment over rotation"), yLabel: "M_b [kN m]", xLabel: "θ [mrad]" });
  const energy = new Energy(() => load());
  const elements = new Elements(app.about, () => {
    energy.focus = elements.model.value;
    load();
  });
  const seen = select("displacement", t("Plotted top displacement"), DISPLACEMENTS, DISPLACEMENTS[0][0], () => {
    if (!view) return;
    choose(view);
    draw();
  });
  const keys = h("div", { id: "keys" });
  const peaks = scrolled(t("Largest values"), { id: "peaks" });
  const verdict = h("p", { class: "answer", id: "verdict", role: "status" });
  const warned = h("div", { class: "warning", id: "warnings", role: "alert", hidden: true });
  const results = h("div", { class: "results" }, verdict, warned, keys, seen, charts.map((chart) => chart.element),
    h("p", { class: "hint" }, t("Shaded: the base of the first model is uplifted. Triangles: its impacts."), " ",
      h("span", { class: "screen" }, t("Point at one of these charts to read all of them. Click or use the arrow keys to set the time; " +
        "drag or press + and − to zoom; double-click or press Escape to reset."))),
    h("h2", {}, t("Largest values")), peaks, elements.table,
    h("div", { class: "pair" }, h("div", {}, h("h2", {}, t("Moment and rotation")), loop.chart.element), elements.chart,
      energy.element));
  const element = h("div", { class: "columns" },
    h("form", { class: "side", onsubmit: (event) => event.preventDefault() },
      player.element,
      h("fieldset", {}, h("legend", {}, t("Runs")), scale, options.element, h("p", { class: "error foot", role: "alert" }))),
    results);
  const moving = making(app, element, "animation", t("Animation (GIF)"));
  const files = app.downloads(element, FILES);
  files.querySelector('[data-file="figure"]').after(moving.button);
  results.append(files, moving.element);

  function draw() {
    const [first] = view.models;
    const falls = view.models.map((m) => m.fall_time ?? Infinity).filter(Number.isFinite);
    const spans = uplifts(first);
    // Of the element whose loop is drawn, with its number in the drawing of the base.
    if (view.held) charts[panels.findIndex(([name]) => name === "element")].options.yLabel = `F_${view.element + 1} [kN]`;
    panels.forEach(([, chart, parts], p) => {
      const series = view.models.flatMap((m, i) => parts.filter(([part]) => m.scaled[part]).map(([part, name], k) => ({
        x: m.t, y: m.scaled[part], until: m.fall_time ?? Infinity, label: name.replace("{model}", m.label), ...m.look,
        width: i ? 1.2 : 1.6, alpha: k ? 0.55 : 1,
      })));
      chart.element.hidden = !series.length;
      chart.set({
        series, spans, xRange: [0, view.end],
        ticks: p === 0 ? first.impact_times : [],
        vlines: falls.map((x, i) => ({ x, color: "error", label: p + i === 0 ? t("falls") : "" })),
      });
    });
    const lifting = view.models.filter((m) => m.lifts);
    loop.set(lifting.map((m) => (
      { t: m.t, x: m.scaled.rotation, y: m.scaled.base_moment, until: m.fall_time ?? Infinity, label: m.label, look: m.look })));
    loop.chart.element.parentElement.hidden = !lifting.length;
    elements.set(view);
    energy.set(view);
    keys.replaceChildren(legend(view.models.map((m) => ({ label: m.label, ...m.look }))));
    peaks.replaceChildren(...table(view));
    verdict.textContent = summary(view);
    warned.replaceChildren(...warnings(view));
    warned.hidden = !warned.children.length;
    player.set(view, view.models.map((m) => m.look.color));
  }

  // The displacement to plot: the total one, if it is known and no other was chosen.
  function choose(answer) {
    const known = answer.models.every((m) => m.scaled.total_top_displacement);
    seen.hidden = !known;
    const key = known ? seen.querySelector("select").value : "top_displacement";
    for (const m of answer.models) m.scaled.displacement = m.scaled[key];
    const [, chart] = panels.find(([name]) => name === "displacement");
    chart.options.yLabel = DISPLACEMENTS.find(([name]) => name === key)[2];
  }

  // The charts follow the time of the animation.
  function follow(time) {
    const at = view.models.map((m) => {
      const [low, high, share] = bracket(m.t, time);
      return (key) => m.scaled[key][low] + share * (m.scaled[key][high] - m.scaled[key][low]);
    });
    for (const [, chart, parts] of panels)
      chart.setCursor(time, view.models.flatMap((m, i) => parts.filter(([part]) => m.scaled[part]).map(([part]) => (
        { x: time, y: at[i](part), color: m.look.color }))));
    loop.follow(time);
    elements.loop.follow(time);
    energy.chart.setCursor(time);
  }

  const load = latest(async () => {
    const started = performance.now();
    const before = verdict.textContent;
    const patience = setTimeout(() => (verdict.textContent = app.about.ready || view ? t("Computing …") : FIRST), PATIENCE);
    const requested = JSON.stringify([app.state.scale, app.state.models]);
    const answer = await app.ask("/api/response", element, { focus: energy.focus, element: elements.element });
    clearTimeout(patience);
    results.classList.toggle("stale", !answer);
    if (!answer) {
      verdict.textContent = before;
      return;
    }
    const all = looks(answer.models);
    answer.models.forEach((m, i) => {
      for (const name of [...OTHERS, ...SERIES]) m[name] = m[name] && decode(m[name]);
      const factor = (key) => PANELS.find(([name, , , , , parts = []]) => name === key || parts.some(([part]) => part === key))?.[2] ?? 1;
      m.scaled = Object.fromEntries(SERIES.map((key) => [key, m[key]?.map((v) => v * factor(key))]));
      m.look = all[i];
    });
    choose(answer);
    answer.end = Math.max(...answer.models.map((m) => m.t[m.t.length - 1]));
    view = answer;
    draw();
    element.dataset.redrawn = String(Math.round(performance.now() - started));
    element.dataset.shows = requested;
  });

  function refresh() {
    scale.setValue(app.state.scale);
    options.refresh();
    load();
  }
  globalThis.rockflexStage = {
    stage: player.stage,
    frame: (i, t, a) => player.stage.frameAt(i, t, a),
    view: () => view,
    move: (t) => player.move(t),
    time: () => player.time,
    playing: () => Boolean(player.playing),
    panel: panels[0][1],
    charts: Object.fromEntries(panels),
    loops: { base: loop, element: elements.loop },
  };
  return { element, refresh, leave: () => player.pause() };
}

// Intervals of time in which the base of a model is uplifted.
function uplifts(model) {
  const spans = [];
  let start = null;
  for (let i = 0; i < model.t.length; i++) {
    if (model.uplifted[i] !== 0 && start === null) start = model.t[i];
    if (model.uplifted[i] === 0 && start !== null) {
      spans.push([start, model.t[i]]);
      start = null;
    }
  }
  if (start !== null) spans.push([start, model.t[model.t.length - 1]]);
  return spans;
}

// Name, heading, factor, and whether it may be compared with a fixed base. A displacement relative to the base may not:
// it lacks the part due to the rotation.
const PEAKS = [
  ["max_rotation", "θ_max [mrad]", 1000, false],
  ["max_top_displacement", "u_top,max relative to the base [m]", 1, false],
  ["max_total_top_displacement", "u_top,max in total [m]", 1, true],
  ["max_base_moment", "M_b,max [kN m]", 1e-3, true],
  ["max_base_shear", "V_b,max [kN]", 1e-3, true],
  ["max_horizontal_reaction", "ΣF_x,max [kN]", 1e-3, true],
  ["min_vertical_reaction", "N_min [kN]", 1e-3, false],
];
const PEAKS_HELP = t("In total: relative to the ground, including the part due to the rotation. ΣF_x: horizontal ground reaction; " +
  "unlike V_b it includes the mass of the base and the damping. N_min: smallest vertical force between base and ground.");
const SLIPS = [["max_slip", "slip_max [mm]", 1000], ["residual_slip", "slip_end [mm]", 1000]];
const EDGE_PEAKS = [["max_edge_uplift", "Edge up [mm]", 1000], ["max_edge_settlement", "Edge down [mm]", 1000]];
const ON_SPRINGS = t("Edge up and down: how far an edge rises above the unloaded springs, and sinks below them.");
const LEFT = t("θ_res: rotation at the end of the run, from that at rest.");

// The fixed-base model to compare with, if any; preferably one that yields too if the model does.
function reference(view, model) {
  const fixed = view.models.filter((m) => !m.lifts);
  return fixed.find((m) => yields(m.label) === yields(model.label)) ?? fixed[0];
}

function named(fixed) {
  return fixed.label === "fixed" ? t("the same structure on a fixed base") : t("the fixed base of {model}", { model: fixed.label });
}

function table(view) {
  const held = view.elements.length > 0;
  const lifting = view.models.filter((m) => m.lifts);
  const standing = lifting.filter((m) => m.status !== "overturned");
  const fixed = [...new Set(standing.map((m) => reference(view, m)).filter(Boolean).map(named))];
  const base = [...(view.ground?.slides ? SLIPS : []), ...(view.ground?.springs.length ? EDGE_PEAKS : [])];
  const last = [...(held ? ["θ_res [mrad]"] : []), ...base.map(([, label]) => label)];
  const meant = [PEAKS_HELP, held ? LEFT : "", view.ground?.springs.length ? ON_SPRINGS : ""].filter(Boolean).join(" ");
  const head = ["Model", "Outcome", ...PEAKS.map(([, label]) => label), "Impacts", "θ_max/θ_nom", ...last];
  return [
    tableOf(head.map(symbol), view.models.map((m) => row(m, view, held, base))),
    h("p", { class: "hint" }, ...symbol(meant), fixed.length ? ` ${t("In brackets: relative to {references}.", { references: fixed.join("; ") })}` : ""),
  ];
}

function row(m, view, held, base) {
  const fell = m.status === "overturned";
  const fixed = reference(view, m);
  const share = (name) => (fixed && m.lifts && !fell && fixed.peaks[name] > 0
    ? ` (${number((100 * m.peaks[name]) / fixed.peaks[name], 3)} %)` : "");
  const outcome = fell ? `overturned at ${number(m.peaks.end_time)} s` : m.lifts ? m.status.replace("_", " ") : "fixed base";
  const cell = ([name, , factor, comparable]) => {
    const value = m.peaks[name];
    if (value === null || (name === "max_rotation" && fell)) return h("td", { "data-name": name }, "–");
    const text = number(value * factor) + (comparable ? share(name) : "");
    const title = `at ${number(m.peaks[`time_of_${name}`])} s`;
    return h("td", { "data-name": name, "data-value": value, title, class: value < 0 ? "overturned" : null }, text);
  };
  return h("tr", { "data-model": m.label },
    h("th", { scope: "row" }, m.label),
    h("td", { class: m.status, "data-name": "status" }, outcome),
    PEAKS.map(cell),
    h("td", { "data-name": "n_impacts", "data-value": m.peaks.n_impacts }, String(m.peaks.n_impacts)),
    h("td", {}, m.lifts && !fell ? `${number((100 * m.peaks.max_rotation) / view.nominal, 3)} %` : "–"),
    held ? residual(m) : null,
    base.map(([name, , factor]) => h("td", { "data-name": name, "data-value": m.peaks[name] }, number(m.peaks[name] * factor))));
}

// The rotation at the end of a run, which friction or a lack of weight can leave.
function residual(m) {
  const value = m.lifts ? m.peaks.residual_rotation : null;
  return h("td", { "data-name": "residual_rotation", "data-value": value }, number(value === null ? null : 1000 * value));
}

// Demands on the ground or tendons that they cannot meet, one paragraph each.
function warnings(view) {
  return view.models.flatMap((m) => m.warnings.map((text) => h("p", { "data-model": m.label }, `${m.label}: ${text}`)));
}

// A sentence or two on the first model, and whether others overturn.
function summary(view) {
  const [first] = view.models;
  const fixed = reference(view, first);
  const p = first.peaks;
  let text = `${first.label}: `;
  if (!first.lifts) {
    text += `on a fixed base the top moves by ${number(p.max_top_displacement, 3)} m and the base moment reaches `;
    text += `${number(p.max_base_moment / 1000, 3)} kN m.`;
  } else if (first.status === "overturned") {
    text += `the structure overturns; it lies on its side at ${number(p.end_time, 3)} s.`;
  } else if (first.status === "no_uplift") {
    text += view.ground?.springs.length
      ? `no edge of the base lifts; it turns by up to ${number(1000 * p.max_rotation, 3)} mrad on its springs.`
      : "the base stays on the ground; the structure responds as on a fixed base.";
  } else {
    const event = view.ground?.springs.length ? "landing" : "impact";
    const impacts = `${p.n_impacts} ${event}${p.n_impacts === 1 ? "" : "s"}`;
    text += `the base rocks with up to ${number(1000 * p.max_rotation, 3)} mrad `;
    text += `at ${number(p.time_of_max_rotation, 3)} s, with ${impacts}.`;
    if (p.nominal_overturning) text += " This exceeds the nominal limit 0.7 atan(B/h*₁), but it did not overturn.";
    if (p.max_total_top_displacement !== null) {
      text += ` The top moves by up to ${number(p.max_total_top_displacement, 3)} m relative to the ground`;
      text += fixed ? `, and ${number(fixed.peaks.max_total_top_displacement, 3)} m for ${named(fixed)}.` : ".";
    }
    if (p.max_slip > 0) text += ` The base slides by up to ${number(1000 * p.max_slip, 3)} mm.`;
    if (fixed && fixed.peaks.max_base_moment > 0) {
      const change = 100 * (p.max_base_moment / fixed.peaks.max_base_moment - 1);
      text += ` The base moment is ${number(Math.abs(change), 3)} % ${change < 0 ? "smaller" : "larger"} than for ${named(fixed)}.`;
    }
  }
  const fallen = view.models.filter((m) => m !== first && m.status === "overturned").map((m) => m.label);
  if (fallen.length) text += ` With ${fallen.join(" and ")} it overturns.`;
  return text;
}
