// The language of the page, its texts, and its decimal sign. English texts are their own names in the catalogue.

import { keep, kept } from "./kept.js";

const KEPT = "rockflex-language";
const list = document.getElementById("language");
const [given] = [new URLSearchParams(location.search).get("lang"), kept(KEPT), "en"] // not the browser's: a link looks alike for all
  .filter((name) => [...list.options].some((each) => each.value === name));
export const language = document.documentElement.lang = list.value = given;
keep(KEPT, language);
list.addEventListener("change", () => (location.search = `?lang=${list.value}`)); // the state is in the address

// Awaited, so that constants of other modules have their texts. Without it the page is in English.
const catalogue = language === "en" ? {} : await fetch(new URL(`../languages/${language}.json`, import.meta.url)).then((found) => found.json()).catch(() => ({}));

// A text, with the values of the names in its braces: t("{count} records", { count: 7 }).
export const t = (text, values = {}) => (catalogue[text] ?? text).replace(/\{(\w+)\}/g, (all, name) => values[name] ?? all);

// One of two texts with a count: counted(2, t("{n} record"), t("{n} records")).
export const counted = (n, one, several) => (n === 1 ? one : several).replace("{n}", n);

// Whether numbers have a decimal comma.
export const COMMA = language !== "en";

// The digits of a number with the decimal sign of the language, and a true minus.
export const written = (digits) => digits.replace("-", "−").replace(".", COMMA ? "," : ".");
