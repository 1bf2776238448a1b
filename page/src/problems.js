// A problem in the program's own words, with the place where it is.
export function problemWords({ pointer, line, where, message }) {
  const place = pointer ?? (where && !/^spec\.json(:\d+)?$/.test(where) ? where : null);
  const at = [place, line ? `line ${line} of the spec` : null].filter(Boolean).join(', ');
  return at ? `${at}: ${message}` : message;
}
