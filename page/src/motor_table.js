// A motor's table edited in place, pasted from a spreadsheet, or taken from a CSV file.
import { byId, el } from './dom.js';

/**
 * Opens the editor with `motor`: {name, points: [[thrust_g, power_W]…]}. `use` gets an inline motor for the
 * spec, `useFile` a table with heads as a file, which the program reads itself.
 */
export function openMotorTable(motor, { use, useFile }) {
  const dialog = byId('motor-dialog');
  const name = el('input', { id: 'motor-name', type: 'text', value: motor.name, autocomplete: 'off' });
  const body = el('tbody');
  const problem = el('p', { class: 'problem', role: 'alert' });
  const row = (thrust = '', power = '') => el('tr', {},
    ...[['thrust in g', thrust], ['power in W', power]].map(([label, value]) => el('td', {},
      el('input', { type: 'text', inputmode: 'decimal', 'aria-label': label, value: String(value), autocomplete: 'off' }))),
    el('td', {}, el('button', { type: 'button', class: 'quiet', 'aria-label': 'Remove the row', onclick: (event) => event.target.closest('tr').remove() }, '×')));
  const fill = (points) => body.replaceChildren(...points.map(([thrust, power]) => row(thrust, power)));
  fill(motor.points.map(([thrust, power]) => [thrust, Number(power.toPrecision(6))]));

  const pasted = (text) => {
    const lines = text.trim().split(/\r?\n/).filter((line) => line.trim());
    const cells = lines.map((line) => line.split(/[\t;,]/).map((cell) => cell.trim()));
    if (cells.every((line) => line.length === 2 && line.every((cell) => cell !== '' && Number.isFinite(Number(cell))))) {
      fill(cells);
      problem.textContent = '';
    } else {
      // A table with heads is the program's to read: it knows the heads of many test stands.
      finish(() => useFile('motor.csv', text.replaceAll('\t', ',')));
    }
  };
  const finish = (act) => { dialog.close(); act(); };

  dialog.replaceChildren(el('form', { method: 'dialog', onsubmit(event) {
    event.preventDefault();
    const points = [...body.rows].map((line) => [...line.querySelectorAll('input')].map(({ value }) => value.trim()))
      .filter((cells) => cells.some(Boolean))
      .map(([thrust, power]) => ({ thrust_g: asNumber(thrust), power_W: asNumber(power) }));
    if (points.length < 2) { problem.textContent = 'A motor needs at least two rows of thrust and power.'; return; }
    finish(() => use({ name: name.value || 'own motor', points }));
  } },
  el('h2', { id: 'motor-title' }, 'The motor’s table'),
  el('p', {}, 'Static thrust and electrical power of one motor with its propeller. Paste two columns from a spreadsheet into any cell, or a whole table with its heads.'),
  el('p', {}, el('label', { for: 'motor-name' }, 'Name '), name),
  el('div', { class: 'scroll tall', onpaste(event) {
    const text = event.clipboardData.getData('text');
    if (!/[\t\n;]|,.*\n/.test(text.trim())) return;
    event.preventDefault();
    pasted(text);
  } }, el('table', { class: 'editor' }, el('thead', {}, el('tr', {}, ['thrust g', 'power W', ''].map((head) => (head ? el('th', { scope: 'col' }, head) : el('td')))), ), body)),
  problem,
  el('p', { class: 'buttons' },
    el('button', { type: 'button', class: 'quiet', onclick() { body.append(row()); body.lastElementChild.querySelector('input').focus(); } }, 'add a row'),
    el('label', { class: 'button quiet' }, 'open a CSV file', el('input', { type: 'file', class: 'unseen', accept: '.csv,.tsv,.txt', async onchange(event) {
      const [file] = event.target.files;
      if (file) { const text = await file.text(); finish(() => useFile(file.name.endsWith('.csv') ? file.name : 'motor.csv', text)); }
    } })),
    el('span', { class: 'push' }),
    el('button', { type: 'button', class: 'quiet', onclick: () => dialog.close() }, 'cancel'),
    el('button', { type: 'submit', class: 'primary' }, 'use this table'))));
  dialog.showModal();
}

/** A text that is no number stays one: the program says what is wrong with it. */
const asNumber = (text) => (text !== '' && Number.isFinite(Number(text)) ? Number(text) : text);
