// The elements between the base and the ground: their peaks, what closes the base, and the loop of one of them.

import { h, number, symbol, tableOf } from "../dom.js";
import { nameOf } from "../symbols.js";
import { Loop } from "./loop.js";

const HEAD = ["Element", "F_max [kN]", "δ_max [mm]", "Dissipated [kJ]", "Yielded or slid"];
const PRESTRESS = "Prestress left [kN]"; // of tendons
const EDGES = { 1: "to the right", "-1": "to the left" };

export class Elements {
  // `chosen` is called when another element or model is chosen.
  constructor(about, chosen) {
    this.about = about;
    this.element = 0;
    this.model = h("select", { id: "elements-of", "aria-label": "Model for the elements", onchange: () => chosen() });
    this.of = h("select", { id: "loop-of", "aria-label": "Element for the loop", onchange: () => {
      this.element = Number(this.of.value);
      chosen();
    } });
    this.rows = h("div", { class: "scroll" });
    this.closing = h("p", { id: "closing" });
    this.table = h("div", { id: "elements" },
      h("h2", { class: "buttons" }, "Elements at the base, by", this.model), this.rows, this.closing);
    this.loop = new Loop({ label: "Force over elongation of an element", yLabel: "F [kN]", xLabel: "δ [mm]" });
    this.chart = h("div", {}, h("h2", { class: "buttons" }, "Loop of", this.of), this.loop.chart.element);
  }

  set(view) {
    const { held } = view;
    this.table.hidden = this.chart.hidden = !held;
    if (!held) return;
    const lifting = view.models.filter((m) => m.lifts);
    this.model.replaceChildren(...lifting.map((m) => h("option", { value: m.label }, m.label)));
    this.model.value = held.label;
    const names = view.elements.map((each, i) => nameOf(this.about, each, i));
    this.of.replaceChildren(...names.map((name, i) => h("option", { value: i }, name)));
    this.element = view.element;
    this.of.value = String(view.element);
    const tendons = held.rows.some((row) => row.prestress !== null);
    const head = [...HEAD, ...(tendons ? [PRESTRESS] : [])].map(symbol);
    this.rows.replaceChildren(tableOf(head, held.rows.map((row, i) => line(row, names[i], tendons))));
    this.closing.textContent = said(view.self_centring);
    this.loop.set(lifting.map((m) => ({
      t: m.t, x: m.element_elongation.map((v) => v * 1000), y: m.element_force.map((v) => v / 1000),
      until: m.fall_time ?? Infinity, label: m.label, look: m.look,
    })));
  }
}

function line(row, name, tendons) {
  const value = (key, factor) => h("td", { "data-name": key, "data-value": row[key] }, number(row[key] === null ? null : row[key] * factor));
  return h("tr", {}, h("th", { scope: "row" }, name),
    value("force", 1e-3), value("elongation", 1e3), value("energy", 1e-3),
    h("td", { "data-name": "yielded", class: row.broken ? "overturned" : null }, row.broken ? "broke" : row.yielded ? "yes" : "no"),
    tendons ? value("prestress", 1e-3) : null);
}

function said(edges) {
  if (!edges.length) return "";
  const parts = edges.map(({ side, closes, ratio }) => {
    const about = edges.length > 1 ? ` after rocking ${EDGES[side]}` : "";
    return `${closes ? "close" : "need not close"} the base${about} against its dissipators (λ = ${number(ratio, 3)})`;
  });
  const [{ at }] = edges;
  const design = at === null ? "" : ` At the largest rotation of these runs λ = ${number(at, 3)}.`;
  return `Weight and prestress ${parts.join(" and ")}; above λ = 1 it centres itself.${design}`;
}
