// One quantity over another, for every model: the whole loop, and on it what has passed at the time of the animation.

import { bracket } from "../axes.js";
import { Chart } from "../chart.js";

export class Loop {
  constructor(options) {
    this.chart = new Chart({ height: 240, firstOnTop: true, xName: options.xLabel, ...options });
    this.curves = [];
    this.time = 0;
  }

  // Models with `x` and `y` over `t`; what follows a fall is left out.
  set(curves) {
    this.curves = curves.map((curve) => {
      const end = curve.until < Infinity ? curve.t.findIndex((t) => t >= curve.until) : curve.t.length;
      return { ...curve, t: curve.t.subarray(0, end), x: curve.x.subarray(0, end), y: curve.y.subarray(0, end) };
    });
    this.chart.set({ series: this.curves.map(({ x, y, label, look }) => (
      { x, y, label, parametric: true, ...look, width: 1, alpha: 0.6 })) });
    this.follow(this.time);
  }

  follow(time) {
    this.time = time;
    const places = this.curves.map(({ t, x, y, look }) => {
      const [low, high, share] = bracket(t, time);
      const at = (values) => values[low] + share * (values[high] - values[low]);
      return { n: low + 1, xs: x, ys: y, x: at(x), y: at(y), color: look.color };
    });
    this.chart.setCursor(null, places, places);
  }
}
