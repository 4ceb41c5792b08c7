// The page: its state, which is stored in the address, its tabs, and what they share.

import { ask, attempt, get, Refusal } from "./api.js";
import { clone, h, number, printing } from "./dom.js";
import { showErrors } from "./form.js";
import { keep as keepForLater, kept } from "./kept.js";
import { language, t } from "./texts.js";
import { setUnits } from "./units.js";

const TABS = [
  ["structure", t("Structure"),
    t("A structure that is not tied to the ground: in an earthquake it lifts off and rocks from edge to edge, which limits its forces. Drag the dots, or type numbers.")],
  ["earthquake", t("Earthquake"),
    t("Choose the ground motion: a recorded earthquake, a pulse or your own file. Scale it as you like.")],
  ["response", t("Response"),
    t("See the structure rock, with amplified displacements, next to its rotation, forces and energy over time.")],
  ["fragility", t("Fragility"),
    t("Estimate how likely a limit state is at a given intensity, from runs with many scaled records.")],
  ["design", t("Design"),
    t("Find how wide the base must be to meet a target probability, with and without a tendon.")],
];

const LIVE = 300; // ms after the last move, until the address changes
const view = document.getElementById("view");
const banner = document.getElementById("banner");
const made = {};
const messages = new WeakMap(); // the last ones by the element that they are about
let wrong = null; // the messages about the link, until something is changed
let early = null; // the tab chosen before the state was known

export const app = {
  about: null,
  state: null,
  seen: "", // a check that is to be shown once its tab is
  begin: null, // the kind of study that begins once its tab is shown
  // Change part of the state and update the page; `live` while a handle or slider still moves: browsers take few changes of
  // the address.
  change(patch, live = false) {
    merge(app.state, patch);
    wrong = null;
    clearTimeout(later);
    if (live) later = setTimeout(keep, LIVE);
    else keep();
    refresh(live);
  },
  // Query the server about the state; messages appear next to the fields of `root`, or in its foot.
  ask(path, root, extra = {}) {
    if (root.closest("[data-closed]")) return Promise.resolve(); // it would replace the request of the tab made anew
    const before = messages.get(root);
    return attempt(async () => {
      const answer = await ask(path, { state: app.state, ...extra });
      if (messages.get(root) === before) app.complain(root, {}); // newer ones are about something else, such as a file
      return answer;
    }, (error) => app.complain(root, error.errors));
  },
  complain(root, errors) {
    messages.set(root, errors);
    const left = showErrors(root, errors);
    const foot = root.querySelector(".foot");
    if (foot) foot.textContent = left.map(elsewhere).join(" ");
  },
  // A button to another tab, below the results; `patch` changes the state before.
  next(tab, text, patch = {}, label = titleOf(tab)) {
    const go = () => {
      merge(app.state, patch);
      app.go(tab);
      tabOf(tab).focus();
    };
    return h("p", { class: "help buttons" }, text, h("button", { type: "button", onclick: go }, label));
  },
  // Open another state of the page, as a link does.
  restore(state) {
    location.hash = `#s=${encode(state)}`;
    document.getElementById("main").focus();
  },
  go(tab) {
    if (!app.state) {
      early = tab;
      return;
    }
    app.state.tab = tab;
    keep();
    show();
  },
};

const titleOf = (tab) => TABS.find(([name]) => name === tab)[1];
const tabOf = (tab) => document.querySelector(`#tabs [data-tab="${tab}"]`);

// A message about a field of another tab, in words.
function elsewhere(text) {
  const found = /^(?:structure|ground)(\.\w+)*?\.(\w+): (.*)$/s.exec(text);
  if (!found) return text.replace(/^record(?:\.\w+)*: (.*)$/s, (_, message) => t("Earthquake: {message}", { message }));
  const values = { field: found[2].replaceAll("_", " "), message: found[3] };
  const plain = app.state.units === "SI" || !/\d/.test(found[3]);
  return plain ? t("Structure, {field}: {message}", values) : t("Structure, {field} (in SI units): {message}", values);
}

// Tables are merged key by key; a structure is replaced, and undefined removes a key.
function merge(target, patch) {
  for (const [key, value] of Object.entries(patch)) {
    const table = value && typeof value === "object" && !Array.isArray(value) && key !== "structure";
    if (value === undefined) delete target[key];
    else if (table && target[key]) merge(target[key], value);
    else target[key] = value;
  }
}

function encode(state) {
  const bytes = new TextEncoder().encode(JSON.stringify(state));
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

function decoded(hash) {
  const found = /^#s=([\w-]+)$/.exec(hash);
  if (!found) return null;
  const text = atob(found[1].replaceAll("-", "+").replaceAll("_", "/"));
  return JSON.parse(new TextDecoder().decode(Uint8Array.from(text, (c) => c.charCodeAt(0))));
}

// What a printed sheet says of its tab; Swedish dates are those of ISO 8601.
function heading() {
  if (!app.state) return "rockflex";
  const { structure, record, record_set, scale, tab, target } = app.state;
  const motion = {
    suite: record.name, pulse: t("a pulse"), upload: t("an uploaded record"), folder: record.given || t("records of a folder"),
  }[record.source];
  const times = scale === 1 ? "" : ` × ${number(scale)}`;
  const of = { structure: structure.name || t("Structure"), record: `${motion}${times}` };
  const one = t("{structure} under {record}", of);
  const earthquake = target.shown ? t("{structure} under records for a target spectrum", of) : one;
  const response = record_set.shown ? t("{structure} under a set of records", of) : one;
  const about = { structure: of.structure, earthquake, response }[tab] ?? t("{structure} under many records", of);
  return `${about} · ${titleOf(tab)} · ${new Date().toLocaleDateString("sv")} · rockflex`;
}

let written = "";
let later = null; // when the address is written
const STEPS = 200; // that can be undone
const ALTERNATIVES = "rockflex-alternatives"; // what the browser keeps of a state
const [past, future] = [[], []]; // states without their tabs, as texts
let present = null;

const inUse = ({ tab: _, ...rest }) => JSON.stringify(rest);

// Write the state into the address, and remember the one before.
function keep() {
  clearTimeout(later);
  later = null;
  const now = inUse(app.state);
  if (present !== null && now !== present) {
    past.push(present);
    past.splice(0, past.length - STEPS);
    future.length = 0;
    if (inUse({ of: app.state.alternatives }) !== inUse({ of: JSON.parse(present).alternatives })) keepForLater(ALTERNATIVES, JSON.stringify(app.state.alternatives));
  }
  present = now;
  offer();
  written = `#s=${encode(app.state)}`;
  history.replaceState(null, "", written);
}

function offer() {
  document.getElementById("undo").disabled = !past.length;
  document.getElementById("redo").disabled = !future.length;
}

// Go to the state before the last change, or from there `to` the one after it; the tab stays.
async function step(from, to) {
  if (later) keep();
  if (!from.length) return;
  const [height, path] = [scrollY, document.activeElement.closest("[data-path]")?.dataset.path];
  to.push(present);
  present = from.pop();
  app.state = { ...JSON.parse(present), tab: app.state.tab };
  keepForLater(ALTERNATIVES, JSON.stringify(app.state.alternatives));
  banner.hidden = true;
  document.getElementById("units").value = app.state.units;
  await renew(true);
  if (path) view.querySelector(`[data-path="${CSS.escape(path)}"]`)?.querySelector("input, select, textarea, button")?.focus();
  scrollTo(0, height);
}

function undoing() {
  const buttons = { undo: [t("Undo (Ctrl+Z)"), past, future], redo: [t("Redo (Ctrl+Y)"), future, past] };
  for (const [id, [title, ...way]] of Object.entries(buttons)) {
    const button = document.getElementById(id);
    button.title = button.ariaLabel = title;
    button.addEventListener("click", () => step(...way));
  }
  let typing = null; // a field whose text is no change yet: the browser undoes it
  addEventListener("input", ({ target }) => (typing = target), true);
  addEventListener("change", () => (typing = null), true);
  addEventListener("keydown", (event) => {
    const key = event.key.toLowerCase();
    if (!(event.ctrlKey || event.metaKey) || event.altKey || !["z", "y"].includes(key) || !app.state) return;
    if (typing && typing === document.activeElement) return;
    event.preventDefault();
    step(...(key === "y" || event.shiftKey ? [future, past] : [past, future]));
  });
}

// The alternatives of the last visit, where no link brings others.
async function withKept(state) {
  try {
    const alternatives = JSON.parse(kept(ALTERNATIVES) ?? "[]");
    return alternatives.length ? await ask("/api/state", { state: { ...state, alternatives } }) : state;
  } catch {
    return state; // of another version, or no JSON
  }
}

async function open() {
  clearTimeout(later); // what was changed last is not written over the address that is opened
  later = null;
  banner.hidden = true;
  wrong = null;
  let state = clone(app.about.state);
  if (!location.hash.startsWith("#s=")) state = await withKept(state);
  else {
    try {
      state = await ask("/api/state", { state: decoded(location.hash) });
    } catch (error) {
      const [values, others] = [{ reason: reason(error) }, error instanceof Refusal && error.state];
      banner.textContent = others ? t("The link has values that cannot be used: {reason} All others are as they were.", values)
        : t("The link cannot be opened: {reason} The default structure is shown instead.", values);
      banner.hidden = false;
      wrong = others && error.errors;
      if (others) state = { ...others, tab: placeOf(Object.keys(error.errors)[0]) ?? others.tab };
    }
  }
  app.state = Object.assign(state, { language });
  if (early) state.tab = early;
  early = null;
  document.getElementById("units").value = state.units;
  await renew(false);
}

// The tab that has a field.
const placeOf = (path) => ({ structure: "structure", record: "earthquake", target: "earthquake", cloud: "fragility", design: "design", limits: "response",
  free_vibration: "response", record_set: "response", models: "response", impact: "response", restitution: "response", bouc_wen: "response", site: "structure" })[path.split(".")[0]];

// Make the tabs anew, in the units of the state; with `runs`, those of studies at once: runs that nobody asks for stop.
async function renew(runs) {
  setUnits(app.about, app.state.units);
  const before = Object.entries(made);
  for (const [name, each] of before) {
    each.leave?.();
    each.close?.(runs);
    each.element.dataset.closed = "";
    delete made[name];
  }
  keep();
  await show();
  for (const [name, { close }] of before) {
    if (!runs || !close) continue;
    const found = await import(`./tabs/${name}.js`).catch(() => null); // meanwhile it may be shown
    if (found) made[name] ??= found.default(app);
  }
}

function reason(error) {
  if (!(error instanceof Refusal)) return t("it is damaged.");
  return Object.entries(error.errors).map(([path, text]) => (path ? `${path}: ${text}` : text)).join(" ");
}

async function show() {
  const { tab } = app.state;
  for (const button of document.querySelectorAll("#tabs button")) {
    const chosen = button.dataset.tab === tab;
    button.setAttribute("aria-selected", String(chosen));
    button.tabIndex = chosen ? 0 : -1;
  }
  for (const [name, each] of Object.entries(made)) if (name !== tab) each.leave?.();
  const found = await import(`./tabs/${tab}.js`).catch(() => null);
  if (app.state.tab !== tab) return;
  if (!found && !made[tab]) {
    view.replaceChildren(h("p", { class: "error", role: "alert" }, t("This tab cannot be loaded: the server does not respond. Is rockflex serve still running? Your input is in the address; reload the page then.")));
    view.dataset.shown = tab;
    return;
  }
  const { default: make } = found ?? {};
  made[tab] ??= make(app);
  const [, , about] = TABS.find(([name]) => name === tab);
  view.replaceChildren(h("p", { class: "help" }, about), made[tab].element);
  view.dataset.shown = tab;
  view.setAttribute("aria-labelledby", `tab-${tab}`);
  document.title = `${titleOf(tab)} · rockflex`;
  refresh();
  if (wrong) app.complain(made[tab].element, wrong);
}

function refresh(live = false) {
  made[app.state.tab]?.refresh(live);
}

function tabs() {
  const list = document.getElementById("tabs");
  list.ariaLabel = t("Steps");
  document.getElementById("language").ariaLabel = t("Language");
  list.append(...TABS.map(([name, title]) => h("button", {
    type: "button", role: "tab", id: `tab-${name}`, "aria-controls": "view", "data-tab": name, onclick: () => app.go(name),
  }, title)));
  list.addEventListener("keydown", (event) => {
    const now = TABS.findIndex(([name]) => name === (app.state?.tab ?? early ?? TABS[0][0]));
    const last = TABS.length - 1;
    const to = { ArrowRight: now === last ? 0 : now + 1, ArrowLeft: now ? now - 1 : last, Home: 0, End: last }[event.key];
    if (to === undefined || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    const [name] = TABS[to];
    app.go(name);
    tabOf(name).focus();
  });
  // Following the link itself would replace the state in the address.
  const skip = document.getElementById("skip");
  skip.textContent = t("Skip to content");
  skip.addEventListener("click", (event) => {
    event.preventDefault();
    document.getElementById("main").focus();
  });
}

function theme(name) {
  document.documentElement.dataset.theme = name;
  if (app.state) refresh();
}

function themes() {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  theme(kept("rockflex-theme") ?? (dark.matches ? "dark" : "light"));
  const button = document.getElementById("theme");
  button.title = button.ariaLabel = t("Light or dark theme");
  button.addEventListener("click", () => {
    const next = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
    keepForLater("rockflex-theme", next);
    theme(next);
  });
}

function unitsChoice() {
  const choose = h("select", { id: "units", "aria-label": t("Units"), title: t("Units of the values shown and typed"), onchange: () => {
    app.state.units = choose.value;
    renew(true);
  } }, Object.keys(app.about.units).map((name) => h("option", {}, name)));
  document.querySelector(".tools").prepend(choose);
}

function copying() {
  const button = document.getElementById("copy");
  button.title = t("Copy a link to the page in its present state");
  button.textContent = t("Copy link");
  button.addEventListener("click", async () => {
    try {
      await navigator.clipboard.writeText(location.href);
      button.textContent = t("Copied");
    } catch {
      button.textContent = t("Copy it from the address");
    }
    setTimeout(() => (button.textContent = t("Copy link")), 2000);
  });
}

// Files and folders that are dropped anywhere: a project is opened, records are read.
function dropping() {
  addEventListener("dragover", (event) => event.dataTransfer.types.includes("Files") && event.preventDefault());
  addEventListener("drop", async (event) => {
    if (!event.dataTransfer.types.includes("Files")) return;
    event.preventDefault();
    const given = [...event.dataTransfer.files];
    const entries = [...event.dataTransfer.items].map((each) => each.webkitGetAsEntry?.());
    const files = entries.some((each) => each?.isDirectory) ? (await Promise.all(entries.filter(Boolean).map(filesIn))).flat() : given;
    if (!app.state || !files.length) return;
    const tab = /\.rockflex$/i.test(files[0].name) ? "structure" : "earthquake";
    app.state.tab = tab;
    keep();
    await show();
    made[tab].drop(files);
  });
}

// The files of what was dropped, and of the folders in it.
async function filesIn(entry) {
  if (entry.isFile) return [await new Promise((resolve, reject) => entry.file(resolve, reject))];
  const [reader, found] = [entry.createReader(), []];
  for (let some; !some || some.length; found.push(...some)) some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
  return (await Promise.all(found.map(filesIn))).flat();
}

themes();
tabs();
copying();
undoing();
dropping();
printing(heading);
try {
  app.about = await get("/api/about");
  unitsChoice();
  await open();
  addEventListener("hashchange", () => {
    if (location.hash !== written) open();
  });
} catch (error) {
  view.replaceChildren(h("p", { class: "error" }, error.message));
  if (!(error instanceof Refusal)) throw error;
}
globalThis.rockflexPage = app; // for tests of the page
