// A chart on a canvas: lines, bands, points, shaded spans, a cursor that moves without a redraw, zoom by dragging.

import { color, h, number } from "./dom.js";

const FONT = "12px system-ui, 'DejaVu Sans', sans-serif";

export class Chart {
  constructor(options = {}) {
    this.options = { height: 150, ...options };
    this.base = h("canvas", { role: "img", "aria-label": options.label ?? "chart" });
    this.over = h("canvas", { class: "over", "aria-hidden": "true" });
    this.element = h("div", { class: "chart" }, this.base, this.over);
    this.data = { series: [] };
    this.zoom = null;
    this.cursor = null;
    this.hover = null;
    new ResizeObserver(() => this.draw()).observe(this.element);
    this.over.addEventListener("pointermove", (event) => this.#move(event));
    this.over.addEventListener("pointerleave", () => this.#leave());
    this.over.addEventListener("pointerdown", (event) => this.#down(event));
    this.over.addEventListener("pointerup", (event) => this.#up(event));
    this.over.addEventListener("dblclick", () => this.#zoomTo(null));
  }

  set(data) {
    this.data = data;
    this.draw();
  }

  #ranges() {
    const { series, xRange, yRange } = this.data;
    let [x0, x1] = this.zoom ?? xRange ?? extent(series.map((s) => s.x), this.options.xLog);
    if (!(x1 > x0)) [x0, x1] = [x0 - 0.5, x0 + 0.5];
    let range = yRange;
    if (!range) {
      const values = series.flatMap((s) => (s.kind === "band" ? [s.low, s.high] : [s.y]));
      const xs = series.flatMap((s) => (s.kind === "band" ? [s.x, s.x] : [s.x]));
      const until = this.data.yUntil ?? Infinity;
      range = within(values, xs, x0, Math.min(x1, until), this.options.yLog);
      for (const line of this.data.hlines ?? []) if (line.fit) range = [Math.min(range[0], line.y), Math.max(range[1], line.y)];
      if (this.options.symmetric) range = [-Math.max(-range[0], range[1]), Math.max(-range[0], range[1])];
      if (!(range[1] > range[0])) range = [range[0] - (Math.abs(range[0]) || 1), range[0] + (Math.abs(range[0]) || 1)];
      const pad = this.options.yLog ? 0 : 0.05 * (range[1] - range[0]);
      range = [this.options.zero && range[0] >= 0 ? 0 : range[0] - pad, range[1] + pad];
    }
    return { x0, x1, y0: range[0], y1: range[1] };
  }

  draw() {
    const width = this.element.clientWidth;
    if (!width) return;
    const height = this.options.height;
    const scale = window.devicePixelRatio || 1;
    for (const canvas of [this.base, this.over]) {
      canvas.width = Math.round(width * scale);
      canvas.height = Math.round(height * scale);
      canvas.style.height = `${height}px`;
    }
    const g = this.base.getContext("2d");
    g.setTransform(scale, 0, 0, scale, 0, 0);
    g.clearRect(0, 0, width, height);
    g.font = FONT;
    const r = this.#ranges();
    const { xLog, yLog } = this.options;
    const yTicks = yLog ? logTicks(r.y0, r.y1) : ticks(r.y0, r.y1, Math.max(2, Math.floor(height / 34)));
    const xTicks = xLog ? logTicks(r.x0, r.x1) : ticks(r.x0, r.x1, Math.max(2, Math.floor(width / 90)));
    const yText = yTicks.map((v) => tickText(v, yTicks));
    const left = Math.max(this.options.left ?? 52, 22 + Math.max(0, ...yText.map((t) => g.measureText(t).width)));
    const bottom = this.options.xLabel ? 34 : 18;
    const box = { x: left, y: 8, w: Math.max(10, width - left - 12), h: Math.max(10, height - 8 - bottom) };
    const tx = xLog ? Math.log10 : (v) => v;
    const ty = yLog ? Math.log10 : (v) => v;
    const ax = box.w / (tx(r.x1) - tx(r.x0));
    const ay = box.h / (ty(r.y1) - ty(r.y0));
    this.frame = {
      box,
      r,
      px: (v) => box.x + (tx(v) - tx(r.x0)) * ax,
      py: (v) => box.y + box.h - (ty(v) - ty(r.y0)) * ay,
      ix: (p) => (xLog ? 10 ** (tx(r.x0) + (p - box.x) / ax) : r.x0 + (p - box.x) / ax),
    };
    const { px, py } = this.frame;
    g.strokeStyle = color("grid");
    g.fillStyle = color("muted");
    g.lineWidth = 1;
    g.textAlign = "center";
    g.textBaseline = "top";
    for (const v of xTicks) {
      line(g, px(v), box.y, px(v), box.y + box.h);
      if (!this.options.noXText) g.fillText(tickText(v, xTicks), px(v), box.y + box.h + 4);
    }
    g.textAlign = "right";
    g.textBaseline = "middle";
    yTicks.forEach((v, i) => {
      line(g, box.x, py(v), box.x + box.w, py(v));
      g.fillText(yText[i], box.x - 6, py(v));
    });
    g.textAlign = "center";
    if (this.options.xLabel) {
      g.textBaseline = "bottom";
      g.fillText(this.options.xLabel, box.x + box.w / 2, height - 1);
    }
    if (this.options.yLabel) {
      g.save();
      g.translate(9, box.y + box.h / 2);
      g.rotate(-Math.PI / 2);
      g.textBaseline = "middle";
      g.fillStyle = color("text");
      g.fillText(this.options.yLabel, 0, 0);
      g.restore();
    }
    g.save();
    g.beginPath();
    g.rect(box.x, box.y, box.w, box.h);
    g.clip();
    g.fillStyle = color("shade");
    for (const [a, b] of this.data.spans ?? []) g.fillRect(px(a), box.y, Math.max(px(b) - px(a), 0.7), box.h);
    if (!yLog && r.y0 < 0 && r.y1 > 0) {
      g.strokeStyle = color("muted");
      g.lineWidth = 0.7;
      line(g, box.x, py(0), box.x + box.w, py(0));
    }
    for (const each of this.data.series) this.#series(g, each, px, py);
    for (const each of this.data.hlines ?? []) rule(g, each, box.x, py(each.y), box.x + box.w, py(each.y));
    let row = 0;
    for (const each of this.data.vlines ?? []) rule(g, each, px(each.x), box.y, px(each.x), box.y + box.h, each.label ? row++ : 0);
    g.fillStyle = color("c1");
    for (const t of this.data.ticks ?? []) {
      g.beginPath();
      g.moveTo(px(t), box.y + box.h - 6);
      g.lineTo(px(t) - 3, box.y + box.h);
      g.lineTo(px(t) + 3, box.y + box.h);
      g.fill();
    }
    g.restore();
    g.strokeStyle = color("line");
    g.lineWidth = 1;
    g.strokeRect(box.x, box.y, box.w, box.h);
    this.#overlay();
  }

  #series(g, s, px, py) {
    g.globalAlpha = s.alpha ?? 1;
    g.strokeStyle = g.fillStyle = color(s.color);
    g.lineWidth = s.width ?? 1.4;
    g.setLineDash(s.dash ?? []);
    if (s.kind === "points") {
      for (let i = 0; i < s.x.length; i++) {
        g.beginPath();
        g.arc(px(s.x[i]), py(s.y[i]), s.size ?? 2.2, 0, 7);
        if (s.hollow) g.stroke();
        else g.fill();
      }
    } else if (s.kind === "band") {
      g.beginPath();
      for (let i = 0; i < s.x.length; i++) g.lineTo(px(s.x[i]), py(s.high[i]));
      for (let i = s.x.length - 1; i >= 0; i--) g.lineTo(px(s.x[i]), py(s.low[i]));
      g.fill();
    } else {
      g.beginPath();
      for (let i = 0; i < s.x.length; i++) g.lineTo(px(s.x[i]), py(s.y[i]));
      g.stroke();
    }
    g.setLineDash([]);
    g.globalAlpha = 1;
  }

  setCursor(x, point = null) {
    this.cursor = x;
    this.point = point;
    this.#overlay();
  }

  #overlay() {
    if (!this.frame) return;
    const g = this.over.getContext("2d");
    const scale = window.devicePixelRatio || 1;
    const { box, r, px, py } = this.frame;
    g.setTransform(scale, 0, 0, scale, 0, 0);
    g.clearRect(0, 0, this.over.width, this.over.height);
    g.font = FONT;
    if (this.cursor !== null && this.cursor >= r.x0 && this.cursor <= r.x1) {
      g.strokeStyle = color("text");
      g.lineWidth = 1;
      line(g, px(this.cursor), box.y, px(this.cursor), box.y + box.h);
    }
    for (const p of this.point ?? []) {
      g.fillStyle = color(p.color);
      g.beginPath();
      g.arc(px(p.x), py(p.y), 4.5, 0, 7);
      g.fill();
      g.strokeStyle = color("bg");
      g.stroke();
    }
    if (this.drag) {
      g.fillStyle = color("accent");
      g.globalAlpha = 0.15;
      g.fillRect(Math.min(...this.drag), box.y, Math.abs(this.drag[1] - this.drag[0]), box.h);
      g.globalAlpha = 1;
    } else if (this.hover !== null) this.#readout(g);
  }

  #readout(g) {
    const { box, ix } = this.frame;
    const at = ix(this.hover);
    const rows = this.data.series.filter((s) => s.label && s.kind !== "points" && s.kind !== "band" && !s.parametric);
    if (!rows.length || this.options.noReadout) return;
    const texts = [`${this.options.xName ?? "x"} = ${number(at, 4)}`, ...rows.map((s) => `${s.label}: ${number(interpolate(s.x, s.y, at), 4)}`)];
    const w = 10 + Math.max(...texts.map((t) => g.measureText(t).width));
    const x = this.hover + w + 12 > box.x + box.w ? this.hover - w - 8 : this.hover + 8;
    g.fillStyle = color("bg");
    g.strokeStyle = color("line");
    g.globalAlpha = 0.92;
    g.fillRect(x, box.y + 3, w, 15 * texts.length + 5);
    g.globalAlpha = 1;
    g.strokeRect(x, box.y + 3, w, 15 * texts.length + 5);
    g.textBaseline = "top";
    g.textAlign = "left";
    texts.forEach((text, i) => {
      g.fillStyle = i ? color(rows[i - 1].color) : color("text");
      g.fillText(text, x + 5, box.y + 6 + 15 * i);
    });
  }

  #at(event) {
    const { box } = this.frame;
    return Math.min(Math.max(event.offsetX, box.x), box.x + box.w);
  }

  #move(event) {
    if (!this.frame) return;
    this.hover = this.#at(event);
    if (this.start !== undefined && Math.abs(this.hover - this.start) > 6 && event.pointerType !== "touch") this.drag = [this.start, this.hover];
    this.#overlay();
  }

  #leave() {
    this.hover = null;
    this.start = this.drag = undefined;
    this.#overlay();
  }

  #down(event) {
    if (this.frame) this.start = this.#at(event);
  }

  #up(event) {
    if (this.start === undefined) return;
    if (this.drag) this.#zoomTo([this.frame.ix(Math.min(...this.drag)), this.frame.ix(Math.max(...this.drag))]);
    else this.options.onpick?.(this.frame.ix(this.#at(event)));
    this.start = this.drag = undefined;
    this.#overlay();
  }

  #zoomTo(range) {
    for (const chart of this.options.group ?? [this]) {
      chart.zoom = range;
      chart.draw();
    }
  }
}

export function legend(items) {
  return h("div", { class: "legend" }, items.map((item) => {
    const swatch = h("canvas", { width: 44, height: 12, "aria-hidden": "true" });
    swatch.style.width = "22px";
    swatch.style.height = "6px";
    const g = swatch.getContext("2d");
    g.strokeStyle = color(item.color);
    g.lineWidth = item.kind === "band" ? 12 : 4;
    g.globalAlpha = item.alpha ?? 1;
    g.setLineDash((item.dash ?? []).map((d) => 2 * d));
    line(g, 0, 6, 44, 6);
    return h("span", {}, swatch, item.label);
  }));
}

function rule(g, each, x0, y0, x1, y1, row = 0) {
  g.strokeStyle = g.fillStyle = color(each.color ?? "muted");
  g.lineWidth = 1;
  g.setLineDash(each.dash ?? [5, 4]);
  line(g, x0, y0, x1, y1);
  g.setLineDash([]);
  if (each.label) {
    g.textBaseline = "top";
    const level = y0 === y1;
    const flip = !level && x0 + g.measureText(each.label).width + 8 > g.canvas.clientWidth - 12;
    g.textAlign = flip ? "right" : "left";
    if (level) g.textAlign = "right";
    g.fillText(each.label, level ? x1 - 6 : x0 + (flip ? -4 : 4), y0 + 2 + 15 * row);
  }
}

function line(g, x0, y0, x1, y1) {
  g.beginPath();
  g.moveTo(x0, y0);
  g.lineTo(x1, y1);
  g.stroke();
}

function extent(arrays, log) {
  let low = Infinity;
  let high = -Infinity;
  for (const values of arrays)
    for (const v of values)
      if (Number.isFinite(v) && (!log || v > 0)) {
        if (v < low) low = v;
        if (v > high) high = v;
      }
  return high >= low ? [low, high] : log ? [0.1, 1] : [0, 1];
}

function within(arrays, xs, x0, x1, log) {
  let low = Infinity;
  let high = -Infinity;
  arrays.forEach((values, k) => {
    for (let i = 0; i < values.length; i++) {
      const v = values[i];
      if (xs[k][i] < x0 || xs[k][i] > x1 || !Number.isFinite(v) || (log && v <= 0)) continue;
      if (v < low) low = v;
      if (v > high) high = v;
    }
  });
  return high >= low ? [low, high] : log ? [0.1, 1] : [0, 1];
}

// Round numbers about `count` of them, but three at least.
function ticks(low, high, count) {
  const raw = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const steps = [10, 5, 2, 1, 0.5, 0.2].map((m) => m * power);
  const first = steps.filter((s) => s >= raw * 0.999).length - 1;
  for (const step of steps.slice(Math.max(first, 0))) {
    const found = [];
    for (let k = Math.ceil(low / step - 1e-9); k <= Math.floor(high / step + 1e-9) && found.length < 50; k++) found.push(k * step);
    if (found.length >= 3) return found;
  }
  return [low, high];
}

function logTicks(low, high) {
  const found = [];
  const decades = Math.log10(high / low);
  const parts = decades > 4 ? [1] : decades > 1.5 ? [1, 2, 5] : [1, 1.5, 2, 3, 4, 5, 7];
  for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); e++)
    for (const m of parts) {
      const v = m * 10 ** e;
      if (v >= low * 0.999 && v <= high * 1.001) found.push(v);
    }
  return found;
}

function tickText(value, all) {
  const size = Math.max(...all.map(Math.abs));
  if (Math.abs(value) < 1e-9 * size) return "0";
  return number(Number(value.toPrecision(6)), 5);
}

export function interpolate(x, y, at) {
  let low = 0;
  let high = x.length - 1;
  if (high < 0 || at < x[0] || at > x[high]) return NaN;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (x[middle] <= at) low = middle;
    else high = middle;
  }
  const step = x[high] - x[low];
  const share = step > 0 ? (at - x[low]) / step : 1;
  return y[low] + share * (y[high] - y[low]);
}
