// Elements, numbers, canvases and small tools that every tab uses, and how a tab is printed.

import { t, written } from "./texts.js";

const PAPER = 3; // pixels of a canvas for each CSS pixel of a sheet

export function h(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name === "class") element.className = value;
    else if (["value", "checked", "disabled", "hidden", "textContent"].includes(name)) element[name] = value;
    else element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.flat(3).filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

// Set attributes that change: each that is set costs the browser a new style, even to what it was.
export function adjust(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    const text = String(value);
    if (element.getAttribute(name) !== text) element.setAttribute(name, text);
  }
}

export function svg(tag, attributes = {}, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

export function number(value, digits = 4) {
  if (value === null || value === undefined || value === "") return "–";
  const x = Number(value);
  if (!Number.isFinite(x)) return x > 0 || value === "inf" ? "∞" : "–";
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (size >= 1e6 || size < 1e-4) {
    const [mantissa, exponent] = x.toExponential(digits - 1).split("e");
    return written(`${trim(mantissa)}·10${superscript(Number(exponent))}`);
  }
  return written(String(Number(x.toPrecision(digits))));
}

function trim(text) {
  return text.includes(".") && !text.includes("e") ? text.replace(/\.?0+$/, "") : text;
}

function superscript(n) {
  return String(n).replace(/./g, (c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]);
}

export function decode(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = binary.charCodeAt(i);
  return new Float32Array(bytes.buffer);
}

export function clone(value) {
  return JSON.parse(JSON.stringify(value));
}

// Repeat `work` for the newest call only; calls in between are skipped. Each call returns when nothing is left to do.
export function latest(work) {
  let running = null;
  let wanted = false;
  async function rounds() {
    try {
      while (wanted) {
        wanted = false;
        await work();
      }
    } finally {
      running = null;
    }
  }
  return function again() {
    wanted = true;
    running ??= rounds();
    return running;
  };
}

export function color(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

// A colour for a part of the page that follows the theme by itself.
export const ink = (name) => `var(--${name})`;

// The context of a canvas, made as large as it is shown.
export function context(canvas, width, height) {
  const scale = document.documentElement.classList.contains("printing") ? PAPER : window.devicePixelRatio || 1;
  const g = canvas.getContext("2d");
  const size = { width: Math.round(width * scale), height: Math.round(height * scale) };
  if (canvas.width === size.width && canvas.height === size.height) g.reset(); // another size takes new memory
  else Object.assign(canvas, size).style.height = `${height}px`;
  g.setTransform(scale, 0, 0, scale, 0, 0);
  return g;
}

export function save(name, blob) {
  const url = URL.createObjectURL(blob);
  const link = h("a", { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

// The message about a file that is too large; empty if it is not.
export function tooLarge({ name, size }, most) {
  if (size <= most) return "";
  return t("{name} has {size} MB, but the page takes {most} MB at most.", { name, size: written((size / 1e6).toFixed(1)), most: most / 1e6 });
}

// A table with a heading for each column, and a button that copies it for a spreadsheet.
export function tableOf(head, rows, attributes = {}) {
  const copy = h("button", { type: "button", class: "copy", onclick: async () => {
    const cells = [...copy.closest("table").rows].map((row) => [...row.cells].map((each) => each.innerText.replace(/\s+/g, " ").trim()).join("\t"));
    const done = await navigator.clipboard.writeText(cells.join("\n")).then(() => true, () => false);
    copy.textContent = done ? t("Copied") : t("Copying is not allowed");
    setTimeout(() => (copy.textContent = t("Copy the table")), 2000);
  } }, t("Copy the table"));
  return h("table", attributes, h("caption", {}, copy),
    h("thead", {}, h("tr", {}, head.map((text) => h("th", { scope: "col" }, text)))), h("tbody", {}, rows));
}

// A part that scrolls sideways by itself where it is too wide, by keys as well.
export const scrolled = (label, attributes, ...children) =>
  h("div", { tabindex: 0, role: "group", "aria-label": label, ...attributes, class: `scroll ${attributes.class ?? ""}`.trim() }, children);

// A symbol with a subscript after an underscore.
export function symbol(text) {
  return text.split(/(_[\w,θαβ]+)/).map((part) => (part.startsWith("_") ? h("sub", {}, part.slice(1)) : part));
}

const drawings = new WeakMap(); // what draws a canvas again

export function redrawn(canvas, draw) {
  drawings.set(canvas, draw);
  return canvas;
}

// `heading` tells what a sheet is about.
export function printing(heading) {
  const root = document.documentElement;
  const about = document.getElementById("printed");
  let theme = null; // before printing
  addEventListener("beforeprint", () => {
    theme ??= root.dataset.theme;
    root.dataset.theme = "light";
    root.classList.add("printing");
    about.textContent = heading();
    about.hidden = false;
    redraw();
  });
  addEventListener("afterprint", () => {
    root.dataset.theme = theme ?? root.dataset.theme;
    theme = null;
    root.classList.remove("printing");
    about.hidden = true;
    redraw();
  });
}

function redraw() {
  for (const canvas of document.querySelectorAll("canvas")) drawings.get(canvas)?.();
}
