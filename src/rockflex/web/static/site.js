// My site: a structure of a few numbers, ag and the ground, and one press to the answer.

import { ask, attempt } from "./api.js";
import { h, svg, symbol } from "./dom.js";
import { box, select, trouble } from "./form.js";
import { t } from "./texts.js";

// Title, what a new one measures in SI units, and its picture.
const KINDS = {
  pier: [t("Pier"), { width: 7, height: 24, weight: 15e6 }, "M4 6h24v5H4zM13 11h6v15h-6zM6 26h20v4H6z"],
  building: [t("Building"), { width: 8, height: 18, weight: 8e6 }, "M7 3h18v27H7zM7 9.7h18M7 16.5h18M7 23.2h18"],
  block: [t("Block"), { width: 0.6, height: 2, weight: 2500 }, "M11 30L6 7l14-3 5 23z"],
};
const GROUNDS = [..."ABCDE"].map((letter) => [letter, letter]);

// `take` gets the structure and the choice of records that the server makes of them.
export function site(app, take) {
  const now = () => app.state.site;
  const put = (patch) => app.change({ site: patch });
  const pictures = h("div", { class: "pictures", role: "group", "aria-label": t("What stands there") }, Object.entries(KINDS).map(([kind, [title, usual, d]]) => (
    h("button", { type: "button", "data-kind": kind, onclick: () => put({ kind, ...usual }) },
      svg("svg", { viewBox: "0 0 32 32", width: 32, height: 32, "aria-hidden": "true" }, svg("path", { d })), title))));
  const entry = (name, label, unit) => box(`site.${name}`, label, now()[name], (value) => put({ [name]: value }), { unit });
  const fields = { width: entry("width", t("Width of the base"), "m"), height: entry("height", t("Height"), "m"), weight: entry("weight", t("Weight"), "N") };
  const material = select("site.material", t("Material"), app.about.materials.map(({ title }) => [title, t(title)]), now().material, (value) => put({ material: value }));
  const ag = box("target.ag", symbol(t("a_g on rock")), app.state.target.ag, (value) => app.change({ target: { ag: value } }), { unit: "g" });
  const ground = select("target.ground", t("Ground type"), GROUNDS, app.state.target.ground, (value) => app.change({ target: { ground: value } }));
  const go = h("button", { type: "button", class: "primary", id: "site", onclick: () => attempt(async () => {
    go.disabled = true;
    const found = await ask("/api/site", { state: app.state });
    app.complain(element, {});
    take(found);
  }, (error) => app.complain(element, error.errors)).finally(() => (go.disabled = false)) }, t("Does it rock? Check it for seven records"));
  const element = h("fieldset", { id: "my-site" }, h("legend", {}, t("My site")), pictures,
    h("div", { class: "twos" }, Object.values(fields), material, ag, ground),
    h("p", { class: "hint" }, t("A square column on its footing, stories of 3 m, or a rigid block. Everything can be changed afterwards.")),
    go, h("p", { class: "error foot", role: "alert" }), h("div", { "data-path": "site" }, trouble()));

  function refresh() {
    const { kind } = now();
    for (const button of pictures.children) button.setAttribute("aria-pressed", String(button.dataset.kind === kind));
    for (const [name, each] of Object.entries(fields)) each.setValue(now()[name]);
    material.setValue(now().material);
    material.hidden = kind === "block";
    ag.setValue(app.state.target.ag);
    ground.setValue(app.state.target.ground);
  }
  return { element, refresh };
}
