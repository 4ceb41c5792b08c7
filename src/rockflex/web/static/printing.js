// Printing: the results of a tab without its forms, in light colours, with charts drawn for the width of a sheet.

const drawings = new WeakMap(); // what draws a canvas again

export function redrawn(canvas, draw) {
  drawings.set(canvas, draw);
  return canvas;
}

// `heading` tells what a sheet is about.
export function printing(heading) {
  const root = document.documentElement;
  const about = document.getElementById("printed");
  let theme = null; // before printing
  addEventListener("beforeprint", () => {
    theme ??= root.dataset.theme;
    root.dataset.theme = "light";
    root.classList.add("printing");
    about.textContent = heading();
    about.hidden = false;
    redraw();
  });
  addEventListener("afterprint", () => {
    root.dataset.theme = theme ?? root.dataset.theme;
    theme = null;
    root.classList.remove("printing");
    about.hidden = true;
    redraw();
  });
}

function redraw() {
  for (const canvas of document.querySelectorAll("canvas")) drawings.get(canvas)?.();
}
