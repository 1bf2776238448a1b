// Values that are more than a number: tables and materials, edited in a dialog.
import { byId, el } from './dom.js';

const dialog = () => byId('value-dialog');
const finish = (act) => { dialog().close(); act(); };

/** A text that is no number stays one: the program says what is wrong with it. */
const asNumber = (text) => (text !== '' && Number.isFinite(Number(text)) ? Number(text) : text);

function open(title, words, submit, ...content) {
  dialog().replaceChildren(el('form', { method: 'dialog', onsubmit(event) { event.preventDefault(); submit(); } },
    el('h2', { id: 'value-title' }, title), el('p', {}, words), ...content,
    el('p', { class: 'buttons end' },
      el('button', { type: 'button', class: 'quiet', onclick: () => dialog().close() }, 'cancel'),
      el('button', { type: 'submit', class: 'primary' }, 'use these values'))));
  dialog().showModal();
}

const nameBox = (name) => el('input', { id: 'value-name', type: 'text', value: name, autocomplete: 'off' });
const named = (box) => el('p', {}, el('label', { for: 'value-name' }, 'Name '), box);

/**
 * Edits `rows` of numbers below `heads`. `use(rows, name)` gets them; `useFile(name, text)`, where it is
 * given, a table with heads of its own, which the program reads itself. `name` null: it has none.
 */
export function editTable({ title, words, heads, rows, name = null, use, useFile = null }) {
  const naming = name === null ? null : nameBox(name);
  const body = el('tbody');
  const problem = el('p', { class: 'problem', role: 'alert' });
  const row = (cells) => el('tr', {},
    heads.map((head, i) => el('td', {}, el('input', { type: 'text', inputmode: 'decimal', 'aria-label': head, value: String(cells[i] ?? ''), autocomplete: 'off' }))),
    el('td', {}, el('button', { type: 'button', class: 'quiet', 'aria-label': 'Remove the row', onclick: (event) => event.target.closest('tr').remove() }, '×')));
  const fill = (list) => body.replaceChildren(...list.map(row));
  fill(rows.length ? rows : [[], []]);

  const pasted = (text) => {
    const cells = text.trim().split(/\r?\n/).filter((line) => line.trim()).map((line) => line.split(/[\t;,]/).map((cell) => cell.trim()));
    problem.textContent = '';
    if (cells.every((line) => line.length === heads.length && line.every((cell) => cell !== '' && Number.isFinite(Number(cell))))) fill(cells);
    else if (useFile) finish(() => useFile('motor.csv', text.replaceAll('\t', ','))); // it knows the heads of many test stands
    else problem.textContent = `What was pasted is not ${heads.length} columns of numbers: ${heads.join(', ')}.`;
  };
  const submit = () => {
    const list = [...body.rows].map((line) => [...line.querySelectorAll('input')].map(({ value }) => value.trim()))
      .filter((cells) => cells.some(Boolean)).map((cells) => cells.map(asNumber));
    finish(() => use(list, naming?.value.trim()));
  };
  open(title, words, submit, naming && named(naming),
    el('div', { class: 'scroll tall', onpaste(event) {
      const text = event.clipboardData.getData('text');
      if (!/[\t\n;]|,.*\n/.test(text.trim())) return;
      event.preventDefault();
      pasted(text);
    } }, el('table', { class: 'editor' }, el('thead', {}, el('tr', {}, heads.map((head) => el('th', { scope: 'col' }, head)), el('td'))), body)),
    problem,
    el('p', { class: 'buttons' },
      el('button', { type: 'button', class: 'quiet', onclick() { body.append(row([])); body.lastElementChild.querySelector('input').focus(); } }, 'add a row'),
      useFile && el('label', { class: 'button quiet' }, 'open a CSV file', el('input', { type: 'file', class: 'unseen', accept: '.csv,.tsv,.txt', async onchange(event) {
        const [file] = event.target.files;
        if (file) { const text = await file.text(); finish(() => useFile(file.name.endsWith('.csv') ? file.name : 'motor.csv', text)); }
      } }))));
}

/** Edits one object by its `fields`, as the program lists them; `values` fills them at the beginning. */
export function editObject({ title, words, fields, values, use }) {
  const boxes = fields.map((field) => ({ field, box: el('input', { id: `value-${field.path}`, type: 'text', autocomplete: 'off',
    inputmode: field.kind === 'number' ? 'decimal' : null, value: String(values[field.path] ?? '') }) }));
  open(title, words,
    () => finish(() => use(Object.fromEntries(boxes.map(({ field, box }) => [field.path, field.kind === 'number' ? asNumber(box.value.trim()) : box.value])
      .filter(([, value]) => value !== '')))),
    boxes.map(({ field, box }) => el('div', { class: 'value' }, el('label', { for: box.id }, `${field.path.replaceAll('_', ' ')}${field.required ? '' : ', may be left out'}`), box, el('p', { class: 'quiet-text' }, field.help))));
}
