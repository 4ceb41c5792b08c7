// Requests to the server. A refusal has messages by the path of the field at fault.

export class Refusal extends Error {
  constructor(errors, status) {
    super(Object.values(errors).join(" "));
    this.errors = errors;
    this.status = status;
  }
}

async function checked(response) {
  if (response.ok) return response;
  let errors = { "": `The server responded with status ${response.status}.` };
  try {
    errors = (await response.json()).errors ?? errors;
  } catch {
    // not JSON: a proxy's page
  }
  throw new Refusal(errors, response.status);
}

async function request(path, options) {
  let response;
  try {
    response = await fetch(path, options);
  } catch (error) {
    if (error.name === "AbortError") throw new Refusal({}, 0); // replaced by a later request
    throw new Refusal({ "": "The server does not respond. Is rockflex serve still running?" }, 0);
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
  const headers = { "Content-Type": "application/json" };
  const options = { method: "POST", headers, body: JSON.stringify(body), signal: controller.signal };
  return (await request(path, options)).json();
}

export async function send(path, file) {
  return (await request(path, { method: "POST", headers: { "Content-Type": "application/octet-stream" }, body: file })).json();
}

export async function drop(path) {
  return (await request(path, { method: "DELETE" })).json();
}

export async function file(path, body) {
  const options = { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) };
  const response = await request(path, options);
  const name = /filename\*=UTF-8''(\S+)/.exec(response.headers.get("Content-Disposition") ?? "")?.[1] ?? "file";
  return [decodeURIComponent(name), await response.blob()];
}
