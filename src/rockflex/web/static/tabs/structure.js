// Structure: what rocks. A form, its modes, and how many of them it needs.

import { send, Refusal } from "../api.js";
import { clone, color, h, latest, number, symbol } from "../dom.js";
import { field, select, tableField } from "../form.js";

export default function structureTab(app) {
  const { kinds, tendon, presets } = app.about;
  const fields = h("div");
  const foot = h("p", { class: "error foot", role: "alert" });
  const results = h("div", { class: "results" });
  const preset = select("preset", "Begin with", [["", "a structure of your own"], ...presets.map((p, i) => [String(i), p.title])], "", (i) => {
    if (i !== "") put(clone(presets[Number(i)].structure), true);
  });
  const kind = select("kind", "Kind", Object.entries(kinds).map(([name, k]) => [name, k.title]), "frame", (name) => put(fresh(name), true));
  const name = h("input", { type: "text", maxlength: 80, onchange: () => put({ ...current(), name: name.value }) });
  const element = h("div", { class: "columns" },
    h("form", { class: "side", onsubmit: (event) => event.preventDefault() },
      h("fieldset", {}, h("legend", {}, "Structure"), preset, kind, field("structure.name", "Name", name), h("div", { "data-path": "structure" }, fields, h("div", { class: "error", role: "alert" })), foot),
      importing(),
      h("fieldset", { "data-path": "structure.tendons" }, h("legend", {}, "Tendons that hold the base down"), h("div", { class: "tendons" }), h("div", { class: "error", role: "alert" }))),
    results);
  const tendonList = element.querySelector(".tendons");
  let drawn = "";

  const current = () => clone(app.state.structure);
  const kindOf = (structure) => Object.keys(kinds).find((key) => structure[key]) ?? "frame";

  function put(structure, redraw = false) {
    if (redraw) drawn = "";
    app.change({ structure });
  }

  // The first preset of a kind, or its defaults.
  function fresh(wanted) {
    const found = presets.find((p) => p.structure[wanted]);
    if (found) return clone(found.structure);
    return { name: "", [wanted]: clone(EXAMPLES[wanted] ?? {}) };
  }

  function form() {
    const structure = app.state.structure;
    const now = kindOf(structure);
    const key = JSON.stringify([now, Object.keys(structure[now]).length, (structure.tendons ?? []).length]);
    kind.setValue(now);
    if (document.activeElement !== name) name.value = structure.name ?? "";
    const match = presets.findIndex((p) => same(p.structure, structure));
    preset.setValue(match < 0 ? "" : String(match));
    if (drawn === key) return;
    drawn = key;
    fields.replaceChildren(...kinds[now].fields.filter((spec) => spec.type !== "table").map((spec) =>
      tableField(`structure.${now}.${spec.name}`, spec, structure[now][spec.name], (value) => {
        const next = current();
        if (value === undefined) delete next[now][spec.name];
        else next[now][spec.name] = value;
        drawn = JSON.stringify([now, Object.keys(next[now]).length, (next.tendons ?? []).length]);
        put(next);
      })));
    tendons(structure);
  }

  function tendons(structure) {
    const list = structure.tendons ?? [];
    tendonList.replaceChildren(
      ...list.map((each, i) => h("details", { open: list.length < 2 },
        h("summary", {}, `Tendon ${i + 1}`),
        tendon.map((spec) => tableField(`structure.tendons.${i}.${spec.name}`, spec, each[spec.name], (value) => {
          const next = current();
          if (value === undefined) delete next.tendons[i][spec.name];
          else next.tendons[i][spec.name] = value;
          put(next);
        })),
        h("button", { type: "button", onclick: () => put({ ...current(), tendons: list.filter((_, j) => j !== i) }, true) }, "Remove"))),
      h("button", { type: "button", disabled: list.length >= 6, onclick: () => put({ ...current(), tendons: [...list, { position: 0, initial_force: 1e5, stiffness: 1e6 }] }, true) }, "Add a tendon"));
  }

  function importing() {
    const part = h("select", { "aria-label": "What a CSV file holds" }, ["mass", "stiffness", "heights", "rotations"].map((p) => h("option", { value: p }, p)));
    const input = h("input", { type: "file", accept: ".npz,.csv", "aria-label": "File of matrices", onchange: async () => {
      const chosen = input.files[0];
      input.value = "";
      if (!chosen) return;
      const box = element.querySelector("[data-path='import'] .error");
      box.textContent = "";
      if (chosen.size > app.about.limits.file) {
        box.textContent = `${chosen.name} has ${(chosen.size / 1e6).toFixed(1)} MB, but the page takes ${app.about.limits.file / 1e6} MB at most.`;
        return;
      }
      try {
        const found = await send(`/api/matrices?name=${encodeURIComponent(chosen.name)}&part=${part.value}`, chosen);
        const now = current();
        const begun = now.matrices ?? { base_mass: 0, half_width: 1, damping_ratio: 0.02 };
        put({ name: now.matrices ? now.name : chosen.name.replace(/\.\w+$/, ""), matrices: { ...begun, ...found } }, true);
      } catch (error) {
        if (!(error instanceof Refusal)) throw error;
        box.textContent = Object.values(error.errors).join(" ");
      }
    } });
    return h("fieldset", { "data-path": "import" }, h("legend", {}, "Import matrices"),
      h("p", { class: "help" }, "From any finite element program: a .npz file with the arrays mass, stiffness and heights, or one CSV file for each. Units: kg, N/m, m; the base held."),
      h("div", { class: "row buttons" }, h("span", {}, "CSV holds"), part), input, h("div", { class: "error", role: "alert" }));
  }

  const load = latest(async () => {
    results.classList.add("stale");
    const answer = await app.ask("/api/structure", element);
    if (!answer) return;
    results.classList.remove("stale");
    results.replaceChildren(...show(answer));
  });

  function show(view) {
    return [
      h("h2", {}, view.name || kinds[view.kind].title),
      view.adequacy ? h("p", { class: "answer", id: "adequacy" }, view.adequacy.reason) : null,
      h("div", { class: "modes" }, modes(view)),
      h("dl", { class: "values" }, view.properties.map((p) => h("div", { title: p.help }, h("dt", {}, symbol(p.symbol), p.unit ? ` [${p.unit}]` : ""), h("dd", { "data-value": p.value }, p.symbol === "α" && p.value === null ? "never: tendons" : number(p.value)), h("dd", { class: "hint" }, p.help)))),
      table(view),
      app.downloads(element, [["modes", "Figure of the modes (SVG)"], ["structure", "Structure (TOML)"]]),
      h("p", { class: "help" }, "Next: choose the earthquake. ", h("button", { type: "button", onclick: () => app.go("earthquake") }, "Earthquake")),
    ].filter(Boolean);
  }

  function refresh() {
    form();
    load();
  }
  return { element, refresh, repaint: () => {} };
}

const EXAMPLES = {
  fish_bone: { story_heights: [4, 3, 3], masses: 4e4, column_stiffness: 2e8, beam_stiffness: "inf", base_mass: 4e4, half_width: 1, damping_ratio: 0.02 },
  beam: { height: 20, mass: 5000, bending_stiffness: 2e10, half_width: 1.5, damping_ratio: 0.02, base_mass: 5e4 },
  matrices: { mass: [4e4, 4e4], stiffness: [[2e7, -1e7], [-1e7, 1e7]], heights: [3, 6], base_mass: 4e4, half_width: 0.8, damping_ratio: 0.02 },
  modes: { omega: [9.771976, 25.583366], shapes: [[0.6180339887, -1.6180339887], [1, 1]], mass: [4e4, 4e4], heights: [3, 6], base_mass: 4e4, half_width: 0.8, damping_ratio: 0.02 },
  properties: { omega: [6.2832], effective_mass: [175906], effective_height: [10.54], top_ordinate: [1.2517], i_theta: 20066620, l0r: 1800000, m_tot: 240000, half_width: 1.054, zeta: 0.02 },
  block: { slenderness: 0.2, half_diagonal: 3 },
};

function same(a, b) {
  const tidy = (s) => JSON.stringify(s, (key, value) => (Array.isArray(value) && key === "tendons" && !value.length ? undefined : value && typeof value === "object" && !Array.isArray(value) ? Object.fromEntries(Object.entries(value).sort()) : value));
  return tidy(a) === tidy(b);
}

// The structure and its first modes, each displaced by its share of a unit motion.
function modes(view) {
  const width = 110;
  const height = 240;
  const top = view.heights[view.heights.length - 1];
  const ns = "http://www.w3.org/2000/svg";
  const shapes = view.shapes.length ? view.shapes : [view.heights.map(() => 0)];
  return h("div", { class: "chips" }, shapes.map((shape, n) => {
    const svg = document.createElementNS(ns, "svg");
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.setAttribute("width", width);
    svg.setAttribute("height", height);
    svg.setAttribute("role", "img");
    const mode = view.modes[n];
    svg.setAttribute("aria-label", mode ? `Mode ${n + 1}, period ${number(mode.period)} s` : "Outline of the rigid block");
    const largest = Math.max(...shape.map(Math.abs)) || 1;
    const x = (u) => width / 2 + (u / largest) * 38;
    const y = (z) => height - 40 - (z / top) * (height - 62);
    const draw = (tag, attributes) => {
      const node = document.createElementNS(ns, tag);
      for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
      svg.append(node);
    };
    const b = Math.min(30, Math.max(6, (view.half_width / top) * (height - 62)));
    draw("line", { x1: x(0), x2: x(0), y1: y(0), y2: y(top), stroke: color("line"), "stroke-dasharray": "4 3" });
    draw("line", { x1: x(0) - b, x2: x(0) + b, y1: y(0), y2: y(0), stroke: color("structure"), "stroke-width": 4 });
    draw("polyline", { points: view.heights.map((z, i) => `${x(shape[i]).toFixed(1)},${y(z).toFixed(1)}`).join(" "), fill: "none", stroke: color("c0"), "stroke-width": 2 });
    if (view.heights.length < 26) view.heights.forEach((z, i) => i && draw("circle", { cx: x(shape[i]), cy: y(z), r: 2.6, fill: color("c0") }));
    if (mode) {
      for (const [line, text] of [`Mode ${n + 1}`, `T = ${number(mode.period, 3)} s`].entries()) {
        const label = document.createElementNS(ns, "text");
        for (const [key, value] of Object.entries({ x: width / 2, y: height - 20 + 14 * line, "text-anchor": "middle", "font-size": 12, fill: color("text") })) label.setAttribute(key, value);
        label.textContent = text;
        svg.append(label);
      }
    }
    return svg;
  }), view.shapes_known ? null : h("p", { class: "hint" }, "The shape over the height is not known: it is drawn as a straight line."));
}

function table(view) {
  if (!view.modes.length) return h("p", { class: "help" }, "A rigid block has no modes: simulate it with the model “rigid”.");
  const head = ["Mode", "Period T [s]", "Mass m* [kg]", "of the total", "Height h* [m]", "Damping", "Period while uplifted [s]"];
  return h("div", { class: "scroll" }, h("table", { id: "modes" },
    h("thead", {}, h("tr", {}, head.map((t) => h("th", { scope: "col" }, t)))),
    h("tbody", {}, view.modes.slice(0, 12).map((m, i) => h("tr", {},
      h("th", { scope: "row" }, String(i + 1)),
      h("td", { "data-value": m.period }, number(m.period)), h("td", { "data-value": m.effective_mass }, number(m.effective_mass)),
      h("td", {}, `${number(100 * m.mass_share, 3)} %`), h("td", { "data-value": m.effective_height }, number(m.effective_height)),
      h("td", {}, `${number(100 * m.damping, 3)} %`), h("td", { "data-value": m.uplifted_period }, number(m.uplifted_period)))))),
  view.modes.length > 12 ? h("p", { class: "hint" }, `and ${view.modes.length - 12} more`) : null);
}
