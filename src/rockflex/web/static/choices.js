// Models, intensity measures and suites to choose from.

import { clone, h } from "./dom.js";
import { trouble } from "./form.js";
import { t } from "./texts.js";
import { unitFor } from "./units.js";

const MODELS = [
  ["MDOF-S", t("all modes, small rotations")],
  ["2DOF-S", t("first mode, small rotations")],
  ["3DOF-S", t("two modes, small rotations")],
  ["2DOF-S-R", t("first mode; its forces include the mass of the other modes")],
  ["2DOF-C", t("first mode, large rotations")],
  ["MDOF-C-SI", t("all modes, large rotations")],
  ["rigid", t("no modes: a rigid block")],
  ["fixed", t("all modes, base held down")],
];
const YIELDING = [
  ["2DOF-S-BW", t("first mode, which yields; small rotations")],
  ["2DOF-C-BW", t("first mode, which yields; large rotations")],
  ["1DOF-fixed-BW", t("first mode, which yields; base held down")],
];

const RIGID = ["block", "rocking_frame"]; // kinds of structures without modes, which all models but one need

export const isRigid = (structure) => RIGID.some((kind) => kind in structure);

// The label of a model with its words, where it has some.
export function explained(label) {
  const found = [...MODELS, ...YIELDING].find(([known]) => known === label);
  return found ? `${label}: ${found[1]}` : label;
}

// Whether a model can stand on springs, or slide.
export const grounded = (label) => !/fixed/.test(label);

export const yields = (label) => label.includes("-BW");

export function models(path, chosen, most, change) {
  let now = clone(chosen);
  let offered = MODELS;
  const chips = h("div", { class: "chips models", role: "group", "aria-label": t("Models") });
  const other = h("input", {
    type: "text", placeholder: t("another, e.g. 4DOF-S or 3DOF-S-R"), "aria-label": t("Another model"), maxlength: 30,
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
      type: "checkbox", checked, disabled, "data-label": label, "aria-label": label, title,
      onchange: () => {
        commit(box.checked ? [...now, label] : now.filter((each) => each !== label));
        chips.querySelector(`[data-label="${CSS.escape(label)}"]`)?.focus();
      },
    });
    return h("label", {}, box, label, title === label ? null : h("span", { class: "hint" }, title));
  }

  function draw() {
    const others = now.filter((label) => !offered.some(([known]) => known === label));
    chips.replaceChildren(...[...offered, ...others.map((label) => [label, label])].map(chip));
  }

  draw();
  const element = h("div", { class: "field", "data-path": path },
    h("div", { class: "label" }, t("Models (up to {most})", { most })), chips, other, trouble());
  // The chosen models of a state, which may have some that yield; a rigid structure has one model.
  element.setValue = (value, { structure, bouc_wen }) => {
    now = clone(value);
    const rigid = isRigid(structure);
    offered = rigid ? MODELS.filter(([label]) => label === "rigid") : bouc_wen ? [...MODELS, ...YIELDING] : MODELS;
    other.hidden = rigid;
    const key = JSON.stringify([now, offered]);
    if (key === element.dataset.drawn) return;
    element.dataset.drawn = key;
    draw();
  };
  return element;
}

// Values and titles for a list; the search for a width excludes measures that depend on the base.
export function measuresOf(about, ofBase) {
  const offered = about.measures.filter((each) => ofBase || !each.of_base);
  return offered.map((each) => [each.name, t(each.title)]);
}

const named = (about, name) => about.measures.find((each) => each.name === name);

export const unitOf = (about, name) => named(about, name).unit;

// Short name of a measure with the unit that is shown, for an axis.
export function axisOf(about, name) {
  const { axis, unit } = named(about, name);
  return unit ? `${axis} [${unitFor(unit).name}]` : axis;
}

export const GIVEN = "given"; // the folder of the visitor among the suites
export const CHOSEN = "chosen"; // and the records for the target spectrum

// Suites of many records, with short names; the folder if there is one, or it is among those chosen; and the records for
// the target spectrum, unless others are to be chosen for it.
export function suitesOf({ about, state }, chosen = [], forTarget = false) {
  const many = about.suites.filter((name) => name !== "el-centro-1940").map((name) => [name, name.replace("fema-p695-", "")]);
  const own = [];
  if (state.record.folder || chosen.includes(GIVEN) || (forTarget && state.target.source === GIVEN)) own.push([GIVEN, t("your folder")]);
  if (!forTarget && (state.target.shown || state.record_set.shown || chosen.includes(CHOSEN))) own.push([CHOSEN, t("records for the target")]);
  return [...many, ...own];
}
