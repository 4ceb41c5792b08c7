// Fields with a label, a unit, limits, help and room for an error.

import { clone, h, number } from "./dom.js";

let serial = 0;

// A field around any control; `path` is where the server's messages about it go.
export function field(path, label, control, { unit = "", hint = "", help = "" } = {}) {
  const id = control.id || `f${++serial}`;
  control.id = id;
  if (hint) control.setAttribute("aria-describedby", `${id}-hint`);
  return h("div", { class: "field", "data-path": path },
    h("label", { for: id, title: help }, label),
    h("div", { class: "row" }, control, unit ? h("span", { class: "unit" }, unit) : null),
    hint ? h("div", { class: "hint", id: `${id}-hint` }, hint) : null,
    h("div", { class: "error", role: "alert" }));
}

// Put every message beside its field; return those that have none here.
export function showErrors(root, errors) {
  for (const element of root.querySelectorAll("[data-path]")) {
    element.querySelector(":scope > .error").textContent = "";
    for (const control of element.querySelectorAll("input, select, textarea")) control.removeAttribute("aria-invalid");
  }
  const left = [];
  for (const [path, text] of Object.entries(errors)) {
    const parts = path.split(".");
    let element = null;
    for (; parts.length && !element; parts.pop()) element = root.querySelector(`[data-path="${CSS.escape(parts.join("."))}"]`);
    if (!element) {
      left.push(path ? `${path}: ${text}` : text);
      continue;
    }
    element.querySelector(":scope > .error").textContent = text.replace(/^[a-z](?=[a-z]* )/, (c) => c.toUpperCase());
    for (const control of element.querySelectorAll("input, select, textarea")) control.setAttribute("aria-invalid", "true");
  }
  return left;
}

export function parseNumber(text) {
  const clean = text.trim().replace("−", "-");
  if (/^[+]?(inf|infinity|∞)$/i.test(clean)) return "inf";
  // What is no number is sent as it is: the server's message names the field.
  return clean !== "" && Number.isFinite(Number(clean)) ? Number(clean) : clean;
}

const list = (text) => text.split(/[,;\s]+/).filter(Boolean).map(parseNumber);
const rows = (text) => text.split(/[\n;]+/).map((line) => line.trim()).filter(Boolean).map(list);

function read(type, text) {
  if (text.trim() === "") return undefined;
  if (type === "matrix") {
    const found = rows(text);
    return found.length === 1 ? found[0] : found;
  }
  if (type === "list" || type === "indices") return list(text);
  if (type === "number or list") {
    const found = list(text);
    return found.length === 1 ? found[0] : found;
  }
  return parseNumber(text);
}

function write(value) {
  if (value === undefined || value === null) return "";
  if (!Array.isArray(value)) return typeof value === "object" ? JSON.stringify(value) : String(value);
  if (Array.isArray(value[0])) return value.map((row) => row.join(", ")).join("\n");
  return value.join(", ");
}

// One field of a table that the server describes; `change(value)` is called with undefined where it was left empty.
export function tableField(path, spec, value, change) {
  const shown = value ?? spec.default;
  let control;
  if (spec.type === "choice") {
    control = h("select", { onchange: () => change(control.value) },
      spec.choices.map((choice) => h("option", { value: choice }, choice)));
    control.value = shown ?? spec.choices[0];
  } else if (spec.type === "flag") {
    control = h("input", { type: "checkbox", checked: Boolean(shown), onchange: () => change(control.checked) });
  } else {
    const many = spec.type === "matrix";
    control = h(many ? "textarea" : "input", {
      type: many ? null : "text", inputmode: many ? null : "text", spellcheck: "false", autocomplete: "off",
      value: write(shown), onchange: () => change(read(spec.type, control.value)),
    });
  }
  const limits = spec.low === null ? "" : `${number(spec.low)} to ${number(spec.high)}${spec.unit ? ` ${spec.unit}` : ""}`;
  const optional = spec.required ? "" : "may be left empty";
  const hint = [spec.help.replace(/\.$/, ""), limits, optional].filter(Boolean).join("; ");
  return field(path, spec.label, control, { unit: spec.unit, hint });
}

// A slider beside a box for the number itself.
export function slider(path, label, { low, high, step, unit = "", hint = "", log = false }, value, change) {
  const to = log ? Math.log10 : (v) => v;
  const from = log ? (v) => Number((10 ** v).toPrecision(3)) : Number;
  const range = h("input", {
    type: "range", min: to(low), max: to(high), step: log ? 0.005 : step, "aria-label": label,
    oninput: () => {
      box.value = from(range.value);
      change(Number(box.value));
    },
  });
  const box = h("input", {
    type: "text", inputmode: "decimal", autocomplete: "off", value,
    onchange: () => {
      range.value = to(Number(box.value));
      change(parseNumber(box.value));
    },
  });
  box.className = "short";
  range.value = to(value);
  const element = field(path, label, box, { unit, hint: hint || `${number(low)} to ${number(high)}${unit ? ` ${unit}` : ""}` });
  element.querySelector(".row").prepend(range);
  element.setValue = (v) => {
    if (document.activeElement !== box) box.value = v;
    if (document.activeElement !== range) range.value = to(v);
  };
  return element;
}

export function select(path, label, options, value, change, extra = {}) {
  const control = h("select", { onchange: () => change(control.value) },
    options.map(([key, text]) => h("option", { value: key }, text)));
  control.value = value;
  const element = field(path, label, control, extra);
  element.setValue = (v) => (control.value = v);
  return element;
}

const MODELS = [
  ["MDOF-S", "Simplified, all modes"], ["2DOF-S", "Simplified, one mode"], ["3DOF-S", "Simplified, two modes"],
  ["2DOF-C", "Complete, one mode: large rotations"], ["MDOF-C-SI", "Complete, all modes"], ["rigid", "Rigid block"],
  ["fixed", "The same structure on a base that cannot lift"],
];

// Chips to choose models by, and a box for labels that are not among them.
export function models(path, chosen, most, change) {
  let now = clone(chosen);
  const chips = h("div", { class: "chips", role: "group", "aria-label": "Models" });
  const other = h("input", { type: "text", placeholder: "another, such as 4DOF-S", "aria-label": "Another model", maxlength: 30,
    onchange: () => {
      const label = other.value.trim();
      other.value = "";
      if (label && !now.includes(label)) commit([...now, label]);
    } });
  const commit = (next) => {
    now = next;
    draw();
    change(clone(now));
  };
  function draw() {
    const known = [...MODELS, ...now.filter((label) => !MODELS.some(([l]) => l === label)).map((label) => [label, label])];
    chips.replaceChildren(...known.map(([label, title]) => {
      const checked = now.includes(label);
      const box = h("input", { type: "checkbox", checked, disabled: (checked && now.length === 1) || (!checked && now.length >= most),
        onchange: () => {
          commit(box.checked ? [...now, label] : now.filter((each) => each !== label));
          chips.querySelector(`[data-label="${CSS.escape(label)}"]`)?.focus();
        }, "data-label": label });
      return h("label", { title }, box, label);
    }));
  }
  draw();
  const element = h("div", { class: "field", "data-path": path },
    h("div", { class: "label" }, `Models (up to ${most})`), chips, other, h("div", { class: "error", role: "alert" }));
  element.setValue = (v) => {
    if (JSON.stringify(v) === JSON.stringify(now)) return;
    now = clone(v);
    draw();
  };
  return element;
}
