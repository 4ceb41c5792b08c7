// Chips to choose models by, and a box for labels that are not among them.

import { clone, h } from "./dom.js";
import { trouble } from "./form.js";

const MODELS = [
  ["MDOF-S", "Simplified, all modes"],
  ["2DOF-S", "Simplified, one mode"],
  ["3DOF-S", "Simplified, two modes"],
  ["2DOF-S-R", "As 2DOF-S; base shear and base moment also count the mass of the modes that are left out"],
  ["2DOF-C", "Complete, one mode: large rotations"],
  ["MDOF-C-SI", "Complete, all modes"],
  ["rigid", "Rigid block"],
  ["fixed", "The same structure on a base that cannot lift"],
];
const YIELDING = [
  ["2DOF-S-BW", "Simplified, one mode, which yields"],
  ["2DOF-C-BW", "Complete, one mode, which yields"],
  ["1DOF-fixed-BW", "One mode, which yields, on a base that cannot lift"],
];

export const yields = (label) => label.includes("-BW");

export function models(path, chosen, most, change) {
  let now = clone(chosen);
  let offered = MODELS;
  const chips = h("div", { class: "chips", role: "group", "aria-label": "Models" });
  const other = h("input", {
    type: "text", placeholder: "another, such as 4DOF-S or 3DOF-S-R", "aria-label": "Another model", maxlength: 30,
    onchange: () => {
      const label = other.value.trim();
      other.value = "";
      if (label && !now.includes(label)) commit([...now, label]);
    },
  });

  function commit(next) {
    now = next;
    draw();
    change(clone(now));
  }

  function chip([label, title]) {
    const checked = now.includes(label);
    const disabled = checked ? now.length === 1 : now.length >= most;
    const box = h("input", {
      type: "checkbox", checked, disabled, "data-label": label,
      onchange: () => {
        commit(box.checked ? [...now, label] : now.filter((each) => each !== label));
        chips.querySelector(`[data-label="${CSS.escape(label)}"]`)?.focus();
      },
    });
    return h("label", { title }, box, label);
  }

  function draw() {
    const others = now.filter((label) => !offered.some(([known]) => known === label));
    chips.replaceChildren(...[...offered, ...others.map((label) => [label, label])].map(chip));
  }

  draw();
  const element = h("div", { class: "field", "data-path": path },
    h("div", { class: "label" }, `Models (up to ${most})`), chips, other, trouble());
  // Those chosen, and whether models that yield are offered, too.
  element.setValue = (value, yielding = false) => {
    now = clone(value);
    offered = yielding ? [...MODELS, ...YIELDING] : MODELS;
    const key = JSON.stringify([now, offered]);
    if (key === element.dataset.drawn) return;
    element.dataset.drawn = key;
    draw();
  };
  return element;
}
