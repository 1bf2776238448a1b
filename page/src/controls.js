// One control a field of the spec, made from the program's table of fields.
import { el, setText } from './dom.js';
import { groupOf, labelOf, sectionOf, valueAt } from './field_words.js';
import { placeOf, steps, valueOf, windowAround, within } from './slider_scale.js';

const sections = [['drone', 'Drone'], ['tether', 'Tether'], ['supply', 'Supply'], ['flight', 'Flight'],
  ['requirements', 'Demands'], ['design', 'About the design']];
const numeric = new Set(['number', 'integer', 'efficiency']);
const own = ' own'; // no name in the library begins with a blank

const kinds = { motor: 'motors', conductor: 'conductors', insulation: 'insulations' };

function rangeWords(field) {
  const parts = [];
  if (Number.isFinite(field.least)) parts.push(`${field.open[0] ? 'above' : 'from'} ${field.least}`);
  if (Number.isFinite(field.greatest)) parts.push(`${field.open[1] ? 'below' : 'to'} ${field.greatest}`);
  const range = parts.length ? `${parts.join(' ')} ${field.unit}`.trim() + '. ' : '';
  const without = field.required ? 'Required.'
    : field.default === null ? 'May be left out.' : `Without it: ${JSON.stringify(field.default)}.`;
  return `${field.path}: ${range}${without}`;
}

/**
 * Builds all controls into `place`. `change(path, value, committed)` is called while a value moves and, with
 * `committed`, once it stays. Returns `show(spec, problems)`, which puts a parsed spec (null: unreadable) and
 * its problems into them and returns the problems that belong to none.
 */
export function buildControls(place, about, { change, edit }) {
  const controls = [];
  const known = about.fields.map((field) => ({ ...field, open: field['open ends'] }));
  for (const [id, title] of sections) {
    const fields = known.filter((field) => sectionOf(field) === id && field.path !== '$schema');
    const common = fields.filter((field) => field.common);
    const rest = fields.filter((field) => !field.common);
    const section = el('section', { class: 'fields', 'aria-labelledby': `section-${id}` },
      el('h2', { id: `section-${id}` }, title));
    for (const field of common) section.append(control(field));
    if (rest.length) {
      const more = el('details', { class: 'more' },
        el('summary', {}, common.length ? `more ${title.startsWith('About') ? '' : 'of the '}${title.toLowerCase()}` : `${title.toLowerCase()}: all fields`,
          el('span', { class: 'count' }, ` ${rest.length}`)));
      let group = null;
      for (const field of rest) {
        const name = groupOf(field);
        if (!group || group.name !== name) {
          group = { name, node: el('div', { class: 'group' }, name ? el('h3', {}, name) : null) };
          more.append(group.node);
        }
        group.node.append(control(field));
      }
      section.append(more);
    }
    place.append(section);
  }

  function control(field) {
    const id = `f-${field.path.replaceAll('.', '-')}`;
    const help = el('p', { class: 'help', id: `${id}-help`, hidden: true }, field.help, ' ',
      el('span', { class: 'range' }, rangeWords(field)));
    const problem = el('p', { class: 'problem', id: `${id}-problem`, hidden: true });
    const described = `${id}-help ${id}-problem`;
    const group = groupOf(field);
    const label = labelOf(field);
    // Names such as "material" say what they are only together with their group.
    const shownLabel = field.common && group && !label.includes(group.split(', ').at(-1)) && group !== 'converter'
      ? `${group.split(', ').at(-1)}, ${label}` : label;
    const made = numeric.has(field.kind) ? number() : choice() ?? text();
    const about_ = el('button', { class: 'about', type: 'button', 'aria-expanded': 'false', 'aria-controls': help.id,
      'aria-label': `About ${shownLabel}`, onclick() {
        help.hidden = !help.hidden;
        about_.setAttribute('aria-expanded', String(!help.hidden));
      } }, '?');
    const row = el('div', { class: 'field', 'data-path': field.path },
      el('label', { for: id, title: field.help }, shownLabel), about_, made.node,
      el('span', { class: 'unit' }, field.unit), made.slider ?? null, made.below ?? null, help, problem);
    controls.push({ field, row, problem, shown: undefined, known: false, ...made });
    return row;

    function number() {
      let window_ = windowAround(field, null);
      let anchored = false;
      const input = el('input', { id, type: 'text', inputmode: 'decimal', autocomplete: 'off', spellcheck: 'false',
        'aria-describedby': described, placeholder: defaultWords(),
        oninput: () => change(field.path, parsed(input.value), false),
        onchange: () => change(field.path, parsed(input.value), true) });
      const slider = el('input', { type: 'range', min: 0, max: steps, step: 1, 'aria-label': `${shownLabel}, slider`,
        'aria-describedby': `${id}-help`,
        oninput() {
          const value = valueOf(window_, Number(slider.value), field);
          input.value = String(value);
          slider.setAttribute('aria-valuetext', `${value} ${field.unit}`);
          change(field.path, value, false);
        },
        onchange() {
          // At rest the window lies around the new value again.
          const value = valueOf(window_, Number(slider.value), field);
          window_ = windowAround(field, value);
          slider.value = String(placeOf(window_, value));
          change(field.path, value, true);
        } });
      return { node: input, slider, below: field.fields.length ? editButton() : null, show(value) {
        const list = Array.isArray(value);
        slider.disabled = list;
        input.disabled = list;
        const plain = list ? null : value ?? null;
        if (parsed(input.value) !== plain) input.value = plain === null ? '' : String(plain); // "30.0" stays as it is typed
        if (document.activeElement === slider && anchored) return;
        const present = typeof value === 'number' ? value : field.default;
        if (!anchored || !(typeof present === 'number' && within(window_, present))) {
          window_ = windowAround(field, typeof present === 'number' ? present : null);
          anchored = typeof present === 'number';
        }
        slider.value = String(typeof present === 'number' ? placeOf(window_, present) : 0);
        slider.setAttribute('aria-valuetext', typeof present === 'number' ? `${present} ${field.unit}` : 'not set');
        slider.classList.toggle('unset', typeof value !== 'number');
      } };
    }

    function choice() {
      const library = kinds[field.kind] ? about[kinds[field.kind]] : null;
      const names = library ? library.map((entry) => [entry.id, entry.name ?? entry.id])
        : field.kind === 'flag' ? [['true', 'yes'], ['false', 'no']]
          : (field.choices ?? []).map((name) => [name, name.replaceAll('_', ' ')]);
      if (!names.length) return null;
      const unset = el('option', { value: '' }, field.required ? 'choose' : `not set (${defaultWords()})`);
      const custom = el('option', { value: own, hidden: true }, 'own values');
      const select = el('select', { id, 'aria-describedby': described, onchange() {
        if (select.value === own) return;
        change(field.path, select.value === '' ? null
          : field.kind === 'flag' ? select.value === 'true' : select.value, true);
      } }, unset, names.map(([value, name]) => el('option', { value }, name)), custom);
      const below = library ? editButton() : null;
      return { node: select, below, wide: true, show(value) {
        const text = value === undefined || value === null ? '' : typeof value === 'object' ? own : String(value);
        const known = names.some(([name]) => name === text) || text === '';
        custom.hidden = known;
        if (!known) setText(custom, text === own ? value.name || 'own values' : text);
        select.value = known ? text : own;
      } };
    }

    function text() {
      const list = field.fields.length > 0; // a table, which is read here and edited in its dialog
      const input = el('input', { id, type: 'text', autocomplete: 'off', 'aria-describedby': described, readonly: list,
        placeholder: list ? 'none' : '', onchange: () => change(field.path, input.value.trim() === '' ? null : input.value, true) });
      return { node: input, wide: true, below: list ? editButton() : null, show(value) {
        input.value = value === undefined || value === null || (list && !value.length) ? ''
          : Array.isArray(value) ? `${value.length} rows` : String(value);
      } };
    }

    /** For what is more than a number or a name. */
    function editButton() {
      const what = { motor: 'edit its table', efficiency: 'give a curve', converter_masses: 'edit the table' }[field.kind] ?? 'own values';
      return el('button', { type: 'button', class: 'quiet', 'aria-label': `${shownLabel}: ${what}`, onclick: () => edit(field) }, what);
    }

    function defaultWords() {
      return field.default === null || field.default === ''
        ? '' : String(field.default).replaceAll('_', ' ');
    }
  }

  function parsed(text) {
    const plain = text.trim();
    if (plain === '') return null;
    const value = Number(plain);
    return Number.isFinite(value) ? value : plain; // a text there is a problem, which the program words
  }

  for (const { row, wide } of controls) row.classList.toggle('wide', Boolean(wide));

  /** The control whose field holds what the pointer means: itself, or an object around it. */
  const ownerOf = (pointer) => {
    const path = pointer.replace(/^\//, '').replaceAll('/', '.');
    return controls.filter(({ field }) => path === field.path || path.startsWith(`${field.path}.`))
      .sort((a, b) => b.field.path.length - a.field.path.length)[0];
  };

  return {
    show(spec, problems) {
      for (const control of controls) {
        if (!spec) continue;
        const value = valueAt(spec, control.field.path);
        // While a slider moves, one field of eighty changes; objects are new ones after every reading.
        if (control.shown === value && control.known) continue;
        control.show(value);
        control.shown = value;
        control.known = true;
      }
      const told = new Map();
      const rest = [];
      for (const problem of problems) {
        const owner = problem.pointer ? ownerOf(problem.pointer) : null;
        if (owner) told.set(owner, [...(told.get(owner) ?? []), problem.message]);
        else rest.push(problem);
      }
      for (const control of controls) {
        const words = told.get(control);
        control.problem.hidden = !words;
        setText(control.problem, words ? words.join('\n') : '');
        if (words) {
          control.node.setAttribute('aria-invalid', 'true');
          const more = control.row.closest('details');
          if (more) more.open = true;
        } else control.node.removeAttribute('aria-invalid');
      }
      return rest;
    },
    /** Shows only the fields that hold `words` in their path, label or help; all for an empty text. */
    filter(words) {
      const wanted = words.trim().toLowerCase().split(/\s+/).filter(Boolean);
      for (const { field, row } of controls) {
        const text = `${field.path} ${labelOf(field)} ${field.help}`.toLowerCase();
        row.hidden = !wanted.every((word) => text.includes(word));
      }
      for (const section of place.querySelectorAll('section.fields')) {
        section.hidden = !section.querySelector('.field:not([hidden])');
        const more = section.querySelector('details');
        if (!more) continue;
        const found = more.querySelector('.field:not([hidden])') !== null;
        more.hidden = !found;
        if (wanted.length) more.open = found;
        for (const group of more.querySelectorAll('.group')) group.hidden = !group.querySelector('.field:not([hidden])');
      }
    },
  };
}
