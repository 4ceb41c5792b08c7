// Matrices from a file of a finite element program.

import { attempt, send } from "../api.js";
import { h, tooLarge } from "../dom.js";
import { fileBox, trouble } from "../form.js";

const PARTS = ["mass", "stiffness", "heights", "rotations"];
const REST = { base_mass: 0, half_width: 1, damping_ratio: 0.02 };

// `structure` returns the present structure, `put` takes the one with the matrices.
export function importing(limit, structure, put) {
  const part = h("select", { id: "part" }, PARTS.map((name) => h("option", { value: name }, name)));
  const input = fileBox(".npz,.csv", take, { "aria-label": "File of matrices" });
  const said = trouble();

  async function take(file) {
    said.textContent = tooLarge(file, limit);
    if (said.textContent) return;
    await attempt(async () => {
      const found = await send(`/api/matrices?name=${encodeURIComponent(file.name)}&part=${part.value}`, file);
      const now = structure();
      const name = now.matrices ? now.name : file.name.replace(/\.\w+$/, "");
      const kept = { ...(now.matrices ?? REST) };
      if (found.stiffness && /\.npz$/i.test(file.name)) for (const each of PARTS) delete kept[each]; // of another structure
      put({ name, matrices: { ...kept, ...found } });
    }, (error) => {
      said.textContent = Object.values(error.errors).join(" ");
    });
  }

  return h("fieldset", { "data-path": "import" }, h("legend", {}, "Import matrices"),
    h("p", { class: "help" }, "From any finite element program: a .npz file with the arrays mass, stiffness, heights and, if there",
      " are any, rotations, or one CSV file for each. Units: kg, N/m, m, rad; fixed base."),
    h("p", { class: "hint" }, "heights: one for each degree of freedom, nan for those that do not move sideways; or rows of an",
      " index and a height. rotations: the indices of the rotations in the plane, counted from 0; they need no height. Degrees",
      " of freedom without mass are condensed out."),
    h("div", { class: "buttons" }, h("label", { for: "part" }, "CSV contains"), part), input, said);
}
