// Response: the rocking structure, animated with its response histories.

import { bracket } from "../axes.js";
import { overTime } from "../chart.js";
import { decode, h, latest } from "../dom.js";
import { select, slider } from "../form.js";
import { looks } from "../looks.js";
import { making } from "../making.js";
import { legend } from "../marks.js";
import { models } from "../models.js";
import { assumptions } from "../response/assumptions.js";
import { Elements } from "../response/elements.js";
import { Energy } from "../response/energy.js";
import { Loop } from "../response/loop.js";
import { Player } from "../response/player.js";
import { table, warnings, words } from "../response/table.js";

const EDGES = [["left_edge", ", left"], ["right_edge", ", right"]];
// Name, axis, factor, title, height, and the curves of each model where there are several.
const PANELS = [
  ["rotation", "θ [mrad]", 1000, "Rotation", 150],
  ["slip", "slip [mm]", 1000, "Slip of the base", 118],
  ["edges", "edges [mm]", 1000, "Rise of the edges", 118, EDGES],
  ["displacement", "", 1, "Displacement of the top", 118],
  ["element", "F [kN]", 1e-3, "Force of an element", 118, [["element_force", ""]]],
  ["base_moment", "M_b [kN m]", 1e-3, "Base moment", 118],
  ["base_shear", "V_b [kN]", 1e-3, "Base shear", 134],
];
const DISPLACEMENTS = [
  ["total_top_displacement", "relative to the ground", "u_top total [m]"],
  ["top_displacement", "relative to the rotating base", "u_top relative [m]"],
];
const SERIES = ["rotation", ...DISPLACEMENTS.map(([key]) => key), "base_moment", "base_shear", "slip", "left_edge", "right_edge", "element_force"];
const OTHERS = ["t", "uplifted", "points", "element_elongation", "heave"];
const FILES = [
  ["report", "Report (HTML)"], ["figure", "Figure (SVG)"], ["energy", "Energy (SVG)"],
  ["peaks", "Peaks (CSV)"], ["histories", "Histories (CSV)"],
  ["study", "Study (TOML)"], ["python", "Python lines"], ["record", "Record (CSV)"],
];

const PATIENCE = 1500; // ms before the page says that it is computing
const FIRST = "Computing … The first run after an installation compiles the kernels, which takes some fifteen seconds.";

export default function responseTab(app) {
  let view = null;
  const player = new Player(follow, app.about.elements);
  const scale = slider("scale", "Scale factor", { low: 0.01, high: 20, log: true }, app.state.scale,
    (value) => app.change({ scale: value }));
  const labels = models("models", app.state.models, app.about.limits.models, (value) => app.change({ models: value }));
  const free = slider("free_vibration", "Free vibration after the record", { low: 0, high: 60, step: 1, unit: "s" },
    app.state.free_vibration, (value) => app.change({ free_vibration: value }));
  const assumed = assumptions(app, () => view?.suggested_yield);
  const onpick = (time) => player.go(time);
  const charts = overTime(PANELS.map(([, yLabel, , name, height, parts]) => (
    { label: `${name} over time`, yLabel, height, firstOnTop: true, onpick, symmetric: !parts })));
  const panels = PANELS.map(([key, , , , , parts = [[key, ""]]], i) => [key, charts[i], parts]);
  const loop = new Loop({ label: "Base moment over rotation", yLabel: "M_b [kN m]", xLabel: "θ [mrad]" });
  const energy = new Energy(() => load());
  const elements = new Elements(app.about, () => {
    energy.focus = elements.model.value;
    load();
  });
  const seen = select("displacement", "Plotted top displacement", DISPLACEMENTS, DISPLACEMENTS[0][0], () => {
    if (!view) return;
    choose(view);
    draw();
  });
  const keys = h("div", { id: "keys" });
  const peaks = h("div", { class: "scroll", id: "peaks" });
  const verdict = h("p", { class: "answer", id: "verdict", role: "status" });
  const warned = h("div", { class: "warning", id: "warnings", role: "alert", hidden: true });
  const results = h("div", { class: "results" }, verdict, warned, keys, seen, charts.map((chart) => chart.element),
    h("p", { class: "hint" }, "Shaded: the base of the first model is uplifted. Triangles: its impacts. ",
      h("span", { class: "screen" }, "Point at one of these charts to read all of them. Click or use the arrow keys to set the time; ",
        "drag or press + and − to zoom; double-click or press Escape to reset.")),
    h("h2", {}, "Largest values"), peaks, elements.table,
    h("div", { class: "pair" }, h("div", {}, h("h2", {}, "Moment and rotation"), loop.chart.element), elements.chart,
      energy.element));
  const element = h("div", { class: "columns" },
    h("form", { class: "side", onsubmit: (event) => event.preventDefault() },
      player.element,
      h("fieldset", {}, h("legend", {}, "Runs"), scale, labels, free, h("p", { class: "error foot", role: "alert" })),
      h("fieldset", {}, h("legend", {}, "Assumptions"), assumed.element)),
    results);
  const moving = making(app, element, "animation", "Animation (GIF)");
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
      const series = view.models.flatMap((m, i) => parts.filter(([part]) => m.scaled[part]).map(([part, suffix], k) => ({
        x: m.t, y: m.scaled[part], until: m.fall_time ?? Infinity, label: m.label + suffix, ...m.look,
        width: i ? 1.2 : 1.6, alpha: k ? 0.55 : 1,
      })));
      chart.element.hidden = !series.length;
      chart.set({
        series, spans, xRange: [0, view.end],
        ticks: p === 0 ? first.impact_times : [],
        vlines: falls.map((t, i) => ({ x: t, color: "error", label: p + i === 0 ? "falls" : "" })),
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
    verdict.textContent = words(view);
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
    const patience = setTimeout(() => (verdict.textContent = app.about.ready || view ? "Computing …" : FIRST), PATIENCE);
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
    labels.setValue(app.state.models, app.state.bouc_wen !== undefined);
    free.setValue(app.state.free_vibration);
    assumed.refresh();
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
