// The peaks of every model, and a summary in words.

import { h, number, symbol, tableOf } from "../dom.js";
import { yields } from "../models.js";

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
const MEANT = "In total: relative to the ground, including the part due to the rotation. ΣF_x: horizontal ground reaction; "
  + "unlike V_b it includes the mass of the base and the damping. N_min: smallest vertical force between base and ground.";
const SLIPS = [["max_slip", "slip_max [mm]", 1000], ["residual_slip", "slip_end [mm]", 1000]];
const EDGES = [["max_edge_uplift", "Edge up [mm]", 1000], ["max_edge_settlement", "Edge down [mm]", 1000]];
const ON_SPRINGS = " Edge up and down: how far an edge rises above the unloaded springs, and sinks below them.";
const LEFT = " θ_res: rotation at the end of the run, from that at rest.";

// The fixed-base model to compare with, if any; preferably one that yields too if the model does.
function reference(view, model) {
  const fixed = view.models.filter((m) => !m.lifts);
  return fixed.find((m) => yields(m.label) === yields(model.label)) ?? fixed[0];
}

function named(fixed) {
  return fixed.label === "fixed" ? "the same structure on a fixed base" : `the fixed base of ${fixed.label}`;
}

export function table(view) {
  const held = view.elements.length > 0;
  const lifting = view.models.filter((m) => m.lifts);
  const standing = lifting.filter((m) => m.status !== "overturned");
  const fixed = [...new Set(standing.map((m) => reference(view, m)).filter(Boolean).map(named))];
  const base = [...(view.ground?.slides ? SLIPS : []), ...(view.ground?.springs.length ? EDGES : [])];
  const last = [...(held ? ["θ_res [mrad]"] : []), ...base.map(([, label]) => label)];
  const meant = MEANT + (held ? LEFT : "") + (view.ground?.springs.length ? ON_SPRINGS : "");
  const head = ["Model", "Outcome", ...PEAKS.map(([, label]) => label), "Impacts", "θ_max/θ_nom", ...last];
  return [
    tableOf(head.map(symbol), view.models.map((m) => row(m, view, held, base))),
    h("p", { class: "hint" }, ...symbol(meant), fixed.length ? ` In brackets: relative to ${fixed.join(" and to ")}.` : ""),
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
export function warnings(view) {
  return view.models.flatMap((m) => m.warnings.map((text) => h("p", { "data-model": m.label }, `${m.label}: ${text}`)));
}

// A sentence or two on the first model, and whether others overturn.
export function words(view) {
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
