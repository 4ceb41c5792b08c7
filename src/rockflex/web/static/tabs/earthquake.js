// Earthquake: what shakes it. Records of suites, pulses, files, and a scale factor.

import { get, Refusal, send } from "../api.js";
import { Chart } from "../chart.js";
import { decode, h, latest, number } from "../dom.js";
import { field, select, slider } from "../form.js";

const SLIDERS = {
  amplitude: { low: 0.1, high: 15, step: 0.05, unit: "m/s²" },
  period: { low: 0.1, high: 5, step: 0.01, unit: "s" },
  gamma: { low: 1, high: 4, step: 0.05, hint: "number of oscillations γ, 1 to 4" },
  nu: { low: -3.14, high: 3.14, step: 0.01, unit: "rad", hint: "phase ν, −π to π" },
};
const NAMES = { amplitude: "Amplitude", period: "Period", gamma: "Oscillations", nu: "Phase" };

export default function earthquakeTab(app) {
  const { about } = app;
  const foot = h("p", { class: "error foot", role: "alert" });
  const source = select("record.source", "Where from", [["suite", "A recorded suite"], ["pulse", "A pulse"], ["upload", "A file of yours"]], app.state.record.source,
    (value) => app.change({ record: { source: value } }));
  const suite = select("record.suite", "Suite", about.suites.map((s) => [s, s]), app.state.record.suite, async (value) => {
    const found = await get(`/api/suite/${encodeURIComponent(value)}`);
    app.change({ record: { suite: value, name: found.records[0].name } });
  });
  const thumbs = h("div", { class: "thumbs", role: "group", "aria-label": "Records" });
  const pulses = select("record.pulse.shape", "Shape", Object.entries(about.pulses).map(([k, p]) => [k, p.title]), app.state.record.pulse.shape,
    (shape) => app.change({ record: { pulse: { shape } } }));
  const sliders = Object.fromEntries(Object.entries(SLIDERS).map(([key, spec]) => [key,
    slider(`record.pulse.${key}`, NAMES[key], spec, app.state.record.pulse[key], (value) => app.change({ record: { pulse: { [key]: value } } }))]));
  const scale = slider("scale", "Scale factor on the record", { low: 0.01, high: 20, log: true }, app.state.scale, (value) => app.change({ scale: value }));
  const uploaded = h("p", { class: "help", id: "uploaded" });
  const panels = {
    suite: h("div", {}, suite, h("div", { "data-path": "record.name" }, thumbs, h("div", { class: "error", role: "alert" }))),
    pulse: h("div", {}, pulses, Object.values(sliders)),
    upload: uploading(),
  };
  const group = [];
  const charts = [["acceleration", "a [m/s²]", "c0"], ["velocity", "v [m/s]", "c2"], ["displacement", "d [m]", "c3"]].map(([key, yLabel, colorName], i) => {
    const chart = new Chart({ label: `Ground ${key} over time`, yLabel, height: i ? 110 : 160, xLabel: i === 2 ? "time [s]" : "", noXText: i < 2, xName: "t [s]", group, symmetric: true, left: 60 });
    group.push(chart);
    return [key, colorName, chart];
  });
  const spectrum = new Chart({ label: "Acceleration spectrum", yLabel: "Sa [m/s²]", xLabel: "period [s]", xLog: true, height: 230, zero: true, xName: "T [s]" });
  const title = h("h2", { id: "record-title" });
  const measures = h("dl", { class: "values", id: "measures" });
  const results = h("div", { class: "results" }, title, charts.map(([, , chart]) => chart.element), measures,
    h("h2", {}, "Response spectrum, 5 % damping"), spectrum.element,
    h("p", { class: "help" }, "Next: see the structure rock. ", h("button", { type: "button", onclick: () => app.go("response") }, "Response")));
  const element = h("div", { class: "columns" },
    h("form", { class: "side", onsubmit: (event) => event.preventDefault() },
      h("fieldset", {}, h("legend", {}, "Ground motion"), source, Object.values(panels), foot), h("fieldset", {}, h("legend", {}, "Scale"), scale)),
    results);
  results.append(app.downloads(element, [["record", "Record (CSV)"]]));
  let shown = "";

  function uploading() {
    const units = h("select", {}, [["", "as the file says"], ["g", "g"], ["m/s2", "m/s²"], ["cm/s2", "cm/s²"]].map(([v, t]) => h("option", { value: v }, t)));
    const dt = h("input", { type: "text", inputmode: "decimal", placeholder: "from the file" });
    const input = h("input", { type: "file", accept: ".at2,.AT2,.csv,.txt,.dat,.tsv", onchange: async () => {
      const chosen = input.files[0];
      input.value = "";
      if (!chosen) return;
      if (chosen.size > about.limits.file) {
        app.complain(element, { "record.upload": `${chosen.name} has ${(chosen.size / 1e6).toFixed(1)} MB, but the page takes ${about.limits.file / 1e6} MB at most.` });
        return;
      }
      uploaded.textContent = `Reading ${chosen.name} …`;
      const query = new URLSearchParams({ name: chosen.name, units: units.value, dt: dt.value });
      try {
        const found = await send(`/api/upload?${query}`, chosen);
        uploaded.textContent = `${found.name}: ${found.samples} samples, PGA ${number(found.pga)} m/s²`;
        app.change({ record: { source: "upload", upload: found.upload, name: found.name } });
      } catch (error) {
        if (!(error instanceof Refusal)) throw error;
        uploaded.textContent = "";
        app.complain(element, error.errors);
      }
    } });
    return h("div", {}, field("record.upload", "File", input, { hint: `AT2, CSV or columns of text; up to ${about.limits.file / 1e6} MB and ${about.limits.duration} s` }),
      field("upload.units", "Unit of the acceleration", units, { hint: "AT2 files are in g by definition" }),
      field("upload.dt", "Sampling step", dt, { unit: "s", hint: "only where the file has no times" }), uploaded,
      h("p", { class: "help" }, "A link does not hold the file: whoever opens it needs the file, too."));
  }

  const pictures = latest(async () => {
    const wanted = app.state.record.suite;
    if (shown !== wanted) {
      let found;
      try {
        found = await get(`/api/suite/${encodeURIComponent(wanted)}`);
      } catch (error) {
        if (!(error instanceof Refusal)) throw error;
        return;
      }
      shown = wanted;
      thumbs.replaceChildren(...found.records.map((r) => h("button", { type: "button", "data-record": r.name, title: [r.event, r.station].filter(Boolean).join(", "),
        onclick: () => app.change({ record: { source: "suite", suite: wanted, name: r.name } }) },
      h("b", {}, r.name), h("br"), r.event || "", picture(r), `PGA ${number(r.pga / 9.81, 3)} g, PGV ${number(r.pgv, 3)} m/s`)));
    }
    for (const button of thumbs.children) button.setAttribute("aria-pressed", String(button.dataset.record === app.state.record.name));
  });

  const load = latest(async () => {
    const answer = await app.ask("/api/record", element);
    results.classList.toggle("stale", !answer);
    if (!answer) return;
    title.textContent = [answer.name, answer.title].filter(Boolean).join(" · ") + (app.state.scale === 1 ? "" : ` × ${number(app.state.scale)}`);
    const x = decode(answer.t);
    for (const [key, colorName, chart] of charts)
      chart.set({ series: [{ x, y: decode(answer[key]), color: colorName, width: 1, label: key }],
        hlines: key === "acceleration" && answer.lifting ? [{ y: answer.lifting, color: "c1", label: "lifts the base if slow", dash: [4, 4] }, { y: -answer.lifting, color: "c1", dash: [4, 4] }] : [] });
    measures.replaceChildren(...answer.measures.map((m) => h("div", { title: m.help }, h("dt", {}, `${m.name} [${m.unit}]`), h("dd", { "data-measure": m.name, "data-value": m.value }, number(m.value)), h("dd", { class: "hint" }, m.help))));
    spectrum.set({ series: [{ x: decode(answer.periods), y: decode(answer.sa), color: "c0", label: "Sa" }],
      vlines: answer.first_period ? [{ x: answer.first_period, label: `T₁ = ${number(answer.first_period, 3)} s`, color: "c1" }] : [] });
  });

  function refresh() {
    const { record } = app.state;
    source.setValue(record.source);
    suite.setValue(record.suite);
    pulses.setValue(record.pulse.shape);
    scale.setValue(app.state.scale);
    for (const [key, element_] of Object.entries(sliders)) {
      element_.setValue(record.pulse[key]);
      element_.hidden = !about.pulses[record.pulse.shape].fields.includes(key);
    }
    const velocity = record.pulse.shape === "mavroeidis";
    sliders.amplitude.querySelector(".unit").textContent = velocity ? "m/s" : "m/s²";
    sliders.amplitude.querySelector(".hint").textContent = velocity ? "0.1 to 15 m/s, of the velocity" : "0.1 to 15 m/s²";
    for (const [key, panel] of Object.entries(panels)) panel.hidden = key !== record.source;
    if (record.source === "suite") pictures();
    if (record.source === "upload" && !record.upload) {
      app.complain(element, {});
      results.classList.add("stale");
      return;
    }
    load();
  }
  return { element, refresh };
}

function picture(record) {
  const ns = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(ns, "svg");
  svg.setAttribute("viewBox", "0 0 100 34");
  svg.setAttribute("preserveAspectRatio", "none");
  svg.setAttribute("aria-hidden", "true");
  const t = decode(record.t);
  const a = decode(record.a);
  const path = document.createElementNS(ns, "path");
  path.setAttribute("d", Array.from(t, (x, i) => `${i ? "L" : "M"}${(100 * x).toFixed(2)} ${(17 - 16 * a[i]).toFixed(2)}`).join(""));
  svg.append(path);
  return svg;
}
