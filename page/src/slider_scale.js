// Where a slider begins and ends, and which number a place on it means. A field may allow five powers
// of ten, of which a design uses a small part: a slider spans a window of it around the present value.

export const steps = 1000;
const decade = 4; // times and parts of the present value that a window of a wide field spans

/** The window of a field around `value`, a number or nothing: {lo, hi, law}. */
export function windowAround(field, value) {
  const least = field.least ?? -Infinity;
  const greatest = field.greatest ?? Infinity;
  // A range is shown whole where the value is not lost at its lower end.
  const narrow = Number.isFinite(least) && Number.isFinite(greatest) &&
    (least > 0 ? greatest / least <= 100 : greatest - least <= 100 && !(value > 0 && value < greatest / 20));
  if (narrow) return { lo: least, hi: greatest, law: 'linear' };
  if (!(value > 0)) {
    // From nothing through all powers of ten: the fourth power makes small values easy to reach.
    const hi = Number.isFinite(greatest) ? greatest : 1000;
    return least >= 0 ? { lo: least, hi, law: 'fourth' } : { lo: Math.max(least, -100), hi: Math.min(hi, 100), law: 'linear' };
  }
  return { lo: Math.max(value / decade, least), hi: Math.min(value * decade, greatest), law: 'log' };
}

export function valueOf(window, place, field) {
  const share = place / steps;
  const { lo, hi, law } = window;
  let value = lo + (hi - lo) * share;
  if (law === 'log') value = lo * (hi / lo) ** share;
  if (law === 'fourth') value = lo + (hi - lo) * share ** 4;
  if (field.kind === 'integer') return Math.round(value);
  if (share === 0) value = lo;
  else if (share === 1) value = hi;
  else value = Number(value.toPrecision(law === 'linear' && Math.abs(value) < 1 ? 2 : 3));
  // An end that is excluded is not offered.
  if (field.open[0] && value <= field.least) return valueOf(window, place + 1, field);
  if (field.open[1] && value >= field.greatest) return valueOf(window, place - 1, field);
  return value;
}

export function placeOf(window, value) {
  const { lo, hi, law } = window;
  let share = (value - lo) / (hi - lo);
  if (law === 'log') share = Math.log(value / lo) / Math.log(hi / lo);
  if (law === 'fourth') share = ((value - lo) / (hi - lo)) ** 0.25;
  return Math.round(Math.min(1, Math.max(0, share)) * steps);
}

export const within = (window, value) => value >= window.lo && value <= window.hi;
