// Work that the server does in the background: studies, and files that take long.

import { ask, attempt, drop, file, get } from "./api.js";
import { CHOSEN, GIVEN, suitesOf, yields } from "./choices.js";
import { h, latest, save } from "./dom.js";
import { box, chips, select, trouble } from "./form.js";
import { counted, t } from "./texts.js";

const STUDY_STATUS = {
  waiting: () => t("Waiting for other users' runs."),
  running: ({ done, total }) => counted(total, t("{done} of {n} run", { done }), t("{done} of {n} runs", { done })),
  done: ({ total }) => counted(total, t("Done: {n} run."), t("Done: {n} runs.")),
  cancelled: ({ done, total }) =>
    counted(total, t("Cancelled after {done} of {n} run.", { done }), t("Cancelled after {done} of {n} runs.", { done })),
  failed: ({ message }) => t("Failed: {message}", { message }),
};
const SHOWN = 400; // ms between two polls while the tab is shown; the first ones come sooner, for studies that are short
const ASIDE = 5000; // and while it is not: the server stops a study that is not polled

// Everything that determines the runs of these models, apart from the study's own choices.
export function assumed({ structure, impact, restitution, bouc_wen, ground }, labels) {
  return [structure, impact, restitution, ground, labels.some(yields) ? bouc_wen : null, labels];
}

// What determines the records of these suites.
export function recordsOf({ record, target: { shown: _, ...target } }, suites) {
  const chosen = suites.includes(CHOSEN) ? target : null;
  const given = suites.includes(GIVEN) || chosen?.source === GIVEN ? [record.folder, record.vertical] : null;
  return [suites, given, chosen];
}

// Controls of the choices of a study.
export function choices(app, kind) {
  const now = app.state[kind];
  const put = (patch) => app.change({ [kind]: patch });
  const set = (name) => (value) => put({ [name]: value });
  const suites = chips(`${kind}.suites`, t("Suites of records"), suitesOf(app, now.suites), now.suites, set("suites"));
  suites.refresh = () => suites.setOptions(suitesOf(app, app.state[kind].suites), app.state[kind].suites);
  return {
    put,
    entry: (name, label, extra) => box(`${kind}.${name}`, label, now[name], set(name), extra),
    list: (name, label, options) => select(`${kind}.${name}`, label, options, now[name], set(name)),
    suites,
  };
}

// What stands in place of a verdict while runs are lacking.
export const undecided = ({ done, total }) => t("{done} of {total} runs: not decided.", { done, total });

// A list of remarks on the fits, hidden while it is empty.
export class Remarks {
  constructor() {
    this.list = h("ul", { class: "notes" });
    this.element = h("details", {}, h("summary", {}, t("Remarks on the fits")), this.list);
    this.set([]);
  }

  set(texts) {
    this.list.replaceChildren(...texts.map((text) => h("li", {}, text)));
    this.element.hidden = !texts.length;
  }
}

const goes = (answer) => ["waiting", "running"].includes(answer.status);

const kept = {}; // what a study goes on with, by its kind

export class Study {
  // `key` identifies everything that determines the runs; `show` draws an answer into `results`; `example` returns the
  // choices of a quick look, so that the tab begins with something to see; `words` are those of the button and the status;
  // `suites` returns those whose records the visitor may have to save, by default the study's own choice; `id` begins the ids of a second study on a tab.
  constructor(app, kind, { words, key, show, results, example, id = "", suites = () => app.state[kind].suites }) {
    Object.assign(this, { app, kind, words, key, show, results, example, suites });
    this.answer = this.begun = null;
    this.watching = false;
    this.asked = 0; // how many studies and quick looks were started
    // The token of the runs, the choices of the quick look while it is what is shown, and the key of the present or last run.
    Object.assign(this, kept[kind] ?? { token: null, looked: null, ran: "" });
    delete kept[kind];
    this.run = h("button", { type: "button", class: "primary", id: `${id}run`, onclick: () => this.#start(null) }, words.run);
    this.cancel = h("button", { type: "button", id: `${id}cancel`, disabled: true, onclick: () => this.#stop() }, t("Cancel"));
    this.bar = h("progress", { max: 1, value: 0, "aria-label": t("Progress") });
    this.status = h("p", { class: "help", id: `${id}status`, role: "status" }, words.none);
    this.foot = h("p", { class: "error foot", role: "alert" });
    this.element = h("div", {},
      h("div", { "data-path": kind }, h("div", { class: "buttons" }, this.run, this.cancel), this.bar, this.status, trouble()),
      this.foot);
    this.load = latest(() => this.#load());
    if (this.token) this.#watch();
  }

  // Update the tab after a change of the state.
  refresh() {
    this.ownRecords.hidden = ![GIVEN, CHOSEN].some((each) => this.suites().includes(each));
    if (this.app.begin === this.kind) {
      this.app.begin = null;
      this.#start(null);
    } else if (!this.token && !this.asked) this.#start(this.example());
    else if (this.token) {
      this.load(); // again, where an answer for the choices before is on its way
      this.#watch();
    }
  }

  // The page was reopened from a link; or the tab is made anew, and goes on with its `runs`.
  close(runs) {
    if (runs && this.token) kept[this.kind] = { token: this.token, looked: this.looked, ran: this.ran };
    this.token = this.answer = null;
  }

  // Buttons for files: files of runs once there are any, the others at any time.
  downloads(ofRuns, others) {
    const own = [`${this.kind}-records`, t("Records (ZIP)")]; // those that the program has not
    const names = ofRuns.map(([what]) => what);
    const path = (what) => (names.includes(what) ? `/api/study/${this.kind}/${this.token}/${what}` : `/api/file/${what}`);
    const buttons = downloads(this.app, [...ofRuns, ...others, own], path);
    const all = [...buttons.querySelectorAll("[data-file]")];
    this.ownRecords = all.find((each) => each.dataset.file === own[0]);
    this.needRuns = all.filter((each) => names.includes(each.dataset.file));
    for (const button of this.needRuns) button.disabled = true;
    return buttons;
  }

  get #root() {
    return this.element.closest(".columns");
  }

  // The state of the page, with the choices of a quick look.
  #with(looked) {
    const { state } = this.app;
    return looked ? { ...state, [this.kind]: { ...state[this.kind], ...looked } } : state;
  }

  async #start(looked) {
    const wanted = this.key();
    const asked = ++this.asked;
    await this.#stop();
    const path = `/api/study/${this.kind}`;
    const found = looked ? await attempt(() => ask(path, { state: this.#with(looked) }), () => null) : await this.app.ask(path, this.#root);
    if (!found || asked !== this.asked) return; // a study took the place of the quick look
    Object.assign(this, { token: found.token, looked, ran: wanted, answer: null, begun: null });
    this.#watch();
  }

  async #stop() {
    if (this.token && this.answer && goes(this.answer)) await attempt(() => drop(`/api/job/${this.token}`), () => {});
  }

  async #watch() {
    if (this.watching) return;
    this.watching = true;
    let pause = SHOWN / 8;
    try {
      do {
        await this.load();
        for (let waited = 0; waited < (this.element.isConnected ? pause : ASIDE); waited += pause)
          await new Promise((resolve) => setTimeout(resolve, pause));
        pause = Math.min(2 * pause, SHOWN);
      } while (this.token && (!this.answer || goes(this.answer)));
    } finally {
      this.watching = false;
    }
  }

  async #load() {
    const token = this.token;
    if (!token) return;
    await attempt(async () => {
      const answer = await ask(`/api/study/${this.kind}/${token}`, { state: this.#with(this.looked) });
      if (token !== this.token) return;
      this.answer = answer;
      this.app.complain(this.#root, {});
      this.#draw();
    }, (error) => {
      if (token !== this.token) return;
      this.app.complain(this.#root, error.errors);
      if (error.status === 404) this.token = this.answer = null;
      this.cancel.disabled = !this.token;
    });
  }

  // The time that the rest takes at the pace so far, once some of it is known.
  #left({ done, total }) {
    const now = performance.now();
    this.begun ??= { now, done };
    const [seconds, more] = [(now - this.begun.now) / 1000, done - this.begun.done];
    if (seconds < 1 || more <= 0) return "";
    const rest = (seconds * (total - done)) / more;
    return rest < 90 ? t("About {n} s left.", { n: Math.ceil(rest / 5) * 5 }) : t("About {n} min left.", { n: Math.ceil(rest / 60) });
  }

  #draw() {
    const { answer } = this;
    const on = goes(answer);
    const old = this.ran !== this.key();
    this.run.textContent = on && !this.looked ? this.words.again : this.words.run;
    this.cancel.disabled = !on;
    this.bar.value = answer.done / answer.total;
    for (const button of this.needRuns) button.disabled = !(answer.ready ?? answer.done) || Boolean(this.looked);
    this.status.textContent = [
      this.looked ? t("A quick look, with fewer runs.") : "", [STUDY_STATUS[answer.status](answer), on && this.#left(answer)].filter(Boolean).join(" · "), old ? this.words.changed : "",
    ].filter(Boolean).join(" ");
    this.results.classList.toggle("stale", old);
    this.show(answer);
  }
}

// Those of a report, which is printed where the server has a browser.
export const reports = (app, what, html, pdf) => [[what, html], ...(app.about.pdf ? [[`${what}-pdf`, pdf]] : [])];

const PATIENCE = 400; // ms before the page shows that it waits, and the longest time between two looks
const FILE_STATUS = {
  waiting: () => t("Waiting for other users' files."),
  running: ({ done, total }) => (total ? t("{done} of {total} frames", { done, total }) : t("Computing …")),
  done: () => t("Saved."),
  cancelled: () => t("Cancelled."),
  failed: () => "",
};

// Buttons for files, which the server makes in the background: what takes long has its progress below them, and can be
// cancelled. Messages appear next to the fields of the tab.
export function downloads(app, files, path = (what) => `/api/file/${what}`) {
  const going = h("div");
  const status = h("p", { class: "help", role: "status" });

  async function make(what, label, button) {
    if (button.ariaBusy === "true") return;
    const root = button.closest(".columns");
    let stopped = false;
    const bar = h("progress", { max: 1, "aria-label": t("Progress of {file}", { file: label }) });
    const cancel = h("button", { type: "button", onclick: () => (stopped = true) }, t("Cancel"));
    const row = h("div", { class: "making", hidden: true }, bar, cancel);
    const patience = setTimeout(() => (row.hidden = false), PATIENCE);
    const say = (answer) => (status.textContent = FILE_STATUS[answer.status](answer));
    button.ariaBusy = "true";
    status.textContent = "";
    going.append(row);
    await attempt(async () => {
      const { token } = await ask(path(what), { state: app.state });
      app.complain(root, {});
      for (let wait = PATIENCE / 8; ; wait = Math.min(2 * wait, PATIENCE)) {
        if (stopped) await drop(`/api/file/${token}`);
        const answer = stopped ? { status: "cancelled" } : await get(`/api/file/${token}`);
        if (answer.total) bar.value = answer.done / answer.total;
        if (!row.hidden || !goes(answer)) say(answer);
        if (answer.status === "failed") app.complain(root, answer.errors);
        if (answer.status === "done") {
          save(...(await file(`/api/file/${token}/content`)));
          await attempt(() => drop(`/api/file/${token}`), () => {}); // it has arrived
        }
        if (!goes(answer)) return;
        await new Promise((resolve) => setTimeout(resolve, wait));
      }
    }, (error) => app.complain(root, error.errors));
    clearTimeout(patience);
    row.remove();
    button.ariaBusy = "false";
  }

  const button = ([what, label]) => {
    const one = h("button", { type: "button", "data-file": what, onclick: () => make(what, label, one) }, label);
    return one;
  };
  return h("div", { class: "downloads" },
    h("div", { class: "buttons" }, h("span", { class: "help" }, t("Download:")), files.map(button)), going, status);
}
