// The units in which values are shown and typed; the state, links and files are in SI units.

import { number } from "./dom.js";
import { t } from "./texts.js";

let table = {}; // units of each system by the kind of quantity
let system = "";
let [peaks, outputs] = [{}, {}]; // symbol, quantity and words of each peak of a run, and of each quantity over time too

export function setUnits(about, name) {
  [table, peaks, outputs, system] = [about.units, about.outputs, { ...about.histories, ...about.outputs }, name];
}

// The unit of a kind of quantity; the system "kN" has that of `usual`: accelerations are in m/s² there.
export const unit = (quantity, usual = quantity === "acceleration" ? "SI" : "kN") => table[system === "kN" ? usual : system][quantity];

// Kinds of quantities of which others have the same unit in SI; angles that are no rotations are in rad in every system.
const KINDS = { m: "length", "N/m²": "elastic modulus", Pa: "stress", rad: "" };

const OF_NAME = { shear_modulus: "shear modulus", rotation: "rotation" }; // fields whose usual unit is not that of others with this one

// The unit that is shown for one of SI, of a field of this name.
export function unitFor(si, name = "") {
  const quantity = OF_NAME[name] ?? KINDS[si] ?? Object.keys(table.SI).find((each) => table.SI[each].name === si);
  return quantity ? unit(quantity) : { size: 1, name: si };
}

// A text with the name of its unit in place of "{unit}".
export const titled = (text, quantity) => text.replace("{unit}", unit(quantity).name);

export const valueIn = (value, quantity, digits) => number(fromSI(value, unit(quantity)), digits);

// Of an output by its name: what heads its column, its value and unit, and what it is.
export const headed = (name) => titled(`${t(outputs[name].symbol)} [{unit}]`, outputs[name].quantity);
export const outputUnit = (name) => unit(outputs[name].quantity);
export const outputIn = (name, value, digits) => valueIn(value, outputs[name].quantity, digits);
export const outputInUnit = (name, value, digits) => inUnit(value, outputs[name].quantity, digits);
export const outputsOf = (runs) => Object.keys(peaks).filter((name) => peaks[name].of === runs);
export const explainedOutputs = (names) => names.map((name) => `${t(outputs[name].symbol)}: ${t(outputs[name].words)}`).join("; ");

export const inUnit = (value, quantity, digits) => `${valueIn(value, quantity, digits)} ${unit(quantity).name}`;

// Numbers, and those in lists, maps and matrices; words such as "inf" stay.
export function eachNumber(value, change) {
  if (typeof value === "number") return change(value);
  if (value === null || typeof value !== "object") return value;
  if (Array.isArray(value)) return value.map((each) => eachNumber(each, change));
  return Object.fromEntries(Object.entries(value).map(([key, each]) => [key, eachNumber(each, change)]));
}

// Without the last digits, which only rounding makes.
export const fromSI = (value, { size }, digits = 12) => eachNumber(value, (each) => (size === 1 ? each : Number((each / size).toPrecision(digits))));
// As in a field: what a conversion makes long has four digits, until it is typed.
const LONG = 1e6; // of the digits of a number as a whole one
export const inField = (value, own) => {
  const exact = fromSI(value, own);
  if (typeof exact !== "number" || own.size === 1) return exact;
  const digits = exact.toExponential().replace(/e.*|[-.]/g, "");
  return Number(digits) > LONG ? Number(exact.toPrecision(4)) : exact;
};
export const toSI = (value, { size }) => eachNumber(value, (each) => (size === 1 ? each : Number((each * size).toPrecision(15))));
