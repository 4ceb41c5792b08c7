// The form of the elements between the base and the ground: any kinds, in any number.

import { h } from "../dom.js";
import { select, tableField, trouble } from "../form.js";
import { nameOf } from "../symbols.js";
import { ELEMENTS } from "./starts.js";

// `current` returns a copy of the structure, `put` takes the changed one.
export function elements({ about }, current, put) {
  const titles = Object.entries(about.elements).map(([name, { title }]) => [name, title]);
  const most = about.limits.elements;
  const rows = h("div");
  const kind = h("select", { id: "new-element", "aria-label": "Element to add" },
    titles.map(([name, title]) => h("option", { value: name }, title)));
  const add = h("button", { type: "button", onclick: () => {
    change((list) => [...list, { kind: kind.value, ...ELEMENTS[kind.value] }]);
    const last = rows.lastElementChild;
    last.open = true;
    last.querySelector("select").focus();
  } }, "Add an element");
  const element = h("fieldset", { "data-path": "structure.elements" }, h("legend", {}, "Elements at the base"),
    h("p", { class: "hint" }, "Between the base and the ground, at the given distance from the axis of the masses."),
    rows, h("div", { class: "buttons" }, add, kind), trouble());

  // Change the list and draw it again.
  function change(next) {
    const structure = current();
    const list = next(structure.elements ?? []);
    if (list.length) structure.elements = list;
    else delete structure.elements;
    draw(list);
    put(structure);
  }

  function draw(list) {
    const open = [...rows.children].map((row) => row.open);
    rows.replaceChildren(...list.map((each, i) => row(each, i, open[i] ?? list.length < 2)));
    add.disabled = list.length >= most;
  }

  function row(each, i, open) {
    const path = `structure.elements.${i}`;
    const summary = h("summary", {}, nameOf(about, each, i));
    const other = select(`${path}.kind`, "Element", titles, each.kind, (name) => {
      change((list) => list.with(i, turned(list[i], name)));
      rows.children[i].querySelector("select").focus();
    });
    const fields = about.elements[each.kind].fields.map((spec) => tableField(`${path}.${spec.name}`, spec, each[spec.name], (value) => {
      const structure = current();
      if (value === undefined) delete structure.elements[i][spec.name];
      else structure.elements[i][spec.name] = value;
      summary.textContent = nameOf(about, structure.elements[i], i);
      put(structure);
    }));
    const remove = h("button", { type: "button", onclick: () => {
      rows.children[i].remove(); // so that the others stay open or closed
      change((list) => list.filter((_, j) => j !== i));
      add.focus();
    } }, "Remove");
    return h("details", { open, "data-path": path }, summary, other, fields, remove, trouble());
  }

  // An element of another kind, with the values that both kinds have.
  function turned(each, name) {
    const kept = about.elements[name].fields.map((spec) => spec.name).filter((key) => key in each);
    return { kind: name, ...ELEMENTS[name], ...Object.fromEntries(kept.map((key) => [key, each[key]])) };
  }

  element.draw = draw;
  return element;
}
