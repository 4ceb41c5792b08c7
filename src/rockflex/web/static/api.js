// Requests to the server. A refusal has messages by the path of the field at fault.

import { t } from "./texts.js";

export class Refusal extends Error {
  constructor(errors, status, state = null) {
    super(Object.values(errors).join(" "));
    Object.assign(this, { errors, status, state }); // the state that opens all the same
  }
}

// The result of `work`; if it is refused, that of `refused`.
export async function attempt(work, refused) {
  try {
    return await work();
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    return refused(error);
  }
}

async function checked(response) {
  if (response.ok) return response;
  const { errors, state } = await response.json().catch(() => ({})); // a proxy's page is not JSON
  throw new Refusal(errors ?? { "": t("The server responded with status {status}.", { status: response.status }) }, response.status, state);
}

const PAGE = new URL("..", import.meta.url); // a server in front may have the page under a path of its own

async function request(path, options) {
  let response;
  try {
    response = await fetch(new URL(`.${path}`, PAGE), options);
  } catch (error) {
    if (error.name === "AbortError") throw new Refusal({}, 0); // replaced by a later request
    throw new Refusal({ "": t("The server does not respond. Is rockflex serve still running?") }, 0);
  }
  return checked(response);
}

export async function get(path) {
  return (await request(path)).json();
}

// A new request replaces a pending one on the same path: the server stops its runs.
const asking = new Map();

export async function ask(path, body) {
  asking.get(path)?.abort();
  const controller = new AbortController();
  asking.set(path, controller);
  const answer = await post(path, "json", JSON.stringify(body), controller.signal);
  return answer.json().catch(() => { throw new Refusal({}, 0); }); // replaced while it was read
}

export async function send(path, file) {
  return (await post(path, "octet-stream", file)).json();
}

// Several files in one request: a line that lists them, then their contents; those above `most` bytes are only listed.
export async function sendAll(path, files, most) {
  const list = files.map((each) => ({
    name: each.webkitRelativePath || each.name, size: each.size, sent: each.size <= most || isArchive(each),
  }));
  const contents = files.filter((_, i) => list[i].sent);
  return send(path, new Blob([`${JSON.stringify(list)}\n`, ...contents]));
}

export const isArchive = ({ name }) => /\.zip$/i.test(name);

function post(path, kind, body, signal) {
  return request(path, { method: "POST", headers: { "Content-Type": `application/${kind}` }, body, signal });
}

export async function drop(path) {
  return (await request(path, { method: "DELETE" })).json();
}

export async function file(path, body) {
  const response = await (body ? post(path, "json", JSON.stringify(body)) : request(path));
  const name = /filename\*=UTF-8''(\S+)/.exec(response.headers.get("Content-Disposition") ?? "")?.[1] ?? "file";
  return [decodeURIComponent(name), await response.blob()];
}
