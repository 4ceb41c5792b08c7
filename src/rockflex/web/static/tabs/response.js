// Response: the rocking structure, animated with its response histories, its peaks and its assumptions.

import { alternatives } from "../alternatives.js";
import { bracket } from "../axes.js";
import { overTime, withTime } from "../chart.js";
import { checksTable, limitsForm, seeCheck } from "../checks.js";
import { yields } from "../choices.js";
import { decode, h, latest, number, scrolled, symbol, tableOf } from "../dom.js";
import { select, slider } from "../form.js";
import { downloads, reports } from "../jobs.js";
import { legend, looks } from "../marks.js";
import { project } from "../project.js";
import { OF_STANDING, recordSet } from "../set.js";
import { Player } from "../stage.js";
import { language, t } from "../texts.js";
import { explainedOutputs, headed, inUnit, outputIn, outputInUnit, outputUnit, outputsOf, titled, valueIn } from "../units.js";
import { Elements, Energy, Loop } from "./energy.js";
import { runs } from "./runs.js";
import { tornado } from "./tornado.js";

const JOINTS = [1, 2, 3].map((k) => [`joint_${k}`, `{model} ${k}`]);
const EDGES = [["left_edge", t("{model}, left")], ["right_edge", t("{model}, right")]];
// Name, output, title, height, and the curves of each model where there are several.
const PANELS = [
  ["rotation", "rotation", t("Rotation"), 150],
  ["joints", "joint_rotation", t("Rotation of joints above the base"), 118, JOINTS],
  ["slip", "slip", t("Slip of the base"), 118],
  ["edges", "edge_uplift", t("Rise of the edges"), 118, EDGES],
  ["displacement", "total_top_displacement", t("Displacement of the top"), 118],
  ["element", "element_force", t("Force of an element"), 118, [["element_force", "{model}"]]],
  ["base_moment", "base_moment", t("Base moment"), 118],
  ["base_shear", "base_shear", t("Base shear"), 118],
];
const DISPLACEMENTS = [
  ["total_top_displacement", t("relative to the ground")],
  ["top_displacement", t("relative to the rotating base")],
];
const SERIES = ["rotation", ...DISPLACEMENTS.map(([key]) => key), "base_moment", "base_shear", "slip", "left_edge", "right_edge", "element_force", ...JOINTS.map(([key]) => key)];
const FORCES = ["base_moment", "base_shear"]; // which a rigid block has not
const OTHERS = ["t", "uplifted", "points", "element_elongation", "heave"];
const FILES = [
  ["figure", t("Figure (SVG)")], ["animation", t("Animation (GIF)")], ["histories", t("Histories (CSV)")],
  ["python", t("Python lines")], ["case", t("Case (TOML)")], ["record", t("Record (CSV)")],
];

const PATIENCE = 1500; // ms before the page says that it is computing

export default function responseTab(app) {
  let view = null;
  let ghosts = []; // the responses of kept alternatives
  const player = new Player(follow, app.about);
  const scale = slider("scale", t("Scale factor"), { low: 0.01, high: 20, log: true }, app.state.scale,
    (value) => app.change({ scale: value }));
  const options = runs(app, () => view?.suggested_yield);
  const onpick = (time) => player.go(time);
  const charts = overTime(PANELS.map(([, output, name, height, parts]) => (
    { label: t("{quantity} over time", { quantity: name }), yLabel: headed(output), height, firstOnTop: true, onpick, symmetric: !parts })));
  const panels = PANELS.map(([key, , , , parts = [[key, "{model}"]]], i) => [key, charts[i], parts]);
  const loop = new Loop({ label: t("Base moment over rotation"), yLabel: headed("base_moment"), xLabel: headed("rotation") });
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
  const [floors, checks] = [h("section"), h("div")];
  const warned = h("div", { class: "warning", id: "warnings", role: "alert", hidden: true });
  const kept = alternatives(app, (found) => {
    ghosts = found.map(({ models: [m] }) => m);
    ghosts.forEach(inUnits);
    Object.assign(player.stage, { ghosts: found }).draw();
    if (!view) return;
    choose(view);
    draw();
  });
  const saved = project(app);
  const matters = tornado(app);
  const results = h("div", { class: "results" }, verdict, warned, keys, seen, charts.map((chart) => chart.element),
    h("p", { class: "hint" }, t("Shaded: the base of the first model is uplifted. Triangles: its impacts."), " ",
      h("span", { class: "screen" }, t("Point at one of these charts to read all of them. Click or use the arrow keys to set the time; " +
        "drag or press + and − to zoom; double-click or press Escape to reset."))),
    h("h2", {}, t("Largest values")), peaks, floors, elements.table, checks,
    h("div", { class: "pair" }, h("div", {}, h("h2", {}, t("Moment and rotation")), loop.chart.element), elements.chart,
      energy.element));
  const records = select("records", t("Records"), [["", t("One record")], ["set", t("A set of records as one result")]], "",
    (value) => app.change({ record_set: { shown: value === "set" } }));
  const form = h("div");
  let set = null; // the set of records, once it is looked at
  const element = h("div", { class: "columns" },
    h("form", { class: "side", onsubmit: (event) => event.preventDefault() },
      records, player.element, form,
      h("fieldset", {}, h("legend", {}, t("Runs")), scale, options.element, h("p", { class: "error foot", role: "alert" })),
      limitsForm(app), saved.element),
    results);
  const files = downloads(app, [...reports(app, "report", t("Report (HTML)"), t("Report (PDF)")), ...FILES]);
  results.append(matters.element, files);

  function draw() {
    const [first] = view.models;
    const falls = view.models.map((m) => m.fall_time ?? Infinity).filter(Number.isFinite);
    const spans = uplifts(first);
    // Of the element whose loop is drawn, with its number in the form.
    if (view.held) charts[panels.findIndex(([name]) => name === "element")].options.yLabel = titled(`F_${view.element + 1} [{unit}]`, "force");
    const drawn = panels.map(([key, chart, parts]) => {
      const series = [...view.models, ...ghosts].flatMap((m, i) => parts.filter(([part]) => m.scaled[part]).map(([part, name], k) => ({
        x: m.t, y: m.scaled[part], until: m.fall_time ?? Infinity, label: name.replace("{model}", m.label), ...m.look,
        width: i ? 1.2 : 1.6, alpha: k ? 0.55 : 1,
      })));
      chart.element.hidden = !series.length || (FORCES.includes(key) && !series.some(({ y }) => y.some(Boolean)));
      return series;
    });
    withTime(charts);
    charts.forEach((chart, p) => chart.set({
      series: drawn[p], spans, xRange: [0, view.end],
      ticks: p === 0 ? first.impact_times : [],
      vlines: falls.map((x, i) => ({ x, color: "error", label: p + i === 0 ? t("falls") : "" })),
    }));
    const lifting = [...view.models, ...ghosts].filter((m) => m.lifts);
    loop.set(lifting.map((m) => (
      { t: m.t, x: m.scaled.rotation, y: m.scaled.base_moment, until: m.fall_time ?? Infinity, label: m.label, look: m.look })));
    loop.chart.element.parentElement.hidden = charts[panels.findIndex(([name]) => name === "base_moment")].element.hidden || !lifting.length;
    elements.set(view);
    energy.set(view);
    keys.replaceChildren(legend([...view.models, ...ghosts].map((m) => ({ label: m.label, ...m.look }))));
    peaks.replaceChildren(...table(view));
    checks.replaceChildren(checksTable(view.checks, first.label));
    if (app.seen) seeCheck(checks, app.seen);
    app.seen = "";
    floors.replaceChildren(...(view.floors.length > 1 ? byFloor(view.floors, first.label) : []));
    verdict.textContent = summary(view);
    warned.replaceChildren(...warnings(view));
    warned.hidden = !warned.children.length;
    player.set(view, view.models.map((m) => m.look.color));
  }

  // The displacement to plot: the total one, if it is known and no other was chosen.
  function choose(answer) {
    const known = answer.models.every((m) => m.scaled.total_top_displacement);
    seen.hidden = !known || !answer.models.some((m) => m.top_displacement.some(Boolean));
    const key = known ? seen.querySelector("select").value : "top_displacement";
    for (const m of [...answer.models, ...ghosts]) m.scaled.displacement = m.scaled[key];
    const [, chart] = panels.find(([name]) => name === "displacement");
    chart.options.yLabel = headed(key);
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
    const patience = setTimeout(() => (verdict.textContent = t("Computing …")), PATIENCE);
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
      inUnits(m);
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
    const { shown } = app.state.record_set;
    records.setValue(shown ? "set" : "");
    if (shown && !set) {
      set = recordSet(app, kept.set);
      form.append(set.form);
      element.append(set.results);
      set.beside.append(kept.element);
    }
    for (const each of [player.element, scale, results]) each.hidden = shown;
    for (const each of set ? [form, set.results] : []) each.hidden = !shown;
    saved.refresh();
    kept.refresh();
    if (shown) {
      set.beside.append(matters.element);
      player.pause();
      set.refresh();
    } else {
      files.before(matters.element);
      load();
    }
    matters.refresh();
  }
  function close(runs) {
    set?.close(runs);
    matters.close(runs);
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
  return { element, refresh, leave: () => player.pause(), close };
}

// The curves of a model in the units of their charts.
function inUnits(m) {
  const output = (key) => PANELS.find(([name, , , , parts = []]) => name === key || parts.some(([part]) => part === key))?.[1] ?? key;
  m.scaled = Object.fromEntries(SERIES.map((key) => [key, m[key]?.map((v) => v / outputUnit(output(key)).size)]));
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

// The peaks of every model, and those that may be compared with a fixed base. A displacement relative to the base may not: it
// lacks the part due to the rotation.
const PEAKS = ["max_rotation", "max_top_displacement", "max_total_top_displacement", "max_base_moment", "max_base_shear",
  "max_horizontal_reaction", "min_vertical_reaction"];
const COMPARED = ["max_total_top_displacement", "max_base_moment", "max_base_shear", "max_horizontal_reaction"];
const RESIDUAL = "residual_rotation";
const STATUS = { no_uplift: t("no uplift"), rocking: t("rocking") };

const FLOORS = [
  ["height", t("Height [{unit}]"), "length"], ["story_drift", t("Drift [{unit}]"), "displacement"],
  ["drift_ratio", t("Drift over story height [{unit}]"), "share"], ["story_shear", t("Shear [{unit}]"), "force"],
  ["floor_acceleration", t("Acceleration [{unit}]"), "acceleration"], ["total_floor_displacement", t("Displacement [{unit}]"), "displacement"],
];

const YIELDING = [["ductility", t("Ductility"), "ratio"], ["residual_drift", t("Residual drift [{unit}]"), "displacement"]];

// The story that yields most, in words; nothing where none does.
function yielding(floors) {
  const most = floors.reduce((best, each, i) => ((each.ductility ?? 0) > (best.ductility ?? 1) ? { ...each, story: floors.length - i } : best), {});
  return most.story ? [t("Story {story} yields most: ductility {ductility}, residual drift {drift}.", { story: most.story, ductility: number(most.ductility, 3), drift: inUnit(most.residual_drift, "displacement", 3) })] : [];
}

function byFloor(floors, model) {
  const columns = [...FLOORS, ...YIELDING].filter(([name]) => floors[0][name] !== undefined);
  if (floors[0].story_drift === undefined)
    return [h("h2", {}, t("Over the height of {model}", { model })), scrolled(t("Largest values over the height"), { id: "floors" }, tableOf(columns.map(([, text, quantity]) => titled(text, quantity)),
      floors.map((each) => h("tr", {}, columns.map(([name, , quantity]) => h("td", { "data-name": name, "data-value": each[name] }, valueIn(each[name], quantity)))))))];
  return [h("h2", {}, t("Stories of {model}", { model })), scrolled(t("Largest values by story"), { id: "floors" },
    tableOf([t("Story"), ...columns.map(([, text, quantity]) => titled(text, quantity))], floors.map((each, i) => h("tr", { class: each.ductility > 1 ? "yields" : null },
      h("th", { scope: "row" }, String(floors.length - i)),
      columns.map(([name, , quantity]) => h("td", { "data-name": name, "data-value": each[name] }, valueIn(each[name], quantity))))))),
  h("p", { class: "hint" }, t("Height and acceleration: of the floor above the story. Drift: of that floor over the one below, without the rotation of the base. Displacement: relative to the ground, rotation included."))];
}

// The fixed-base model to compare with, if any; preferably one that yields too if the model does.
function reference(view, model) {
  const fixed = view.models.filter((m) => !m.lifts);
  return fixed.find((m) => yields(m.label) === yields(model.label)) ?? fixed[0];
}

function named(fixed) {
  return fixed.label === "fixed" ? t("the same structure on a fixed base") : t("the fixed base of {model}", { model: fixed.label });
}

const listed = (words) => new Intl.ListFormat(language).format(words);

function table(view) {
  const held = view.elements.length > 0;
  const shown = PEAKS.filter((name) => name === "max_rotation" || view.models.some((m) => m.peaks[name]));
  const lifting = view.models.filter((m) => m.lifts);
  const standing = lifting.filter((m) => m.status !== "overturned");
  const fixed = [...new Set(standing.map((m) => reference(view, m)).filter(Boolean).map(named))];
  const last = [...(held ? [RESIDUAL] : []), ...(view.ground?.slides ? outputsOf("sliding") : []),
    ...(view.ground?.springs.length ? outputsOf("springs") : [])];
  const meant = [`${explainedOutputs([...shown, ...last])}.`,
    ...(fixed.length ? [t("In brackets: relative to {reference}.", { reference: listed(fixed) })] : [])];
  const head = [t("Model"), t("Outcome"), ...shown.map(headed), t("Impacts"), "θ_max/θ_nom", ...last.map(headed)];
  return [
    tableOf(head.map(symbol), view.models.map((m) => row(m, view, shown, last))),
    h("p", { class: "hint" }, symbol(meant.join(" "))),
  ];
}

function row(m, view, shown, last) {
  const fell = m.status === "overturned";
  const fixed = reference(view, m);
  const share = (name) => (fixed && m.lifts && !fell && fixed.peaks[name] > 0
    ? ` (${inUnit(m.peaks[name] / fixed.peaks[name], "share", 3)})` : "");
  const outcome = fell ? t("overturned at {time}", { time: inUnit(m.peaks.end_time, "time") }) : m.lifts ? STATUS[m.status] : t("fixed base");
  const cell = (name) => {
    const value = m.peaks[name];
    if (value === null || (fell && OF_STANDING.includes(name))) return h("td", { "data-name": name }, "–");
    const text = outputIn(name, value) + (COMPARED.includes(name) ? share(name) : "");
    const title = t("at {time}", { time: inUnit(m.peaks[`time_of_${name}`], "time") });
    return h("td", { "data-name": name, "data-value": value, title, class: value < 0 ? "overturned" : null }, text);
  };
  // What friction or a lack of weight can leave; a fixed base has no rotation.
  const final = (name) => {
    const value = name === RESIDUAL && (!m.lifts || fell) ? null : m.peaks[name];
    return h("td", { "data-name": name, "data-value": value }, outputIn(name, value));
  };
  return h("tr", { "data-model": m.label },
    h("th", { scope: "row" }, m.label),
    h("td", { class: m.status, "data-name": "status" }, outcome),
    shown.map(cell),
    h("td", { "data-name": "n_impacts", "data-value": m.peaks.n_impacts }, String(m.peaks.n_impacts)),
    h("td", {}, m.lifts && !fell ? inUnit(m.peaks.max_rotation / view.nominal, "share", 3) : "–"),
    last.map(final));
}

// Demands on the ground or tendons that they cannot meet, one paragraph each.
function warnings(view) {
  return view.models.flatMap((m) => m.warnings.map((text) => h("p", { "data-model": m.label }, `${m.label}: ${text}`)));
}

// A few sentences on the first model, and whether others overturn.
function summary(view) {
  const [first] = view.models;
  const fixed = reference(view, first);
  const [p, model, springs] = [first.peaks, first.label, view.ground?.springs.length > 0];
  const said = [];
  const time = (value) => inUnit(value, "time", 3);
  const shown = (name, of = p) => outputInUnit(name, of[name], 3);
  const rotation = shown("max_rotation");
  if (!first.lifts) {
    said.push(t("{model}: on a fixed base the top moves by {top} and the base moment reaches {moment}.",
      { model, top: shown("max_top_displacement"), moment: shown("max_base_moment") }));
  } else if (first.status === "overturned") {
    said.push(t("{model}: the structure overturns; it lies on its side at {time}.", { model, time: time(p.end_time) }));
  } else if (first.status === "no_uplift") {
    said.push(springs ? t("{model}: no edge of the base lifts; it turns by up to {rotation} on its springs.", { model, rotation })
      : t("{model}: the base stays on the ground; the structure responds as on a fixed base.", { model }));
  } else {
    const values = { model, rotation, time: time(p.time_of_max_rotation), count: p.n_impacts };
    const [one, several] = springs
      ? [t("{model}: the base rocks with up to {rotation} at {time}, with 1 landing.", values),
        t("{model}: the base rocks with up to {rotation} at {time}, with {count} landings.", values)]
      : [t("{model}: the base rocks with up to {rotation} at {time}, with 1 impact.", values),
        t("{model}: the base rocks with up to {rotation} at {time}, with {count} impacts.", values)];
    said.push(p.n_impacts === 1 ? one : several);
    if (p.nominal_overturning) said.push(t("This exceeds the nominal limit 0.7 atan(B/h*₁), but it did not overturn."));
    const top = shown("max_total_top_displacement");
    if (p.max_total_top_displacement !== null) {
      said.push(fixed ? t("The top moves by up to {top} relative to the ground, and {other} for {reference}.",
        { top, other: shown("max_total_top_displacement", fixed.peaks), reference: named(fixed) })
        : t("The top moves by up to {top} relative to the ground.", { top }));
    }
    if (p.max_slip > 0) said.push(t("The base slides by up to {slip}.", { slip: shown("max_slip") }));
    if (fixed && fixed.peaks.max_base_moment > 0) {
      const change = p.max_base_moment / fixed.peaks.max_base_moment - 1;
      const values = { share: inUnit(Math.abs(change), "share", 3), reference: named(fixed) };
      said.push(change < 0 ? t("The base moment is {share} smaller than for {reference}.", values)
        : t("The base moment is {share} larger than for {reference}.", values));
    }
  }
  const fallen = view.models.filter((m) => m !== first && m.status === "overturned").map((m) => m.label);
  said.push(...yielding(view.floors));
  if (fallen.length) said.push(t("With {models} it overturns.", { models: listed(fallen) }));
  return said.join(" ");
}
