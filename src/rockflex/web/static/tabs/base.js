// The base of a structure: the elements between it and the ground, and the ground itself.

import { grounded, isRigid, yields } from "../choices.js";
import { clone, h } from "../dom.js";
import { nameOf } from "../drawing.js";
import { folded, select, tableField, trouble } from "../form.js";
import { t } from "../texts.js";

const PLACES = ["position", "between", "height", "cosine"];

// A new element, derived from the weight W = m g and the half width b of the structure. The first of its kind that is not
// in the middle is followed by its twin on the other side. What yields does so at W/8, as a pair that resists with a
// quarter of the moment W b of the weight (λ = 4), after 2 mm; a tendon pulls with W/5, and gains as much while the base
// turns by 1/50; a damper has a force of W/20, at 0.1 m/s if it is viscous; a gap is of 5 mm. Of strands, bars
// and plates there are as many as that force needs.
function fresh(kind, list, view) {
  const { mass, half_width: b, eccentricity: e } = view ?? { ...USUAL, eccentricity: 0 };
  const weight = 9.81 * mass;
  const alike = list.filter((each) => each.kind === kind && !each.between && !each.height);
  const twin = alike.find((each) => each.position && !alike.some((other) => other.position === -each.position));
  if (twin) return { ...clone(twin), position: -twin.position };
  const share = (part) => round(weight * part);
  let part = 0.85; // further in than those of other kinds
  while (part > 0.3 && list.some((each) => Math.abs(Math.abs(each.position) - part * (b - Math.abs(e))) < 0.05 * b)) part -= 0.15;
  const edge = round(part * (b - Math.abs(e)));
  const pieces = (force, each) => Math.min(Math.max(Math.round(force / each), 1), 100); // of catalogues
  const bar = { position: edge, stiffness: share(1 / 8 / 0.002), yield_force: share(1 / 8) };
  const values = {
    tendon: { position: 0, initial_force: share(1 / 5), stiffness: share(1 / 5 / (b / 50)) },
    yielding_dissipator: bar,
    viscous_damper: { position: edge, coefficient: share(1 / 20 / 0.1) },
    friction_damper: { position: edge, force: share(1 / 20) },
    flag_shaped_bar: { ...bar, post_yield_ratio: 0.05, flag_depth: 0.8 },
    gap_bar: { position: edge, stiffness: bar.stiffness, gap: 0.005 },
    multilinear_bar: { position: edge, elongations: [0.005, 0.02], forces: [share(1 / 8), share(1 / 4)] },
    strand_tendon: { position: 0, n: pieces(share(1 / 5), 140e3), strand: "Y1860S7-15.7", length: 15, prestress: 0.5 },
    bar_fuse: { position: edge, n: pieces(share(1 / 8), 157e3), diameter: 0.02, length: 0.5, steel: "B500B" },
    u_plate_fuse: { position: edge, n: pieces(share(1 / 8), 17.75e3), width: 0.1, thickness: 0.01, diameter: 0.1,
      steel: "S355" },
  };
  return { kind, ...values[kind] };
}

let latest = h("div"); // the rows of the latest form, of which another one in other units opens the same

// `current` returns a copy of the structure, `put` takes the changed one; `shown` returns its view, if there is one.
export function elements({ about }, current, put, shown) {
  const titles = Object.entries(about.elements).map(([name, { title }]) => [name, t(title)]);
  const most = about.limits.elements;
  const before = latest;
  const rows = latest = h("div");
  const kind = h("select", { id: "new-element", "aria-label": t("Element to add") },
    titles.map(([name, title]) => h("option", { value: name }, title)));
  const add = h("button", { type: "button", onclick: () => {
    change((list) => [...list, fresh(kind.value, list, shown())]);
    const last = rows.lastElementChild;
    last.open = true;
    last.querySelector("select").focus();
  } }, t("Add an element"));
  const element = folded("devices", t("Devices at the base"), h("div", { "data-path": "structure.elements" },
    h("p", { class: "hint" }, t("Between the base and the ground, at the given distance from the axis of the masses. A new one suits the weight.")),
    rows, h("div", { class: "buttons" }, add, kind), trouble()));

  // Change the list and draw it again.
  function change(next) {
    const structure = current();
    const list = next(structure.elements ?? []);
    if (list.length) structure.elements = list;
    else delete structure.elements;
    draw(list);
    put(structure);
  }

  function draw(list) {
    const open = [...(rows.firstChild ? rows : before).children].map((row) => row.open);
    rows.replaceChildren(...list.map((each, i) => row(each, i, open[i] ?? list.length < 2)));
    add.disabled = list.length >= most;
    element.querySelector("summary").textContent = list.length ? t("Devices at the base ({n})", { n: list.length }) : t("Devices at the base");
  }

  function row(each, i, open) {
    const path = `structure.elements.${i}`;
    const summary = h("summary", {}, nameOf(about, each, i));
    const other = select(`${path}.kind`, t("Element"), titles, each.kind, (name) => {
      change((list) => list.with(i, turned(list[i], name)));
      rows.children[i].querySelector("select").focus();
    });
    const all = about.elements[each.kind].fields.map((spec) => [spec.required || each[spec.name] !== undefined, tableField(`${path}.${spec.name}`, spec, each[spec.name], (value) => {
      const structure = current();
      if (value === undefined) delete structure.elements[i][spec.name];
      else structure.elements[i][spec.name] = value;
      summary.textContent = nameOf(about, structure.elements[i], i);
      put(structure);
    })]);
    const fields = all.filter(([wanted]) => wanted).map(([, each]) => each);
    const left = all.filter(([wanted]) => !wanted).map(([, each]) => each);
    if (left.length) fields.push(folded("optional-device", t("Optional fields"), left));
    const remove = h("button", { type: "button", onclick: () => {
      rows.children[i].remove(); // so that the others stay open or closed
      change((list) => list.filter((_, j) => j !== i));
      add.focus();
    } }, t("Remove"));
    return h("details", { open, "data-path": path }, summary, other, fields, remove, trouble());
  }

  // An element of another kind, with the values that both have; forces of fuses and dampers do not suit a tendon.
  function turned(each, name) {
    const tendon = [each.kind, name].includes("tendon");
    const kept = about.elements[name].fields.map((spec) => spec.name).filter((key) => key in each && (!tendon || PLACES.includes(key)));
    return { ...fresh(name, [], shown()), ...Object.fromEntries(kept.map((key) => [key, each[key]])) };
  }

  element.draw = draw;
  return element;
}

const KINDS = [
  ["", t("rigid")], ["springs", t("springs")], ["winkler", t("bed, by subgrade modulus")],
  ["asce41", t("bed of ASCE 41, by shear modulus")], ["gazetas", t("bed of Gazetas, by shear modulus")],
];
const WITHOUT = {
  winkler: ["shear_modulus", "poisson_ratio", "method", "density"], gazetas: ["subgrade_modulus", "end_ratio", "damping", "method"],
  asce41: ["subgrade_modulus", "end_zone", "end_ratio", "method", "density"],
};
const [FRICTION, DAMPING, SETTLEMENT, GRAVITY] = [0.5, 0.3, 0.005, 9.81]; // of new springs, and m and m/s²
const USUAL = { mass: 2e5, half_width: 1 }; // kg and m of a structure that cannot be built yet
const round = (value) => Number(value.toPrecision(2));

// `shown` returns the view of the present structure, or a promise of it: its weight and width are those of new springs.
export function ground(app, shown) {
  const { about } = app;
  const specs = Object.fromEntries(about.ground.map((spec) => [spec.name, spec]));
  const kind = select("ground.kind", t("Ground"), KINDS, "", choose);
  const tick = h("input", { type: "checkbox", id: "slides", onchange: () => {
    const { friction: _, ...rest } = app.state.ground ?? {};
    put(tick.checked ? { ...rest, friction: FRICTION } : rest);
  } });
  const [fields, friction] = [h("div"), h("div")];
  const element = folded("ground", t("Ground"), h("div", { "data-path": "ground" }, kind, fields,
    h("label", { class: "check" }, tick, t("The base can slide (Coulomb friction)")), friction,
    h("p", { class: "hint" }, t("On springs no impact law acts. Models on a fixed base are left out, there and if the base can slide.")),
    trouble()));

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
    // Over half of the length the coefficient is 6.83/(1 − ν), over the rest 0.73/(1 − ν); 2.27/(1 − ν) for a square of Gazetas.
    const [own, factor] = name === "gazetas" ? [{ method: name }, 2.27] : [{}, 2.8];
    return { ...mat, bed: { ...bed, ...own, shear_modulus: round((stiffness * 0.65) / (2 * b * factor)), poisson_ratio: 0.35 } };
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
    const [, title] = KINDS.find(([name]) => name === kindOf(given));
    element.querySelector("summary").textContent = given?.friction === undefined ? t("Ground: {kind}", { kind: title })
      : t("Ground: {kind}, can slide", { kind: title });
    if (key !== drawn) form();
    drawn = key;
    fields.querySelector('[data-path="ground.springs.positions"]')?.setValue(given.springs.positions); // springs can be dragged
  };
  return element;
}

function kindOf(given) {
  if (given?.springs) return "springs";
  if (!given?.bed) return "";
  if (given.bed.method) return given.bed.method;
  return given.bed.shear_modulus !== undefined || given.bed.poisson_ratio !== undefined ? "asce41" : "winkler";
}

// The models of a state that can stand on springs or slide, or others in their place.
export function without(state) {
  const usual = isRigid(state.structure) ? ["rigid"] : ["MDOF-S", "2DOF-S"];
  const left = (labels) => {
    const found = labels.filter(grounded);
    return found.length ? found : [...usual];
  };
  const [models, cloud, design] = [left(state.models), left(state.cloud.models), left([state.design.model])];
  const found = { models, cloud: { models: cloud }, design: { model: design[0] } };
  return [...models, ...cloud, ...design].some(yields) ? found : { ...found, bouc_wen: undefined };
}
