// Intensity measures and suites, as the studies offer them.

// Name, title, unit and what stands at an axis.
const MEASURES = [
  ["pgv", "PGV, peak ground velocity", "m/s", "PGV"],
  ["pga", "PGA, peak ground acceleration", "m/s²", "PGA"],
  ["pgd", "PGD, peak ground displacement", "m", "PGD"],
  ["sa_t1", "Sa(T₁), spectral acceleration", "m/s²", "Sa(T₁)"],
  ["sd_t1", "Sd(T₁), spectral displacement", "m", "Sd(T₁)"],
  ["arias", "Arias intensity", "m/s", "Arias intensity"],
  ["cav", "CAV, cumulative absolute velocity", "m/s", "CAV"],
];
const RELATIVE = [
  ["relative_pga", "PGA/(g tan α)", "", "PGA/(g tan α)"],
  ["relative_pgv", "p PGV/(g tan α)", "", "p PGV/(g tan α)"],
];

export { MEASURES };
export const ALL_MEASURES = [...MEASURES, ...RELATIVE];

export const unitOf = (measure) => ALL_MEASURES.find(([name]) => name === measure)[2];

// Short name of a measure with its unit, for an axis.
export function axisOf(measure) {
  const [, , unit, short] = ALL_MEASURES.find(([name]) => name === measure);
  return unit ? `${short} [${unit}]` : short;
}

// Suites of many records, with short names.
export function suitesOf(about) {
  const many = about.suites.filter((name) => name !== "el-centro-1940");
  return many.map((name) => [name, name.replace("fema-p695-", "")]);
}
