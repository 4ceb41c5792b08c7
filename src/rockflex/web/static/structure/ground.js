// The form of the ground: rigid or springs under the base, and whether the base can slide.

import { h } from "../dom.js";
import { select, tableField, trouble } from "../form.js";
import { grounded } from "../models.js";

const KINDS = [
  ["", "rigid"], ["springs", "springs"], ["winkler", "bed, by subgrade modulus"],
  ["asce41", "bed of ASCE 41, by shear modulus"],
];
const WITHOUT = { winkler: ["shear_modulus", "poisson_ratio"], asce41: ["subgrade_modulus", "end_zone", "end_ratio"] };
const [FRICTION, DAMPING, SETTLEMENT, GRAVITY] = [0.5, 0.3, 0.005, 9.81]; // of new springs, and m and m/s²
const USUAL = { mass: 2e5, half_width: 1 }; // kg and m of a structure that cannot be built yet
const round = (value) => Number(value.toPrecision(2));

// `shown` returns the view of the present structure, or a promise of it: its weight and width are those of new springs.
export function ground(app, shown) {
  const { about } = app;
  const specs = Object.fromEntries(about.ground.map((spec) => [spec.name, spec]));
  const kind = select("ground.kind", "Ground", KINDS, "", choose);
  const tick = h("input", { type: "checkbox", id: "slides", onchange: () => {
    const { friction: _, ...rest } = app.state.ground ?? {};
    put(tick.checked ? { ...rest, friction: FRICTION } : rest);
  } });
  const [fields, friction] = [h("div"), h("div")];
  const element = h("fieldset", { "data-path": "ground" }, h("legend", {}, "Ground"), kind, fields,
    h("label", { class: "check" }, tick, "The base can slide (Coulomb friction)"), friction,
    h("p", { class: "hint" }, "On springs no impact law acts, and only simplified elastic models that lift can be used; likewise if the base can slide."),
    trouble());

  let chosen = ""; // a later choice replaces one that still waits for the structure
  async function choose(name) {
    chosen = name;
    const { state } = app;
    const view = name ? shown() : null;
    const known = view instanceof Promise ? await view : view;
    if (chosen === name && app.state === state) put({ ...kept(), ...made(name, known) });
  }

  function kept() {
    const { friction: mu } = app.state.ground ?? {};
    return mu === undefined ? {} : { friction: mu };
  }

  // Springs that settle a little under the weight, and a rigid mat of a tenth of the mass.
  function made(name, view) {
    if (!name) return {};
    const { mass, half_width: b } = view ?? USUAL;
    const stiffness = (mass * GRAVITY) / SETTLEMENT;
    const mat = { mat_mass: round(0.1 * mass) };
    if (name === "springs") return { ...mat, springs: { stiffness: round(stiffness / 2), heave_damping_ratio: DAMPING } };
    const bed = { breadth: round(2 * b), heave_damping_ratio: DAMPING };
    if (name === "winkler") return { ...mat, bed: { ...bed, subgrade_modulus: round(stiffness / (2 * b * bed.breadth)) } };
    // Over half of the length the coefficient is 6.83/(1 − ν), over the rest 0.73/(1 − ν).
    return { ...mat, bed: { ...bed, shear_modulus: round((stiffness * 0.65) / (2 * b * 2.8)), poisson_ratio: 0.35 } };
  }

  // Replace the ground, and leave what cannot be used on it.
  function put(next) {
    const { state } = app;
    const before = state.ground;
    if (before) delete state.ground;
    const given = Object.keys(next).length ? next : undefined;
    const patch = { ground: given };
    if (given && !before) Object.assign(patch, without(state));
    if (given?.springs || given?.bed) Object.assign(patch, { impact: undefined, restitution: undefined });
    app.change(patch);
  }

  function entry(path, spec, values, change) {
    return tableField(`${path}.${spec.name}`, spec, values[spec.name], change);
  }

  function form() {
    const given = app.state.ground;
    const now = kindOf(given);
    kind.setValue(now);
    tick.checked = given?.friction !== undefined;
    friction.replaceChildren(...(tick.checked ? [own("friction")] : []));
    const inner = now === "springs" ? "springs" : "bed";
    fields.replaceChildren(...(now ? [
      ...specs[inner].fields.filter((spec) => !WITHOUT[now]?.includes(spec.name)).map((spec) => entry(`ground.${inner}`, spec,
        given[inner], (value) => app.change({ ground: { [inner]: { [spec.name]: value } } }))),
      own("mat_mass"), own("base_inertia"),
    ] : []));
  }

  function own(name) {
    return entry("ground", specs[name], app.state.ground, (value) => app.change({ ground: { [name]: value } }));
  }

  // The fields are drawn anew only where others are needed, so that the present one keeps the focus.
  let drawn = null;
  element.refresh = () => {
    const { ground: given } = app.state;
    const key = JSON.stringify([kindOf(given), given?.friction !== undefined]);
    if (key === drawn) return;
    drawn = key;
    form();
  };
  return element;
}

function kindOf(given) {
  if (given?.springs) return "springs";
  if (!given?.bed) return "";
  return given.bed.shear_modulus !== undefined || given.bed.poisson_ratio !== undefined ? "asce41" : "winkler";
}

// The models of a state that can stand on springs or slide, or others in their place; no hysteresis.
export function without(state) {
  const usual = "block" in state.structure ? ["rigid"] : ["MDOF-S", "2DOF-S"];
  const left = (labels) => {
    const found = labels.filter(grounded);
    return found.length ? found : [...usual];
  };
  return {
    models: left(state.models), cloud: { models: left(state.cloud.models) }, design: { model: left([state.design.model])[0] },
    bouc_wen: undefined,
  };
}
