// Axes of a chart: ranges, round numbers, and the maps between values and pixels.

import { color, number } from "./dom.js";

export const FONT = "12px system-ui, 'DejaVu Sans', sans-serif";

// The ranges of both axes: all data, the given ranges, or the zoomed interval.
export function ranges(data, options, zoom) {
  const { series, xRange, yRange, hlines = [] } = data;
  let [x0, x1] = zoom ?? xRange ?? extent(series.map((s) => s.x), options.xLog);
  if (!(x1 > x0)) [x0, x1] = [x0 - 0.5, x0 + 0.5];
  if (yRange) return { x0, x1, y0: yRange[0], y1: yRange[1] };
  // Values after `until` may leave the chart, such as the rotation of a falling structure.
  const parts = series.flatMap((s) => (s.kind === "band" ? [s.low, s.high] : [s.y]).map((y) => [s.x, y, s.until]));
  let [low, high] = within(parts, x0, x1, options.yLog);
  for (const line of hlines.filter((each) => each.fit)) {
    low = Math.min(low, line.y);
    high = Math.max(high, line.y);
  }
  if (options.symmetric) {
    high = Math.max(-low, high);
    low = -high;
  }
  if (!(high > low)) {
    const around = Math.abs(low) || 1;
    [low, high] = [low - around, high + around];
  }
  const pad = options.yLog ? 0 : 0.05 * (high - low);
  return { x0, x1, y0: options.zero && low >= 0 ? 0 : low - pad, y1: high + pad };
}

// The box of the axes on a canvas, their ticks, and the maps between values and pixels.
export function layout(g, width, height, range, options) {
  const { xLog, yLog } = options;
  const yCount = Math.max(2, Math.floor(height / 34));
  const yTicks = yLog ? logTicks(range.y0, range.y1, yCount) : ticks(range.y0, range.y1, yCount);
  const yTexts = yTicks.map((value) => tickText(value, yTicks));
  const left = Math.max(options.left ?? 52, 22 + Math.max(0, ...yTexts.map((text) => g.measureText(text).width)));
  const bottom = options.xLabel ? 34 : 18;
  const box = { x: left, y: 8, w: Math.max(10, width - left - 12), h: Math.max(10, height - 8 - bottom) };
  const xCount = Math.max(2, Math.floor(box.w / (xLog ? 44 : 80)));
  const xTicks = xLog ? logTicks(range.x0, range.x1, xCount) : ticks(range.x0, range.x1, xCount);
  const tx = xLog ? Math.log10 : (value) => value;
  const ty = yLog ? Math.log10 : (value) => value;
  const ax = box.w / (tx(range.x1) - tx(range.x0));
  const ay = box.h / (ty(range.y1) - ty(range.y0));
  const back = (pixel) => tx(range.x0) + (pixel - box.x) / ax;
  return {
    box, range, xTicks, yTicks, yTexts,
    px: (value) => box.x + (tx(value) - tx(range.x0)) * ax,
    py: (value) => box.y + box.h - (ty(value) - ty(range.y0)) * ay,
    ix: (pixel) => (xLog ? 10 ** back(pixel) : back(pixel)),
  };
}

export function drawAxes(g, { box, xTicks, yTicks, yTexts, px, py }, width, height, options) {
  g.strokeStyle = color("grid");
  g.fillStyle = color("muted");
  g.lineWidth = 1;
  g.textAlign = "center";
  g.textBaseline = "top";
  for (const value of xTicks) {
    line(g, px(value), box.y, px(value), box.y + box.h);
    if (options.noXText) continue;
    const text = tickText(value, xTicks);
    const half = g.measureText(text).width / 2;
    const x = Math.max(Math.min(px(value), width - 1 - half), box.x - 4 + half); // clear of the labels beside the axis
    g.fillText(text, x, box.y + box.h + 4);
  }
  g.textAlign = "right";
  g.textBaseline = "middle";
  yTicks.forEach((value, i) => {
    line(g, box.x, py(value), box.x + box.w, py(value));
    g.fillText(yTexts[i], box.x - 6, py(value));
  });
  g.fillStyle = color("text");
  if (options.xLabel) {
    label(g, options.xLabel, box.x + box.w / 2, height - 9);
  }
  if (options.yLabel) {
    g.save();
    g.translate(9, box.y + box.h / 2);
    g.rotate(-Math.PI / 2);
    label(g, options.yLabel, 0, 0);
    g.restore();
  }
}

// Text centred at a point; characters after an underscore are a subscript.
function label(g, text, x, y) {
  const parts = text.split(/_(\w+)/);
  const fonts = [FONT, FONT.replace("12px", "9px")];
  const widths = parts.map((part, i) => {
    g.font = fonts[i % 2];
    return g.measureText(part).width;
  });
  let at = x - widths.reduce((a, b) => a + b) / 2;
  g.textAlign = "left";
  g.textBaseline = "middle";
  parts.forEach((part, i) => {
    g.font = fonts[i % 2];
    g.fillText(part, at, y + 3 * (i % 2));
    at += widths[i];
  });
  g.font = FONT;
}

export function line(g, x0, y0, x1, y1) {
  g.beginPath();
  g.moveTo(x0, y0);
  g.lineTo(x1, y1);
  g.stroke();
}

function extent(arrays, log) {
  return within(arrays.map((values) => [values, values]), -Infinity, Infinity, log);
}

// Lowest and highest y of all pairs of arrays, where x lies from x0 to x1.
function within(parts, x0, x1, log) {
  let low = Infinity;
  let high = -Infinity;
  for (const [x, y, end] of parts)
    for (let i = 0; i < y.length && !(x[i] > end); i++) {
      const value = y[i];
      if (x[i] < x0 || x[i] > x1 || !Number.isFinite(value) || (log && value <= 0)) continue;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  return high >= low ? [low, high] : log ? [0.1, 1] : [0, 1];
}

// Round numbers, about `count` of them, but three at least.
function ticks(low, high, count) {
  const raw = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const steps = [10, 5, 2, 1, 0.5, 0.2].map((m) => m * power);
  const first = steps.filter((s) => s >= raw * 0.999).length - 1;
  for (const step of steps.slice(Math.max(first, 0))) {
    const found = [];
    const last = Math.floor(high / step + 1e-9);
    for (let k = Math.ceil(low / step - 1e-9); k <= last && found.length < 50; k++) found.push(k * step);
    if (found.length >= 3) return found;
  }
  return [low, high];
}

// Round numbers of a logarithmic axis, no more than `count` unless they would be fewer than two.
function logTicks(low, high, count) {
  const found = (parts, each = 1) => {
    const values = [];
    for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); e++)
      for (const m of e % each ? [] : parts) {
        const value = m * 10 ** e;
        if (value >= low * 0.999 && value <= high * 1.001) values.push(value);
      }
    return values;
  };
  const choices = [found([1, 1.5, 2, 3, 4, 5, 7]), found([1, 2, 5]), found([1, 3]), found([1]), found([1], 2), found([1], 4)];
  const few = choices.findIndex((values) => values.length <= count);
  const chosen = choices[few < 0 ? choices.length - 1 : few];
  return chosen.length >= 2 ? chosen : (choices[Math.max(few - 1, 0)] ?? chosen);
}

function tickText(value, all) {
  const size = Math.max(...all.map(Math.abs));
  if (Math.abs(value) < 1e-9 * size) return "0";
  return number(Number(value.toPrecision(6)), 5);
}

export function interpolate(x, y, at) {
  if (!x.length || at < x[0] || at > x[x.length - 1]) return NaN;
  const [low, high, share] = bracket(x, at);
  return y[low] + share * (y[high] - y[low]);
}

// Indices around a time, and its relative position between them; of the two nodes of an event the later one counts.
export function bracket(t, time) {
  let low = 0;
  let high = t.length - 1;
  if (time <= t[0]) return [0, 0, 0];
  if (time >= t[high]) return [high, high, 0];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (t[middle] <= time) low = middle;
    else high = middle;
  }
  return [low, high, (time - t[low]) / (t[high] - t[low])];
}
