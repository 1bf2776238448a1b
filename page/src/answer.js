// What the program says of the design: headline, the numbers an engineer looks for first, its sentences.
import { byId, el, setText, table } from './dom.js';
import { fixed, shown } from './numbers.js';

const at = (result, path) => path.split('.').reduce((value, key) => value?.[key] ?? null, result.optimum);

/** Numbers of an optimum that stand side by side with those of a pinned design. */
const quantities = [
  ['Cross-section', 'cross_section_mm2', 'mm²', 4],
  ['Supply, hover', 'hover.total_power_W', 'W', 4],
  ['Supply, forward', 'forward.total_power_W', 'W', 4],
  ['Headroom, hover', 'hover.headroom', '', 3],
  ['Tether', 'hover.tether_mass_g', 'g', 4],
  ['Take-off', 'hover.takeoff_mass_g', 'g', 4],
];
const further = [
  ['Headroom, forward', 'forward.headroom', '', 3],
  ['Lost in the tether, hover', 'hover.tether_loss_W', 'W', 3],
  ['Lost in the tether, forward', 'forward.tether_loss_W', 'W', 3],
  ['Current, hover', 'hover.current_A', 'A', 4],
  ['Current, forward', 'forward.current_A', 'A', 4],
  ['Voltage at the drone, hover', 'hover.received_voltage_V', 'V', 4],
  ['Voltage at the drone, forward', 'forward.received_voltage_V', 'V', 4],
  ['Tilt, forward', 'forward.pitch_deg', '°', 3],
  ['Resistance of the tether', 'hover.tether_resistance_ohm', 'Ω', 4],
];

/** `now` against `before`: "+3.1 %", nothing where either is missing. */
export function changeWords(now, before) {
  if (!Number.isFinite(now) || !Number.isFinite(before) || before === 0) return '';
  const percent = 100 * (now / before - 1);
  if (Math.abs(percent) < 0.05) return '±0 %';
  return `${percent > 0 ? '+' : '−'}${Math.abs(percent).toFixed(1)} %`;
}

const tiles = [];

export function buildAnswer() {
  byId('tiles').replaceChildren(...quantities.map(([name, , unit]) => {
    const number = el('span', { class: 'number' }, '–');
    const change = el('span', { class: 'change' });
    tiles.push({ number, change });
    return el('div', { class: 'tile' }, el('dt', {}, name), el('dd', {}, number, el('span', { class: 'unit' }, ` ${unit}`), change));
  }));
}

/** Shows an answer; `pinned` is the result of the pinned design, or null. */
export function showAnswer(answer, pinned) {
  const { result } = answer;
  const good = result.status === 'optimal';
  setText(byId('design-name'), result.name);
  setText(byId('headline'), answer.headline);
  byId('headline').className = good ? 'headline' : 'headline bad';
  quantities.forEach(([, path, , digits], i) => {
    setText(tiles[i].number, shown(at(result, path), digits));
    setText(tiles[i].change, pinned ? changeWords(at(result, path), at(pinned, path)) : '');
  });
  list(byId('sentences'), answer.sentences.filter((sentence) => sentence !== answer.headline));
  list(byId('remedies'), answer.remedies);
  byId('remedies').hidden = answer.remedies.length === 0;
  const warnings = answer.warnings.filter((warning) => !answer.sentences.includes(warning));
  list(byId('warnings'), warnings);
  byId('warnings').hidden = warnings.length === 0;
  setText(byId('glance'), good
    ? `${shown(at(result, 'cross_section_mm2'))} mm² · ${shown(at(result, 'hover.total_power_W'))} W hover · ${shown(at(result, 'forward.total_power_W'))} W forward`
    : answer.headline);
  setText(byId('command'), answer.command);
}

/** The pages of what limits the design and of its warnings, asked for with `explain(code)` once they are opened. */
export function showExplained(result, explain) {
  const codes = [...new Set([result.optimum?.limited_by ?? result.limited_by, ...result.warning_codes])].filter(Boolean);
  const details = byId('explained');
  details.ontoggle = () => {
    if (!details.open || details.dataset.codes === codes.join()) return;
    details.dataset.codes = codes.join();
    byId('explained-codes').replaceChildren(...codes.flatMap((code) => {
      const page = explain(code);
      return page ? [el('h3', {}, `${page.title} `, el('code', {}, code)),
        ...page.parts.flatMap(({ heading, texts }) => [el('h4', {}, heading), ...texts.map((text) => el('p', {}, text))])] : [];
    }));
  };
  details.ontoggle();
}

/** Items are reused, so that what did not change stays as it is. */
function list(node, texts) {
  while (node.children.length > texts.length) node.lastElementChild.remove();
  texts.forEach((text, i) => {
    const words = typeof text === 'string' ? text : text.sentence ?? text.text;
    if (node.children[i]) setText(node.children[i], words);
    else node.append(el('li', {}, words));
  });
}

export function sizesTable(result) {
  if (!result.standard_sizes?.length) return el('p', {}, 'No standard size lies near: nothing can fly as required.');
  return table('Sizes that can be bought', ['size', 'mm²', 'tether g', 'hover W', 'forward W', 'headroom', 'verdict'],
    result.standard_sizes.map((size) => ({
      class: size.feasible ? 'meets' : 'misses',
      cells: [size.name, shown(size.cross_section_mm2), fixed(size.hover?.tether_mass_g, 0), fixed(size.hover?.total_power_W, 1),
        fixed(size.forward?.total_power_W, 1), fixed(size.hover?.headroom, 2),
        size.feasible ? 'meets every requirement' : size.shortcoming ?? 'does not fly'] })), { words: [6] });
}

export function whatIfTable(now, pinned, fields) {
  const rows = [...quantities, ...further].map(([name, path, unit, digits]) => [unit ? `${name} (${unit})` : name,
    shown(at(pinned, path), digits), shown(at(now, path), digits), changeWords(at(now, path), at(pinned, path))]);
  return [
    fields.length
      ? table('Fields that differ', ['field', 'pinned', 'now'], fields.map(({ path, before, after }) => [path, before, after]))
      : el('p', {}, 'The design is as pinned. Move a slider: the table and the pale curves keep the pinned design in sight.'),
    table('The pinned design and this one', ['', 'pinned', 'now', 'change'], rows),
  ];
}

/** A table of the program; `extra(row index)` gives a cell more. */
export function programTable({ title, columns, rows }, caption = title, extra = null) {
  const words = columns.map(({ align }, c) => (align === 'left' ? c : -1)).filter((c) => c > 0);
  const heads = columns.map((column) => column.title);
  return table(caption, extra ? [...heads, 'use'] : heads, rows.map(({ cells, emphasis }, i) => ({
    class: emphasis ? 'main' : null, cells: extra ? [...cells, extra(i)] : cells })),
  { words: extra ? [...words, columns.length] : words });
}

export function motorsTable(answer, current, use) {
  const button = (id) => (id === current ? 'in use'
    : el('button', { type: 'button', class: 'quiet', 'aria-label': `Use ${id}`, onclick: () => use(id) }, 'use'));
  return [programTable(answer.table, 'Motors, each with its own best tether', (i) => button(answer.table.rows[i].cells[0])),
    answer.refused.length ? el('details', {}, el('summary', {}, `Not feasible: ${answer.refused.length}`),
      el('ul', {}, answer.refused.map((words) => el('li', {}, words)))) : null];
}
