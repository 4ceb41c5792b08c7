// Where the input energy goes, over time.

import { Chart } from "../chart.js";
import { decode, h } from "../dom.js";
import { legend } from "../marks.js";

const PARTS = [
  ["kinetic", "kinetic"],
  ["strain", "strain"],
  ["gravity", "raised weight"],
  ["element_strain", "stored in elements", "tendons"],
  ["damped", "damping"],
  ["yielded", "yielding"],
  ["elements", "taken by elements", "fuse"],
  ["lost", "impacts"],
  ["soil_strain", "compressed ground", "clay"],
  ["soil", "damped by the ground"],
  ["friction", "friction of the base"],
];

export class Energy {
  // `chosen` is called when another model is chosen.
  constructor(chosen) {
    this.focus = "";
    this.chart = new Chart({
      label: "Energy over time", yLabel: "energy [kJ]", xLabel: "time [s]", height: 240, zero: true, xName: "t [s]",
    });
    this.keys = h("div");
    this.note = h("p", { class: "hint" });
    this.of = h("select", { id: "energy-of", "aria-label": "Model for the energy", onchange: () => {
      this.focus = this.of.value;
      chosen();
    } });
    this.element = h("div", {},
      h("h2", { class: "buttons" }, "Energy of", this.of), this.chart.element, this.keys, this.note);
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
    let below = new Float32Array(x.length);
    const series = [];
    for (const [name, label, tone = name] of PARTS) {
      const values = energy[name] ? decode(energy[name]) : [];
      if (!values.some((value) => value !== 0)) continue;
      const high = below.map((value, i) => value + values[i] / 1000);
      series.push({ kind: "band", x, low: below, high, color: tone, alpha: 0.75, edge: true, label, until });
      below = high;
    }
    const input = decode(energy.input).map((value) => value / 1000);
    series.push({ x, y: input, color: "text", width: 1.2, label: "input", until });
    this.chart.set({
      series, xRange: [0, view.end],
      vlines: until < Infinity ? [{ x: until, color: "error", label: "falls" }] : [],
    });
    this.keys.replaceChildren(legend(series));
  }
}
