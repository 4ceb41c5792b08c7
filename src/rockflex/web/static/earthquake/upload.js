// A record from an uploaded file.

import { attempt, send } from "../api.js";
import { h, number, tooLarge } from "../dom.js";
import { box, field, fileBox, select } from "../form.js";

export const UNITS = [["", "as in the file"], ["g", "g"], ["m/s2", "m/s²"], ["cm/s2", "cm/s²"]];

// `complain` takes messages by the path of their field.
export function uploading(app, complain) {
  const { file: most, duration } = app.about.limits;
  let unit = "";
  let step = "";
  let along = ""; // the record without its vertical component
  const said = h("p", { class: "help", id: "uploaded", role: "status" });
  const kinds = ".at2,.AT2,.csv,.txt,.dat,.tsv,.asc,.ASC,.v1,.V1,.v2,.V2,.v2c,.V2c,.xlsx,.NS,.EW,.UD,.NS2,.EW2,.UD2";
  const input = fileBox(kinds, (file) => take(file, "record.upload"));
  const upwards = fileBox(kinds, (file) => take(file, "record.vertical"));

  async function take(file, path) {
    const vertical = path === "record.vertical";
    const under = vertical ? along || app.state.record.upload : "";
    const large = vertical && !under ? "Choose the file of the horizontal component first." : tooLarge(file, most);
    said.textContent = large ? "" : `Reading ${file.name} …`;
    complain(large ? { [path]: large } : {});
    if (large) return;
    await attempt(async () => {
      const found = await send(`/api/upload?${new URLSearchParams({ name: file.name, units: unit, dt: step, under })}`, file);
      const both = found.pva === null ? "" : `, vertical ${number(found.pva)} m/s²`;
      said.textContent = `${found.name}: ${found.samples} samples, PGA ${number(found.pga)} m/s²${both}`;
      if (!vertical) along = found.upload;
      app.change({ record: { source: "upload", upload: found.upload, name: found.name } });
    }, (error) => {
      said.textContent = "";
      complain(error.errors);
    });
  }

  return h("div", {},
    field("record.upload", "File", input, { hint: `AT2, CSV, text columns, Excel, K-NET, ESM or COSMOS; up to ${most / 1e6} MB and ${duration} s` }),
    field("record.vertical", "Vertical component", upwards, { hint: "optional; upwards positive, with the same step; or a column “vertical” in the file above" }),
    select("upload.units", "Unit of the acceleration", UNITS, "", (value) => (unit = value), { hint: "if the file does not state it" }),
    box("upload.dt", "Sampling step", undefined, (value) => (step = value), { unit: "s", hint: "only if the file has no times" }),
    said,
    h("p", { class: "help" }, "A link does not contain the file: whoever opens it needs the file, too."));
}
