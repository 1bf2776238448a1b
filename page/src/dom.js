// Elements of the page. Every text reaches it as text, never as markup, whatever a spec or a log is called.

/** An element with properties and children; `on…` are listeners, others attributes, null is left out. */
export function el(tag, properties = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(properties ?? {})) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else if (name === 'class') node.className = value;
    else if (name === 'value' || name === 'checked' || name === 'hidden') node[name] = value;
    else node.setAttribute(name, value === true ? '' : String(value));
  }
  node.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return node;
}

export const byId = (id) => document.getElementById(id);

/** Writes only where it differs, so that what did not change is neither laid out nor read out again. */
export function setText(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/** Gives `bytes` or a text to the user as a file. */
export function download(name, content, type) {
  const address = URL.createObjectURL(new Blob([content], { type }));
  el('a', { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

/** A table with a head, `rows` of cells; columns after the first are numbers unless in `words`. */
export function table(caption, heads, rows, { words = [] } = {}) {
  const kind = (column) => (column === 0 || words.includes(column) ? 'word' : 'n');
  return el('div', { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': caption },
    el('table', {},
      el('caption', { class: 'unseen' }, caption),
      el('thead', {}, el('tr', {}, heads.map((head, c) => el('th', { scope: 'col', class: kind(c) }, head)))),
      el('tbody', {}, rows.map((row) => {
        const cells = Array.isArray(row) ? row : row.cells;
        return el('tr', { class: row.class ?? null }, cells.map((cell, c) =>
          c === 0 ? el('th', { scope: 'row', class: 'word' }, cell) : el('td', { class: kind(c) }, cell)));
      }))));
}
