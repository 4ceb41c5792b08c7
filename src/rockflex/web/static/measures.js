// Intensity measures and suites, as the studies offer them.

const MEASURES = [
  ["pgv", "PGV, peak ground velocity", "m/s"],
  ["pga", "PGA, peak ground acceleration", "m/s²"],
  ["pgd", "PGD, peak ground displacement", "m"],
  ["sa_t1", "Sa(T₁), spectral acceleration", "m/s²"],
  ["sd_t1", "Sd(T₁), spectral displacement", "m"],
  ["arias", "Arias intensity", "m/s"],
  ["cav", "CAV, cumulative absolute velocity", "m/s"],
];
const RELATIVE = [
  ["relative_pga", "PGA/(g tan α)", ""],
  ["relative_pgv", "p PGV/(g tan α)", ""],
];

export { MEASURES };
export const ALL_MEASURES = [...MEASURES, ...RELATIVE];

export const unitOf = (measure) => ALL_MEASURES.find(([name]) => name === measure)[2];

// Short name of a measure with its unit, for an axis.
export function axisOf(measure) {
  const [, title, unit] = ALL_MEASURES.find(([name]) => name === measure);
  const name = title.split(",")[0];
  return unit ? `${name} [${unit}]` : name;
}

// Suites of many records, with short names.
export function suitesOf(about) {
  const many = about.suites.filter((name) => name !== "el-centro-1940");
  return many.map((name) => [name, name.replace("fema-p695-", "")]);
}
