// Logs: what they hold, the drag they show, what the simulation gets wrong. All of it in a worker, which
// can be stopped; logs never leave the computer, and are in no link.
import { el, setText } from './dom.js';
import { DrawnFigure } from './figure.js';
import { figuresOf } from './figure_data.js';
import { unpacked } from './link.js';
import { problemWords } from './problems.js';

const most = 1.5e9; // bytes: beyond them the program's 32-bit memory has no room to work in

/** `startWorker()` gives a fresh worker; `spec()` the design at hand; `take(spec)` puts a learned one in use. */
export function buildLearn(place, { startWorker, spec, take }) {
  const logs = new Map(); // name → bytes
  const drawn = [];
  let worker = null;

  const list = el('ul', { class: 'logs' });
  const input = el('input', { type: 'file', multiple: true, class: 'unseen', id: 'log-files',
    onchange: () => { add([...input.files]); input.value = ''; } });
  const drop = el('div', { class: 'drop' },
    el('p', {}, el('strong', {}, 'Drop flight or power logs here'), ' or ',
      el('label', { for: 'log-files', class: 'button quiet' }, 'choose files'), input),
    el('p', { class: 'quiet-text' }, 'ArduPilot .bin and .log, PX4 .ulg, CSV; also packed as .gz. Nothing leaves this computer: the page has no way to send anything.'));
  const mass = option('Mass as flown', 'g', 'mass_g', 'the spec’s');
  const pitch = option('Pitch in level flight', '°', 'pitch_offset_deg', '0');
  const power = el('select', { id: 'learn-power' });
  const flight = el('select', { id: 'learn-flight' });
  const buttons = el('p', { class: 'buttons' },
    el('button', { type: 'button', onclick: () => ask('log') }, 'What it holds'),
    el('button', { type: 'button', onclick: () => ask('drag') }, 'Drag'),
    el('button', { type: 'button', onclick: () => ask('diagnose') }, 'Diagnose'));
  const busy = el('div', { class: 'busy', hidden: true });
  const busyWords = el('span', { role: 'status' });
  busy.append(el('progress', { 'aria-label': 'Working' }), busyWords,
    el('button', { type: 'button', onclick: () => stop('Stopped; nothing was changed.') }, 'cancel'));
  const result = el('div', { class: 'learned', 'aria-live': 'polite' });
  const panel = el('div', { hidden: true },
    list,
    el('div', { class: 'options' },
      el('div', {}, el('label', { for: 'learn-flight' }, 'Flight log'), flight),
      el('div', {}, el('label', { for: 'learn-power' }, 'Power log, for a diagnosis'), power), mass.node, pitch.node),
    buttons);
  place.replaceChildren(drop, panel, busy, result);

  function option(label, unit, name, otherwise) {
    const id = `learn-${name}`;
    const box = el('input', { id, type: 'text', inputmode: 'decimal', placeholder: otherwise, autocomplete: 'off' });
    return { node: el('div', {}, el('label', { for: id }, `${label} (${unit})`), box), name,
      get value() { const text = box.value.trim(); return text === '' ? null : Number.isFinite(Number(text)) ? Number(text) : text; } };
  }

  async function add(files) {
    result.replaceChildren();
    let added = '';
    for (const file of files) {
      if (file.size > most) {
        tell(`${file.name} has ${(file.size / 1e6).toFixed(0)} MB: more than a page can hold. The program on the command line reads it.`);
        continue;
      }
      try {
        const { name, bytes } = await unpacked(file.name, new Uint8Array(await file.arrayBuffer()));
        logs.set(name, bytes);
        added = name;
        chosen(isPower(bytes) ? power : flight, name);
      } catch (error) {
        tell(`${file.name} cannot be read: ${error.message || 'it is damaged'}.`);
      }
    }
    showLogs();
    // A CSV holds what its heads say; what an autopilot's log holds is worth telling at once.
    if (files.length === 1 && logs.has(added) && !added.toLowerCase().endsWith('.csv')) ask('log');
  }

  /** A power log of this project's kind names its supply in its head (docs/diagnosis-power.md). */
  const isPower = (bytes) => /supply_(voltage_V|current_A)/.test(new TextDecoder().decode(bytes.subarray(0, 4096)));

  function chosen(select, name) {
    showLogs();
    select.value = name;
  }

  function showLogs() {
    panel.hidden = logs.size === 0;
    list.replaceChildren(...[...logs].map(([name, bytes]) => el('li', {}, el('span', { class: 'name' }, name),
      ` ${(bytes.length / 1e6).toFixed(bytes.length < 1e7 ? 2 : 0)} MB `,
      el('button', { type: 'button', class: 'quiet', 'aria-label': `Remove ${name}`, onclick() { logs.delete(name); showLogs(); } }, 'remove'))));
    const names = [...logs.keys()];
    const fill = (select, none) => {
      const before = select.value;
      select.replaceChildren(...(none === null ? [] : [el('option', { value: '' }, none)]), ...names.map((name) => el('option', { value: name }, name)));
      if (names.includes(before)) select.value = before;
    };
    fill(flight, 'none');
    fill(power, 'none');
  }

  function tell(words) {
    result.append(el('p', { class: 'note bad', role: 'alert' }, words));
  }

  function stop(words) {
    worker?.terminate();
    worker = null;
    busy.hidden = true;
    clearInterval(stop.clock);
    for (const button of buttons.children) button.disabled = false;
    if (words) tell(words);
  }

  function ask(what) {
    const options = Object.fromEntries([mass, pitch].map(({ name, value }) => [name, value]).filter(([, value]) => value !== null));
    const names = what === 'diagnose' ? [...new Set([flight.value, power.value])].filter(Boolean) : [flight.value || power.value].filter(Boolean);
    result.replaceChildren();
    drawn.length = 0;
    if (!names.length) return tell('No log is chosen.');
    const request = what === 'log' ? { ask: 'log', file: names[0] }
      : what === 'drag' ? { ask: 'drag', file: names[0], spec: spec(), ...options }
        : { ask: 'diagnose', spec: spec(), ...options, ...(flight.value && flight.value === power.value ? { log: flight.value }
          : { ...(flight.value ? { flights: [flight.value] } : {}), ...(power.value ? { power: power.value } : {}) }) };
    const began = performance.now();
    const verb = { log: 'Reading the log', drag: 'Fitting the drag', diagnose: 'Judging every effect on data held out' }[what];
    busy.hidden = false;
    for (const button of buttons.children) button.disabled = true;
    setText(busyWords, `${verb} …`);
    clearInterval(stop.clock);
    stop.clock = setInterval(() => setText(busyWords, `${verb} … ${((performance.now() - began) / 1000).toFixed(0)} s`), 1000);
    worker = startWorker();
    worker.onmessage = ({ data }) => {
      stop();
      let reply;
      try {
        if (data.failed) throw new Error(data.failed);
        reply = JSON.parse(data.answer);
      } catch (error) {
        return tell(`This did not come to an end: ${error.message}. The design and the logs are as they were.`);
      }
      if (reply.problems) return reply.problems.forEach((problem) => tell(problemWords(problem)));
      showLearned(what, reply.answer);
    };
    worker.onerror = (event) => { event.preventDefault(); stop(`This did not come to an end: ${event.message || 'the memory did not suffice'}. The design and the logs are as they were.`); };
    worker.postMessage({ request: JSON.stringify(request), files: Object.fromEntries(names.map((name) => [name, logs.get(name)])) });
  }

  function showLearned(what, answer) {
    const title = { log: 'What it holds', drag: 'The drag that it shows', diagnose: 'What the simulation gets wrong' }[what];
    result.append(el('h3', {}, title));
    if (answer.spec) {
      result.append(el('p', {}, el('button', { type: 'button', class: 'primary', onclick() { take(answer.spec); } }, 'Use in this design')));
    }
    if (answer.notes?.length) result.append(el('ul', { class: 'note plain' }, answer.notes.map((note) => el('li', {}, note))));
    result.append(el('pre', { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': title }, answer.text));
    for (const figure of figuresOf(answer.figures ?? [])) {
      const picture = new DrawnFigure({ heading: 'h4' });
      drawn.push(picture);
      result.append(picture.node);
      picture.show(figure);
    }
    if (answer.command) result.append(el('p', { class: 'command-line' }, el('code', {}, answer.command)));
  }

  return { add, recolour: () => drawn.forEach((picture) => picture.recolour()) };
}
