// How the lines of several models or designs are distinguished: by colour, and by dashes for the colour-blind.

const LOOKS = [
  { color: "c0", dash: [] },
  { color: "c1", dash: [7, 3] },
  { color: "c2", dash: [2, 2] },
  { color: "c3", dash: [7, 2, 2, 2] },
];
const FIXED = [
  { color: "fixed", dash: [4, 3] },
  { color: "fixed2", dash: [10, 4] },
  { color: "fixed", dash: [1, 3] },
  { color: "fixed2", dash: [4, 2, 1, 2] },
];

export const look = (i) => LOOKS[i % LOOKS.length];

// A look for each of several models; those on a fixed base have separate looks.
export function looks(models) {
  let lifting = 0;
  let fixed = 0;
  return models.map((model) => (model.lifts ? look(lifting++) : FIXED[fixed++ % FIXED.length]));
}
