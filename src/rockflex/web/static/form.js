// Fields with a label, a unit, limits, help and space for an error.

import { h, number, symbol } from "./dom.js";
import { keep, kept } from "./kept.js";
import { COMMA, t } from "./texts.js";
import { fromSI, inField, toSI, unitFor } from "./units.js";

let serial = 0;

// The range of a number in the unit `shown`, in words; with `name` it is that of the field of this name, and the numbers are in SI.
export function between(low, high, shown = "", name = "") {
  const { size, name: unit } = name ? unitFor(shown, name) : { size: 1, name: shown };
  return `${t("{low} to {high}", { low: number(low / size), high: number(high / size) })}${unit ? ` ${unit}` : ""}`;
}

// A field around any control; the server's messages about `path` appear in it. `unit` is that of SI: `element.unit` is shown.
export function field(path, label, control, { unit = "", hint = "", help = "", name = "" } = {}) {
  const id = control.id || `f${++serial}`;
  control.id = id;
  control.setAttribute("aria-describedby", hint ? `${id}-hint ${id}-error` : `${id}-error`);
  const sign = h("span", { class: "unit" });
  const element = h("div", { class: "field", "data-path": path },
    h("label", { for: id, title: help }, label),
    h("div", { class: "row" }, control, sign),
    hint ? h("div", { class: "hint", id: `${id}-hint` }, symbol(hint)) : null,
    trouble(`${id}-error`));
  element.setUnit = (si) => {
    element.unit = unitFor(si, name);
    element.dataset.si = element.unit.size === 1 ? "" : si;
    sign.textContent = element.unit.name;
    sign.hidden = !si;
  };
  element.setUnit(unit);
  if (typeof label === "string" && !path.startsWith("few.")) labels.set(path.split(".").at(-1), label.charAt(0).toLowerCase() + label.slice(1));
  return element;
}

// Space for the server's messages about the enclosing element.
export function trouble(id = null) {
  return h("div", { class: "error", role: "alert", id });
}

// Put every message next to its field, in place of those of the same root; return the messages without a field here.
export function showErrors(root, errors) {
  for (const element of root.querySelectorAll("[data-path]")) {
    const place = element.querySelector(":scope > .error");
    if ((place.root ?? root) !== root) continue; // a part of the form, such as the project, says what became of its own work
    place.textContent = "";
    for (const control of controls(element)) control.removeAttribute("aria-invalid");
  }
  const left = [];
  for (const [path, text] of Object.entries(errors)) {
    const parts = path.split(".");
    let element = null;
    for (; parts.length && !element; parts.pop())
      element = [...root.querySelectorAll(`[data-path="${CSS.escape(parts.join("."))}"]`)].find((each) => !each.closest("[hidden]"));
    if (!element && !root.querySelector(`[data-also~="${CSS.escape(path)}"]`)) {
      left.push(path ? `${path}: ${text}` : text);
      continue;
    }
    // A field in sight that shows the same value has the message as well, and the folded form stays folded.
    const twins = [...root.querySelectorAll(`[data-also~="${CSS.escape(path)}"]`)].filter((each) => !each.hidden);
    for (let folded = element?.closest("details"); folded && !twins.length; folded = folded.parentElement.closest("details")) folded.open = true;
    for (const each of [element, ...twins]) if (each) tellBeside(each, text, root);
  }
  return left;
}

function tellBeside(element, text, root) {
  const place = element.querySelector(":scope > .error");
  place.root = root;
  place.textContent = worded(element, text);
  // A message about a whole group does not concern its single fields.
  if (element.classList.contains("field"))
    for (const control of controls(element)) control.setAttribute("aria-invalid", "true");
}

const labels = new Map(); // of all fields so far, by their names in files and in Python
const POSITIVE = /^(?:it|\w+) must be a (zero or )?positive, finite number(?: in .*?)?, but (\S+) was given\.$/;
const RANGE = /^it must be from (\S+) to (\S+), but (\S+) was given\.$/;
const ONE_NAME = /\b[a-z]+(?:_[a-z0-9]+)+\b/g;

// A message in the words and units of the page, where its form is known.
function worded(element, text) {
  const label = element.classList.contains("field") ? element.querySelector("label")?.textContent : null;
  const { unit } = element;
  if (label && unit) {
    const shown = (value) => `${Number.isFinite(Number(value)) ? number(fromSI((element.times ?? 1) * Number(value), unit), 6) : value.replace("inf", "∞")} ${unit.name}`.trim();
    const [, zero, given] = POSITIVE.exec(text) ?? [];
    if (given) return zero ? t("{field} must be zero or positive, but {value} was given.", { field: label, value: shown(given) })
      : t("{field} must be positive, but {value} was given.", { field: label, value: shown(given) });
    const [, low, high, value] = RANGE.exec(text) ?? [];
    if (value) return t("{field} must be from {low} to {high}, but {value} was given.", { field: label, low: shown(low), high: shown(high), value: shown(value) });
  }
  const { si } = element.dataset;
  const plain = text.replace(ONE_NAME, (name) => labels.get(name) ?? name.replaceAll("_", " "));
  return si && /\d/.test(text) ? t("In SI units ({unit}): {message}", { unit: si, message: plain }) : plain.replace(/^[a-z](?=[a-z]* )/, (c) => c.toUpperCase());
}

function controls(element) {
  return element.querySelectorAll("input, select, textarea");
}

// A part of a form under its heading, open or closed as the visitor left the last one of this name.
export function folded(name, title, ...children) {
  const key = `rockflex-open-${name}`;
  const element = h("details", { class: "task", open: kept(key) === "true", "data-task": name,
    ontoggle: () => keep(key, element.open) }, h("summary", {}, title), children);
  return element;
}

const DECIMAL = /^[+-]?\d+,\d+(e[+-]?\d+)?$/i; // with a comma
const THOUSANDS = /^[+-]?[1-9]\d{0,2},\d{3}(\.\d*)?$/; // perhaps: in English 1,234 may be either
const unclear = (word) => !COMMA && THOUSANDS.test(word);

// Whether a text may be one of two numbers.
export const ambiguous = (text) => unclear(String(text).trim());

// Text that is not a number, or may be one of two, is sent unchanged: the server's message names the field.
export function parseNumber(text) {
  const clean = text.trim().replace("−", "-");
  if (/^[+]?(inf|infinity|∞)$/i.test(clean)) return "inf";
  const point = DECIMAL.test(clean) && !unclear(clean) ? clean.replace(",", ".") : clean;
  return point !== "" && Number.isFinite(Number(point)) ? Number(point) : clean;
}

// A comma within a number is a decimal comma where spaces or semicolons separate the numbers, or if there is `one`; else
// commas separate them. What may be either is sent unchanged.
function list(text, { one = false, separates = false } = {}) {
  const words = text.replaceAll("−", "-").split(/\s*,\s+|[;\s]+/).filter(Boolean);
  const commas = words.filter((word) => word.includes(","));
  if (!separates && commas.length) {
    const alone = !COMMA && words.length === 1 && !one && DECIMAL.test(words[0]) && !/^[+-]?0,/.test(words[0]);
    if (alone || words.some(unclear)) return words;
    if (commas.every((word) => DECIMAL.test(word))) return words.map(parseNumber);
  }
  return words.flatMap((word) => word.split(",")).filter(Boolean).map(parseNumber);
}

// Rows end with their lines, or with semicolons if there is one line.
function matrix(text) {
  const ends = text.trim().includes("\n") ? /;?\s*\n\s*/ : /;/;
  const found = text.split(ends).filter((row) => row.trim()).map((row) => list(row, { separates: !/\S[\s;]+\S/.test(row) }));
  return found.length === 1 ? found[0] : found;
}

// Numbers by their indices, such as 0: 3, 2: 6; other text is sent unchanged.
function map(text) {
  const words = text.replace(/[{}"']/g, " ").replace(/\s*[:=]\s*/g, ":").trim().split(/\s*,\s+|[;\s]+|,(?=\d+:)/);
  const pairs = words.filter(Boolean).map((word) => word.replace(/,$/, "").split(":"));
  return pairs.every(([index, value]) => /^\d+$/.test(index) && value)
    ? Object.fromEntries(pairs.map(([index, value]) => [index, parseNumber(value)])) : text;
}

function read(type, text) {
  if (text.trim() === "") return undefined;
  if (type === "matrix") return matrix(text);
  if (type === "list") return list(text);
  if (type === "list or map") return /[:=]/.test(text) ? map(text) : list(text);
  if (type === "indices") return list(text, { separates: true });
  if (type === "number or list") {
    const found = list(text, { one: true });
    return found.length === 1 ? found[0] : found;
  }
  return parseNumber(text);
}

// Show numbers with commas, or in the language's other sign, as they were understood.
function understood(control, value) {
  const clear = (each) => typeof each === "number" || (typeof each === "object" && Object.values(each).every(clear));
  if ((control.value.includes(",") || (COMMA && control.value.includes("."))) && clear(value)) control.value = write(value);
  return value;
}

function write(value) {
  if (value === undefined || value === null) return "";
  if (typeof value === "object" && !Array.isArray(value))
    return Object.entries(value).map(([index, each]) => `${index}: ${plain(each)}`).join(BETWEEN);
  if (!Array.isArray(value)) return plain(value);
  if (Array.isArray(value[0])) return value.map((row) => row.map(plain).join(COMMA ? " " : ", ")).join("\n");
  return value.map(plain).join(BETWEEN);
}

const BETWEEN = COMMA ? "; " : ", "; // numbers of a list

// With the decimal sign of the language, without long rows of zeros.
function plain(value) {
  const long = typeof value === "number" && Math.abs(value) >= 1e7;
  const digits = long ? value.toExponential().replace("e+", "e") : String(value);
  return COMMA && typeof value === "number" ? digits.replace(".", ",") : digits;
}

// One field of a table that the server describes; `change(value)` is called with undefined where it was left empty.
export function tableField(path, spec, value, change) {
  const shown = value ?? spec.default;
  const unit = unitFor(spec.unit ?? "", spec.name);
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
      onchange: () => change(toSI(understood(control, read(spec.type, control.value)), unit)),
    });
    control.value = write(inField(shown, unit));
  }
  const limits = spec.low === null ? "" : between(...fromSI([spec.low, spec.high], unit), unit.name);
  const typed = spec.type !== "flag" && spec.type !== "choice";
  const optional = typed && !spec.required ? t("optional") : "";
  const each = spec.type === "number or list" ? t("one number for all, or a list") : "";
  const hint = [t(spec.help).replace(/\.$/, ""), each, limits, optional].filter(Boolean).join("; ");
  const element = field(path, t(spec.label), control, { unit: spec.unit, name: spec.name, hint });
  element.setValue = (v) => document.activeElement !== control && (control.value = write(inField(v, unit)));
  return element;
}

// An optional table within a table; `change` gets the whole table, or undefined once it is removed.
export function tableGroup(path, spec, value, start, change) {
  let now = value;
  const element = h("fieldset", { class: "group", "data-path": path });
  const button = (text, next, focus) => h("button", {
    type: "button",
    onclick: () => {
      now = next();
      draw();
      element.querySelector(focus)?.focus();
      change(now);
    },
  }, text);
  function draw() {
    const inner = now ? spec.fields.map((each) => tableField(`${path}.${each.name}`, each, now[each.name], (v) => {
      now = { ...now, [each.name]: v };
      change(now);
    })) : [];
    element.replaceChildren(h("legend", {}, t(spec.label)), h("p", { class: "hint" }, symbol(t(spec.help))), ...inner,
      now ? button(t("Remove"), () => undefined, "button") : button(t("Add"), start, "input"), trouble());
  }
  draw();
  return element;
}

// A box for one or several numbers.
export function box(path, label, value, change, { many = false, digits, ...extra } = {}) {
  const control = h("input", {
    type: "text", inputmode: many ? "text" : "decimal", autocomplete: "off",
    onchange: () => change(toSI(understood(control, many ? list(control.value) : parseNumber(control.value)), element.unit)),
  });
  const element = field(path, label, control, extra);
  element.setValue = (v) => document.activeElement !== control && (control.value = write(digits ? fromSI(v, element.unit, digits) : inField(v, element.unit)));
  element.setValue(value);
  return element;
}

// A box for a file, which takes each file at once, the same one again too.
export function fileBox(accept, take, attributes = {}) {
  const input = h("input", {
    type: "file", accept, ...attributes,
    onchange: () => {
      const [chosen] = input.files;
      input.value = "";
      if (chosen) take(chosen);
    },
  });
  return input;
}

// Chips of which at least one stays chosen.
export function chips(path, label, options, chosen, change) {
  const group = h("div", { class: "chips", role: "group", "aria-label": label });
  const element = h("div", { class: "field", "data-path": path }, h("div", { class: "label" }, label), group, trouble());
  const chip = (now) => ([value, text]) => {
    const input = h("input", { type: "checkbox", value, checked: now.includes(value), onchange: () => {
      const next = [...group.querySelectorAll("input:checked")].map((each) => each.value);
      if (next.length) change(next);
      else input.checked = true;
    } });
    return h("label", {}, input, text);
  };
  element.setOptions = (next, now) => {
    const key = JSON.stringify([next, now]);
    if (key === element.dataset.drawn) return;
    element.dataset.drawn = key;
    const focused = group.contains(document.activeElement) ? document.activeElement.value : null;
    group.replaceChildren(...next.map(chip(now)));
    if (focused !== null) group.querySelector(`[value="${CSS.escape(focused)}"]`)?.focus();
  };
  element.setOptions(options, chosen);
  return element;
}

// A slider with a box for the number; `change` is told whether the slider still moves.
export function slider(path, label, { low, high, step, unit = "", hint = "", log = false }, value, change) {
  const to = log ? Math.log10 : (v) => v;
  const from = log ? (v) => Number((10 ** v).toPrecision(3)) : Number;
  const range = h("input", {
    type: "range", min: to(low), max: to(high), step: log ? 0.005 : step, "aria-label": label,
    oninput: () => {
      entry.value = plain(fromSI(from(range.value), element.unit, 3));
      say();
      change(toSI(parseNumber(entry.value), element.unit), true);
    },
    onchange: () => change(toSI(parseNumber(entry.value), element.unit), false),
  });
  const entry = h("input", {
    type: "text", class: "short", inputmode: "decimal", autocomplete: "off",
    onchange: () => {
      const given = toSI(understood(entry, parseNumber(entry.value)), element.unit);
      range.value = to(Number(given));
      change(given);
    },
  });
  const element = field(path, label, entry, { unit, hint: hint || between(low, high, unit) });
  element.querySelector(".row").prepend(range);
  const say = () => range.setAttribute("aria-valuetext", `${entry.value} ${element.unit.name}`.trim());
  element.setValue = (v) => {
    if (document.activeElement !== entry) entry.value = write(inField(v, element.unit));
    if (document.activeElement !== range) range.value = to(v);
    say();
  };
  element.setValue(value);
  return element;
}

export function select(path, label, options, value, change, extra = {}) {
  const control = h("select", { onchange: () => change(control.value) });
  const element = field(path, label, control, extra);
  element.setOptions = (next, chosen = control.value) => {
    control.replaceChildren(...next.map(([key, text]) => h("option", { value: key }, text)));
    control.value = chosen;
  };
  element.setValue = (v) => (control.value = v);
  element.setOptions(options, value);
  return element;
}
