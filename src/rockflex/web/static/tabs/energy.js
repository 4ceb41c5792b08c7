// Energies and elements of a response, and the loops of force over movement.

import { bracket } from "../axes.js";
import { Chart } from "../chart.js";
import { decode, h, number, scrolled, symbol, tableOf } from "../dom.js";
import { nameOf } from "../drawing.js";
import { legend } from "../marks.js";
import { t } from "../texts.js";
import { titled, unit, valueIn } from "../units.js";

export class Loop {
  constructor(options) {
    this.chart = new Chart({ height: 240, firstOnTop: true, xName: options.xLabel, ...options });
    this.curves = [];
    this.time = 0;
  }

  // Models with `x` and `y` over `t`; what follows a fall is left out.
  set(curves) {
    this.curves = curves.map((curve) => {
      const end = curve.until < Infinity ? curve.t.findIndex((t) => t >= curve.until) : curve.t.length;
      return { ...curve, t: curve.t.subarray(0, end), x: curve.x.subarray(0, end), y: curve.y.subarray(0, end) };
    });
    this.chart.set({ series: this.curves.map(({ x, y, label, look }) => (
      { x, y, label, parametric: true, ...look, width: 1, alpha: 0.6 })) });
    this.follow(this.time);
  }

  follow(time) {
    this.time = time;
    const places = this.curves.map(({ t, x, y, look }) => {
      const [low, high, share] = bracket(t, time);
      const at = (values) => values[low] + share * (values[high] - values[low]);
      return { n: low + 1, xs: x, ys: y, x: at(x), y: at(y), color: look.color };
    });
    this.chart.setCursor(null, places, places);
  }
}

const PARTS = [
  ["kinetic", t("kinetic")],
  ["strain", t("strain")],
  ["gravity", t("raised weight")],
  ["element_strain", t("stored in elements"), "tendons"],
  ["damped", t("damping")],
  ["yielded", t("yielding")],
  ["elements", t("taken by elements"), "fuse"],
  ["lost", t("impacts")],
  ["soil_strain", t("compressed ground"), "clay"],
  ["soil", t("damped by the ground")],
  ["friction", t("friction of the base")],
];

export class Energy {
  // `chosen` is called when another model is chosen.
  constructor(chosen) {
    this.focus = "";
    this.chart = new Chart({
      label: t("Energy over time"), yLabel: titled(t("energy [{unit}]"), "energy"), xLabel: t("time [s]"), height: 240, zero: true, xName: "t [s]",
    });
    this.keys = h("div");
    this.note = h("p", { class: "hint" });
    this.of = h("select", { id: "energy-of", "aria-label": t("Model for the energy"), onchange: () => {
      this.focus = this.of.value;
      chosen();
    } });
    this.element = h("div", {},
      h("h2", { class: "buttons" }, t("Energy of"), this.of), this.chart.element, this.keys, this.note);
  }

  set(view) {
    const { energy } = view;
    this.of.replaceChildren(...view.models.map((m) => h("option", { value: m.label }, m.label)));
    this.of.value = energy.label;
    this.note.textContent = energy.note ?? "";
    this.chart.element.hidden = this.keys.hidden = Boolean(energy.note);
    if (energy.note) return;
    const until = view.models.find((m) => m.label === energy.label)?.fall_time ?? Infinity;
    const x = decode(energy.t);
    const { size } = unit("energy");
    let below = new Float32Array(x.length);
    const series = [];
    for (const [name, label, tone = name] of PARTS) {
      const values = energy[name] ? decode(energy[name]) : [];
      if (!values.some((value) => value !== 0)) continue;
      const high = below.map((value, i) => value + values[i] / size);
      series.push({ kind: "band", x, low: below, high, color: tone, alpha: 0.75, edge: true, label, until });
      below = high;
    }
    const input = decode(energy.input).map((value) => value / size);
    series.push({ x, y: input, color: "text", width: 1.2, label: t("input"), until });
    this.chart.set({
      series, xRange: [0, view.end],
      vlines: until < Infinity ? [{ x: until, color: "error", label: t("falls") }] : [],
    });
    this.keys.replaceChildren(legend(series));
  }
}

// Name, heading and kind of quantity.
const COLUMNS = [
  ["force", t("F_max [{unit}]"), "force"],
  ["elongation", t("δ_max [{unit}]"), "displacement"],
  ["energy", t("Dissipated [{unit}]"), "energy"],
];
const PRESTRESS = ["prestress", t("Prestress left [{unit}]"), "force"]; // of tendons
const CLOSING = [t("Weight and prestress need not close the base against its dissipators (λ = {ratio})."),
  t("Weight and prestress close the base against its dissipators (λ = {ratio}).")];
const EDGES = { 1: t("After rocking to the right: {text}"), "-1": t("After rocking to the left: {text}") };

export class Elements {
  // `chosen` is called when another element or model is chosen.
  constructor(about, chosen) {
    this.about = about;
    this.element = 0;
    this.model = h("select", { id: "elements-of", "aria-label": t("Model for the elements"), onchange: () => chosen() });
    this.of = h("select", { id: "loop-of", "aria-label": t("Element for the loop"), onchange: () => {
      this.element = Number(this.of.value);
      chosen();
    } });
    this.rows = scrolled(t("Largest values of the elements"), {});
    this.closing = h("p", { id: "closing" });
    this.table = h("div", { id: "elements" },
      h("h2", { class: "buttons" }, t("Elements at the base, by"), this.model), this.rows, this.closing);
    this.loop = new Loop({ label: t("Force over elongation of an element"),
      yLabel: titled("F [{unit}]", "force"), xLabel: titled("δ [{unit}]", "displacement") });
    this.chart = h("div", {}, h("h2", { class: "buttons" }, t("Loop of"), this.of), this.loop.chart.element);
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
    const last = held.rows.some((row) => row.prestress !== null) ? [PRESTRESS] : [];
    const headings = (columns) => columns.map(([, text, quantity]) => titled(text, quantity));
    const head = [t("Element"), ...headings(COLUMNS), t("Yielded or slid"), ...headings(last)].map(symbol);
    this.rows.replaceChildren(tableOf(head, held.rows.map((row, i) => line(row, names[i], last))));
    this.closing.textContent = said(view.self_centring);
    this.loop.set(lifting.map((m) => ({
      t: m.t, x: m.element_elongation.map((v) => v / unit("displacement").size), y: m.scaled.element_force,
      until: m.fall_time ?? Infinity, label: m.label, look: m.look,
    })));
  }
}

function line(row, name, last) {
  const value = ([key, , quantity]) => h("td", { "data-name": key, "data-value": row[key] }, valueIn(row[key], quantity));
  return h("tr", {}, h("th", { scope: "row" }, name), COLUMNS.map(value),
    h("td", { "data-name": "yielded", class: row.broken ? "overturned" : null }, row.broken ? t("broke") : row.yielded ? t("yes") : t("no")),
    last.map(value));
}

function said(edges) {
  if (!edges.length) return "";
  const texts = edges.map(({ side, closes, ratio }) => (edges.length > 1 ? EDGES[side] : "{text}")
    .replace("{text}", CLOSING[Number(closes)]).replace("{ratio}", number(ratio, 3)));
  const [{ at }] = edges;
  const design = at === null ? [] : [t("At the largest rotation of these runs λ = {ratio}.", { ratio: number(at, 3) })];
  return [...texts, t("Above λ = 1 the base centres itself."), ...design].join(" ");
}
