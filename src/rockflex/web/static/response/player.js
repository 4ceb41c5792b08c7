// The moving structure with its controls: play, speed, time and amplification.

import { h } from "../dom.js";
import { slider } from "../form.js";
import { legend } from "../marks.js";
import { Stage } from "../stage.js";
import { colorOf } from "../symbols.js";

const SPEEDS = [["0.05", "1/20"], ["0.1", "1/10"], ["0.25", "1/4"], ["0.5", "1/2"], ["1", "real time"], ["2", "× 2"]];
const STEPS = 200; // of the arrow keys over the whole duration

export class Player {
  // `moved` is called with each time shown; `kinds` are those of elements.
  constructor(moved, kinds) {
    this.moved = moved;
    this.kinds = kinds;
    this.stage = new Stage();
    this.view = null;
    this.time = 0;
    this.amplification = 1;
    this.chosen = false; // whether the user chose the amplification
    this.playing = null;
    this.button = h("button", { type: "button", class: "primary", id: "play", onclick: () => this.toggle() }, "Play");
    this.speed = h("select", { id: "speed", "aria-label": "Speed" },
      SPEEDS.map(([value, text]) => h("option", { value }, text)));
    this.speed.value = "1";
    const jump = h("button", {
      type: "button", title: "Go to the largest rotation",
      onclick: () => this.view && this.go(this.view.models[0].peaks.time_of_max_rotation),
    }, "Largest rotation");
    // Screen readers read the time from its slider: announcing every frame would never end.
    this.clock = h("output", { id: "clock", for: "scrub", "aria-live": "off" }, "0.00 s");
    this.scrub = h("input", {
      type: "range", id: "scrub", min: 0, max: 1, step: 0.001, value: 0, "aria-label": "Time",
      oninput: () => this.go(Number(this.scrub.value)),
    });
    this.amplify = slider("amplification", "Amplification of the drawing", { low: 1, high: 200, log: true }, 1, (value) => {
      this.chosen = true;
      this.amplification = Number(value) > 0 ? Number(value) : 1;
      this.stage.show(this.time, this.amplification);
    });
    this.stage.canvas.addEventListener("keydown", (event) => this.#key(event));
    this.keys = h("div");
    this.element = h("div", { class: "stage" }, this.stage.canvas, this.keys,
      h("div", { class: "buttons" }, this.button, this.speed, jump),
      h("div", { class: "buttons time" }, this.scrub, this.clock), this.amplify);
  }

  set(view, colors) {
    this.view = view;
    if (!this.chosen) {
      this.amplification = suited(view);
      this.amplify.setValue(this.amplification);
    }
    this.stage.set({ ...view, colors });
    const shown = Object.keys(this.kinds).filter((kind) => view.elements.some((each) => each.kind === kind));
    this.keys.replaceChildren(legend(shown.map((kind) => ({ label: this.kinds[kind].title, color: colorOf(kind) }))));
    this.scrub.max = view.end;
    this.scrub.step = Math.max(0.001, Number((view.end / 20000).toPrecision(1)));
    this.move(this.time);
  }

  move(time) {
    this.time = Math.min(Math.max(time, 0), this.view.end);
    this.scrub.value = this.time;
    const text = `${this.time.toFixed(2)} s`;
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
    this.button.textContent = "Play";
  }

  #start() {
    if (!this.view) return;
    if (this.time >= this.view.end) this.move(0);
    this.button.textContent = "Pause";
    let last = performance.now();
    const frame = (now) => {
      if (!this.playing) return;
      const step = Math.min(now - last, 100) / 1000;
      last = now;
      this.move(this.time + step * Number(this.speed.value));
      if (this.time >= this.view.end) this.pause();
      else this.playing = requestAnimationFrame(frame);
    };
    this.playing = requestAnimationFrame(frame);
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
