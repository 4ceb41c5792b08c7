// Structure: a form, its modes, and how many of them are needed.

import { clone, h, latest, number, symbol } from "../dom.js";
import { field, select, tableField, tableGroup, trouble } from "../form.js";
import { base } from "../structure/base.js";
import { ground, without } from "../structure/ground.js";
import { elements } from "../structure/elements.js";
import { importing } from "../structure/matrices.js";
import { pictures, table } from "../structure/modes.js";
import { REPLACED, section } from "../structure/section.js";
import { INNER, KINDS } from "../structure/starts.js";

export default function structureTab(app) {
  const { kinds, eccentricity, presets, limits } = app.about;
  const current = () => clone(app.state.structure);
  const kindOf = (structure) => Object.keys(kinds).find((key) => structure[key]) ?? "frame";
  let cuts = 0; // changes of the cross-section; a later one replaces one that waits
  const known = {}; // what the last section of each kind gave
  let drawn = false; // whether the form has the fields of the present structure

  function put(structure, redraw = false) {
    if (redraw) {
      drawn = false;
      cuts++;
    }
    const rigid = "block" in structure;
    app.change({ structure, ...(rigid === "block" in app.state.structure ? {} : modelsFor(rigid)) });
  }

  // A rigid block has no modes, and all models but one need some.
  function modelsFor(rigid) {
    const { models, cloud, design } = app.about.state;
    if (rigid) return { models: ["rigid"], cloud: { models: ["rigid"] }, design: { model: "rigid" } };
    const usual = { models, cloud: { models: cloud.models }, design: { model: design.model } };
    return app.state.ground ? without({ structure: {}, ...usual }) : usual;
  }

  const own = [["", "custom structure"], ...presets.map((p, i) => [String(i), p.title])];
  const preset = select("preset", "Start from", own, "", (i) => i !== "" && put(clone(presets[Number(i)].structure), true));
  const titles = Object.entries(kinds).map(([name, { title }]) => [name, title]);
  const kind = select("kind", "Kind", titles, "frame", (name) => put(fresh(name), true));
  const name = h("input", { type: "text", maxlength: 80, onchange: () => put({ ...current(), name: name.value }) });
  const fields = h("div");
  const moved = h("div");
  const held = elements(app, current, put);
  let view = null;
  let viewed = ""; // the structure of the view
  const below = ground(app, viewNow);
  const results = h("div", { class: "results" });
  const element = h("div", { class: "columns" },
    h("form", { class: "side", onsubmit: (event) => event.preventDefault() },
      h("fieldset", {}, h("legend", {}, "Structure"), preset, kind, field("structure.name", "Name", name),
        h("div", { "data-path": "structure" }, fields, moved, trouble()), h("p", { class: "error foot", role: "alert" })),
      held, below, importing(limits.file, current, (structure) => put(structure, true))),
    results);

  // The first preset of a kind, or default values.
  function fresh(wanted) {
    const found = presets.find((p) => p.structure[wanted]);
    return found ? clone(found.structure) : { name: "", [wanted]: clone(KINDS[wanted] ?? {}) };
  }

  function form() {
    const { structure } = app.state;
    const now = kindOf(structure);
    kind.setValue(now);
    if (document.activeElement !== name) name.value = structure.name ?? "";
    const match = presets.findIndex((p) => same(p.structure, structure));
    preset.setValue(match < 0 ? "" : String(match));
    if (drawn) return;
    drawn = true;
    const values = structure[now];
    const given = (spec) => !(values.section && REPLACED.includes(spec.name) && values[spec.name] === undefined);
    const focused = fields.contains(document.activeElement) && document.activeElement.closest("[data-path]").dataset.path;
    fields.replaceChildren(...kinds[now].fields.filter(given).map((spec) => entry(now, spec, values)));
    if (focused) fields.querySelector(`[data-path="${CSS.escape(focused)}"]`)?.querySelector("input, select, button")?.focus();
    moved.replaceChildren(tableField("structure.eccentricity", eccentricity, structure.eccentricity, (value) => {
      const next = current();
      set(next, "eccentricity", value);
      put(next);
    }));
    held.draw(structure.elements ?? []);
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
    if (value) for (const name of REPLACED) delete next[now][name];
    else Object.assign(next[now], { bending_stiffness: fact("EI", 2e10), [now === "beam" ? "mass" : "mass_per_length"]: fact("m", 5000) });
    put(next, anew);
  }

  const load = latest(async () => {
    results.classList.add("stale");
    const asked = JSON.stringify(app.state.structure);
    const answer = await app.ask("/api/structure", element);
    if (!answer) return;
    results.classList.remove("stale");
    view = answer;
    viewed = asked;
    if (answer.section.length) known[answer.kind] = answer.section;
    results.replaceChildren(...show());
  });

  // The view of the present structure: at once if it is there, else a promise of it; null if it cannot be built.
  function viewNow() {
    const now = () => (viewed === JSON.stringify(app.state.structure) ? view : null);
    return now() ?? load().then(now);
  }

  function show() {
    return [
      h("h2", {}, view.name || kinds[view.kind].title),
      view.adequacy ? h("p", { class: "answer", id: "adequacy" }, view.adequacy.reason) : "",
      view.adequacy ? h("p", { class: "hint" }, "This check uses masses and frequencies only. Impacts also excite higher modes, ",
        "which affect the base shear most: compare with MDOF-S on the Response tab.") : "",
      view.warnings.length
        ? h("div", { class: "warning", id: "warnings", role: "alert" }, view.warnings.map((text) => h("p", {}, text))) : "",
      view.freedoms ? h("p", { class: "hint", id: "freedoms" }, view.freedoms) : "",
      pictures(view),
      view.elements.length || view.ground ? base(app.about, view) : "",
      h("dl", { class: "values" }, view.properties.map(parameter)),
      view.section.length ? h("h2", {}, "Cross-section") : "",
      view.section.length ? h("dl", { class: "values", id: "section" }, view.section.map(parameter)) : "",
      view.ground?.facts.length ? h("h2", {}, "Springs under the base") : "",
      view.ground?.facts.length ? h("dl", { class: "values", id: "springs" }, view.ground.facts.map(parameter)) : "",
      table(view),
      app.downloads(element, [["modes", "Modes (SVG)"], ["structure", "Structure (TOML)"]]),
      app.next("earthquake", "Next: choose the earthquake."),
    ];
  }

  function refresh() {
    form();
    below.refresh();
    load();
  }
  return { element, refresh };
}

function parameter(p) {
  const value = p.none ? `none: ${p.none}` : number(p.value);
  return h("div", {}, h("dt", {}, symbol(p.symbol), p.unit ? ` [${p.unit}]` : ""),
    h("dd", { "data-value": p.value }, value), h("dd", { class: "hint" }, p.help));
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
