// Strokes and colours of the parts of a drawing: elements between base and ground, springs, and how the base moves on them.

import { color } from "./dom.js";
import { t } from "./texts.js";
import { inUnit } from "./units.js";

const COLORS = { tendon: "tendons", yielding_dissipator: "fuse", viscous_damper: "damper", friction_damper: "friction" };

const DRAWN = { strand_tendon: "tendon", bar_fuse: "yielding_dissipator", u_plate_fuse: "yielding_dissipator" };

export const colorOf = (kind) => COLORS[DRAWN[kind] ?? kind] ?? "fuse";
export const isTendon = (kind) => colorOf(kind) === "tendons";

// "2: Viscous damper at 0.8 m".
export function nameOf(about, each, place) {
  const title = `${place + 1}: ${t(about.elements[each.kind].title)}`;
  const [low, high] = each.between ?? [];
  if (each.between?.length === 2) return t("{element}, floors {low} to {high}", { element: title, low, high });
  if (each.height) return t("{element}, tie at {height}", { element: title, height: inUnit(each.height, "length") });
  return t("{element} at {position}", { element: title, position: inUnit(each.position ?? 0, "length") });
}

// Strokes in pixels, [across, along], of an element that reaches from the ground to `length` along.
export function strokes(kind, length) {
  const at = (share) => share * length;
  const parts = { yielding_dissipator: fuse, viscous_damper: dashpot, friction_damper: plates }[DRAWN[kind] ?? kind];
  return parts?.(at) ?? [{ points: [[0, 0], [0, length]], width: 1.5 }];
}

// A coil spring from the ground to `length` along, `half` wide to either side.
export function coil(length, half) {
  const turns = [0.12, 0.24, 0.4, 0.56, 0.72, 0.88].map((share, i) => [i === 0 || i === 5 ? 0 : i % 2 ? half : -half, share * length]);
  return [{ points: [[0, 0], ...turns, [0, length]], width: 1.4 }];
}

// A bar, thick where it is held and narrow where it yields.
function fuse(at) {
  const [a, b, c, d] = [0.26, 0.36, 0.64, 0.74].map(at);
  return [{
    points: [[-3.5, 0], [-3.5, a], [-1.2, b], [-1.2, c], [-3.5, d], [-3.5, at(1)],
      [3.5, at(1)], [3.5, d], [1.2, c], [1.2, b], [3.5, a], [3.5, 0]],
    fill: true, width: 1,
  }];
}

// A piston in a cylinder.
function dashpot(at) {
  const [low, middle, high] = [0.2, 0.5, 0.75].map(at);
  return [
    { points: [[0, 0], [0, low]], width: 1.8 },
    { points: [[-5, high], [-5, low], [5, low], [5, high]], width: 1.8 },
    { points: [[-3.2, middle], [3.2, middle]], width: 2.6 },
    { points: [[0, middle], [0, at(1)]], width: 1.8 },
  ];
}

// Two plates that slide on each other, with the bolt that clamps them.
function plates(at) {
  return [
    { points: [[-1.7, 0], [-1.7, at(0.68)]], width: 3 },
    { points: [[1.7, at(0.32)], [1.7, at(1)]], width: 3 },
    { points: [[-6, at(0.5)], [6, at(0.5)]], width: 1.8 },
    { points: [[-6, at(0.5) - 3], [-6, at(0.5) + 3]], width: 1.8 },
    { points: [[6, at(0.5) - 3], [6, at(0.5) + 3]], width: 1.8 },
  ];
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
export function drawSprings(g, springs, frame, to, depth) {
  const half = springs.length > 4 ? 2.5 : 5;
  for (const x of springs) {
    const [across, end] = to(frame.place(x, 0));
    const [, rest] = to([0, 0]);
    const lifted = end < rest;
    const foot = rest + depth;
    g.strokeStyle = color(lifted ? "control" : "soil");
    g.globalAlpha = lifted ? 0.7 : 1;
    for (const { points, width } of coil(foot - (lifted ? rest : end), half)) {
      g.lineWidth = width;
      g.beginPath();
      for (const [u, v] of points) g.lineTo(across + u, foot - v);
      g.stroke();
    }
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
