// Records from a visitor's files: one file, or a folder.

import { attempt, get, isArchive, send, sendAll } from "../api.js";
import { h, latest, number, scrolled, tableOf, tooLarge } from "../dom.js";
import { box, field, fileBox, select, trouble } from "../form.js";
import { counted, language, t } from "../texts.js";
import { inUnit, unit as unitIn } from "../units.js";

const UNITS = [["", t("as in the file")], ["g", "g"], ["m/s2", "m/s²"], ["cm/s2", "cm/s²"]];

// `complain` takes messages by the path of their field.
export function uploading(app, complain) {
  const { file: most, duration } = app.about.limits;
  let unit = "";
  let step = "";
  let along = ""; // the record without its vertical component
  let last = null; // the file that was given last, and its path: it is read again with another unit or step
  let taken = null; // the file of the record, which keeps its scale when it is read again
  const said = h("p", { class: "help", id: "uploaded", role: "status" });
  const kinds = ".at2,.AT2,.csv,.txt,.dat,.tsv,.asc,.ASC,.v1,.V1,.v2,.V2,.v2c,.V2c,.xlsx,.NS,.EW,.UD,.NS2,.EW2,.UD2";
  const input = fileBox(kinds, (file) => take(file, "record.upload"));
  const upwards = fileBox(kinds, (file) => take(file, "record.vertical"));

  async function take(file, path) {
    last = [file, path];
    const vertical = path === "record.vertical";
    const under = vertical ? along || app.state.record.upload : "";
    const large = vertical && !under ? t("Choose the file of the horizontal component first.") : tooLarge(file, most);
    said.textContent = large ? "" : t("Reading {name} …", file);
    complain(large ? { [path]: large } : {});
    if (large) return;
    await attempt(async () => {
      const found = await send(`/api/upload?${new URLSearchParams({ name: file.name, units: unit, dt: step, under })}`, file);
      const values = { name: found.name, count: found.samples, pga: inUnit(found.pga, "acceleration"), pva: inUnit(found.pva, "acceleration") };
      said.textContent = found.pva === null ? t("{name}: {count} samples, PGA {pga}", values)
        : t("{name}: {count} samples, PGA {pga}, vertical {pva}", values);
      if (!vertical) along = found.upload;
      app.change({ record: { source: "upload", upload: found.upload, name: found.name }, ...(vertical || taken === file ? {} : { scale: 1 }) });
      if (!vertical) taken = file;
    }, (error) => {
      said.textContent = "";
      complain(error.errors);
    });
  }

  const afresh = () => last && take(...last);
  const element = h("div", {},
    field("record.upload", t("File"), input, { hint: t("AT2, CSV, text columns, Excel, K-NET, ESM or COSMOS; up to {most} MB and {duration} s", { most: most / 1e6, duration }) }),
    field("record.vertical", t("Vertical component"), upwards, { hint: t("optional; upwards positive, with the same step; or a column “vertical” in the file above") }),
    select("upload.units", t("Unit of the acceleration"), UNITS, "", (value) => {
      unit = value;
      afresh();
    }, { hint: t("if the file does not state it") }),
    box("upload.dt", t("Sampling step"), undefined, (value) => {
      step = value;
      afresh();
    }, { unit: "s", hint: t("only if the file has no times") }),
    said,
    h("p", { class: "help" }, t("A link does not contain the file: whoever opens it needs the file, too.")));
  return { element, take: (file) => take(file, "record.upload") };
}

const HEAD = [t("record"), "PGA [{unit}]", t("duration [s]"), "Δt [s]", "M", "R [km]", "V_s30 [m/s]", t("recording"), t("component"), t("format"), t("file")];

// `complain` takes messages by the path of their field. `report` is the table, which belongs to the results.
export function folder(app, complain) {
  const { file: most, files: many, folder: together } = app.about.limits;
  let unit = "";
  let step = "";
  let shown = ""; // the folder of the report
  let times = 0; // that files were given
  let last = null; // the files that were given last, which are read again with another unit or step
  let taken = null; // those of the folder, whose record keeps its scale
  const said = h("p", { class: "help", id: "given", role: "status" });
  const input = (attributes) => h("input", {
    type: "file", multiple: true, ...attributes,
    onchange: ({ target }) => {
      const chosen = [...target.files];
      target.value = "";
      if (chosen.length) give(chosen);
    },
  });
  const vertical = h("input", { type: "checkbox", id: "upwards", onchange: () => put({ vertical: vertical.checked }) });
  const upwards = h("label", { class: "check" }, vertical, t("With the vertical components of the stations"));
  const rows = scrolled(t("Records given"), { class: "report" });
  const stations = scrolled(t("Recordings"), {});
  const notes = h("ul", { class: "notes" });
  const findings = h("ul", { class: "notes" });
  const summary = h("p", { class: "answer", id: "taken" });
  const report = h("section", { id: "report", hidden: true },
    h("h2", {}, t("Your records")), summary, rows, notes,
    h("details", {}, h("summary", {}, t("Recordings: which components belong together")), stations),
    h("details", {}, h("summary", {}, t("Units, time steps and components: what says so")), findings));

  function put(patch) {
    app.change({ record: patch });
  }

  async function give(files) {
    last = files;
    const mine = ++times; // the answer about files given later may come first
    const large = tooMuch(files);
    said.textContent = large ? "" : files.length === 1 ? t("Reading {name} …", files[0]) : t("Reading {n} files …", { n: files.length });
    complain(large ? { "record.folder": large } : {});
    if (large) return;
    await attempt(async () => {
      const found = await sendAll(`/api/folder?${new URLSearchParams({ units: unit, dt: step, language })}`, files, most);
      if (mine !== times) return;
      draw(found);
      const first = found.entries.find((entry) => entry.taken);
      app.change({ record: { source: "folder", folder: found.folder, given: first.name }, ...(taken === files ? {} : { scale: 1 }) });
      taken = files;
    }, (error) => {
      if (mine !== times) return;
      said.textContent = "";
      complain(error.errors);
    });
  }

  function tooMuch(files) {
    const size = files.reduce((sum, each) => sum + (each.size > most && !isArchive(each) ? 0 : each.size), 0);
    if (files.length > many) return t("There are {n} files, but the page takes {most} at most. Choose fewer.", { n: files.length, most: many });
    if (size > together) return t("The files have {size} MB, but the page takes {most} MB at most. Choose fewer.", { size: (size / 1e6).toFixed(0), most: together / 1e6 });
    return "";
  }

  function draw(found) {
    shown = found.folder;
    const own = found.entries.filter((entry) => entry.taken);
    const left = found.entries.length - own.length;
    const pairs = found.stations.filter((each) => each.horizontal.length === 2);
    const upright = pairs.filter((each) => each.vertical).length;
    said.textContent = "";
    summary.textContent = [
      counted(own.length, t("{n} record taken."), t("{n} records taken.")), counted(left, t("{n} entry not taken."), t("{n} entries not taken.")),
      t("Recordings: {n}, with two horizontal components: {pairs}, of these with a vertical one, too: {upright}.", { n: found.stations.length, pairs: pairs.length, upright }),
    ].join(" ");
    rows.replaceChildren(tableOf(HEAD.map((text) => subscript(text.replace("{unit}", unitIn("acceleration", "kN").name))), found.entries.map(row)));
    stations.replaceChildren(tableOf([t("recording"), t("horizontal"), t("vertical")], found.stations.map((each) => h("tr", {},
      h("th", { scope: "row" }, each.name), h("td", {}, each.horizontal.join(", ") || "–"), h("td", {}, each.vertical ?? "–")))));
    notes.replaceChildren(...found.notes.map((text) => h("li", {}, text)));
    findings.replaceChildren(...found.findings.map((text) => h("li", {}, text)));
    upwards.hidden = !own.some((entry) => entry.vertical);
  }

  function row(entry) {
    if (!entry.taken) {
      return h("tr", { class: "left", "data-file": entry.file },
        h("td", {}, entry.file), h("td", { colspan: HEAD.length - 1, class: "reason" }, entry.paired ? entry.reason : t("not taken: {reason}", entry)));
    }
    const use = h("button", { type: "button", "data-given": entry.name, title: t("Use this record"), onclick: () => (
      put({ source: "folder", given: entry.name })) }, entry.name);
    const pga = h("td", { "data-value": entry.pga }, number(entry.pga / unitIn("acceleration", "kN").size, 3));
    const facts = [entry.magnitude, entry.distance, entry.vs30].map((value) => h("td", {}, number(value)));
    const recording = [entry.recording ?? "–", entry.vertical ? t("with vertical") : "", entry.reason ? `(${entry.reason})` : ""].filter(Boolean);
    return h("tr", { "data-file": entry.file },
      h("td", {}, use), pga, h("td", {}, number(entry.duration)), h("td", {}, number(entry.dt)), ...facts,
      h("td", {}, recording.join(" ")), h("td", {}, entry.component ?? "–"), h("td", {}, entry.format ?? "–"), h("td", {}, entry.file));
  }

  const load = latest(async () => {
    const { folder: token } = app.state.record;
    if (!token || shown === token) return;
    // The query for the record itself reports an error.
    const found = await attempt(() => get(`/api/folder/${token}`), () => null);
    if (found && token === app.state.record.folder) draw(found);
  });

  async function refresh() {
    await load();
    const { folder: token, given, vertical: both, source } = app.state.record;
    report.hidden = source !== "folder" || !token || shown !== token;
    vertical.checked = both;
    for (const button of rows.querySelectorAll("[data-given]")) button.setAttribute("aria-pressed", String(button.dataset.given === given));
  }

  const element = h("div", { "data-path": "record.folder" },
    field("given.folder", t("Folder"), input({ webkitdirectory: true, id: "folder" }),
      { hint: t("up to {many} files, {together} MB together and {most} MB each", { many, together: together / 1e6, most: most / 1e6 }) }),
    field("given.files", t("Or files, or a ZIP archive"), input({ id: "files" }),
      { hint: t("AT2, CSV, text columns, Excel, K-NET, ESM, COSMOS, GeoNet; PEER’s search results or a flatfile among them give magnitude, distance and soil") }),
    select("given.units", t("Unit of the acceleration"), UNITS, "", (value) => {
      unit = value;
      if (last) give(last);
    }, { hint: t("of files that do not state it") }),
    box("given.dt", t("Sampling step"), undefined, (value) => {
      step = value;
      if (last) give(last);
    }, { unit: "s", hint: t("of files that do not state it") }),
    said, upwards, trouble(),
    h("p", { class: "help" }, t("The records stay on the server until it is restarted or needs the space; a link does not contain them.")));
  return { element, report, refresh, give };
}

function subscript(text) {
  const [head, below] = text.split("_");
  if (!below) return text;
  const [index, ...rest] = below.split(" ");
  return [head, h("sub", {}, index), ` ${rest.join(" ")}`];
}
