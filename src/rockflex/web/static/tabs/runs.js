// The choices of the runs: models, free vibration, impact law, and whether the superstructure yields.

import { isBlock, models, yields } from "../choices.js";
import { h, symbol } from "../dom.js";
import { select, slider, tableField, trouble } from "../form.js";
import { t } from "../texts.js";

const IMPACTS = [
  ["", t("the one that each model has by itself")],
  ["simplified", t("velocities of the masses are kept (simplified, Eq. 25)")],
  ["complete", t("kinetic energy is kept (complete, Eq. 19)")],
  ["restitution", t("part of the rotation goes on (restitution)")],
];
const IMPACT_HELP = {
  "": t("The law sets the velocities after an impact."),
  simplified: t("Conserves the horizontal velocity of each mass; the rotation stops."),
  complete: t("Conserves the total horizontal kinetic energy; the rotation stops."),
  restitution: t("Conserves the horizontal velocity of each mass; part of the rotation continues about the other edge."),
};
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
  const impact = select("impact", t("Impact law"), IMPACTS, "", (value) => app.change({
    impact: value || undefined,
    restitution: value === "restitution" ? RESTITUTION : undefined,
  }), { hint: `${IMPACT_HELP[""]} ${FORCES}` });
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
    yielding.hidden = isBlock(state.structure);
    free.setValue(state.free_vibration);
    impact.setValue(state.impact ?? "");
    impact.querySelector(".hint").replaceChildren(...symbol(`${IMPACT_HELP[state.impact ?? ""]} ${FORCES}`));
    restitution.hidden = state.impact !== "restitution";
    restitution.setValue(state.restitution ?? RESTITUTION);
    const on = state.bouc_wen !== undefined;
    tick.checked = on;
    fields.hidden = !on;
    if (on && !drawn) fields.replaceChildren(...app.about.bouc_wen.map(entry));
    drawn = on;
  }
  return { element: h("div", {}, labels, free, impact, restitution, yielding), refresh };
}
