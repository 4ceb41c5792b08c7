// The first drawing: a structure that rocks, with handles that are its form, three numbers and the few inputs that matter.

import { attempt, get } from "./api.js";
import { Chart } from "./chart.js";
import { verdictOf } from "./checks.js";
import { explained } from "./choices.js";
import { adjust, clone, decode, h, latest, number } from "./dom.js";
import { ambiguous, box, select, slider } from "./form.js";
import { Player, UNDER } from "./stage.js";
import { t } from "./texts.js";
import { eachNumber, inUnit, outputInUnit, titled, unit } from "./units.js";

const CURVES = ["t", "rotation", "points", "uplifted", "slip", "heave", "left_edge", "right_edge"];
const HEIGHTS = { frame: "story_height", wall_frame: "height", tapered_tower: "height", cantilever: "height", beam: "height", rocking_frame: "column_height" };
const STIFFNESSES = ["bending_stiffness", "shear_stiffness", "elastic_modulus", "stiffness", "column_stiffness", "beam_stiffness"];
const LEAD = 3; // s before the largest rotation at which the drawing begins to move
const FAR_FIELD = "fema-p695-far-field";
const PATIENCE = 60; // ms for which a handle waits for an answer, to move together with the drawing
const SELDOM = 200; // ms between two values of a text field during a drag: browsers inspect the form after each
const MEASURED = 24; // px below the handles, for the width
const NEAR = 0.05; // of a range: arrow keys with Shift, Page Up and Page Down
const touched = matchMedia("(max-width: 900px), (pointer: coarse)");
const size = () => (touched.matches ? 26 : 16); // px of a handle, as in style.css
const tidy = (value) => Number(value.toPrecision(3));
const clamp = (value, [low, high]) => Math.min(high, Math.max(low, value));
const times = (value, factor) => eachNumber(value, (each) => Number((each * factor).toPrecision(6)));

export const kindOf = (structure, kinds) => Object.keys(kinds).find((key) => structure[key]) ?? "frame";

// What a structure measures, and how each measure is set: half width, height and first period, where they are in a field
// of its form. The others stay as they are, so a wider frame of the same period has another slenderness. `view` is of the
// structure `of`, and `structure` may have changed since: each measure is what the fields of `structure` make of it, NaN of a
// text that is no number.
export function measures(structure, view, kinds, of = structure) {
  const kind = kindOf(structure, kinds);
  const [values, seen] = [structure[kind], of[kind]];
  if (!seen) return {};
  const [B, H, T] = [view.half_width, view.heights.at(-1), view.period];
  const into = (patch) => ({ ...clone(structure), [kind]: { ...values, ...patch } });
  const scaled = (names, factor) => Object.fromEntries(names.filter((name) => name in seen).map((name) => [name, times(seen[name], factor)]));
  const grown = (name) => (typeof values[name] === "number" && values[name] && seen[name] ? values[name] / seen[name] : 1);
  const found = {};
  if (kind === "block") {
    const sized = "width" in values; // or by slenderness and half diagonal
    const [half, tall] = sized ? [values.width / 2, Number(values.height)] : [values.half_diagonal * Math.sin(values.slenderness), 2 * values.half_diagonal * Math.cos(values.slenderness)];
    const block = (b, h) => ({ ...clone(structure), block: { mass: values.mass, width: Number((2 * b).toPrecision(6)), height: Number(h.toPrecision(6)) } });
    const fields = sized ? ["width", "height"] : ["slenderness", "half_diagonal"];
    if (half > 0) Object.assign(found, { B: { value: half, fields, set: (v) => block(v, tall) }, H: { value: tall, fields, set: (v) => block(half, v) } });
    return found;
  }
  const direct = ["half_width", "base_radius"].find((name) => name in seen);
  const [high, stiff] = [HEIGHTS[kind], STIFFNESSES.filter((name) => name in seen)];
  const tall = H * grown(high);
  const wide = direct ?? ["column_width"].find((name) => name in seen) ?? "aspect_ratio";
  const half = direct ? Number(values[direct]) : wide === "aspect_ratio" ? (B * grown(high)) / grown(wide) : B * grown(wide);
  const aspect = (h, b) => (wide === "aspect_ratio" ? scaled([wide], (h / H) * (B / b)) : scaled([wide], b / B));
  if (kind !== "properties") found.B = { value: half, fields: [wide], set: (v) => into(direct ? { [direct]: v } : aspect(tall, v)) };
  if (high && !values.z && !values.lumped_masses)
    found.H = { value: tall, fields: [high], set: (v) => into({ ...scaled([high], v / H), ...(direct ? {} : aspect(v, half)) }) };
  if (seen.period !== undefined) found.T = { value: T * grown("period"), fields: ["period"], set: (v) => into({ period: times(seen.period, v / T) }) }; // masses that lean make T longer than the field
  else if (T && stiff.length) found.T = { value: T / Math.sqrt(grown(stiff[0])), fields: stiff, set: (v) => into(scaled(stiff, (T / v) ** 2)) };
  return found;
}

// The handles of a drawing: each is a number with its range, at a place in metres, in a `row` below it. What stands in a
// pair about the middle stays a pair.
function handles(app, view) {
  const { structure, ground } = app.state;
  const { B, H } = measures(structure, view, app.about.kinds, view.of);
  const { half_width: b, eccentricity: e } = view;
  const within = [-b - e, b - e];
  const places = (structure.elements ?? []).filter((each) => !each.between && !each.height).map((each) => each.position ?? 0);
  const springs = ground?.springs;
  const stood = springs ? (springs.positions ?? within) : [];
  const reach = Math.max(0, ...[...places, ...(springs?.positions ?? [])].map((x) => Math.abs(x + e)));
  const found = [];
  if (B?.value > 0) found.push({ name: "B", label: t("Width of the base"), value: 2 * B.value, range: [2 * Math.max(B.value / 4, reach), 8 * B.value],
    at: [B.value - e, 0], times: 2,
    next: (v) => ({ structure: B.set(v / 2) }) });
  if (H?.value > 0) found.push({ name: "H", label: t("Height"), up: true, value: H.value, range: [H.value / 4, 4 * H.value],
    at: [0, H.value],
    next: (v) => ({ structure: H.set(v) }) });
  const moved = (all, i, v) => all.map((x, k) => (k === i ? v : k !== i && x !== 0 && Math.abs(x + all[i]) < 1e-9 ? -v : x));
  (structure.elements ?? []).forEach((each, i) => {
    if (each.between || each.height) return;
    const { kind, position = 0 } = each;
    found.push({ name: `element ${i}`, label: t("Position of {number}, {kind}", { number: i + 1, kind: t(app.about.elements[kind].title) }), value: position, range: within, at: [position, 0], row: 1, sign: i + 1,
      next: (v) => {
        const all = structure.elements.map((other) => (other.kind === kind && !other.between && !other.height ? other.position ?? 0 : NaN));
        const now = moved(all, i, v);
        return { structure: { ...clone(structure), elements: structure.elements.map((other, k) => (Number.isNaN(now[k]) ? other : { ...other, position: now[k] })) } };
      } });
  });
  if (stood.length < 9) stood.forEach((x, i) => found.push({
    name: `spring ${i}`, label: t("Position of spring {number}", { number: i + 1 }), value: x, range: within, at: [x, 0], row: places.length ? 2 : 1,
    next: (v) => ({ ground: { springs: { positions: moved(stood, i, v) } } }),
  }));
  return found;
}

// Where handles are across, in px: beside each other in their rows, as near to their places as they can be.
function spread(found, stage) {
  const across = new Map();
  for (const row of new Set(found.map((each) => each.row))) {
    const own = found.filter((each) => each.row === row).map(({ name, at }) => [name, stage.spot(...at)[0]]).sort((a, b) => a[1] - b[1]);
    const pitch = row ? Math.min(size() + 2, stage.width / own.length) : 0;
    const right = [];
    const left = [];
    own.forEach(([, x], i) => right.push(Math.max(x, i ? right[i - 1] + pitch : x)));
    own.toReversed().forEach(([, x], i) => left.unshift(Math.min(x, i ? left[0] - pitch : x)));
    own.forEach(([name], i) => across.set(name, (left[i] + right[i]) / 2));
  }
  return across;
}

// `load(quick)` asks for another response; `settle()` is called once a change is over.
export function drawing(app, settle) {
  const shaking = new Chart({ label: t("Ground acceleration over time"), yLabel: titled("a_g [{unit}]", "acceleration"), height: 84, xName: "t [s]", symmetric: true, onpick: (time) => player.go(time) });
  const player = new Player((time) => shaking.setCursor(time), app.about, { height: 430, room: 1.22, loop: true, measured: true });
  const { stage } = player;
  const calm = matchMedia("(prefers-reduced-motion: reduce)");
  const dots = new Map(); // by the name of their handle
  const styles = new WeakMap(); // of each of them
  let view = null;
  let told = 0; // when the fields were last given their values
  let held = null; // the handle that is dragged, as it was before
  let aim = null; // where it is to be put
  let late = null; // when it is, whether or not the last answer is there

  // Below the drawing, for rows of handles.
  function makeRoom() {
    stage.under = Math.max(...(view ? handles(app, view) : []).map(({ row = 0 }) => row * (size() + 2) + size() / 2 + MEASURED), UNDER);
  }
  touched.addEventListener("change", makeRoom);

  function act(handle, value, live) {
    const put = clamp(handle.range.find((end) => Math.abs(value - end) < 1e-9) ?? tidy(value), handle.range); // to the very end
    app.change(handle.next(put), live);
    place();
  }

  // Put the handle that is dragged where the pointer is.
  function follow() {
    if (aim === null) return;
    clearTimeout(late);
    late = setTimeout(waited, PATIENCE);
    act(held, aim, true);
    aim = null;
  }
  function waited() {
    late = null;
    follow();
  }

  function dot(name) {
    const now = () => held ?? handles(app, view).find((each) => each.name === name);
    const element = h("div", {
      class: "handle", role: "slider", tabindex: 0, "data-handle": name,
      onpointerdown: (event) => {
        element.setPointerCapture(event.pointerId);
        held = { ...now(), from: [event.clientX, event.clientY], zoom: stage.zoom };
        player.hold(true);
      },
      onpointermove: (event) => {
        if (!element.hasPointerCapture(event.pointerId)) return;
        const moved = held.up ? held.from[1] - event.clientY : event.clientX - held.from[0];
        aim = held.value + ((held.times ?? 1) * moved) / held.zoom;
        if (late === null) follow();
      },
      onlostpointercapture: () => {
        follow();
        clearTimeout(late);
        held = late = null;
        player.hold(false);
        settle();
      },
      onkeydown: (event) => {
        const handle = now();
        const [low, high] = handle.range;
        const step = 10 ** Math.floor(Math.log10((high - low) / 20)) / 2;
        const far = (high - low) * NEAR;
        const to = {
          ArrowRight: step, ArrowUp: step, ArrowLeft: -step, ArrowDown: -step, PageUp: far, PageDown: -far,
          Home: low - handle.value, End: high - handle.value,
        }[event.key];
        if (to === undefined || event.altKey || event.ctrlKey || event.metaKey) return;
        event.preventDefault();
        act(handle, handle.value + to * (event.shiftKey ? 5 : 1), true);
        settle();
      },
    });
    return element;
  }

  // Put every handle where the present state has it.
  function place() {
    if (!view) return;
    const found = handles(app, view);
    for (const [name, element] of dots) {
      if (found.some((each) => each.name === name)) continue;
      element.remove();
      dots.delete(name);
    }
    const across = spread(found, stage);
    for (const { name, label, value, range, at, up, row = 0, sign = "" } of found) {
      if (!dots.has(name)) {
        dots.set(name, dot(name));
        stage.layer.append(dots.get(name));
      }
      const element = dots.get(name);
      const [x, y] = stage.spot(...at);
      const [off, down] = [across.get(name) - x, row * (size() + 2)];
      const length = inUnit(value, "length", 3);
      const reach = Math.abs(off) > 1 ? Math.hypot(off, down) - 8 : 0;
      if (element.textContent !== String(sign)) element.textContent = sign;
      const style = `transform: translate(${x + off}px, ${y + down}px); --reach: ${reach}px; --turn: ${Math.atan2(off, -down)}rad`; // without a new layout
      if (styles.get(element) !== style) element.style.cssText = style;
      styles.set(element, style);
      adjust(element, {
        title: `${label}: ${length}`, "data-value": length, // shown while it is dragged
        "aria-label": label, "aria-valuenow": tidy(value), "aria-valuemin": tidy(range[0]), "aria-valuemax": tidy(range[1]), "aria-valuetext": length,
        "aria-orientation": up ? "vertical" : "horizontal",
      });
    }
  }
  stage.placed = place;

  const figures = h("dl", { class: "values three", id: "three" });
  const note = h("p", { class: "hint", hidden: true });
  const verdict = h("p", { class: "answer", id: "rocks" });
  const said = h("p", { class: "hidden", role: "status" }); // the verdict and the three numbers, once a change is over
  stage.element.after(shaking.element, verdict, figures, said, note);
  // What is shown is not of the present state.
  const stale = (on) => [stage.canvas, verdict, figures].forEach((each) => each.classList.toggle("stale", on));
  const quick = few(app, () => view, settle, stale);

  // Show the response of a structure.
  function set(run, of) {
    note.hidden = !run.note;
    note.textContent = run.note ?? "";
    figures.hidden = verdict.hidden = shaking.element.hidden = Boolean(run.note);
    if (run.note) return;
    const first = !view;
    const [m] = run.models;
    for (const each of [m, run.twin ?? {}]) for (const name of CURVES) each[name] = each[name] && decode(each[name]);
    view = { ...run, of, end: m.t.at(-1), models: [{ ...m, label: explained(m.label) }] };
    stage.twin = run.twin && { ...view, models: [run.twin] };
    if (run.accelerogram) shaking.set({ xRange: [0, view.end], series: [{ x: decode(run.accelerogram.t), y: decode(run.accelerogram.a).map((a) => a / unit("acceleration").size), color: "muted", width: 1, label: t("acceleration") }] });
    makeRoom();
    player.set(view);
    if (aim === null) {
      clearTimeout(late);
      late = null;
      place();
    } else follow(); // and places all of them
    figures.replaceChildren(...three(m, run));
    tellVerdict(m, run);
    const now = performance.now();
    if (!stage.held || now - told > SELDOM) {
      told = now;
      quick.refresh();
    }
    if (!first) return;
    const peak = m.peaks.time_of_max_rotation ?? 0;
    player.move(calm.matches ? peak : peak - LEAD);
    resume();
  }

  // Whether it rocks, how near to the limit, its base moment, and the checks, which only a whole answer has.
  function tellVerdict({ status, peaks }, { nominal, fixed_base_moment: fixed, checks }) {
    const share = inUnit(peaks.max_rotation / nominal, "share", 3);
    const sentences = [status === "overturned" ? t("It overturns.") : status === "rocking" ? t("It rocks, up to {share} of the limit of the rotation.", { share }) : t("It does not rock."),
      fixed && status !== "overturned" ? t("Its base moment is {share} of that with the base held down.", { share: inUnit(peaks.max_base_moment / fixed, "share", 3) }) : ""];
    verdict.dataset.status = status;
    verdictOf(verdict, sentences, checks ?? { rows: [] }, { overturns: status === "overturned" || peaks.max_rotation > nominal, see });
    if (!stage.held) said.textContent = [verdict.textContent, ...[...figures.children].map((each) => each.textContent)].join("; ");
  }

  // The table of the checks is on the Response tab.
  function see(name) {
    app.seen = name;
    app.change({ record_set: { shown: false } });
    app.go("response");
  }

  const resume = () => !calm.matches && view && !player.playing && player.toggle();
  globalThis.rockflexDrawn = { player, view: () => view };
  return { player, set, quick, stale, resume, leave: () => player.pause() };
}

const FORMULAS = { rotation: t("max |θ|"), top: t("max |u + h θ|"), moment: t("max |M_b| / max |M_b| of a fixed base"), share: t("max |θ| / θ_nom") };

// Largest rotation, top displacement, and base moment over that of a fixed base.
function three({ peaks, status }, { fixed_base_moment: fixed, fixed_top_displacement: stiff, period: modal, nominal }) {
  const fell = status === "overturned";
  const top = peaks.max_total_top_displacement ?? peaks.max_top_displacement;
  const one = (key, name, value, help, raw) => h("div", { title: FORMULAS[key] }, h("dt", {}, name), h("dd", { "data-three": key, "data-value": raw }, value), h("dd", { class: "hint" }, help));
  const share = fixed ? inUnit(peaks.max_base_moment / fixed, "share", 3) : outputInUnit("max_base_moment", peaks.max_base_moment, 3);
  return [
    one("rotation", t("Largest rotation"), fell ? t("overturns") : outputInUnit("max_rotation", peaks.max_rotation, 3),
      fell ? t("it falls, and lies at {time}", { time: inUnit(peaks.end_time, "time", 3) }) : t("of the base while it stands on one edge"),
      peaks.max_rotation),
    one("top", t("Top displacement"), fell ? "–" : outputInUnit("max_top_displacement", top, 3),
      stiff ? t("{top} if its base were held down", { top: outputInUnit("max_top_displacement", stiff, 3) }) : t("relative to the ground"), top),
    ...(modal ? [one("moment", t("Base moment"), share, fixed ? t("of that if its base were held down") : t("at the level of the base"),
      fixed ? peaks.max_base_moment / fixed : null)]
      : [one("share", t("Rotation over the limit"), fell ? "–" : inUnit(peaks.max_rotation / nominal, "share", 3), t("of the nominal limit of the rotation"), peaks.max_rotation / nominal)]),
  ];
}

const TIMES = { B: 2 }; // of the measure in its field, which has the full width
let last = null; // what was measured last, from which a tab made anew goes on

// The few inputs that matter, beside the drawing: they show the state, and what is typed that cannot be in it.
function few(app, shown, settle, stale) {
  const bad = new Map(); // the structure in whose place a text was typed, by the field
  const measured = () => {
    last = shown() ?? last;
    return last ? measures(app.state.structure, last, app.about.kinds, last.of) : {};
  };
  const field = (name, label, unit, hint) => box(`few.${name}`, label, "", (value) => {
    const { [name]: found } = measured();
    tell(name, found && !(value > 0) && (ambiguous(value) ? t("Is the comma for thousands or for decimals? Write {thousands} or {decimals}.", { thousands: value.replace(",", ""), decimals: value.replaceAll(".", "").replace(",", ".") }) : t("It must be a number above 0.")));
    stale(bad.size > 0);
    if (!found || bad.has(name)) return;
    app.change({ structure: found.set(value / (TIMES[name] ?? 1)) }, true);
    settle();
  }, { unit, hint, digits: 4 });
  const fields = { B: field("B", t("Width of the base, 2 B"), "m"), H: field("H", t("Height"), "m", " "), T: field("T", t("First period, base held down"), "s") };

  // Say beside a field why its text cannot be used, until another one is typed or the structure is another.
  function tell(name, said) {
    const on = Boolean(said);
    const place = fields[name].querySelector(".error");
    if (on) bad.set(name, app.state.structure);
    else bad.delete(name);
    place.root = on ? place : null;
    place.textContent = said || "";
    fields[name].querySelector("input").setAttribute("aria-invalid", String(on));
  }
  const record = select("few.record", t("Earthquake record"), [], "", (value) => {
    const [suite, name] = value.split("|");
    if (value === "more") app.go("earthquake");
    else app.change({ record: name ? { source: "suite", suite, name } : { source: suite } });
  });
  const scale = slider("few.scale", t("Scale factor of the record"), { low: 0.01, high: 20, log: true }, 1, (value, live) => app.change({ scale: value }, live));
  scale.dataset.also = "scale";
  record.dataset.also = "record.name record.suite record.upload record.folder record.pulse record";
  let known = [["el-centro-1940|EL-CENTRO-1940-NS", "El Centro 1940"], ["pulse", t("a pulse")]];
  attempt(() => get(`/api/suite/${FAR_FIELD}`), () => ({ records: [] })).then(({ records }) => {
    known = [...known, ...records.map(({ name, event }) => [`${FAR_FIELD}|${name}`, `${event}, ${name}`])];
    refresh();
  });

  function refresh() {
    const { record: now, scale: by } = app.state;
    const chosen = now.source === "suite" ? `${now.suite}|${now.name}` : now.source;
    if (record.dataset.listed !== `${known.length} ${chosen}`) { // not at every move of a handle
      const other = known.some(([value]) => value === chosen) ? [] : [[chosen, now.source === "suite" ? now.name : t("your own record")]];
      record.setOptions([...other, ...known, ["more", t("others: suites, pulses, your files …")]], chosen);
      record.dataset.listed = `${known.length} ${chosen}`;
    }
    record.setValue(chosen);
    scale.setValue(by);
    const found = measured();
    const kind = kindOf(app.state.structure, app.about.kinds);
    for (const [name, structure] of bad) if (structure !== app.state.structure) tell(name);
    for (const [name, each] of Object.entries(fields)) {
      each.hidden = !found[name];
      if (!found[name] || bad.has(name)) continue;
      const { value: measure, fields: own } = found[name];
      const value = (TIMES[name] ?? 1) * measure;
      each.times = TIMES[name];
      each.dataset.also = own.map((key) => `structure.${kind}.${key}`).join(" ");
      each.setValue(each.unit.size === 1 && value > 0 ? tidy(value) : value);
    }
    fields.H.querySelector(".hint").textContent = found.H?.value > 0 && found.B?.value > 0 ? t("{ratio} times the half width", { ratio: number(found.H.value / found.B.value, 3) }) : "";
  }
  return { element: h("div", { class: "few" }, Object.values(fields), record, scale), refresh };
}
