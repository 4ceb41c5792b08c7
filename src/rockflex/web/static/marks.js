// The marks of a chart, their legend, and the looks of several models or designs: by colour, and by dashes for the colour-blind.

import { interpolate, line } from "./axes.js";
import { color, h, number, redrawn } from "./dom.js";

export function drawMarks(g, data, { box, range, px, py }, options) {
  g.save();
  g.beginPath();
  g.rect(box.x, box.y, box.w, box.h);
  g.clip();
  g.fillStyle = color("shade");
  for (const [a, b] of data.spans ?? []) g.fillRect(px(a), box.y, Math.max(px(b) - px(a), 0.7), box.h);
  if (!options.yLog && range.y0 < 0 && range.y1 > 0) {
    g.strokeStyle = color("muted");
    g.lineWidth = 0.7;
    line(g, box.x, py(0), box.x + box.w, py(0));
  }
  const series = options.firstOnTop ? data.series.toReversed() : data.series;
  for (const each of series) drawSeries(g, each, px, py);
  for (const each of data.hlines ?? []) rule(g, each, box.x, py(each.y), box.x + box.w, py(each.y), 0, box);
  let row = 0;
  for (const each of data.vlines ?? [])
    rule(g, each, px(each.x), box.y, px(each.x), box.y + box.h, each.label ? row++ : 0, box);
  g.fillStyle = color("c1");
  for (const t of data.ticks ?? []) {
    g.beginPath();
    g.moveTo(px(t), box.y + box.h - 6);
    g.lineTo(px(t) - 3, box.y + box.h);
    g.lineTo(px(t) + 3, box.y + box.h);
    g.fill();
  }
  g.restore();
}

function drawSeries(g, s, px, py) {
  g.globalAlpha = s.alpha ?? 1;
  g.strokeStyle = g.fillStyle = color(s.color);
  g.lineWidth = s.width ?? 1.4;
  g.setLineDash(s.dash ?? []);
  g.beginPath();
  if (s.kind === "points") {
    for (let i = 0; i < s.x.length; i++) {
      g.beginPath();
      g.arc(px(s.x[i]), py(s.y[i]), s.size ?? 2.2, 0, 7);
      if (s.hollow) g.stroke();
      else g.fill();
    }
  } else if (s.kind === "band") {
    for (let i = 0; i < s.x.length; i++) g.lineTo(px(s.x[i]), py(s.high[i]));
    for (let i = s.x.length - 1; i >= 0; i--) g.lineTo(px(s.x[i]), py(s.low[i]));
    g.fill();
    if (s.edge) {
      g.globalAlpha = 1;
      g.lineWidth = 1;
      g.beginPath();
      for (let i = 0; i < s.x.length; i++) g.lineTo(px(s.x[i]), py(s.high[i]));
      g.stroke();
    }
  } else {
    for (let i = 0; i < s.x.length; i++) g.lineTo(px(s.x[i]), py(s.y[i]));
    g.stroke();
  }
  g.setLineDash([]);
  g.globalAlpha = 1;
}

// The last trail first, so that the first one is on top.
export function drawTrails(g, trails, { box, px, py }) {
  g.save();
  g.beginPath();
  g.rect(box.x, box.y, box.w, box.h);
  g.clip();
  g.lineWidth = 2;
  g.lineJoin = "round";
  for (const { xs, ys, n, x, y, color: tone } of trails.toReversed()) {
    g.strokeStyle = color(tone);
    g.beginPath();
    for (let i = 0; i < n; i++) g.lineTo(px(xs[i]), py(ys[i]));
    g.lineTo(px(x), py(y));
    g.stroke();
  }
  g.restore();
}

// A straight line across the chart with its label; labels of vertical ones are stacked.
function rule(g, each, x0, y0, x1, y1, row, box) {
  g.strokeStyle = g.fillStyle = color(each.color ?? "muted");
  g.lineWidth = 1;
  g.setLineDash(each.dash ?? [5, 4]);
  line(g, x0, y0, x1, y1);
  g.setLineDash([]);
  if (!each.label) return;
  const width = g.measureText(each.label).width;
  const level = y0 === y1;
  const flip = level || x0 + width + 8 > box.x + box.w;
  const x = level ? x1 - 6 : x0 + (flip ? -4 : 4);
  const above = level && y0 > box.y + 18;
  const y = above ? y0 - 16 : y0 + 3 + 17 * row;
  g.save();
  g.globalAlpha = 0.8; // lines behind a label must not make it hard to read
  g.fillStyle = color("bg");
  g.fillRect(flip ? x - width - 2 : x - 2, y - 1, width + 4, 15);
  g.restore();
  g.textBaseline = "top";
  g.textAlign = flip ? "right" : "left";
  g.fillText(each.label, x, y);
}

// The values of the labelled series of a chart at x; for a band, its height.
export function readings(series, x) {
  const labelled = series.filter((s) => s.label && s.kind !== "points" && !s.parametric);
  return labelled.map((s) => {
    const value = s.kind === "band" ? interpolate(s.x, s.high, x) - interpolate(s.x, s.low, x) : interpolate(s.x, s.y, x);
    const text = number(value, 4);
    return { color: s.color, value: text, text: `${s.label}: ${text}` };
  });
}

// A box with these rows next to a point on the chart.
export function drawReadout(g, rows, at, box) {
  const left = drawPanel(g, 10 + Math.max(...rows.map((row) => g.measureText(row.text).width)), 15 * rows.length + 5, at, box);
  rows.forEach((row, i) => {
    g.fillStyle = color(row.color);
    g.fillText(row.text, left + 5, box.y + 6 + 15 * i);
  });
}

// The same on one line, which hides less: without names if they would fill half of the chart, below each other if the
// values alone do not fit.
export function drawStrip(g, rows, at, box) {
  const parts = (key) => rows.map((row) => [row[key], row.color, g.measureText(row[key]).width + 10]);
  const length = (row) => row.reduce((sum, [, , width]) => sum + width, 0);
  const named = parts("text");
  const row = length(named) < box.w / 2 ? named : parts("value");
  if (length(row) > box.w) return drawReadout(g, rows, at, box);
  let left = drawPanel(g, length(row), 20, at, box) + 5;
  for (const [text, tone, width] of row) {
    g.fillStyle = color(tone);
    g.fillText(text, left, box.y + 6);
    left += width;
  }
}

// The empty box of a readout beside a point; where it begins.
function drawPanel(g, width, height, at, box) {
  const least = Math.max(1, Math.min(box.x, box.x + box.w - width)); // clear of the labels beside the axis
  const left = at + width + 12 > box.x + box.w ? Math.max(at - width - 8, least) : at + 8;
  g.globalAlpha = 0.92;
  g.fillStyle = color("bg");
  g.fillRect(left, box.y + 3, width, height);
  g.globalAlpha = 1;
  g.strokeStyle = color("line");
  g.strokeRect(left, box.y + 3, width, height);
  g.textBaseline = "top";
  g.textAlign = "left";
  return left;
}

export function legend(items) {
  return h("div", { class: "legend" }, items.map((item) => {
    const canvas = h("canvas", { width: 56, height: 12, "aria-hidden": "true" });
    const draw = () => drawSwatch(canvas.getContext("2d"), item);
    draw();
    return h("span", {}, redrawn(canvas, draw), item.label);
  }));
}

function drawSwatch(g, item) {
  g.clearRect(0, 0, 56, 12);
  g.strokeStyle = color(item.color);
  g.lineWidth = item.kind === "band" ? 12 : 4;
  g.globalAlpha = item.alpha ?? 1;
  g.setLineDash((item.dash ?? []).map((d) => 2 * d));
  line(g, 0, 6, 56, 6);
}

const LOOKS = [
  { color: "c0", dash: [] },
  { color: "c1", dash: [7, 3] },
  { color: "c2", dash: [2, 2] },
  { color: "c3", dash: [7, 2, 2, 2] },
];
const FIXED = [
  { color: "fixed", dash: [4, 3] },
  { color: "fixed2", dash: [10, 4] },
  { color: "fixed", dash: [1, 3] },
  { color: "fixed2", dash: [4, 2, 1, 2] },
];

export const look = (i) => LOOKS[i % LOOKS.length];

// A look for each of several models; those on a fixed base have separate looks.
export function looks(models) {
  let lifting = 0;
  let fixed = 0;
  return models.map((model) => (model.lifts ? look(lifting++) : FIXED[fixed++ % FIXED.length]));
}
