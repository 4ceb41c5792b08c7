// The texts of the page in its language. English texts are their own names in the catalogue.

let catalogue = {};

// A text, with the values of the names in its braces: t("{count} records", { count: 7 }).
export const t = (text, values = {}) => (catalogue[text] ?? text).replace(/\{(\w+)\}/g, (all, name) => values[name] ?? all);
