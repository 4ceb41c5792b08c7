// The structure rocking on its base: every model beside the others, all at one time.

import { color, h } from "./dom.js";

const IMPACT = 0.12; // s for which an impact is marked

export class Stage {
  constructor(height = 340) {
    this.canvas = h("canvas", { role: "img", "aria-label": "Animation of the structure" });
    this.height = height;
    this.view = null;
    this.time = 0;
    this.amplification = 1;
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  set(view) {
    this.view = view;
    this.draw();
  }

  show(time, amplification) {
    this.time = time;
    this.amplification = amplification;
    this.draw();
  }

  // What is drawn of a model at a time, in metres from the centre of the base.
  frameAt(index, time, amplification) {
    const { heights, half_width: b } = this.view;
    const model = this.view.models[index];
    const n = heights.length;
    const [low, high, share] = bracket(model.t, time);
    const mix = (values, i = low, j = high) => values[i] + share * (values[j] - values[i]);
    const theta = mix(model.rotation);
    // At the very instants of uplift and impact the rotation is zero, so either side may be taken.
    const side = theta > 0 ? 1 : theta < 0 ? -1 : 0;
    const turned = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, theta * amplification));
    const place = (x, y) => {
      const pivot = side * b;
      const dx = x - pivot;
      return [pivot + dx * Math.cos(turned) + y * Math.sin(turned), y * Math.cos(turned) - dx * Math.sin(turned)];
    };
    const u = Array.from({ length: n }, (_, i) => mix(model.points, low * n + i, high * n + i));
    return {
      theta, side, u, place,
      points: u.map((value, i) => place(amplification * value, heights[i])),
      base: [place(-b, 0), place(b, 0)],
      impact: model.impact_times.some((t) => time >= t && time - t < IMPACT),
    };
  }

  draw() {
    const width = this.canvas.clientWidth;
    if (!width || !this.view) return;
    const scale = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(width * scale);
    this.canvas.height = Math.round(this.height * scale);
    this.canvas.style.height = `${this.height}px`;
    const g = this.canvas.getContext("2d");
    g.setTransform(scale, 0, 0, scale, 0, 0);
    g.clearRect(0, 0, width, this.height);
    const count = this.view.models.length;
    const cell = width / count;
    const { heights, half_width: b } = this.view;
    const top = heights[heights.length - 1];
    const falls = this.view.models.some((model) => model.status === "overturned" || model.fall_time !== null);
    const reach = falls ? top + 2 * b : Math.max(0.32 * top, 1.6 * b);
    const zoom = Math.min((this.height - 74) / (top * 1.08), cell / (2.1 * reach));
    this.view.models.forEach((model, i) => this.#model(g, model, i, cell * (i + 0.5), zoom, cell));
  }

  #model(g, model, index, centre, zoom, cell) {
    const ground = this.height - 44;
    const f = this.frameAt(index, this.time, this.amplification);
    const { heights, half_width: b, kind } = this.view;
    const to = ([x, y]) => [centre + zoom * x, ground - zoom * y];
    const path = (points) => {
      g.beginPath();
      for (const p of points) g.lineTo(...to(p));
      g.stroke();
    };
    g.save();
    g.beginPath();
    g.rect(centre - cell / 2, 0, cell, this.height);
    g.clip();
    g.strokeStyle = color("muted");
    g.lineWidth = 1;
    g.beginPath();
    g.moveTo(centre - cell / 2 + 6, ground + 1.5);
    g.lineTo(centre + cell / 2 - 6, ground + 1.5);
    g.stroke();
    for (let x = centre - cell / 2 + 10; x < centre + cell / 2 - 6; x += 9) {
      g.beginPath();
      g.moveTo(x, ground + 2);
      g.lineTo(x - 5, ground + 8);
      g.stroke();
    }
    if (f.side !== 0) {
      // The gap under the base.
      g.fillStyle = color("c1");
      g.globalAlpha = 0.28;
      g.beginPath();
      for (const p of [f.base[0], f.base[1], [f.base[1][0], 0], [f.base[0][0], 0]]) g.lineTo(...to(p));
      g.fill();
      g.globalAlpha = 1;
    }
    const wide = heights.length > 25;
    const columns = kind === "frame" || kind === "fish_bone" || kind === "lumped" ? [-0.82 * b, 0.82 * b] : [0];
    g.strokeStyle = color("structure");
    g.lineJoin = "round";
    const at = (x, i) => f.place(x + this.amplification * f.u[i], heights[i]);
    if (kind === "block") {
      g.fillStyle = color("shade");
      g.beginPath();
      for (const p of [f.place(-b, 0), f.place(b, 0), f.place(b, heights[1]), f.place(-b, heights[1])]) g.lineTo(...to(p));
      g.closePath();
      g.fill();
      g.stroke();
    } else {
      g.lineWidth = columns.length > 1 ? 2.4 : kind === "cantilever" || kind === "beam" || kind === "properties" ? 5 : 7;
      for (const x of columns) path(heights.map((_, i) => at(x, i)));
      if (columns.length > 1)
        for (let i = 1; i < heights.length; i++) {
          g.lineWidth = wide ? 1 : 3.2;
          path([at(columns[0], i), at(columns[1], i)]);
        }
      else if (kind === "cantilever") {
        g.fillStyle = color("structure");
        const [x, y] = to(at(0, heights.length - 1));
        g.fillRect(x - 12, y - 7, 24, 14);
      }
    }
    g.lineWidth = 5;
    path([f.place(-b, 0), f.place(b, 0)]);
    g.fillStyle = color("muted");
    for (const x of this.view.tendons) {
      g.strokeStyle = color("tendons");
      g.lineWidth = 1.5;
      path([[x, -0.02 * heights[heights.length - 1]], f.place(x, Math.min(heights[heights.length - 1], 0.6 * heights[heights.length - 1]))]);
    }
    if (f.impact) {
      g.strokeStyle = color("lost");
      g.lineWidth = 2.5;
      for (const x of [-b, b]) {
        const [px, py] = to([x, 0]);
        g.beginPath();
        g.arc(px, py, 8, 0, 7);
        g.stroke();
      }
    }
    const over = Math.abs(f.theta) > 1.5;
    g.font = "600 12px system-ui, 'DejaVu Sans', sans-serif";
    g.textAlign = "center";
    g.fillStyle = color(this.view.colors?.[index] ?? "text");
    g.fillText(model.label, centre, 16);
    g.font = "12px system-ui, 'DejaVu Sans', sans-serif";
    g.fillStyle = over ? color("error") : f.impact ? color("lost") : f.side ? color("c1") : color("muted");
    const state = over ? "overturned" : f.impact ? "impact" : f.side ? "uplifted" : model.lifts ? "in contact" : "fixed base";
    g.fillText(state, centre, this.height - 20);
    g.fillStyle = color("muted");
    g.fillText(`θ = ${(1000 * f.theta).toFixed(2)} mrad`, centre, this.height - 5);
    g.restore();
  }
}

// Indices around a time, and how far it is between them; of the two nodes of an event the later one counts.
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
