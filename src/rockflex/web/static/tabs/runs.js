// The choices of the runs: models, free vibration, impact law, and whether the superstructure yields.

import { isRigid, models, yields } from "../choices.js";
import { h, symbol } from "../dom.js";
import { select, slider, tableField, trouble } from "../form.js";
import { t } from "../texts.js";

const IMPACT_HELP = t("The law sets the velocities after an impact.");
const FORCES = t("The impulse of an impact is not in the history of forces, and V_b and M_b are those of rigid ground: " +
  "on stiff springs with little damping, V_b of a flexural frame may be larger.");
const RESTITUTION = 0.8; // default
const RANGE = t("0: the base stays down until the next uplift; 1: it rocks on without loss");
const YIELDING = ["2DOF-S", "2DOF-S-BW", "1DOF-fixed-BW"];
const DISPLACEMENT = 0.05; // m, if the server suggests none

// `suggested` returns a yield displacement that suits the response shown.
export function runs(app, suggested) {
  const labels = models("models", app.state.models, app.about.limits.models, (value) => app.change({ models: value }));
  const free = slider("free_vibration", t("Free vibration after the record"), { low: 0, high: 60, step: 1, unit: "s" },
    app.state.free_vibration, (value) => app.change({ free_vibration: value }));
  const { laws } = app.about; // a law with and without a restitution is there twice
  const key = (law) => law.name + (laws.find((each) => each.name === law.name) === law ? "" : " e");
  const chosen = (state) => laws.find((law) => law.name === state.impact && law.restitution === (state.restitution !== undefined))
    ?? laws.find((law) => law.name === state.impact);
  const listed = [["", t("the one that each model has by itself")], ...laws.map((law) => [key(law), t(law.title)])];
  const impact = select("impact", t("Impact law"), listed, "", (value) => {
    const law = laws.find((each) => key(each) === value);
    app.change({ impact: law?.name, restitution: law?.restitution ? RESTITUTION : undefined });
  }, { hint: `${IMPACT_HELP} ${FORCES}` });
  const restitution = slider("restitution", t("Coefficient of restitution"),
    { low: 0, high: 1, step: 0.01, hint: RANGE }, RESTITUTION, (value) => app.change({ restitution: value }));
  const tick = h("input", { type: "checkbox", id: "yields", onchange: () => (tick.checked ? begin() : end()) });
  const fields = h("div");
  const yielding = h("div", { "data-path": "bouc_wen" },
    h("label", { class: "check" }, tick, t("The superstructure yields (Bouc–Wen)")),
    h("p", { class: "hint" }, t("Only models with -BW in their label yield; the others stay elastic.")),
    fields, trouble());
  let drawn = false;

  function begin() {
    const found = suggested() ?? DISPLACEMENT;
    app.change({ bouc_wen: { yield_displacement: Number(found.toPrecision(3)) }, models: [...YIELDING] });
  }

  function end() {
    const { state } = app.about; // the default state, whose models do not yield
    const without = (labels, otherwise) => {
      const left = labels.filter((label) => !yields(label));
      return left.length ? left : [...otherwise];
    };
    app.change({
      bouc_wen: undefined,
      models: without(app.state.models, state.models),
      cloud: { models: without(app.state.cloud.models, state.cloud.models) },
      design: { model: without([app.state.design.model], [state.design.model])[0] },
    });
  }

  function entry(spec) {
    const change = (value) => app.change({ bouc_wen: { [spec.name]: value } });
    return tableField(`bouc_wen.${spec.name}`, spec, app.state.bouc_wen[spec.name], change);
  }

  function refresh() {
    const { state } = app;
    labels.setValue(state.models, state);
    yielding.hidden = isRigid(state.structure);
    free.setValue(state.free_vibration);
    const law = chosen(state);
    impact.setValue(law ? key(law) : "");
    impact.querySelector(".hint").replaceChildren(...symbol(`${law ? t(law.help) : IMPACT_HELP} ${FORCES}`));
    restitution.hidden = !law?.restitution;
    restitution.setValue(state.restitution ?? RESTITUTION);
    const on = state.bouc_wen !== undefined;
    tick.checked = on;
    fields.hidden = !on;
    if (on && !drawn) fields.replaceChildren(...app.about.bouc_wen.map(entry));
    drawn = on;
  }
  return { element: h("div", {}, labels, free, impact, restitution, yielding), refresh };
}
