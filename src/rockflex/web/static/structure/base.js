// The base with its edges, the axis of the masses and the elements, to scale across.

import { ink, svg } from "../dom.js";
import { coil, colorOf, nameOf, strokes } from "../symbols.js";

const [WIDTH, HEIGHT] = [460, 104];
const [BASE, GROUND] = [40, 74]; // px from the top
const NUMBERS = 13; // px between numbers that would overlap

export function base(about, view) {
  const { half_width: b, eccentricity: e, elements, ground } = view;
  const springs = ground?.springs ?? [];
  const reach = Math.max(b + Math.abs(e), ...elements.map((each) => Math.abs(each.position)));
  const x = (metres) => WIDTH / 2 + (metres / reach) * (WIDTH / 2 - 24);
  const [left, right] = [x(-b - e), x(b - e)];
  const names = elements.map((each, i) => nameOf(about, each, i));
  if (springs.length) names.unshift("springs under the base");
  return svg("svg", {
    id: "base", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": `The base and what holds it: ${names.join("; ")}`,
  },
  svg("line", { x1: x(0), x2: x(0), y1: 4, y2: BASE, stroke: ink("control"), "stroke-dasharray": "4 3" }),
  svg("path", { d: hatch(), stroke: ink("muted"), fill: "none" }),
  ...elements.flatMap((each) => drawn(each, x(each.position))),
  svg("line", { x1: left, x2: right, y1: BASE, y2: BASE, stroke: ink("structure"), "stroke-width": 5 }),
  ...springs.flatMap((place) => sprung(x(place), springs.length)),
  ...(springs.length ? [] : [left, right]).map((at) => svg("path", { d: `M${at} ${BASE}l-7 ${GROUND - BASE}h14z`, fill: ink("structure") })),
  ...numbers(elements.map((each) => x(each.position))));
}

function hatch() {
  let path = `M8 ${GROUND}H${WIDTH - 8}`;
  for (let at = 14; at < WIDTH - 8; at += 10) path += `M${at} ${GROUND}l-5 6`;
  return path;
}

function sprung(at, count) {
  return coil(GROUND - BASE, count > 4 ? 5 : 7).map(({ points, width }) => svg("polyline", {
    points: points.map(([u, v]) => `${(at + u).toFixed(1)},${(GROUND - v).toFixed(1)}`).join(" "),
    fill: "none", stroke: ink("soil"), "stroke-width": width,
  }));
}

function drawn({ kind }, at) {
  const tone = ink(colorOf(kind));
  const tendon = kind === "tendon";
  const [from, length] = tendon ? [GROUND + 10, GROUND + 6] : [GROUND, GROUND - BASE];
  return strokes(kind, length).map(({ points, width, fill }) => svg("polyline", {
    points: points.map(([u, v]) => `${(at + u).toFixed(1)},${(from - v).toFixed(1)}`).join(" "),
    fill: fill ? tone : "none", stroke: tone, "stroke-width": tendon ? 2 : width,
  }));
}

// The numbers below the ground, each in the highest row where it has room.
function numbers(places) {
  const rows = [];
  return places.map((at, i) => ({ at, i })).sort((a, b) => a.at - b.at).map(({ at, i }) => {
    let row = rows.findIndex((last) => at - last >= NUMBERS);
    if (row < 0) row = rows.length;
    rows[row] = at;
    return svg("text", { x: at, y: GROUND + 18 + 11 * Math.min(row, 1), "text-anchor": "middle", "font-size": 11, fill: ink("text") },
      String(i + 1));
  });
}
