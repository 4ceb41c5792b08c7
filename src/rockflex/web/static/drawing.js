// Symbols of what holds a base, springs, and how the base moves on them.

import { color } from "./dom.js";
import { t } from "./texts.js";
import { inUnit } from "./units.js";

// "2: Viscous damper at 0.8 m".
export function nameOf(about, each, place) {
  const title = `${place + 1}: ${t(about.elements[each.kind].title)}`;
  const [low, high] = each.between ?? [];
  if (each.between?.length === 2) return t("{element}, floors {low} to {high}", { element: title, low, high });
  if (each.height) return t("{element}, tie at {height}", { element: title, height: inUnit(each.height, "length") });
  return t("{element} at {position}", { element: title, position: inUnit(each.position ?? 0, "length") });
}

// Strokes in pixels, [across, along], of a symbol of the server that reaches from the ground to `length` along.
function strokes(symbol, length, half = 1) {
  return symbol.map(([points, width, filled]) => ({ points: points.map(([u, share]) => [half * u, share * length]), width, filled }));
}

// A symbol along the line from one point to another, with lines that are `more` px wider.
export function drawBetween(g, symbol, from, end, half, more = 0) {
  const [across, along] = [end[0] - from[0], end[1] - from[1]];
  g.save();
  g.translate(...from);
  g.rotate(Math.atan2(along, across) - Math.PI / 2);
  for (const { points, width, filled } of strokes(symbol, Math.hypot(across, along), half)) {
    g.lineWidth = width + more;
    g.beginPath();
    for (const [u, v] of points) g.lineTo(-u, v);
    if (filled) g.fill();
    else g.stroke();
  }
  g.restore();
}

const SLIDING = 1e-4; // m/s
const [LEAST, MOST] = [18, 70]; // px of a spring that is unloaded

// The pixels between the ground and the level of the unloaded springs: room for the base to sink, drawn at this scale.
export function depthOf(view, amplification, zoom) {
  if (!view.ground?.springs.length) return 0;
  const deepest = Math.max(...view.models.map((model) => model.peaks.max_edge_settlement));
  return Math.min(MOST, LEAST + zoom * amplification * deepest);
}

// How far a base has slid and risen in metres, whether it slides, and whether it is off the ground.
export function motionOf(model, [low, high, share], side) {
  const mix = (values) => (values ? values[low] + share * (values[high] - values[low]) : 0);
  const slides = Boolean(model.slip) && high > low
    && Math.abs(model.slip[high] - model.slip[low]) > SLIDING * (model.t[high] - model.t[low]);
  const sprung = Boolean(model.heave);
  return {
    slip: mix(model.slip), heave: mix(model.heave), slides, sprung,
    uplifted: sprung ? Boolean(model.uplifted[low]) && Boolean(model.uplifted[high]) : side !== 0,
    flies: sprung && Math.min(mix(model.left_edge), mix(model.right_edge)) > 0,
  };
}

// Springs from the ground to the base; those that the base has left stand at their full length, in a lighter tone.
export function drawSprings(g, symbol, springs, frame, to, depth) {
  const half = springs.length > 4 ? 2.5 : 5;
  for (const x of springs) {
    const [across, end] = to(frame.place(x, 0));
    const [, rest] = to([0, 0]);
    const lifted = end < rest;
    g.strokeStyle = color(lifted ? "control" : "soil");
    g.globalAlpha = lifted ? 0.7 : 1;
    drawBetween(g, symbol, [across, rest + depth], [across, lifted ? rest : end], half);
  }
  g.globalAlpha = 1;
}

// Marks in the ground below the edges where the base stood.
export function drawStance(g, edges, to, ground) {
  g.fillStyle = color("muted");
  for (const x of edges) {
    const [across] = to([x, 0]);
    g.beginPath();
    g.moveTo(across, ground + 2);
    g.lineTo(across - 4, ground + 10);
    g.lineTo(across + 4, ground + 10);
    g.fill();
  }
}
