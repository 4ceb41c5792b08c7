// The base on its ground in the moving drawing: how it moves there, the springs under it, and where it stood.

import { color } from "./dom.js";
import { coil } from "./symbols.js";

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
