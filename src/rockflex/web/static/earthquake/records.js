// The records of a suite as small pictures to choose from.

import { attempt, get } from "../api.js";
import { decode, h, latest, number, svg } from "../dom.js";
import { trouble } from "../form.js";
import { unitOf } from "../measures.js";

const GRAVITY = 9.81;

export function records(app) {
  const thumbs = h("div", { class: "thumbs", role: "group", "aria-label": "Records" });
  let shown = "";

  function thumb(suite, record) {
    const place = [record.event, record.station].filter(Boolean).join(", ");
    const strength = [`PGA ${number(record.pga / GRAVITY, 3)} g`, h("br"), `PGV ${number(record.pgv, 3)} ${unitOf(app.about, "pgv")}`];
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
  const t = decode(record.t);
  const a = decode(record.a);
  const d = Array.from(t, (x, i) => `${i ? "L" : "M"}${(100 * x).toFixed(2)} ${(17 - 16 * a[i]).toFixed(2)}`).join("");
  return svg("svg", { viewBox: "0 0 100 34", preserveAspectRatio: "none", "aria-hidden": "true" }, svg("path", { d }));
}
