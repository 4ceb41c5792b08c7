// The form of a cross-section in the place of stiffness and mass: a shape with its sizes and material, or several parts.

import { h } from "../dom.js";
import { select, tableField, trouble } from "../form.js";

const SHAPES = [
  ["", "none: EI and mass are given"], ["rectangle", "rectangle"], ["box", "hollow box"], ["circle", "circle"],
  ["tube", "hollow circle"], ["composite", "composite of several parts"],
];
// New sizes in m by shape.
const SIZES = {
  rectangle: { width: 1, depth: 1.5 }, box: { width: 2, depth: 2, wall: 0.25 }, circle: { diameter: 1.5 }, tube: { diameter: 1.5, wall: 0.2 },
};
const MATERIALS = [
  ["concrete", { elastic_modulus: 3e10, density: 2500 }], ["steel", { elastic_modulus: 2.1e11, density: 7850 }],
  ["timber", { elastic_modulus: 1.1e10, density: 450 }], ["masonry", { elastic_modulus: 5e9, density: 1900 }],
];
const [CONCRETE, STEEL] = MATERIALS.map(([, values]) => values);
const OF_MATERIAL = ["elastic_modulus", "density"];
const MOST = 20; // parts

export const REPLACED = ["bending_stiffness", "mass", "mass_per_length"]; // what a section gives

// `current` returns the present section; `change(section, anew)` takes another one, or undefined for none; `anew` if other
// fields are needed then.
export function section(about, path, spec, current, change) {
  const drawn = current();
  const shape = drawn?.shape ?? "";
  const partSpecs = about.section_part;
  const choose = select(`${path}.shape`, "Cross-section", SHAPES, shape, (name) => change(turned(name), true),
    { hint: "in place of bending stiffness and mass" });

  // The same material in another shape.
  function turned(name) {
    if (!name) return undefined;
    if (name === "composite") {
      const core = { shape: "circle", diameter: 0.96, ...CONCRETE, offset: 0 };
      return { shape: name, parts: [{ shape: "tube", diameter: 1, wall: 0.02, ...STEEL, offset: 0 }, core] };
    }
    const value = current();
    const now = value?.shape === "composite" ? value.parts[0] : value;
    const kept = Object.fromEntries(OF_MATERIAL.map((key) => [key, now?.[key] ?? CONCRETE[key]]));
    const factor = value?.stiffness_factor === undefined ? {} : { stiffness_factor: value.stiffness_factor };
    return { shape: name, ...SIZES[name], ...kept, ...factor };
  }

  // `get` returns the present table of the field.
  const field = (place, specs, name, get, put) => {
    const found = specs.find((each) => each.name === name);
    const needed = name !== "stiffness_factor" && name !== "offset";
    const { shape: of, [name]: value } = get();
    return tableField(`${place}.${name}`, { ...found, required: needed }, value, (next) => {
      const table = get();
      if (table?.shape === of) put(with_(table, name, next)); // a field that is removed reports a change begun in it
    });
  };

  // A list that fills in the material.
  function material(get, put) {
    const same = MATERIALS.find(([, values]) => OF_MATERIAL.every((key) => values[key] === get()[key]));
    const names = [...MATERIALS.map(([name]) => [name, name]), ["", "own values"]];
    return select("section.material", "Material", names, same?.[0] ?? "", (name) => {
      const found = MATERIALS.find(([each]) => each === name);
      if (found) put({ ...get(), ...found[1] }, true);
    });
  }

  const fieldsOf = (place, specs, get, more, put) => [
    ...Object.keys(SIZES[get().shape] ?? {}).map((name) => field(place, specs, name, get, put)),
    material(get, put),
    ...[...OF_MATERIAL, ...more].map((name) => field(place, specs, name, get, put)),
  ];

  function part(each, i) {
    const place = `${path}.parts.${i}`;
    const get = () => current()?.parts?.[i];
    const parts = (next, anew) => change({ ...current(), parts: next }, anew);
    const put = (next, anew) => parts(current().parts.with(i, next), anew);
    const own = select(`${place}.shape`, "Shape", SHAPES.slice(1, -1), each.shape, (name) => {
      const { elastic_modulus, density, offset } = get();
      put({ shape: name, ...SIZES[name], elastic_modulus, density, offset }, true);
    });
    const remove = h("button", { type: "button", onclick: () => (
      parts(current().parts.filter((_, j) => j !== i), true)) }, "Remove");
    return h("fieldset", { class: "group", "data-path": place }, h("legend", {}, `Part ${i + 1}`), own,
      fieldsOf(place, partSpecs, get, ["offset"], put), drawn.parts.length > 1 ? remove : null, trouble());
  }

  const inner = [];
  if (shape === "composite") {
    const add = h("button", { type: "button", disabled: drawn.parts.length >= MOST, onclick: () => {
      const { parts } = current();
      change({ ...current(), parts: [...parts, { ...parts.at(-1) }] }, true);
    } }, "Add a part");
    inner.push(...drawn.parts.map(part), add, field(path, spec.fields, "stiffness_factor", current, change));
  } else if (shape) inner.push(...fieldsOf(path, spec.fields, current, ["stiffness_factor"], change));
  return h("div", { class: "section", "data-path": path }, choose, inner, trouble());
}

function with_(table, name, next) {
  const { [name]: _, ...rest } = table;
  return next === undefined ? rest : { ...rest, [name]: next };
}
