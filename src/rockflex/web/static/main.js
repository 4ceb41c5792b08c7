// The page: its state, which is stored in the address, its tabs, and what they share.

import { ask, attempt, file, get, Refusal } from "./api.js";
import { clone, h, number, printing, save } from "./dom.js";
import { showErrors } from "./form.js";
import { t } from "./texts.js";

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

const LIVE = 300; // ms between two changes of the address
const SLOW = 400; // ms after which a button says that it works
const view = document.getElementById("view");
const banner = document.getElementById("banner");
const made = {};
const messages = new WeakMap(); // the last ones by the element that they are about
let early = null; // the tab chosen before the state was known

export const app = {
  about: null,
  state: null,
  uploads: {},
  // Change part of the state and update the page; `live` while a handle or slider still moves: browsers take few changes of
  // the address.
  change(patch, live = false) {
    merge(app.state, patch);
    if (live) later ??= setTimeout(keep, LIVE);
    else keep();
    refresh(live);
  },
  // Query the server about the state; messages appear next to the fields of `root`, or in its foot.
  ask(path, root, extra = {}) {
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
  download(path, root) {
    return attempt(async () => save(...(await file(path, { state: app.state }))), (error) => app.complain(root, error.errors));
  },
  // Buttons that fetch files.
  downloads(root, files, path = (what) => `/api/download/${what}`) {
    const button = ([what, label]) => {
      const run = () => once(one, () => app.download(path(what), root));
      const one = h("button", { type: "button", "data-file": what, onclick: run }, label);
      return one;
    };
    return h("div", { class: "buttons downloads" }, h("span", { class: "help" }, t("Download:")), files.map(button));
  },
  // A button to another tab, below the results.
  next(tab, text) {
    const go = () => {
      app.go(tab);
      tabOf(tab).focus();
    };
    return h("p", { class: "help buttons" }, text, h("button", { type: "button", onclick: go }, titleOf(tab)));
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

// Do the work of a button once at a time; the button says so where it takes long.
async function once(button, work) {
  if (button.ariaBusy === "true") return;
  const label = button.textContent;
  button.ariaBusy = "true";
  const slow = setTimeout(() => (button.textContent = `${label} …`), SLOW);
  try {
    await work();
  } finally {
    clearTimeout(slow);
    button.ariaBusy = "false";
    button.textContent = label;
  }
}

const titleOf = (tab) => TABS.find(([name]) => name === tab)[1];
const tabOf = (tab) => document.querySelector(`#tabs [data-tab="${tab}"]`);

// A message about a field of another tab, in words.
function elsewhere(text) {
  const found = /^(?:structure|ground)(\.\w+)*?\.(\w+): (.*)$/s.exec(text);
  if (found) return t("Structure, {field}: {text}", { field: found[2].replaceAll("_", " "), text: found[3] });
  const [, of] = /^record(?:\.\w+)*: (.*)$/s.exec(text) ?? [];
  return of === undefined ? text : t("Earthquake: {text}", { text: of });
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
  const { structure, record, scale, tab, target } = app.state;
  const motion = {
    suite: record.name, pulse: t("a pulse"), upload: t("an uploaded record"), folder: record.given || t("records of a folder"),
  }[record.source];
  const times = scale === 1 ? "" : ` × ${number(scale)}`;
  const of = { structure: structure.name || t("Structure"), motion: `${motion}${times}` };
  const one = t("{structure} under {motion}", of);
  const earthquake = target.shown ? t("{structure} under records for a target spectrum", of) : one;
  const about = { structure: of.structure, earthquake, response: one }[tab] ?? t("{structure} under many records", of);
  return `${about} · ${titleOf(tab)} · ${new Date().toLocaleDateString("sv")} · rockflex`;
}

let written = "";
let later = null; // when the address is written

function keep() {
  clearTimeout(later);
  later = null;
  written = `#s=${encode(app.state)}`;
  history.replaceState(null, "", written);
}

async function open() {
  banner.hidden = true;
  let state = clone(app.about.state);
  if (location.hash.startsWith("#s=")) {
    try {
      state = await ask("/api/state", { state: decoded(location.hash) });
    } catch (error) {
      banner.textContent = t("The link cannot be opened: {reason} The default structure is shown instead.", { reason: reason(error) });
      banner.hidden = false;
    }
  }
  app.state = state;
  if (early) state.tab = early;
  early = null;
  for (const [name, each] of Object.entries(made)) {
    each.close?.();
    delete made[name];
  }
  keep();
  await show();
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
  const { default: make } = await import(`./tabs/${tab}.js`);
  if (app.state.tab !== tab) return;
  made[tab] ??= make(app);
  const [, , about] = TABS.find(([name]) => name === tab);
  view.replaceChildren(h("p", { class: "help" }, about), made[tab].element);
  view.dataset.shown = tab;
  view.setAttribute("aria-labelledby", `tab-${tab}`);
  document.title = `${titleOf(tab)} · rockflex`;
  refresh();
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
  theme(localStorage.getItem("rockflex-theme") ?? (dark.matches ? "dark" : "light"));
  const button = document.getElementById("theme");
  button.title = button.ariaLabel = t("Light or dark theme");
  button.addEventListener("click", () => {
    const next = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
    localStorage.setItem("rockflex-theme", next);
    theme(next);
  });
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

themes();
tabs();
copying();
printing(heading);
try {
  app.about = await get("/api/about");
  await open();
  addEventListener("hashchange", () => {
    if (location.hash !== written) open();
  });
} catch (error) {
  view.replaceChildren(h("p", { class: "error" }, error.message));
  if (!(error instanceof Refusal)) throw error;
}
globalThis.rockflexPage = app; // for tests of the page
