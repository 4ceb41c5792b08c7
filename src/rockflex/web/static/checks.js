// Checks of a run or a set of records against limits: the form of the limits, and the table.

import { h, number, scrolled, symbol, tableOf } from "./dom.js";
import { box, folded } from "./form.js";
import { t } from "./texts.js";

// Name, label, unit, and what the limit is or where one is found.
const limits = () => [
  ["drift_ratio", t("Story drift over story height"), "", t("EN 1998-1:2004, 4.4.3.2; ASCE 7-16, Table 12.12-1")],
  ["rotation_ratio", t("Rotation over α"), "", t("α: where the static moment vanishes")],
  ["friction", t("Friction between base and ground"), "", t("coefficient that is available")],
  ["slip", t("Slip of the base"), "m", t("of a base that can slide")],
  ["seat_width", t("Displacement of the top"), "m", t("at which what lies on it loses its seat; EN 1998-2:2005, 6.6.4")],
  ["tendon_ratio", t("Tendon force over yield force"), "", t("1 without an entry")],
  ["fuse_strain", t("Strain of a fuse"), "", t("from tests of the bar")],
  ["fuse_length", t("Length of a fuse that yields"), "m", t("for its strain")],
  ["bearing_pressure", t("Pressure under the base"), "Pa", t("EN 1997-1:2004, Annex D")],
  ["contact_ratio", t("Least length in contact over 2 B"), "", t("up to 1; EN 1997-1:2004, 6.5.4")],
  ["toe_stress", t("Stress at the toe"), "Pa", t("EN 1992-1-1:2004, 3.1.6 and 6.7")],
  ["toe_length", t("Length of the bearing at the toe"), "m", t("for the stress at the toe")],
  ["breadth", t("Breadth of the base out of the plane"), "m", t("for pressures on rigid ground and at the toe")],
  ["moment_ratio", t("Base moment over resisting moment"), "", t("without an entry uplift is told, and not limited")],
];

export function limitsForm(app) {
  const entry = ([name, label, unit, hint]) => box(`limits.${name}`, label, app.state.limits[name],
    (value) => app.change({ limits: { [name]: value === "" ? undefined : value } }), { unit, hint });
  return folded("limits", t("Limits of the checks"),
    h("p", { class: "hint" }, t("All optional. Without an entry the rotation, tendons and breaking elements are checked, against the limits that the table names.")),
    limits().map(entry));
}

// The check with the largest ratio, in words, and whether it fails; null without any.
export function worstCheck({ rows }) {
  const [worst] = rows.filter(({ ratio }) => ratio !== null).sort((a, b) => (b.ok === false) - (a.ok === false) || b.ratio - a.ratio);
  if (!worst) return null;
  const values = { check: t(worst.name), ratio: number(worst.ratio, 3) };
  return { name: worst.name, fails: worst.ok === false, text: worst.ok === false ? t("{check} fails, {ratio}", values) : t("{check} is closest to its limit, {ratio}", values) };
}

// A verdict in a line, coloured: sentences, and the checks, of which the worst is a link; `see(name)` shows that check.
export function verdictOf(element, sentences, { rows }, { overturns, see }) {
  const worst = worstCheck({ rows });
  const fails = rows.filter(({ ok }) => ok === false).length;
  const link = worst && h("a", { href: "#", id: "worst", "data-worst": worst.name, class: worst.fails ? "overturned" : null, onclick: (event) => {
    event.preventDefault();
    see(worst.name);
  } }, worst.fails || worst.name !== "rotation" ? worst.text : t("No check fails")); // of the rotation a sentence tells already
  const more = fails > 1 ? t("{n} checks fail.", { n: fails }) : "";
  element.classList.toggle("bad", overturns || fails > 0);
  element.classList.toggle("good", !overturns && !fails);
  element.replaceChildren(h("b", { class: overturns ? "overturned" : null }, sentences[0]), ` ${sentences.slice(1).join(" ")} ${more} `, ...(link ? [link, "."] : []));
}

// Show a check in its table.
export function seeCheck(root, name) {
  const row = root.querySelector(`[data-check="${CSS.escape(name)}"]`);
  const table = row?.closest(".scroll");
  table?.scrollIntoView({ block: "center" });
  table?.focus({ preventScroll: true });
}

// The heading and the table of the checks of `of`.
export function checksTable({ rows, missing, unlimited }, of) {
  const head = [t("check"), t("result"), t("demand"), t("limit"), t("ratio"), t("source of the limit, or what happens")];
  return h("section", { class: "checks" },
    h("h2", {}, t("Checks of {what}", { what: of })),
    scrolled(t("Checks"), {}, tableOf(head, rows.map(row))),
    unlimited.length ? h("p", { class: "hint" }, t("Without a limit: {names}. Give one under “Limits of the checks”.", { names: unlimited.map((name) => t(name)).join(", ") })) : null,
    missing.map(([name, lacks]) => h("p", { class: "hint" }, t("Not checked: {name}: {reason}.", { name: t(name), reason: lacks }))));
}

function row(each) {
  const verdict = { true: t("ok"), false: t("fails") }[each.ok] ?? "–";
  const value = (x) => (x === null ? "–" : `${number(x)} ${each.unit}`.trim());
  const source = each.source === "user" ? t("given here") : t(each.source) || each.note.split("; ")[0];
  return h("tr", { "data-check": each.name },
    h("th", { scope: "row" }, t(each.name)),
    h("td", { "data-name": "ok", class: each.ok === false ? "overturned" : null }, verdict),
    h("td", { "data-name": "demand", "data-value": each.value }, value(each.demand)),
    h("td", {}, (each.at_least ? "≥ " : "") + value(each.limit)),
    h("td", { "data-name": "ratio", "data-value": each.ratio }, number(each.ratio, 3)),
    h("td", { class: "words" }, symbol(source)));
}
