// The moving structure, with its controls: play, speed, time and amplification.

import { bracket, FONT } from "./axes.js";
import { color, context, h, number, redrawn, save } from "./dom.js";
import { depthOf, drawBetween, drawSprings, drawStance, motionOf } from "./drawing.js";
import { slider } from "./form.js";
import { legend } from "./marks.js";
import { t, written } from "./texts.js";
import { inUnit, unit } from "./units.js";

const IMPACT = 0.12; // s for which an impact is marked
const LOW = 230; // px of a drawing that stays in sight above a form, in a narrow window, and at most
const SHARE = 0.42; // of the height of the window
const BESIDE = 46; // px from the base to the dimension of the height
const TWIN = 0.3; // opacity
const BARS = [1, 2, 5]; // of the length of a scale bar, times a power of ten
export const UNDER = 44; // px below the ground, for words or handles
const GHOST = 0.55; // opacity
const narrow = matchMedia("(max-width: 900px)");

class Stage {
  // `room` is the height that fits in the drawing, over that of the structure; `symbols` are those of the server.
  // With `measured` it has dimensions and a scale bar.
  constructor(symbols, { height = 340, room = 1.08, measured = false } = {}) {
    this.canvas = redrawn(h("canvas", {
      tabindex: 0, role: "application", "aria-roledescription": t("animation"), "aria-keyshortcuts": "Space ArrowLeft ArrowRight",
      "aria-label": t("The structure rocking: space plays and pauses, arrow keys step"),
    }), () => this.draw());
    this.layer = h("div", { class: "handles" });
    this.element = h("div", { class: "pinned" }, this.canvas, this.layer);
    Object.assign(this, { symbols, measured, tall: height, height, room, held: false, under: UNDER }); // held: the scale stays while something is dragged
    this.view = null;
    this.ghosts = []; // other structures that move behind the first model
    this.twin = null; // the same on a fixed base
    this.time = 0;
    this.amplification = 1;
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  show(time, amplification) {
    this.time = time;
    this.amplification = amplification;
    this.draw();
  }

  // The left and the right edge of the base, in metres from the axis of the masses.
  edges({ half_width: b, eccentricity: e } = this.view) {
    return [-b - e, b - e];
  }

  // The drawing of a model at a time, in metres from the axis of the masses.
  frameAt(index, time, amplification, view = this.view) {
    const { heights } = view;
    const [left, right] = this.edges(view);
    const model = view.models[index];
    const [n, sunk] = [heights.length, model.heave ? this.depth / this.zoom : 0];
    const [low, high, share] = bracket(model.t, time);
    const mix = (values, i = low, j = high) => values[i] + share * (values[j] - values[i]);
    const theta = mix(model.rotation);
    // At the instants of uplift and impact the rotation is zero, so either side will do.
    const side = theta > 0 ? 1 : theta < 0 ? -1 : 0;
    const turned = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, theta * amplification));
    const moved = motionOf(model, [low, high, share], side);
    const [across, up] = [amplification * moved.slip, moved.sprung ? amplification * moved.heave : 0];
    const pivot = moved.sprung || side === 0 ? 0 : side > 0 ? right : left;
    const place = (x, y) => {
      const dx = x - pivot;
      return [across + pivot + dx * Math.cos(turned) + y * Math.sin(turned), up + y * Math.cos(turned) - dx * Math.sin(turned)];
    };
    const u = Array.from({ length: n }, (_, i) => mix(model.points, low * n + i, high * n + i));
    // A point of the outline stays on the ground (0), moves sideways with its floor (1), or turns and bends (2).
    const at = ([x, z, how]) => {
      if (!how) return [x, z > 0 ? z : z - sunk];
      const i = Math.max(1, heights.findIndex((each) => each >= z * (1 - 1e-9)));
      const share = (z - heights[i - 1]) / (heights[i] - heights[i - 1]);
      const [x1, z1] = place(x + amplification * (u[i - 1] + share * (u[i] - u[i - 1])), Math.min(z, view.turning ?? Infinity));
      return [x1, how === 1 ? z : z1];
    };
    return {
      ...moved, theta, side, place, at,
      points: heights.map((z) => at([0, z, 2])),
      base: view.turning ? [[left, 0], [right, 0]] : [place(left, 0), place(right, 0)], // under columns it stays
      impact: model.impact_times.some((t) => time >= t && time - t < IMPACT),
    };
  }

  draw() {
    const width = this.canvas.clientWidth;
    if (!width || !this.view) return;
    this.height = narrow.matches ? Math.min(LOW, Math.max(SHARE * innerHeight, LOW / 2), this.tall) : this.tall;
    const g = context(this.canvas, width, this.height);
    const count = this.view.models.length;
    const cell = width / count;
    const all = [this.view, ...this.ghosts];
    const b = Math.max(...all.flatMap((view) => this.edges(view)).map(Math.abs));
    const top = Math.max(...all.map((view) => view.heights.at(-1)));
    const falls = this.view.models.some((model) => model.status === "overturned" || model.fall_time !== null);
    const reach = Math.max(falls ? top + 2 * b : 0.32 * top, 1.6 * b, ...all.map((view) => view.reach));
    const wide = cell / (2.1 * reach);
    if (!this.held || !this.zoom) {
      const first = Math.min((this.height - 30 - this.under) / (top * this.room), wide);
      this.depth = depthOf(this.view, this.amplification, first);
      this.zoom = Math.min((this.height - 30 - this.under - this.depth) / (top * this.room), wide);
    }
    const [before, scale] = [this.scale, [width, this.height, this.under, this.zoom, this.depth].join()];
    Object.assign(this, { width, scale });
    if (scale !== before) this.placed?.(); // which changes the page, so not at every frame
    this.view.models.forEach((model, i) => this.#model(g, model, i, cell * (i + 0.5), this.zoom, cell));
  }

  // Where a point of the only model is while it rests, in px.
  spot(x, y) {
    return [this.width / 2 + this.zoom * x, this.height - this.under - (this.view.models[0].heave ? this.depth : 0) - this.zoom * y];
  }

  #model(g, model, index, centre, zoom, cell) {
    const ground = this.height - this.under; // and above it, the level at which springs are unloaded
    const level = ground - (model.heave ? this.depth : 0);
    const frame = this.frameAt(index, this.time, this.amplification);
    const to = ([x, y]) => [centre + zoom * x, level - zoom * y];
    const path = (points) => {
      g.beginPath();
      for (const point of points) g.lineTo(...to(point));
    };
    g.save();
    g.beginPath();
    g.rect(centre - cell / 2, 0, cell, this.height);
    g.clip();
    drawGround(g, centre - cell / 2, centre + cell / 2, ground);
    if (this.placed) {
      g.strokeStyle = color("control"); // where it rests
      g.setLineDash([4, 3]);
      path([[0, 0], [0, this.view.heights.at(-1)]]);
      g.stroke();
      g.setLineDash([]);
    }
    if (model.slip || frame.sprung) drawStance(g, this.edges(), to, ground);
    if (frame.sprung) drawSprings(g, this.symbols.spring, this.view.ground.springs, frame, to, this.depth);
    else if (frame.side !== 0) {
      // The gap under the base.
      g.fillStyle = color("c1");
      g.globalAlpha = 0.28;
      path([frame.base[0], frame.base[1], [frame.base[1][0], 0], [frame.base[0][0], 0]]);
      g.fill();
      g.globalAlpha = 1;
    }
    g.lineJoin = "round";
    if (this.measured) this.#dimensions(g, to, centre, ground, cell);
    g.globalAlpha = TWIN;
    if (this.twin) drawOutline(g, this.twin, this.frameAt(0, this.time, this.amplification, this.twin), path, "fixed");
    g.globalAlpha = GHOST;
    if (index === 0) for (const ghost of this.ghosts) drawOutline(g, ghost, this.frameAt(0, this.time, this.amplification, ghost), path, ghost.models[0].look.color);
    g.globalAlpha = 1;
    drawOutline(g, this.view, frame, path, "structure");
    const past = (time) => time !== null && time !== undefined && time <= this.time;
    const { elements = [], broken = [], stories = [] } = model.yielding ?? {};
    this.view.elements.forEach(({ symbol, ends }, k) => {
      g.strokeStyle = g.fillStyle = color(past(broken[k]) ? "error" : past(elements[k]) ? "lost" : symbol);
      const more = symbol === "tendons" ? 2 : 0; // thin, and often before a column
      drawBetween(g, this.symbols[symbol], ...ends.map((point) => to(frame.at(point))), 1, more);
    });
    g.strokeStyle = color("lost");
    g.lineWidth = 5;
    for (const [floor, time] of stories) {
      if (!past(time)) continue;
      path([frame.points[floor - 1], frame.points[floor]]); // a story that has yielded
      g.stroke();
    }
    if (frame.impact) this.#blow(g, frame, to);
    this.#words(g, model, index, frame, centre, cell - 8);
    g.restore();
  }

  // Height and width of what stands at rest, a bar of a round length, and how much the motion is amplified.
  #dimensions(g, to, centre, ground, cell) {
    const [left, right] = this.edges();
    const top = this.view.heights.at(-1);
    const small = cell < 300;
    g.strokeStyle = g.fillStyle = color("muted");
    g.font = FONT;
    g.lineWidth = 1;
    const lines = [];
    const [x0, y0] = to([Math.min(left, -this.view.reach), 0]);
    const [, y1] = to([0, top]);
    if (!small) {
      const x = Math.max(centre - cell / 2 + 60, x0 - BESIDE);
      lines.push([x, y0, x, y1], [x - 4, y0, x + 4, y0], [x - 4, y1, x + 4, y1]);
      g.textAlign = "right";
      g.textBaseline = "middle";
      g.fillText(inUnit(top, "length", 3), x - 6, (y0 + y1) / 2);
    }
    const [[a], [b], y] = [to([left, 0]), to([right, 0]), this.height - 9];
    lines.push([a, y, b, y], [a, y - 4, a, y + 4], [b, y - 4, b, y + 4]);
    g.textAlign = "left";
    g.textBaseline = "alphabetic";
    g.fillText(inUnit(right - left, "length", 3), b + 6, y + 4);
    const most = Math.min(90, cell / 5) / this.zoom / unit("length").size;
    const power = 10 ** Math.floor(Math.log10(most));
    const length = power * BARS.findLast((each) => each * power <= most);
    const [from, w] = [centre + cell / 2 - 16, length * unit("length").size * this.zoom];
    if (b + 60 < from - w) {
      lines.push([from - w, y, from, y], [from - w, y - 4, from - w, y + 4], [from, y - 4, from, y + 4]);
      g.textAlign = "center";
      g.fillText(`${number(length)} ${unit("length").name}`, from - w / 2, y - 6);
    }
    g.beginPath();
    for (const [ax, ay, bx, by] of lines) {
      g.moveTo(ax, ay);
      g.lineTo(bx, by);
    }
    g.stroke();
    if (this.amplification === 1) return;
    g.textAlign = "left";
    g.fillText(t("motion × {n}", { n: number(this.amplification, 2) }), centre - cell / 2 + 10, y + 4, a - centre + cell / 2 - 20);
  }

  #blow(g, frame, to) {
    g.strokeStyle = color("lost");
    g.lineWidth = 2.5;
    for (const x of this.edges()) {
      g.beginPath();
      g.arc(...to([x + this.amplification * frame.slip, 0]), 8, 0, 7);
      g.stroke();
    }
  }

  #words(g, model, index, frame, centre, room) {
    const [text, tone] = stateOf(model, frame, this.time);
    g.textAlign = "center";
    g.textBaseline = "alphabetic";
    g.font = `600 ${FONT}`;
    g.fillStyle = color(this.view.colors?.[index] ?? "text");
    g.fillText(model.label, centre, 16, room);
    g.font = FONT;
    g.fillStyle = color(tone);
    // Handles lie under a base that has them, and its words above it.
    const [beside, first, second] = this.placed ? [80, 33, 33] : [0, this.height - 20, this.height - 5];
    g.fillText(text, centre - beside, first, room);
    g.fillStyle = color("muted");
    const { size, name } = unit("rotation");
    const rotation = `${written((frame.theta / size).toFixed(size < 1 ? 2 : 5))} ${name}`;
    g.fillText(room > 100 ? `θ = ${rotation}` : rotation, centre + beside, second, room);
  }
}

// The state of a model in words, and the colour of the words.
function stateOf(model, frame, time) {
  if (Math.abs(frame.theta) > 1.5) return [t("overturned"), "error"];
  if ((model.fall_time ?? Infinity) <= time) return [t("falling"), "error"];
  if (frame.flies) return [t("off the ground"), "c1"];
  if (frame.impact) return [t("impact"), "lost"];
  if (frame.uplifted) return [frame.slides ? t("uplifted, sliding") : t("uplifted"), "c1"];
  if (frame.slides) return [t("sliding"), "friction"];
  return [model.lifts ? t("in contact") : t("fixed base"), "muted"];
}

function drawOutline(g, { strokes }, frame, path, tone) {
  g.strokeStyle = color(tone);
  g.fillStyle = color("shade");
  for (const { points, width, filled } of strokes) {
    g.lineWidth = width;
    path(points.map(frame.at));
    if (filled) g.fill();
    g.stroke();
  }
}

function drawGround(g, left, right, ground) {
  g.strokeStyle = color("muted");
  g.lineWidth = 1;
  g.beginPath();
  g.moveTo(left + 6, ground + 1.5);
  g.lineTo(right - 6, ground + 1.5);
  for (let x = left + 10; x < right - 6; x += 9) {
    g.moveTo(x, ground + 2);
    g.lineTo(x - 5, ground + 8);
  }
  g.stroke();
}

const SPEEDS = [["0.05", "1/20"], ["0.1", "1/10"], ["0.25", "1/4"], ["0.5", "1/2"], ["1", t("real time")], ["2", "× 2"]];
const STEPS = 200; // of the arrow keys over the whole duration

export class Player {
  // `moved` is called with each time shown; with `loop` it begins again at its end.
  constructor(moved, { elements, symbols }, { loop = false, ...size } = {}) {
    Object.assign(this, { moved, kinds: elements, loop, stage: new Stage(symbols, size), view: null, time: 0, amplification: 1, playing: null });
    this.chosen = false; // whether the user chose the amplification
    this.button = h("button", { type: "button", class: "primary", id: "play", onclick: () => this.toggle() }, t("Play"));
    this.speed = h("select", { id: "speed", "aria-label": t("Speed") },
      SPEEDS.map(([value, text]) => h("option", { value }, text)));
    this.speed.value = "1";
    const picture = h("button", { type: "button", id: "picture", onclick: () => this.#save() }, t("Save picture"));
    const jump = h("button", {
      type: "button", title: t("Go to the largest rotation"),
      onclick: () => this.view && this.go(this.view.models[0].peaks.time_of_max_rotation),
    }, t("Largest rotation"));
    // Screen readers read the time from its slider: announcing every frame would never end.
    this.clock = h("output", { id: "clock", for: "scrub", "aria-live": "off" }, `${written("0.00")} s`);
    this.scrub = h("input", {
      type: "range", id: "scrub", min: 0, max: 1, step: 0.001, value: 0, "aria-label": t("Time"),
      oninput: () => this.go(Number(this.scrub.value)),
    });
    this.amplify = slider("amplification", t("Amplification of the drawing"), { low: 1, high: 200, log: true }, 1, (value) => {
      this.chosen = true;
      this.amplification = Number(value) > 0 ? Number(value) : 1;
      this.stage.show(this.time, this.amplification);
    });
    this.stage.canvas.addEventListener("keydown", (event) => this.#key(event));
    this.keys = h("div");
    this.element = h("div", { class: "stage" }, this.stage.element, this.keys,
      h("div", { class: "buttons" }, this.button, this.speed, jump, picture),
      h("div", { class: "buttons time" }, this.scrub, this.clock), this.amplify);
  }

  set(view, colors) {
    this.view = view;
    if (!this.chosen) {
      this.amplification = suited(view);
      this.amplify.setValue(this.amplification);
    }
    this.stage.view = { ...view, colors };
    if (this.stage.held && this.playing) return this.advance();
    const shown = new Map(view.elements.map((each) => [each.kind, each.symbol]));
    this.keys.replaceChildren(legend([...shown].map(([kind, symbol]) => ({ label: t(this.kinds[kind].title), color: symbol }))));
    this.scrub.max = view.end;
    this.scrub.step = Math.max(0.001, Number((view.end / 20000).toPrecision(1)));
    this.move(this.time);
  }

  move(time) {
    this.time = Math.min(Math.max(time, 0), this.view.end);
    this.scrub.value = this.time;
    const text = `${written(this.time.toFixed(2))} s`;
    this.clock.textContent = text;
    this.scrub.setAttribute("aria-valuetext", text);
    this.stage.show(this.time, this.amplification);
    this.moved(this.time);
  }

  // To a time chosen by the user.
  go(time) {
    this.pause();
    if (this.view) this.move(time);
  }

  toggle() {
    if (this.playing) this.pause();
    else this.#start();
  }

  pause() {
    if (this.playing) cancelAnimationFrame(this.playing);
    this.playing = null;
    this.button.textContent = t("Play");
  }

  #start() {
    if (!this.view) return;
    if (this.time >= this.view.end) this.move(0);
    this.button.textContent = t("Pause");
    this.last = performance.now();
    this.#next();
  }

  #next() {
    this.playing = requestAnimationFrame(() => {
      if (!this.playing || this.stage.held) return;
      this.advance();
      if (this.playing) this.#next();
    });
  }

  // While something is dragged each answer brings a picture, and no frame comes between.
  hold(on) {
    this.stage.held = on;
    if (!this.playing) return;
    cancelAnimationFrame(this.playing);
    if (!on) this.#next();
  }

  // To the time that is due.
  advance() {
    const now = performance.now();
    const next = this.time + (Math.min(now - this.last, 100) / 1000) * Number(this.speed.value);
    this.last = now;
    this.move(next >= this.view.end && this.loop ? 0 : next);
    if (this.time >= this.view.end) this.pause();
  }

  // The drawing on its background, as an image.
  #save() {
    const { canvas } = this.stage;
    const sheet = h("canvas", { width: canvas.width, height: canvas.height });
    const g = sheet.getContext("2d");
    g.fillStyle = color("bg");
    g.fillRect(0, 0, canvas.width, canvas.height);
    g.drawImage(canvas, 0, 0);
    sheet.toBlob((blob) => save("rockflex.png", blob));
  }

  #key(event) {
    if (!this.view || event.altKey || event.ctrlKey || event.metaKey) return;
    const step = (this.view.end / STEPS) * (event.shiftKey ? 10 : 1);
    const to = { ArrowLeft: this.time - step, ArrowRight: this.time + step, Home: 0, End: this.view.end }[event.key];
    if (event.key === " ") this.toggle();
    else if (to !== undefined) this.go(to);
    else return;
    event.preventDefault();
  }
}

// The amplification that lets the largest displacement fill a good part of the picture.
function suited(view) {
  const top = view.heights[view.heights.length - 1];
  let largest = 1e-9;
  for (const model of view.models) {
    if (model.status === "overturned") return 1;
    const { peaks } = model;
    largest = Math.max(largest, peaks.max_total_top_displacement ?? peaks.max_rotation * top + peaks.max_top_displacement);
  }
  return Math.min(200, Math.max(1, Number(((0.2 * top) / largest).toPrecision(2))));
}
