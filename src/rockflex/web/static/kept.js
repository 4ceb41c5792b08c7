// What the browser keeps for the next visit, where it lets: in private windows, or when it is full, it may refuse.

export function kept(name) {
  try {
    return localStorage.getItem(name);
  } catch {
    return null;
  }
}

export function keep(name, value) {
  try {
    localStorage.setItem(name, value);
  } catch {} // the page works without
}
