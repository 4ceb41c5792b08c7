// The spectra of chosen records beside their target, and the records in a table.

import { Chart } from "../chart.js";
import { h, number, symbol, tableOf } from "../dom.js";
import { legend } from "../marks.js";

const HEAD = ["record", "earthquake", "M", "R [km]", "V_s30 [m/s]", "factor", "misfit", "S_a/target"];

export class Spectra {
  constructor() {
    this.chart = new Chart({
      label: "Spectra of the chosen records over the period", yLabel: "Sa [m/s²]", xLabel: "period [s]", xName: "T [s]",
      height: 360, xLog: true, yLog: true,
    });
    this.title = h("h2", { id: "target-title" });
    this.facts = h("dl", { class: "values", id: "fit" });
    this.keys = h("div");
    this.rows = h("div", { class: "scroll", id: "chosen" });
    this.notes = h("ul", { class: "notes" });
    this.element = h("div", {}, this.title, this.facts, this.keys, this.chart.element,
      h("p", { class: "hint" }, "Shaded: the range of periods. Band: 16th to 84th percentile of a lognormal distribution. ",
        "Thin lines: the chosen records, scaled."),
      this.notes, this.rows);
  }

  show(answer) {
    const { periods: x, range: [low, high] } = answer;
    this.title.textContent = `${answer.records.length} of ${answer.offered} records for ${answer.target}`;
    this.facts.replaceChildren(...[
      ["misfit", answer.misfit, "of the mean: root mean square of ln(mean/target)"],
      ["least mean/target", answer.least_ratio, "over the range; codes ask for 0.9"],
      ["mean/target at T = 0", answer.zero_period_ratio, "EN 1998-1:2004 asks for 1"],
      ["largest spread", answer.dispersion, "standard deviation of ln S_a"],
    ].map(([name, value, help]) => h("div", {}, h("dt", {}, name), h("dd", { "data-fact": name, "data-value": value }, number(value)),
      h("dd", { class: "hint" }, symbol(help)))));
    const lines = [
      { y: answer.wanted, label: "target", color: "c1", width: 2.2 },
      { y: answer.mean, label: "mean", color: "c0", width: 2.2 },
    ].map((each) => ({ x, ...each }));
    this.chart.set({
      spans: [[low, high]],
      series: [
        ...(answer.singles.length > 1 ? [{ kind: "band", x, low: answer.low, high: answer.high, color: "c0", alpha: 0.16 }] : []),
        ...answer.singles.map((y) => ({ x, y, color: "muted", width: 0.8, alpha: 0.7 })),
        ...lines,
      ],
    });
    this.keys.replaceChildren(legend(lines));
    this.notes.replaceChildren(...answer.notes.map((text) => h("li", {}, text)));
    this.rows.replaceChildren(tableOf(HEAD.map(symbol), answer.records.map(row)));
  }
}

function row(each) {
  const where = [each.event, each.year, each.station].filter((part) => part !== null).join(", ");
  return h("tr", { "data-record": each.record },
    h("th", { scope: "row" }, each.record), h("td", {}, where || "–"), h("td", {}, number(each.magnitude)),
    h("td", {}, number(each.distance_km)), h("td", {}, number(each.vs30)),
    h("td", { "data-name": "factor", "data-value": each.factor }, number(each.factor)),
    h("td", { "data-name": "misfit", "data-value": each.misfit }, number(each.misfit, 3)),
    h("td", {}, `${number(each.least_ratio, 3)} to ${number(each.largest_ratio, 3)}`));
}
