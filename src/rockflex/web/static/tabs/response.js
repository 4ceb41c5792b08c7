// Response: the structure rocks, in step with everything that is known of it.

import { bracket, Stage } from "../stage.js";
import { Chart, legend } from "../chart.js";
import { decode, h, latest, number, symbol } from "../dom.js";
import { models, select, slider } from "../form.js";

const LOOKS = [
  { color: "c0", dash: [] }, { color: "c1", dash: [7, 3] }, { color: "c2", dash: [2, 2] }, { color: "c3", dash: [7, 2, 2, 2] },
];
const FIXED = { color: "fixed", dash: [4, 3] };
const PANELS = [
  ["rotation", "θ [mrad]", 1000], ["top_displacement", "u_top [m]", 1], ["base_moment", "M_b [kN m]", 1e-3], ["base_shear", "V_b [kN]", 1e-3],
];
const PEAKS = [
  ["max_rotation", "θ_max [mrad]", 1000], ["max_top_displacement", "u_top,max [m]", 1], ["max_base_moment", "M_b,max [kN m]", 1e-3], ["max_base_shear", "V_b,max [kN]", 1e-3],
];
const ENERGY = ["kinetic", "strain", "gravity", "tendons", "damped", "lost"];
const ENERGY_NAMES = { kinetic: "motion", strain: "flexure", gravity: "raised weight", tendons: "tendons", damped: "damped", lost: "lost in impacts" };

export default function responseTab(app) {
  let view = null;
  let playing = null;
  let time = 0;
  let amplification = 1;
  let chosen = false; // whether somebody chose the amplification

  const foot = h("p", { class: "error foot", role: "alert" });
  const scale = slider("scale", "Scale factor on the record", { low: 0.01, high: 20, log: true }, app.state.scale, (value) => app.change({ scale: value }));
  const chips = models("models", app.state.models, app.about.limits.models, (value) => app.change({ models: value }));
  const free = slider("free_vibration", "Free vibration after the record", { low: 0, high: 60, step: 1, unit: "s" }, app.state.free_vibration, (value) => app.change({ free_vibration: value }));
  const impact = select("impact", "Impact", [["model", "as the model has it"], ["simplified", "simplified (Eq. 25)"], ["complete", "complete (Eq. 29)"]], app.state.impact, (value) => app.change({ impact: value }),
    { hint: "How much of its speed the structure keeps when the base strikes the ground" });
  const stage = new Stage();
  const play = h("button", { type: "button", class: "primary", id: "play", onclick: () => (playing ? pause() : start()) }, "Play");
  const scrub = h("input", { type: "range", id: "scrub", min: 0, max: 1, step: 0.001, value: 0, "aria-label": "Time", oninput: () => {
    pause();
    move(Number(scrub.value));
  } });
  const clock = h("output", { id: "clock", for: "scrub" }, "0.00 s");
  const speed = h("select", { id: "speed", "aria-label": "Speed" }, [["0.05", "1/20"], ["0.1", "1/10"], ["0.25", "1/4"], ["0.5", "1/2"], ["1", "real time"], ["2", "× 2"]].map(([v, t]) => h("option", { value: v }, t)));
  speed.value = "1";
  const amplify = slider("amplification", "Amplification of what is drawn", { low: 1, high: 200, log: true }, 1, (value) => {
    chosen = true;
    amplification = Number(value) > 0 ? Number(value) : 1;
    stage.show(time, amplification);
  });
  const jump = h("button", { type: "button", title: "Go to the largest rotation", onclick: () => {
    pause();
    move(view.models[0].peaks.time_of_max_rotation);
  } }, "Largest rotation");
  const group = [];
  const panels = PANELS.map(([key, yLabel], i) => {
    const chart = new Chart({ label: `${yLabel} over time`, yLabel, height: i ? 118 : 150, noXText: i < 3, xLabel: i === 3 ? "time [s]" : "", xName: "t [s]", group, symmetric: true, left: 74, onpick: (t) => {
      pause();
      move(t);
    } });
    group.push(chart);
    return [key, chart];
  });
  const loop = new Chart({ label: "Base moment over rotation", yLabel: "M_b [kN m]", xLabel: "θ [mrad]", height: 240, noReadout: true });
  const energy = new Chart({ label: "Energy over time", yLabel: "energy [kJ]", xLabel: "time [s]", height: 240, zero: true, noReadout: true });
  const keys = h("div", { id: "keys" });
  const energyKeys = h("div");
  let focus = "";
  const energyOf = h("select", { id: "energy-of", "aria-label": "Model whose energy is shown", onchange: () => {
    focus = energyOf.value;
    load();
  } });
  const energyTitle = h("h2", { class: "buttons" }, "Energy of", energyOf);
  const energyNote = h("p", { class: "hint" });
  const peaks = h("div", { class: "scroll", id: "peaks" });
  const verdict = h("p", { class: "answer", id: "verdict", role: "status" });
  const results = h("div", { class: "results" }, verdict, keys, panels.map(([, chart]) => chart.element),
    h("p", { class: "hint" }, "Shade: the base of the first model is off the ground. Triangles: its impacts. Click for the time, drag to zoom, double click to see all."),
    h("h2", {}, "Largest values"), peaks,
    h("div", { class: "pair" }, h("div", {}, h("h2", {}, "Moment and rotation"), loop.element), h("div", {}, energyTitle, energy.element, energyKeys, energyNote)));
  const element = h("div", { class: "columns" },
    h("form", { class: "side", onsubmit: (event) => event.preventDefault() },
      h("div", { class: "stage" }, stage.canvas,
        h("div", { class: "buttons" }, play, speed, jump, clock), scrub, amplify),
      h("fieldset", {}, h("legend", {}, "What to compare"), scale, chips, free, impact, foot)),
    results);
  results.append(app.downloads(element, [["figure", "Figure (SVG)"], ["energy", "Energy (SVG)"], ["peaks", "Peaks (CSV)"], ["histories", "Histories (CSV)"], ["study", "Study (TOML)"], ["python", "Python lines"], ["record", "Record (CSV)"]]));

  function look(i) {
    return view.models[i].lifts ? LOOKS[i] : FIXED;
  }

  // Let the largest movement fill a good part of the picture.
  function suit() {
    const top = view.heights[view.heights.length - 1];
    let largest = 1e-9;
    for (const model of view.models) {
      if (model.status === "overturned") return 1;
      largest = Math.max(largest, model.peaks.max_rotation * top + model.peaks.max_top_displacement);
    }
    return Math.min(200, Math.max(1, Number(((0.2 * top) / largest).toPrecision(2))));
  }

  function draw() {
    const first = view.models[0];
    const spans = uplifts(first);
    const falls = view.models.map((m) => m.fall_time).filter((t) => t !== null && t !== undefined);
    const until = falls.length ? Math.min(...falls) : Infinity;
    panels.forEach(([key, chart], p) => chart.set({
      series: view.models.map((m, i) => ({ x: m.t, y: m.scaled[key], label: m.label, ...look(i), width: i ? 1.2 : 1.6 })).reverse(),
      spans, xRange: [0, view.end], yUntil: until,
      ticks: p === 0 ? first.impact_times : [],
      vlines: falls.map((t, i) => ({ x: t, color: "error", label: p + i === 0 ? "does not come back" : "" })),
    }));
    loop.set({ series: view.models.filter((m) => m.lifts).map((m) => {
      const i = view.models.indexOf(m);
      const end = m.fall_time ? m.t.findIndex((t) => t >= m.fall_time) : m.t.length;
      return { x: m.scaled.rotation.subarray(0, end), y: m.scaled.base_moment.subarray(0, end), label: m.label, parametric: true, ...look(i), width: 1 };
    }).reverse() });
    energies();
    keys.replaceChildren(legend(view.models.map((m, i) => ({ label: m.label, ...look(i) }))));
    stage.set({ ...view, colors: view.models.map((_, i) => look(i).color) });
    table();
    verdict.replaceChildren(...words(view));
    scrub.max = view.end;
    scrub.step = Math.max(0.001, Number((view.end / 20000).toPrecision(1)));
  }

  function energies() {
    const e = view.energy;
    energyOf.replaceChildren(...view.models.map((m) => h("option", { value: m.label }, m.label)));
    energyOf.value = e.label;
    energyNote.textContent = e.note ?? "";
    if (e.note) {
      energy.set({ series: [] });
      energyKeys.replaceChildren();
      return;
    }
    const x = decode(e.t);
    let below = new Float32Array(x.length);
    const shown = ENERGY.filter((name) => e.values[name].some((v) => v !== 0));
    const series = shown.map((name) => {
      const high = below.map((v, i) => v + e.values[name][i] / 1000);
      const band = { kind: "band", x, low: below, high, color: name, alpha: 0.75, label: ENERGY_NAMES[name] };
      below = high;
      return band;
    });
    const input = { x, y: e.values.input.map((v) => v / 1000), color: "text", width: 1.2, label: "put in by the ground" };
    const falls = view.models.find((m) => m.label === e.label)?.fall_time ?? Infinity;
    energy.set({ series: [...series, input], xRange: [0, view.end], yUntil: falls, vlines: falls < Infinity ? [{ x: falls, color: "error", label: "does not come back" }] : [] });
    energyKeys.replaceChildren(legend([...series, input]));
  }

  function table() {
    const fixed = view.models.find((m) => !m.lifts);
    const share = (m, key) => (fixed && m.lifts && fixed.peaks[key] > 0 && m.status !== "overturned" ? ` (${number((100 * m.peaks[key]) / fixed.peaks[key], 3)} %)` : "");
    const rows = view.models.map((m) => h("tr", { "data-model": m.label },
      h("th", { scope: "row" }, m.label),
      h("td", { class: m.status, "data-name": "status" }, m.status === "overturned" ? `overturned at ${number(m.peaks.end_time)} s` : m.lifts ? m.status.replace("_", " ") : "fixed base"),
      PEAKS.map(([key, , factor], i) => h("td", { "data-name": key, "data-value": m.peaks[key], title: `at ${number(m.peaks[`time_of_${key}`])} s` },
        m.status === "overturned" && i === 0 ? "–" : number(m.peaks[key] * factor) + (i ? share(m, key) : ""))),
      h("td", { "data-name": "n_impacts", "data-value": m.peaks.n_impacts }, String(m.peaks.n_impacts)),
      h("td", {}, m.lifts && m.status !== "overturned" ? `${number((100 * m.peaks.max_rotation) / view.nominal, 3)} %` : "–"),
      view.tendons.length ? h("td", {}, number(m.peaks.max_tendon_force / 1000)) : null));
    peaks.replaceChildren(h("table", {},
      h("thead", {}, h("tr", {}, ["Model", "Outcome", ...PEAKS.map(([, label]) => label), "Impacts", "θ_max/θ_nom", ...(view.tendons.length ? ["Tendon [kN]"] : [])].map((t) => h("th", { scope: "col" }, symbol(t))))),
      h("tbody", {}, rows)),
    h("p", { class: "hint", hidden: !fixed }, "In brackets: as a share of the same structure on a fixed base."));
  }

  function move(t) {
    time = Math.min(Math.max(t, 0), view.end);
    scrub.value = time;
    clock.textContent = `${time.toFixed(2)} s`;
    stage.show(time, amplification);
    const points = (key, factor) => view.models.map((m, i) => {
      const [low, high, share] = bracket(m.t, time);
      const mix = (values) => values[low] + share * (values[high] - values[low]);
      return { x: factor ? time : mix(m.scaled.rotation), y: mix(m.scaled[key]), color: look(i).color, lifts: m.lifts };
    });
    for (const [key, chart] of panels) chart.setCursor(time, points(key, true));
    loop.setCursor(null, points("base_moment", false).filter((p) => p.lifts));
    energy.setCursor(time);
  }

  function start() {
    if (!view) return;
    if (time >= view.end) move(0);
    play.textContent = "Pause";
    let last = performance.now();
    const frame = (now) => {
      if (!playing) return;
      const step = Math.min(now - last, 100) / 1000;
      last = now;
      move(time + step * Number(speed.value));
      if (time >= view.end) pause();
      else playing = requestAnimationFrame(frame);
    };
    playing = requestAnimationFrame(frame);
  }

  function pause() {
    if (playing) cancelAnimationFrame(playing);
    playing = null;
    play.textContent = "Play";
  }

  const load = latest(async () => {
    const begun = performance.now();
    const answer = await app.ask("/api/response", element, { focus });
    results.classList.toggle("stale", !answer);
    if (!answer) return;
    for (const m of answer.models) {
      for (const name of ["t", "side", "points", ...PANELS.map(([key]) => key)]) m[name] = decode(m[name]);
      m.scaled = Object.fromEntries(PANELS.map(([key, , factor]) => [key, m[key].map((v) => v * factor)]));
    }
    if (!answer.energy.note) answer.energy.values = Object.fromEntries([...ENERGY, "input"].map((name) => [name, decode(answer.energy[name])]));
    answer.end = Math.max(...answer.models.map((m) => m.t[m.t.length - 1]));
    view = answer;
    if (!chosen) {
      amplification = suit();
      amplify.setValue(amplification);
    }
    draw();
    move(Math.min(time, view.end));
    element.dataset.redrawn = String(Math.round(performance.now() - begun));
    element.dataset.shows = JSON.stringify([app.state.scale, app.state.models]);
  });

  function refresh() {
    scale.setValue(app.state.scale);
    chips.setValue(app.state.models);
    free.setValue(app.state.free_vibration);
    impact.setValue(app.state.impact);
    load();
  }
  globalThis.rockflexStage = { stage, frame: (i, t, a) => stage.frameAt(i, t, a), view: () => view, move, time: () => time, playing: () => Boolean(playing) };
  return { element, refresh, leave: pause };
}

function uplifts(model) {
  const spans = [];
  let begun = null;
  for (let i = 0; i < model.t.length; i++) {
    if (model.side[i] !== 0 && begun === null) begun = model.t[i];
    if (model.side[i] === 0 && begun !== null) {
      spans.push([begun, model.t[i]]);
      begun = null;
    }
  }
  if (begun !== null) spans.push([begun, model.t[model.t.length - 1]]);
  return spans;
}

// What happened, in a sentence for each model.
function words(view) {
  const first = view.models[0];
  const fixed = view.models.find((m) => !m.lifts);
  const p = first.peaks;
  let text = `${first.label}: `;
  if (!first.lifts) text += `on a fixed base the top moves by ${number(p.max_top_displacement, 3)} m and the base moment reaches ${number(p.max_base_moment / 1000, 3)} kN m.`;
  else if (first.status === "overturned") text += `the structure overturns; it lies on its side at ${number(p.end_time, 3)} s.`;
  else if (first.status === "no_uplift") text += "the base stays on the ground; the structure answers as on a fixed base.";
  else {
    const s = p.n_impacts === 1 ? "" : "s";
    text += `the base lifts and rocks with up to ${number(1000 * p.max_rotation, 3)} mrad at ${number(p.time_of_max_rotation, 3)} s, with ${p.n_impacts} impact${s}.`;
    if (p.nominal_overturning) text += " That is past the nominal limit 0.7 atan(B/h*₁), though it did not fall.";
    if (fixed && fixed.peaks.max_base_moment > 0) {
      const change = 100 * (p.max_base_moment / fixed.peaks.max_base_moment - 1);
      text += ` Against a fixed base the base moment is ${number(Math.abs(change), 3)} % ${change < 0 ? "smaller" : "larger"}.`;
    }
  }
  const fallen = view.models.filter((m) => m !== first && m.status === "overturned").map((m) => m.label);
  if (fallen.length) text += ` With ${fallen.join(" and ")} it overturns.`;
  return [document.createTextNode(text)];
}
