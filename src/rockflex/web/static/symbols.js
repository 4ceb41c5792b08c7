// The elements between the base and the ground: their names and colours, and the strokes that draw them.

const COLORS = { tendon: "tendons", yielding_dissipator: "fuse", viscous_damper: "damper", friction_damper: "friction" };

export const colorOf = (kind) => COLORS[kind];

// "2: Viscous damper at 0.8 m".
export function nameOf(about, each, place) {
  const x = each.position ?? 0;
  return `${place + 1}: ${about.elements[each.kind].title} at ${String(Number(Number(x).toPrecision(4))).replace("-", "−")} m`;
}

// Strokes in pixels, [across, along], of an element that reaches from the ground to `length` along.
export function strokes(kind, length) {
  const at = (share) => share * length;
  if (kind === "yielding_dissipator") return fuse(at);
  if (kind === "viscous_damper") return dashpot(at);
  if (kind === "friction_damper") return plates(at);
  return [{ points: [[0, 0], [0, length]], width: 1.5 }];
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
