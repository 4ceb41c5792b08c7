// Structure: a drawing that moves and is a form, the whole form folded by task, modes, and how many of them are needed.

import { alternatives } from "../alternatives.js";
import { attempt, send } from "../api.js";
import { CHOSEN, isRigid } from "../choices.js";
import { clone, h, ink, latest, number, scrolled, svg, symbol, tableOf, tooLarge } from "../dom.js";
import { drawing, kindOf } from "../drawn.js";
import { field, fileBox, folded, select, tableField, tableGroup, trouble } from "../form.js";
import { downloads, reports } from "../jobs.js";
import { project } from "../project.js";
import { site } from "../site.js";
import { t } from "../texts.js";
import { fromSI, titled, unit, unitFor, valueIn } from "../units.js";
import { elements, ground, without } from "./base.js";

// Default values of a form where no preset has the kind.
const DEFAULTS = {
  fish_bone: {
    story_heights: [4, 3, 3], masses: 4e4, column_stiffness: 2e8, beam_stiffness: "inf",
    base_mass: 4e4, half_width: 1, damping_ratio: 0.02,
  },
  beam: {
    height: 20, mass: 5000, bending_stiffness: 2e10, half_width: 1.5, damping_ratio: 0.02, base_mass: 5e4,
  },
  matrices: {
    mass: [4e4, 4e4], stiffness: [[2e7, -1e7], [-1e7, 1e7]], heights: [3, 6],
    base_mass: 4e4, half_width: 0.8, damping_ratio: 0.02,
  },
  modes: {
    omega: [9.771976, 25.583366], shapes: [[0.6180339887, -1.6180339887], [1, 1]], mass: [4e4, 4e4], heights: [3, 6],
    base_mass: 4e4, half_width: 0.8, damping_ratio: 0.02,
  },
  properties: {
    omega: [6.2832], effective_mass: [175906], effective_height: [10.54], top_ordinate: [1.2517],
    i_theta: 20066620, l0r: 1800000, m_tot: 240000, half_width: 1.054, zeta: 0.02,
  },
  block: { width: 0.6, height: 2, mass: 250 },
  rocking_frame: { n_columns: 4, column_width: 1.6, column_height: 9.6, column_mass: 6e4, cap_mass: 2.4e5 },
};

// Tables nested in that of a structure, by name.
const INNER = {
  lumped_masses: (beam) => ({ heights: [beam.height], masses: [1e4] }),
};
const narrow = matchMedia("(max-width: 900px)");
const FLOORLESS = ["properties", "block", "rocking_frame"]; // kinds whose floors are not known: no mass leans on them, and no story yields
const YIELD = 0.3; // share of the weight that new stories bear before they yield

export default function structureTab(app) {
  const { kinds, whole, presets, limits } = app.about;
  const current = () => clone(app.state.structure);
  let cuts = 0; // changes of the cross-section; a later one replaces one that waits
  const known = {}; // what the last section of each kind gave
  let drawn = false; // whether the form has the fields of the present structure

  function put(structure, redraw = false) {
    if (redraw) {
      drawn = false;
      cuts++;
    }
    const rigid = isRigid(structure);
    app.change({ structure, ...(rigid === isRigid(app.state.structure) ? {} : modelsFor(rigid)) });
  }

  function modelsFor(rigid) {
    const { models, cloud, design } = app.about.state;
    if (rigid) return { models: ["rigid"], cloud: { models: ["rigid"], limit: "overturning" }, design: { model: "rigid" } };
    const usual = { models, cloud: { models: cloud.models, limit: cloud.limit }, design: { model: design.model } };
    return app.state.ground ? without({ structure: {}, ...usual }) : usual;
  }

  const listed = [["", t("custom structure")], ...presets.map((p, i) => [String(i), t(p.title)])];
  const preset = select("preset", t("Start from"), listed, "", (i) => i !== "" && put(clone(presets[Number(i)].structure), true));
  const titles = Object.entries(kinds).map(([name, { title }]) => [name, t(title)]);
  const kind = select("kind", t("Kind"), titles, "frame", (name) => put(fresh(name), true));
  const name = h("input", { type: "text", maxlength: 80, onchange: () => put({ ...current(), name: name.value }) });
  const fields = h("div");
  let view = null;
  let viewed = ""; // the structure of the view
  const held = elements(app, current, put, () => view);
  const below = ground(app, viewNow);
  const shown = drawing(app, () => {
    drawn = false;
    app.change({});
  });
  const own = site(app, ({ structure, target }) => {
    app.begin = "record_set";
    drawn = false;
    const none = { ground: undefined, bouc_wen: undefined, impact: undefined, restitution: undefined };
    app.change({ structure, ...modelsFor(isRigid(structure)), ...none, target, tab: "response", scale: 1,
      record_set: { shown: true, suites: [CHOSEN], scale: 1, rule: "ec8" } });
    app.go("response");
  });
  const kept = alternatives(app, (ghosts) => Object.assign(shown.player.stage, { ghosts }).draw(), true);
  const saved = project(app);
  const facts = h("div");
  const more = folded("modes", t("Modes, masses, and which model to use"), facts);
  const results = h("div", { class: "results" }, kept.element, more, app.next("response", t("Next: see forces and energies over time.")),
    app.next("response", t("Or design for a set of records, with checks and a report."), { record_set: { shown: true } }, t("Set of records")));
  const matrices = importMatrices(limits.file, current, (structure) => put(structure, true));
  const side = h("form", { class: "side", onsubmit: (event) => event.preventDefault() },
    own.element, h("fieldset", {}, h("legend", {}, t("This structure")), preset, shown.quick.element, h("p", { class: "error foot", role: "alert" })),
    folded("structure", t("Structure: all fields"), kind, matrices, field("structure.name", t("Name"), name),
      h("div", { "data-path": "structure" }, fields, trouble())),
    held, below, saved.element);
  const element = h("div", { class: "columns first" }, side, shown.player.element, results);
  // In the order in which the eye reads: a narrow window has the drawing above the form.
  const order = () => element.prepend(...(narrow.matches ? [shown.player.element, side] : [side, shown.player.element]));
  narrow.addEventListener("change", order);
  order();

  // The first preset of a kind, or default values.
  function fresh(wanted) {
    const found = presets.find((p) => p.structure[wanted]);
    return found ? clone(found.structure) : { name: "", [wanted]: clone(DEFAULTS[wanted] ?? {}) };
  }

  function form() {
    const { structure } = app.state;
    const now = kindOf(structure, kinds);
    kind.setValue(now);
    matrices.hidden = now !== "matrices";
    if (document.activeElement !== name) name.value = structure.name ?? "";
    const match = presets.findIndex((p) => same(p.structure, structure));
    preset.setValue(match < 0 ? "" : String(match));
    if (drawn) return;
    drawn = true;
    const values = structure[now];
    const given = (spec) => !(values.section && SET_BY_SECTION.includes(spec.name) && values[spec.name] === undefined);
    const focused = fields.contains(document.activeElement) && document.activeElement.closest("[data-path]").dataset.path;
    const specs = kinds[now].fields.filter(given);
    const own = whole.filter((spec) => !spec.floors || !FLOORLESS.includes(now));
    const wanted = (spec, table) => spec.required || table[spec.name] !== undefined || ["section", ...SET_BY_SECTION].includes(spec.name);
    const left = [...specs.filter((spec) => !wanted(spec, values)).map((spec) => entry(now, spec, values)),
      ...own.filter((spec) => !wanted(spec, structure)).map(ofWhole)];
    fields.replaceChildren(...specs.filter((spec) => wanted(spec, values)).map((spec) => entry(now, spec, values)),
      ...own.filter((spec) => wanted(spec, structure)).map(ofWhole), left.length ? folded("optional", t("Optional fields"), left) : "");
    if (focused) fields.querySelector(`[data-path="${CSS.escape(focused)}"]`)?.querySelector("input, select, button")?.focus();
    held.draw(structure.elements ?? []);
  }

  // A field of every kind of structure.
  function ofWhole(spec) {
    const change = (value) => {
      const next = current();
      set(next, spec.name, value);
      put(next);
    };
    const [path, value] = [`structure.${spec.name}`, app.state.structure[spec.name]];
    const strength = () => Number((YIELD * 9.81 * (view?.mass ?? 1e5)).toPrecision(2));
    const starts = {
      stories: () => ({ strengths: strength(), post_yield_ratio: 0.05 }),
      podium: () => ({ n_columns: 4, column_width: 0.8, column_height: 5, column_mass: 8e3 }),
      joints: () => ({ heights: [Number((0.5 * (view?.heights.at(-1) ?? 10)).toPrecision(2))], half_widths: view?.half_width ?? 1 }),
    };
    const start = starts[spec.name] ?? (() => ({}));
    return spec.type === "table" ? tableGroup(path, spec, value, start, change) : tableField(path, spec, value, change);
  }

  function entry(now, spec, values) {
    const path = `structure.${now}.${spec.name}`;
    const change = (value) => {
      const next = current();
      set(next[now], spec.name, value);
      put(next);
    };
    if (spec.name === "section") {
      return section(app.about, path, spec, () => app.state.structure[now].section, (value, anew) => cut(now, value, anew));
    }
    if (spec.type !== "table") return tableField(path, spec, values[spec.name], change);
    const start = () => INNER[spec.name]?.(app.state.structure[now]) ?? {};
    return tableGroup(path, spec, values[spec.name], start, change);
  }

  // Give a structure another section; without one it has the stiffness and mass of the last.
  async function cut(now, value, anew) {
    const mine = ++cuts;
    if (!value) await viewNow();
    if (mine !== cuts) return;
    const next = current();
    if (!next[now]) return;
    const facts = known[now] ?? [];
    const fact = (symbol, usual) => Number((facts.find((each) => each.symbol === symbol)?.value ?? usual).toPrecision(6));
    set(next[now], "section", value);
    if (value) for (const name of SET_BY_SECTION) delete next[now][name];
    else Object.assign(next[now], { bending_stiffness: fact("EI", 2e10), [now === "beam" ? "mass" : "mass_per_length"]: fact("m", 5000) });
    put(next, anew);
  }

  results.append(downloads(app, reports(app, "report", t("Report (HTML)"), t("Report (PDF)"))));
  let answered = ""; // the state whose answer is shown
  const inUse = () => JSON.stringify({ ...app.state, tab: "" });
  let quick = false; // whether the drawing alone is needed
  const load = latest(async () => {
    const fast = quick;
    const asked = app.state.structure;
    const key = inUse();
    if (!fast) results.classList.toggle("stale", key !== answered);
    const answer = await app.ask("/api/structure", element, fast ? { quick: true } : {});
    shown.stale(!answer);
    if (!answer) return shown.quick.refresh();
    shown.set({ ...answer, ...answer.run }, asked);
    if (fast) return;
    results.classList.remove("stale");
    answered = key;
    view = answer;
    viewed = JSON.stringify(asked);
    if (answer.section.length) known[answer.kind] = answer.section;
    facts.replaceChildren(...show());
  });

  // The view of the present structure: at once if it is there, else a promise of it; null if it cannot be built.
  function viewNow() {
    const now = () => (viewed === JSON.stringify(app.state.structure) ? view : null);
    return now() ?? load().then(now);
  }

  function show() {
    return [
      h("h2", {}, view.name || t(kinds[view.kind].title)),
      view.adequacy ? h("p", { class: "answer", id: "adequacy" }, view.adequacy.reason) : "",
      view.adequacy ? h("p", { class: "hint" }, t("This check uses masses and frequencies only. Impacts also excite higher modes, " +
        "which affect the base shear most: compare with MDOF-S on the Response tab.")) : "",
      view.warnings.length
        ? h("div", { class: "warning", id: "warnings", role: "alert" }, view.warnings.map((text) => h("p", {}, text))) : "",
      view.freedoms ? h("p", { class: "hint", id: "freedoms" }, view.freedoms) : "",
      view.kind === "block" ? "" : pictures(view),
      h("dl", { class: "values" }, view.properties.map(parameter)),
      view.section.length ? h("h2", {}, t("Cross-section")) : "",
      view.section.length ? h("dl", { class: "values", id: "section" }, view.section.map(parameter)) : "",
      view.ground?.facts.length ? h("h2", {}, t("Springs under the base")) : "",
      view.ground?.facts.length ? h("dl", { class: "values", id: "springs" }, view.ground.facts.map(parameter)) : "",
      table(view),
    ];
  }

  function refresh(live = false) {
    quick = live;
    if (!live) {
      results.classList.toggle("stale", inUse() !== answered);
      form();
      below.refresh();
      kept.refresh();
      saved.refresh();
      own.refresh();
      shown.quick.refresh();
    }
    shown.resume();
    load();
  }
  return { element, refresh, leave: () => shown.leave(), drop: ([file]) => saved.take(file) };
}

// How the parameters follow from masses m at heights h, the half width B, and forces F₀ of tendons at r from the pivot.
const FORMULAS = {
  "m_tot": "m_tot = Σ m", "L₀ʳ": "L₀ʳ = Σ m h", "I_θ": "I_θ = Σ m (h² + B²)", "M_r": "M_r = m_tot g B + Σ F₀ r", "a_lift": "a_lift = M_r / L₀ʳ",
  "α": "M(α) = 0; α = M_r / (g L₀ʳ)", "θ_nom": t("θ_nom = 0.7 atan(B / h*₁)"), "λ": "λ = (m_tot g B + Σ F₀ r) / Σ F_y r", "η": "η = θ'⁺ / θ'⁻",
  "A": "A = ∫ dA", "I": "I = ∫ z² dA", "EI": "EI = k E I", "m": "m = ρ A", "w": "w = m_tot g / Σ k", "Σk": "Σ k", "Σkx²": "Σ k x²",
};

const EDGES = { 1: t("to the right: {fact}"), "-1": t("to the left: {fact}") };

function parameter(p) {
  const own = p.quantity ? unit(p.quantity) : unitFor(p.unit);
  const value = p.none ? t("none: {reason}", { reason: t(p.none) }) : number(fromSI(p.value, own));
  return h("div", { title: FORMULAS[p.symbol] }, h("dt", {}, symbol(p.symbol), own.name ? ` [${own.name}]` : ""),
    h("dd", { "data-value": p.value }, value), h("dd", { class: "hint" }, p.edge ? EDGES[p.edge].replace("{fact}", t(p.help)) : t(p.help, p)));
}

function set(target, key, value) {
  if (value === undefined) delete target[key];
  else target[key] = value;
}

function same(a, b) {
  return JSON.stringify(tidy(a)) === JSON.stringify(tidy(b));
}

// The same content in the same order, without empty lists.
function tidy(value) {
  if (Array.isArray(value)) return value.map(tidy);
  if (value === null || typeof value !== "object") return value;
  const entries = Object.entries(value).filter(([, each]) => !Array.isArray(each) || each.length);
  return Object.fromEntries(entries.sort().map(([key, each]) => [key, tidy(each)]));
}

const PARTS = ["mass", "stiffness", "heights", "rotations"];
const REST = { base_mass: 0, half_width: 1, damping_ratio: 0.02 };

// Matrices from a file of a finite element program: `structure` returns the present structure, `put` takes the new one.
function importMatrices(limit, structure, put) {
  const part = h("select", { id: "part" }, PARTS.map((name) => h("option", { value: name }, name)));
  const input = fileBox(".npz,.csv", take, { "aria-label": t("File of matrices") });
  const said = trouble();

  async function take(file) {
    said.textContent = tooLarge(file, limit);
    if (said.textContent) return;
    await attempt(async () => {
      const found = await send(`/api/matrices?name=${encodeURIComponent(file.name)}&part=${part.value}`, file);
      const now = structure();
      const name = now.matrices ? now.name : file.name.replace(/\.\w+$/, "");
      const kept = { ...(now.matrices ?? REST) };
      if (found.stiffness && /\.npz$/i.test(file.name)) for (const each of PARTS) delete kept[each]; // of another structure
      put({ name, matrices: { ...kept, ...found } });
    }, (error) => {
      said.textContent = Object.values(error.errors).join(" ");
    });
  }

  return h("fieldset", { "data-path": "import" }, h("legend", {}, t("Import matrices")),
    h("p", { class: "help" }, t("From any finite element program: a .npz file with the arrays mass, stiffness, heights and, if there" +
      " are any, rotations, or one CSV file for each. Units: kg, N/m, m, rad; fixed base.")),
    h("p", { class: "hint" }, t("heights: one for each degree of freedom, nan for those that do not move sideways; or rows of an" +
      " index and a height. rotations: the indices of the rotations in the plane, counted from 0; they need no height. Degrees" +
      " of freedom without mass are condensed out.")),
    h("div", { class: "buttons" }, h("label", { for: "part" }, t("CSV contains")), part), input, said);
}

const SHAPES = [
  ["", t("none: EI and mass are given")], ["rectangle", t("rectangle")], ["box", t("hollow box")], ["circle", t("circle")],
  ["tube", t("hollow circle")], ["composite", t("composite of several parts")],
];
// New sizes in m by shape.
const SIZES = {
  rectangle: { width: 1, depth: 1.5 }, box: { width: 2, depth: 2, wall: 0.25 }, circle: { diameter: 1.5 }, tube: { diameter: 1.5, wall: 0.2 },
};
const OF_MATERIAL = ["elastic_modulus", "density"];
const MOST = 20; // parts

const SET_BY_SECTION = ["bending_stiffness", "mass", "mass_per_length"]; // what a section gives

// `current` returns the present section; `change(section, anew)` takes another one, or undefined for none; `anew` if other
// fields are needed then.
function section(about, path, spec, current, change) {
  const drawn = current();
  const shape = drawn?.shape ?? "";
  const partSpecs = about.section_part;
  const materials = about.materials.map(({ title, ...values }) => [t(title), values]);
  const [CONCRETE, STEEL] = materials.map(([, values]) => values);
  const choose = select(`${path}.shape`, t("Cross-section"), SHAPES, shape, (name) => change(turned(name), true),
    { hint: t("in place of bending stiffness and mass") });

  // The same material in another shape.
  function turned(name) {
    if (!name) return undefined;
    if (name === "composite") {
      const core = { shape: "circle", diameter: 0.96, ...CONCRETE, offset: 0 };
      return { shape: name, parts: [{ shape: "tube", diameter: 1, wall: 0.02, ...STEEL, offset: 0 }, core] };
    }
    const value = current();
    const now = value?.shape === "composite" ? value.parts[0] : value;
    const kept = Object.fromEntries(OF_MATERIAL.map((key) => [key, now?.[key] ?? CONCRETE[key]]));
    const factor = value?.stiffness_factor === undefined ? {} : { stiffness_factor: value.stiffness_factor };
    return { shape: name, ...SIZES[name], ...kept, ...factor };
  }

  // `get` returns the present table of the field.
  const field = (place, specs, name, get, put) => {
    const found = specs.find((each) => each.name === name);
    const needed = name !== "stiffness_factor" && name !== "offset";
    const { shape: of, [name]: value } = get();
    return tableField(`${place}.${name}`, { ...found, required: needed }, value, (next) => {
      const table = get();
      if (table?.shape === of) put(with_(table, name, next)); // a field that is removed reports a change begun in it
    });
  };

  // A list that fills in the material.
  function material(get, put) {
    const same = materials.find(([, values]) => OF_MATERIAL.every((key) => values[key] === get()[key]));
    const names = [...materials.map(([name]) => [name, name]), ["", t("own values")]];
    return select("section.material", t("Material"), names, same?.[0] ?? "", (name) => {
      const found = materials.find(([each]) => each === name);
      if (found) put({ ...get(), ...found[1] }, true);
    });
  }

  const fieldsOf = (place, specs, get, more, put) => [
    ...Object.keys(SIZES[get().shape] ?? {}).map((name) => field(place, specs, name, get, put)),
    material(get, put),
    ...[...OF_MATERIAL, ...more].map((name) => field(place, specs, name, get, put)),
  ];

  function part(each, i) {
    const place = `${path}.parts.${i}`;
    const get = () => current()?.parts?.[i];
    const parts = (next, anew) => change({ ...current(), parts: next }, anew);
    const put = (next, anew) => parts(current().parts.with(i, next), anew);
    const own = select(`${place}.shape`, t("Shape"), SHAPES.slice(1, -1), each.shape, (name) => {
      const { elastic_modulus, density, offset } = get();
      put({ shape: name, ...SIZES[name], elastic_modulus, density, offset }, true);
    });
    const remove = h("button", { type: "button", onclick: () => (
      parts(current().parts.filter((_, j) => j !== i), true)) }, t("Remove"));
    return h("fieldset", { class: "group", "data-path": place }, h("legend", {}, t("Part {number}", { number: i + 1 })), own,
      fieldsOf(place, partSpecs, get, ["offset"], put), drawn.parts.length > 1 ? remove : null, trouble());
  }

  const inner = [];
  if (shape === "composite") {
    const add = h("button", { type: "button", disabled: drawn.parts.length >= MOST, onclick: () => {
      const { parts } = current();
      change({ ...current(), parts: [...parts, { ...parts.at(-1) }] }, true);
    } }, t("Add a part"));
    inner.push(...drawn.parts.map(part), add, field(path, spec.fields, "stiffness_factor", current, change));
  } else if (shape) inner.push(...fieldsOf(path, spec.fields, current, ["stiffness_factor"], change));
  return h("div", { class: "section", "data-path": path }, choose, inner, trouble());
}

function with_(table, name, next) {
  const { [name]: _, ...rest } = table;
  return next === undefined ? rest : { ...rest, [name]: next };
}

const [WIDTH, HEIGHT] = [110, 240];
const SWAY = 38; // px
const ROWS = 12;

// The structure and its first modes, each drawn with its contribution to a unit displacement.
function pictures(view) {
  const shapes = view.shapes.length ? view.shapes : [view.heights.map(() => 0)];
  return h("div", { class: "modes" }, shapes.map((shape, n) => picture(view, shape, n)),
    view.shapes_known ? null
      : h("p", { class: "hint" }, t("The mode shapes are not known and drawn as straight lines.")));
}

function picture(view, shape, n) {
  const mode = view.modes[n];
  const top = view.heights[view.heights.length - 1];
  const tall = HEIGHT - 62;
  const largest = Math.max(...shape.map(Math.abs)) || 1;
  const x = (u) => WIDTH / 2 + (u / largest) * SWAY;
  const y = (z) => HEIGHT - 40 - (z / top) * tall;
  const b = Math.min(30, Math.max(6, (view.half_width / top) * tall));
  const middle = x(0) - (view.eccentricity / view.half_width) * b;
  const points = view.heights.map((z, i) => `${x(shape[i]).toFixed(1)},${y(z).toFixed(1)}`).join(" ");
  const floors = view.heights.length < 26 ? view.heights.slice(1) : [];
  const texts = mode ? [t("Mode {number}", { number: n + 1 }), `T = ${number(mode.period, 3)} s`] : [];
  const name = mode ? t("Mode {number}, period {period} s", { number: n + 1, period: number(mode.period) }) : t("Outline of the rigid block");
  return svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, width: WIDTH, height: HEIGHT, role: "img", "aria-label": name },
    svg("line", { x1: x(0), x2: x(0), y1: y(0), y2: y(top), stroke: ink("control"), "stroke-dasharray": "4 3" }),
    svg("line", { x1: middle - b, x2: middle + b, y1: y(0), y2: y(0), stroke: ink("structure"), "stroke-width": 4 }),
    svg("polyline", { points, fill: "none", stroke: ink("c0"), "stroke-width": 2 }),
    ...floors.map((z, i) => svg("circle", { cx: x(shape[i + 1]), cy: y(z), r: 2.6, fill: ink("c0") })),
    ...texts.map((text, line) => svg("text", {
      x: WIDTH / 2, y: HEIGHT - 20 + 14 * line, "text-anchor": "middle", "font-size": 12, fill: ink("text"),
    }, text)));
}

function table(view) {
  if (!view.modes.length)
    return h("p", { class: "help" }, t("A rigid block has no modes. Use the model “rigid”."));
  const uplifted = view.modes[0].uplifted.length > 1 ? [
    t("Period while uplifted, right edge [s]"), t("Damping while uplifted, right edge"),
    t("Period while uplifted, left edge [s]"), t("Damping while uplifted, left edge"),
  ] : [t("Period while uplifted [s]"), t("Damping while uplifted")];
  const head = [t("Mode"), t("Period T [s]"), titled(t("Mass m* [{unit}]"), "mass"), t("Share of total mass"),
    titled(t("Height h* [{unit}]"), "length"), t("Damping"), ...uplifted];
  const value = (v, quantity = "time") => h("td", { "data-value": v }, valueIn(v, quantity));
  const percent = (v) => h("td", {}, `${number(100 * v, 3)} %`);
  const rows = view.modes.slice(0, ROWS).map((m, i) => h("tr", {},
    h("th", { scope: "row" }, String(i + 1)),
    value(m.period), value(m.effective_mass, "mass"), percent(m.mass_share), value(m.effective_height, "length"), percent(m.damping),
    m.uplifted.flatMap((each) => [value(each.period), percent(each.damping)])));
  return h("div", {},
    scrolled(t("Modes"), {}, tableOf(head, rows, { id: "modes" })),
    view.modes.length > ROWS ? h("p", { class: "hint" }, t("and {n} more", { n: view.modes.length - ROWS })) : null);
}
