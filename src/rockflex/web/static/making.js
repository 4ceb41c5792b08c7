// A file that takes long: a button that starts it, its progress, and a button to cancel it.

import { ask, attempt, drop, file, get } from "./api.js";
import { h, save } from "./dom.js";

const POLL = 400; // ms
const SAID = {
  waiting: () => "Waiting for other users' files.",
  running: ({ done, total }) => (total ? `${done} of ${total} frames` : "Computing …"),
  done: () => "Saved.",
  cancelled: () => "Cancelled.",
  failed: () => "",
};

// The button, and the element that shows the progress; messages appear next to the fields of `root`.
export function making(app, root, what, label) {
  let token = null;
  const button = h("button", { type: "button", "data-file": what, onclick: make }, label);
  const cancel = h("button", { type: "button", onclick: () => attempt(() => drop(`/api/file/${token}`), refused) }, "Cancel");
  const bar = h("progress", { max: 1, value: 0, "aria-label": `Progress of ${label}` });
  const status = h("p", { class: "help", role: "status" });
  const going = h("div", { class: "making", hidden: true }, bar, cancel);
  const refused = (error) => app.complain(root, error.errors);

  async function make() {
    if (button.ariaBusy === "true") return;
    button.ariaBusy = "true";
    bar.value = 0;
    status.textContent = "";
    await attempt(follow, refused);
    going.hidden = true;
    button.ariaBusy = "false";
  }

  async function follow() {
    ({ token } = await ask(`/api/file/${what}`, { state: app.state }));
    app.complain(root, {});
    going.hidden = false;
    for (;;) {
      const answer = await get(`/api/file/${token}`);
      bar.value = answer.total ? answer.done / answer.total : 0;
      status.textContent = SAID[answer.status](answer);
      if (answer.status === "failed") app.complain(root, answer.errors);
      if (answer.status === "done") return save(...(await file(`/api/file/${token}/content`)));
      if (!["waiting", "running"].includes(answer.status)) return null;
      await new Promise((resolve) => setTimeout(resolve, POLL));
    }
  }
  return { button, element: h("div", { id: `making-${what}` }, going, status) };
}
