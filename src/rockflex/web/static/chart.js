// A chart on a canvas: a cursor that moves without a redraw, zoom by dragging, both by keys as well.

import { drawAxes, FONT, layout, line, ranges } from "./axes.js";
import { color, context, h, number, redrawn } from "./dom.js";
import { drawMarks, drawReadout, drawStrip, drawTrails, readings } from "./marks.js";
import { t } from "./texts.js";

const KEYS = "ArrowLeft ArrowRight Home End + - Escape";

export class Chart {
  constructor(options = {}) {
    this.options = { height: 150, ...options };
    this.base = redrawn(h("canvas", { "aria-hidden": "true" }), () => this.draw());
    this.over = h("canvas", { class: "over", "aria-hidden": "true" });
    this.said = h("p", { class: "hidden", "aria-live": "polite" });
    this.element = h("div", {
      class: "chart", tabindex: 0, role: "application", "aria-roledescription": t("chart"),
      "aria-label": options.label, "aria-keyshortcuts": KEYS,
      onkeydown: (event) => this.#key(event), onblur: () => this.#leave(),
    }, this.base, this.over, this.said);
    this.data = { series: [] };
    this.zooms = []; // intervals of x, each within the one before; the last is shown
    this.cursor = null; // x of the line set from outside
    this.hover = null; // x of the line that follows the pointer or the keys, here or in another chart of the group
    this.by = null; // what it follows: "pointer", "keys", or "group"
    new ResizeObserver(() => this.draw()).observe(this.element);
    this.over.addEventListener("pointermove", (event) => this.#move(event));
    this.over.addEventListener("pointerleave", () => this.#leave());
    this.over.addEventListener("pointerdown", (event) => this.#down(event));
    this.over.addEventListener("pointerup", (event) => this.#up(event));
    this.over.addEventListener("dblclick", () => this.#zoom(() => []));
  }

  get zoom() {
    return this.zooms.at(-1) ?? null;
  }

  set(data) {
    this.data = data;
    this.draw();
  }

  // A line at x, points, and trails: the first `n` nodes of `xs` and `ys`, and from there to the point.
  setCursor(x, points = [], trails = []) {
    this.cursor = x;
    this.points = points;
    this.trails = trails;
    this.#overlay();
  }

  draw() {
    const width = this.element.clientWidth;
    if (!width) return;
    const { height } = this.options;
    const [g, over] = [this.base, this.over].map((canvas) => context(canvas, width, height));
    g.font = over.font = FONT;
    this.frame = layout(g, width, height, ranges(this.data, this.options, this.zoom), this.options);
    drawAxes(g, this.frame, width, height, this.options);
    drawMarks(g, this.data, this.frame, this.options);
    const { box } = this.frame;
    g.strokeStyle = color("line");
    g.lineWidth = 1;
    g.strokeRect(box.x, box.y, box.w, box.h);
    this.#overlay();
  }

  #overlay() {
    if (!this.frame) return;
    const g = this.over.getContext("2d");
    g.clearRect(0, 0, this.over.width, this.over.height);
    const { box, range, px, py } = this.frame;
    g.strokeStyle = color("text");
    if (this.cursor !== null && this.cursor >= range.x0 && this.cursor <= range.x1)
      line(g, px(this.cursor), box.y, px(this.cursor), box.y + box.h);
    if (this.trails?.length) drawTrails(g, this.trails, this.frame);
    const inside = ({ x, y }) => x >= range.x0 && x <= range.x1 && y >= range.y0 && y <= range.y1;
    for (const point of (this.points ?? []).filter(inside)) {
      g.fillStyle = color(point.color);
      g.beginPath();
      g.arc(px(point.x), py(point.y), 4.5, 0, 7);
      g.fill();
      g.strokeStyle = color("bg");
      g.stroke();
    }
    if (this.drag) {
      g.fillStyle = color("accent");
      g.globalAlpha = 0.15;
      g.fillRect(Math.min(...this.drag), box.y, Math.abs(this.drag[1] - this.drag[0]), box.h);
      g.globalAlpha = 1;
    } else if (this.hover !== null) {
      this.#hovered(g);
    }
  }

  // Charts of curves have a line with the values on it; the keys move one in every chart.
  #hovered(g) {
    const { box, px } = this.frame;
    const at = px(this.hover);
    const rows = this.readout;
    const outside = at < box.x - 0.5 || at > box.x + box.w + 0.5;
    if (outside || (rows.length < 2 && this.by !== "keys")) return;
    g.strokeStyle = color(this.by === "keys" ? "focus" : "muted");
    g.lineWidth = this.by === "keys" ? 1 : 0.7;
    line(g, at, box.y, at, box.y + box.h);
    g.lineWidth = 1;
    if (rows.length < 2) return;
    if (this.by === "group") drawStrip(g, rows.slice(1), at, box);
    else drawReadout(g, rows, at, box);
  }

  // The rows of x and of the values there, of which each has a text.
  get readout() {
    if (this.hover === null) return [];
    const { xName = "x" } = this.options;
    return [{ color: "text", text: `${xName} = ${number(this.hover, 4)}` }, ...readings(this.data.series, this.hover)];
  }

  // All charts of a group show the line, and their values there.
  #point(x, by) {
    for (const chart of this.options.group ?? [this]) {
      chart.hover = x;
      chart.by = chart === this ? by : "group";
      chart.#overlay();
    }
  }

  #at(event) {
    const { box } = this.frame;
    return Math.min(Math.max(event.offsetX, box.x), box.x + box.w);
  }

  #move(event) {
    if (!this.frame) return;
    const at = this.#at(event);
    const far = this.start !== undefined && Math.abs(at - this.start) > 6;
    if (far && event.pointerType !== "touch") this.drag = [this.start, at];
    this.#point(this.frame.ix(at), "pointer");
  }

  #leave() {
    this.start = this.drag = undefined;
    this.#point(null, null);
  }

  #down(event) {
    if (this.frame) this.start = this.#at(event);
  }

  #up(event) {
    if (this.start === undefined) return;
    const { ix } = this.frame;
    if (this.drag) this.#zoomTo(ix(Math.min(...this.drag)), ix(Math.max(...this.drag)));
    else this.options.onpick?.(ix(this.#at(event)));
    this.start = this.drag = undefined;
    this.#overlay();
  }

  // Arrows move the cursor, plus and minus zoom about it, Escape shows all.
  #key(event) {
    if (!this.frame || event.altKey || event.ctrlKey || event.metaKey) return;
    const { box, ix, px } = this.frame;
    const right = box.x + box.w;
    const inside = this.cursor !== null && px(this.cursor) >= box.x && px(this.cursor) <= right;
    const now = this.hover !== null ? px(this.hover) : inside ? px(this.cursor) : box.x + box.w / 2;
    const step = (box.w / 100) * (event.shiftKey ? 10 : 1);
    const to = { ArrowLeft: now - step, ArrowRight: now + step, Home: box.x, End: right }[event.key];
    if (to !== undefined) {
      this.#point(ix(Math.min(Math.max(to, box.x), right)), "keys");
      this.options.onpick?.(this.hover);
      this.said.textContent = this.readout.map((row) => row.text).join("; ");
    } else if (event.key === "+" || event.key === "=") this.#zoomTo(ix(now - box.w / 4), ix(now + box.w / 4));
    else if (event.key === "-") this.#zoom((zooms) => zooms.slice(0, -1));
    else if (event.key === "Escape") this.#zoom(() => []);
    else return;
    event.preventDefault();
    this.#overlay();
  }

  #zoomTo(low, high) {
    const { x0, x1 } = this.frame.range;
    this.#zoom((zooms) => [...zooms, [Math.max(low, x0), Math.min(high, x1)]]);
  }

  // All charts of a group show the same interval.
  #zoom(next) {
    for (const chart of this.options.group ?? [this]) {
      chart.zooms = next(chart.zooms);
      chart.hover = null;
      chart.draw();
    }
  }
}

// Charts over time, one below the other, which zoom together; only the last one names the axis.
export function overTime(charts) {
  const group = [];
  for (const options of charts) group.push(new Chart({ xName: "t [s]", group, symmetric: true, left: 80, ...options }));
  withTime(group);
  return group;
}

// Give the last of those that are not hidden the axis of time, and its room.
export function withTime(group) {
  const last = group.findLast(({ element }) => !element.hidden) ?? group.at(-1);
  for (const chart of group) {
    chart.tall ??= chart.options.height;
    Object.assign(chart.options, { xLabel: chart === last ? t("time [s]") : "", noXText: chart !== last, height: chart.tall + (chart === last ? 16 : 0) });
  }
}
