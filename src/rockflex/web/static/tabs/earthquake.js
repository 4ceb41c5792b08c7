// Earthquake: a record of a suite, a pulse or a file, its history, spectrum and measures.

import { attempt, get, isArchive } from "../api.js";
import { Chart, overTime } from "../chart.js";
import { decode, h, latest, number, svg } from "../dom.js";
import { between, select, slider, trouble } from "../form.js";
import { downloads } from "../jobs.js";
import { t } from "../texts.js";
import { fromSI, inUnit, titled, unit, unitFor } from "../units.js";
import { folder, uploading } from "./files.js";
import { target } from "./target.js";

const SOURCES = [["suite", t("A recorded suite")], ["pulse", t("A pulse")], ["upload", t("Your own file")], ["folder", t("Your folder of records")]];
const MISSING = {
  upload: t("Choose a file; its motion and spectrum will appear here."),
  folder: t("Choose a folder, files or a ZIP archive of records; a report of them will appear here."),
};
const PULSE = {
  amplitude: [t("Amplitude"), { low: 0.1, high: 15, step: 0.05, unit: "m/s²" }],
  period: [t("Period"), { low: 0.1, high: 5, step: 0.01, unit: "s" }],
  gamma: [t("Oscillations"), { low: 1, high: 4, step: 0.05, hint: t("number of oscillations γ, 1 to 4") }],
  nu: [t("Phase"), { low: -3.14, high: 3.14, step: 0.01, unit: "rad", hint: t("phase ν, −π to π") }],
};
const TASKS = [["", t("Choose one ground motion")], ["target", t("Choose records for a target spectrum")]];
const HISTORIES = [
  ["acceleration", "a [{unit}]", "acceleration", "c0", 160, t("Ground acceleration over time"), t("acceleration")],
  ["vertical", "a_v [{unit}]", "acceleration", "c1", 110, t("Vertical ground acceleration over time"), t("vertical acceleration")],
  ["velocity", "v [{unit}]", "velocity", "c2", 110, t("Ground velocity over time"), t("velocity")],
  ["displacement", "d [{unit}]", "length", "c3", 110, t("Ground displacement over time"), t("displacement")],
];

export default function earthquakeTab(app) {
  const { about } = app;
  const { record } = app.state;
  const put = (patch) => app.change({ record: patch });
  const source = select("record.source", t("Source"), SOURCES, record.source, (value) => put({ source: value }));
  const suite = select("record.suite", t("Suite"), about.suites.map((name) => [name, name]), record.suite, async (value) => {
    const found = await get(`/api/suite/${encodeURIComponent(value)}`);
    put({ suite: value, name: found.records[0].name });
  });
  const thumbs = records(app);
  const titles = Object.entries(about.pulses).map(([name, { title }]) => [name, t(title)]);
  const shape = select("record.pulse.shape", t("Shape"), titles, record.pulse.shape, (value) => put({ pulse: { shape: value } }));
  const sliders = Object.fromEntries(Object.entries(PULSE).map(([key, [label, spec]]) => [key,
    slider(`record.pulse.${key}`, label, spec, record.pulse[key], (value) => put({ pulse: { [key]: value } }))]));
  const scale = slider("scale", t("Scale factor"), { low: 0.01, high: 20, log: true }, app.state.scale,
    (value) => app.change({ scale: value }));
  const given = folder(app, (errors) => app.complain(element, errors));
  const own = uploading(app, (errors) => app.complain(element, errors));
  const panels = {
    suite: h("div", {}, suite, thumbs.element),
    pulse: h("div", {}, shape, Object.values(sliders)),
    upload: own.element,
    folder: given.element,
  };

  const charts = overTime(HISTORIES.map(([, yLabel, quantity, , height, label]) => (
    { label, yLabel: titled(yLabel, quantity), height })));
  const spectrum = new Chart({
    label: t("Acceleration spectrum"), yLabel: titled("Sa [{unit}]", "acceleration"), xLabel: t("period [s]"), xName: "T [s]", height: 230,
    xLog: true, zero: true,
  });
  const title = h("h2", { id: "record-title" });
  const measures = h("dl", { class: "values", id: "measures" });
  const drawing = h("div", {},
    title, charts.map((chart) => chart.element), measures,
    h("h2", {}, t("Response spectrum, 5 % damping")), spectrum.element);
  const empty = h("p", { class: "answer", hidden: true }, "");
  const results = h("div", { class: "results" }, empty, given.report, drawing);
  const chosen = target(app, () => element);
  const single = [
    h("fieldset", {}, h("legend", {}, t("Ground motion")), source, Object.values(panels),
      h("p", { class: "error foot", role: "alert" })),
    h("fieldset", {}, h("legend", {}, t("Scale")), scale)];
  const task = select("task", t("Task"), TASKS, "", (value) => app.change({ target: { shown: value === "target" } }));
  const side = h("form", { class: "side", onsubmit: (event) => event.preventDefault() }, task);
  const place = h("div");
  const element = h("div", { class: "columns" }, side, place);
  given.report.append(downloads(app, [["records", t("Your records (ZIP)")]]));
  drawing.append(downloads(app, [["record", t("Record (CSV)")]]), app.next("response", t("Next: watch the structure rock.")));

  const load = latest(async () => {
    const answer = await app.ask("/api/record", element);
    results.classList.toggle("stale", !answer);
    if (answer) show(answer);
  });

  function show(answer) {
    const times = app.state.scale === 1 ? "" : ` × ${number(app.state.scale)}`;
    title.textContent = [answer.name, answer.title].filter(Boolean).join(" · ") + times;
    const x = decode(answer.t);
    HISTORIES.forEach(([key, , quantity, color, , , label], i) => {
      charts[i].element.hidden = !answer[key];
      if (!answer[key]) return;
      const { size } = unit(quantity);
      const level = key === "acceleration" && answer.lifting / size;
      const lifting = { color: "c1", dash: [4, 4] };
      charts[i].set({
        series: [{ x, y: decode(answer[key]).map((value) => value / size), color, width: 1, label }],
        hlines: level ? [{ ...lifting, y: level, label: t("static uplift") }, { ...lifting, y: -level }] : [],
      });
    });
    measures.replaceChildren(...answer.measures.map((m) => h("div", {},
      h("dt", {}, `${t(m.name)} [${unitFor(m.unit).name}]`),
      h("dd", { "data-measure": m.name, "data-value": m.value }, number(fromSI(m.value, unitFor(m.unit)))),
      h("dd", { class: "hint" }, t(m.help)))));
    const first = answer.first_period;
    spectrum.set({
      series: [{ x: decode(answer.periods), y: decode(answer.sa).map((value) => value / unit("acceleration").size), color: "c0", label: "Sa" }],
      vlines: first ? [{ x: first, label: `T₁ = ${number(first, 3)} s`, color: "c1" }] : [],
    });
  }

  function refresh() {
    const { shown } = app.state.target;
    task.setValue(shown ? "target" : "");
    for (const [parent, children] of [[side, [task, ...(shown ? [chosen.form] : single)]], [place, [shown ? chosen.results : results]]])
      if (parent.lastChild !== children.at(-1)) parent.replaceChildren(...children);
    if (shown) chosen.refresh();
    else refreshRecord();
  }

  function refreshRecord() {
    const now = app.state.record;
    source.setValue(now.source);
    suite.setValue(now.suite);
    shape.setValue(now.pulse.shape);
    scale.setValue(app.state.scale);
    for (const [key, control] of Object.entries(sliders)) {
      control.setValue(now.pulse[key]);
      control.hidden = !about.pulses[now.pulse.shape].fields.includes(key);
    }
    const velocity = now.pulse.shape === "mavroeidis";
    sliders.amplitude.setUnit(velocity ? "m/s" : "m/s²");
    sliders.amplitude.setValue(now.pulse.amplitude);
    const { low, high } = PULSE.amplitude[1];
    const [from, to] = fromSI([low, high], sliders.amplitude.unit, 3);
    const range = between(from, to, sliders.amplitude.unit.name);
    sliders.amplitude.querySelector(".hint").textContent = velocity ? t("{range}, of the velocity", { range }) : range;
    for (const [key, panel] of Object.entries(panels)) panel.hidden = key !== now.source;
    if (now.source === "suite") thumbs.refresh();
    given.refresh();
    const missing = now.source in MISSING && !now[now.source];
    empty.textContent = MISSING[now.source] ?? "";
    drawing.hidden = missing;
    empty.hidden = !missing;
    if (missing) app.complain(element, {});
    else load();
  }
  // Files that are dropped: one is a record, several are a folder of them.
  function drop(files) {
    const many = files.length > 1 || isArchive(files[0]);
    app.change({ target: { shown: false }, record: { source: many ? "folder" : "upload" } });
    if (many) given.give(files);
    else own.take(files[0]);
  }
  return { element, refresh, drop };
}

function records(app) {
  const thumbs = h("div", { class: "thumbs", role: "group", "aria-label": t("Records") });
  let shown = "";

  function thumb(suite, record) {
    const place = [record.event, record.station].filter(Boolean).join(", ");
    const { size, name } = unit("acceleration", "kN");
    const strength = [`PGA ${number(record.pga / size, 3)} ${name}`, h("br"), `PGV ${inUnit(record.pgv, "velocity", 3)}`];
    return h("button", {
      type: "button", "data-record": record.name, title: place,
      onclick: () => app.change({ record: { source: "suite", suite, name: record.name } }),
    }, h("b", {}, record.name), h("br"), record.event || "", picture(record), strength);
  }

  const refresh = latest(async () => {
    const { suite, name } = app.state.record;
    if (shown !== suite) {
      // The query for the record itself reports an error.
      const found = await attempt(() => get(`/api/suite/${encodeURIComponent(suite)}`), () => null);
      if (!found) return;
      thumbs.replaceChildren(...found.records.map((record) => thumb(suite, record)));
      shown = suite;
    }
    for (const button of thumbs.children) button.setAttribute("aria-pressed", String(button.dataset.record === name));
  });

  return { element: h("div", { "data-path": "record.name" }, thumbs, trouble()), refresh };
}

function picture(record) {
  const times = decode(record.t);
  const a = decode(record.a);
  const d = Array.from(times, (x, i) => `${i ? "L" : "M"}${(100 * x).toFixed(2)} ${(17 - 16 * a[i]).toFixed(2)}`).join("");
  return svg("svg", { viewBox: "0 0 100 34", preserveAspectRatio: "none", "aria-hidden": "true" }, svg("path", { d }));
}
