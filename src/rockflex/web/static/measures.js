// Intensity measures and suites offered by the studies.

// Values and titles for a list; the search for a width excludes measures that depend on the base.
export function measuresOf(about, ofBase) {
  const offered = about.measures.filter((each) => ofBase || !each.of_base);
  return offered.map((each) => [each.name, each.title]);
}

const named = (about, name) => about.measures.find((each) => each.name === name);

export const unitOf = (about, name) => named(about, name).unit;

// Short name of a measure with its unit, for an axis.
export const axisOf = (about, name) => named(about, name).axis;

export const GIVEN = "given"; // the folder of the visitor among the suites
export const CHOSEN = "chosen"; // and the records for the target spectrum

// Suites of many records, with short names; the folder if there is one, or it is among those chosen; and the records for
// the target spectrum, unless others are to be chosen for it.
export function suitesOf({ about, state }, chosen = [], forTarget = false) {
  const many = about.suites.filter((name) => name !== "el-centro-1940").map((name) => [name, name.replace("fema-p695-", "")]);
  const own = [];
  if (state.record.folder || chosen.includes(GIVEN) || (forTarget && state.target.source === GIVEN)) own.push([GIVEN, "your folder"]);
  if (!forTarget && (state.target.shown || chosen.includes(CHOSEN))) own.push([CHOSEN, "records for the target"]);
  return [...many, ...own];
}
