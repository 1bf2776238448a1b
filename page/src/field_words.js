// What a field of the spec is called beside its control. Paths, units and help come from the program.

/** "length_m" and "m" → "length": the unit stands beside the control already. */
function withoutUnit(name, unit) {
  const plain = unit.replace(/[³]/g, '3').replace(/[²]/g, '2').replace(/[·()]/g, '').replace('°', '')
    .replace('Ω', 'ohm').replace('%', 'percent');
  for (const ending of [plain, plain.replaceAll('/', '_'), plain.replace('/', '_per_'), 'deg']) {
    if (ending && unit && name.endsWith('_' + ending)) return name.slice(0, -ending.length - 1);
  }
  return name;
}

const words = (name) => name.replaceAll('_', ' ');

/** "supply.converter.min_input_voltage_V" → "min input voltage". */
export const labelOf = (field) => words(withoutUnit(field.path.split('.').at(-1), field.unit));

/** "tether.insulation.thickness_mm" → "insulation": the group within its section, "" where there is none. */
export const groupOf = (field) => words(field.path.split('.').slice(1, -1).join(', '));

/** The section of the page: the first part of the path; texts about the design have one of their own. */
export const sectionOf = (field) => (field.path.includes('.') ? field.path.split('.')[0] : 'design');

/** The value of `path` in a parsed spec; undefined where there is none. */
export function valueAt(spec, path) {
  let value = spec;
  for (const key of path.split('.')) {
    if (value === null || typeof value !== 'object') return undefined;
    value = Object.hasOwn(value, key) ? value[key] : undefined;
  }
  return value;
}
