// Numbers as people read them. What is computed is never rounded, only what is shown.

const forms = new Map();
function form(digits) {
  if (!forms.has(digits)) {
    forms.set(digits, new Intl.NumberFormat('en', { maximumSignificantDigits: digits,
      minimumSignificantDigits: digits, useGrouping: false }));
  }
  return forms.get(digits);
}

/** `digits` significant ones; a dash where there is no number. */
export function shown(value, digits = 4) {
  if (typeof value !== 'number' || !Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e7 || size < 1e-4) return value.toExponential(digits - 1);
  if (size >= 10 ** digits) return String(Math.round(value));
  return form(digits).format(value);
}

/** A fixed number of decimals; a dash where there is no number. */
export const fixed = (value, decimals) =>
  typeof value === 'number' && Number.isFinite(value) ? value.toFixed(decimals) : '–';

/** What a slider gives: three digits, without the noise of binary fractions. */
export const roundedTo = (value, digits) => Number(Number(value).toPrecision(digits));
