// The modes of a structure: drawings and a table.

import { h, ink, number, svg, tableOf } from "../dom.js";

const [WIDTH, HEIGHT] = [110, 240];
const SWAY = 38; // px
const ROWS = 12;

// The structure and its first modes, each drawn with its contribution to a unit displacement.
export function pictures(view) {
  const shapes = view.shapes.length ? view.shapes : [view.heights.map(() => 0)];
  return h("div", { class: "modes" }, shapes.map((shape, n) => picture(view, shape, n)),
    view.shapes_known ? null
      : h("p", { class: "hint" }, "The mode shapes are not known and drawn as straight lines."));
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
  const texts = mode ? [`Mode ${n + 1}`, `T = ${number(mode.period, 3)} s`] : [];
  const name = mode ? `Mode ${n + 1}, period ${number(mode.period)} s` : "Outline of the rigid block";
  return svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, width: WIDTH, height: HEIGHT, role: "img", "aria-label": name },
    svg("line", { x1: x(0), x2: x(0), y1: y(0), y2: y(top), stroke: ink("control"), "stroke-dasharray": "4 3" }),
    svg("line", { x1: middle - b, x2: middle + b, y1: y(0), y2: y(0), stroke: ink("structure"), "stroke-width": 4 }),
    svg("polyline", { points, fill: "none", stroke: ink("c0"), "stroke-width": 2 }),
    ...floors.map((z, i) => svg("circle", { cx: x(shape[i + 1]), cy: y(z), r: 2.6, fill: ink("c0") })),
    ...texts.map((text, line) => svg("text", {
      x: WIDTH / 2, y: HEIGHT - 20 + 14 * line, "text-anchor": "middle", "font-size": 12, fill: ink("text"),
    }, text)));
}

export function table(view) {
  if (!view.modes.length)
    return h("p", { class: "help" }, "A rigid block has no modes. Use the model “rigid”.");
  const edges = view.modes[0].uplifted.length > 1 ? [", right edge", ", left edge"] : [""];
  const head = ["Mode", "Period T [s]", "Mass m* [kg]", "Share of total mass", "Height h* [m]", "Damping",
    ...edges.flatMap((edge) => [`Period while uplifted${edge} [s]`, `Damping while uplifted${edge}`])];
  const value = (v) => h("td", { "data-value": v }, number(v));
  const percent = (v) => h("td", {}, `${number(100 * v, 3)} %`);
  const rows = view.modes.slice(0, ROWS).map((m, i) => h("tr", {},
    h("th", { scope: "row" }, String(i + 1)),
    value(m.period), value(m.effective_mass), percent(m.mass_share), value(m.effective_height), percent(m.damping),
    m.uplifted.flatMap((each) => [value(each.period), percent(each.damping)])));
  return h("div", {},
    h("div", { class: "scroll" }, tableOf(head, rows, { id: "modes" })),
    view.modes.length > ROWS ? h("p", { class: "hint" }, `and ${view.modes.length - ROWS} more`) : null);
}
