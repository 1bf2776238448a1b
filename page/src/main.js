import { buildAnswer, motorsTable, showAnswer, showExplained, sizesTable, whatIfTable } from './answer.js';
import { buildControls } from './controls.js';
import { openCore } from './core.js';
import { byId, download, el, setText } from './dom.js';
import { valueAt } from './field_words.js';
import { DrawnFigure, takeColours } from './figure.js';
import { figuresOf } from './figure_data.js';
import { makeHistory } from './history.js';
import { buildLearn } from './learn.js';
import { editObject, editTable } from './value_dialog.js';
import { packedProgram } from './packed_program.js';
import { problemWords } from './problems.js';

const views = [['sizes', 'Sizes'], ['whatif', 'What if'], ['motors', 'Motors'], ['envelope', 'Envelope'],
  ['cable', 'Cable'], ['learn', 'Learn from a log'], ['spec', 'Spec']];
const specLimit = 5e6; // bytes; a log dropped by its wrong name is not taken for a spec

let call; // the program: (request, files) → answer
let about;
let state = { spec: '', pinned: null, files: {}, view: 'sizes' };
let shownAnswer = null; // the last one without problems
let pinnedAnswer = null;
let controls;
let learn;
const main = new DrawnFigure({ heading: 'h2', unseen: true });
const side = []; // figures of the view at hand
const places = new Map(); // of views that keep what is in them

const encoder = new TextEncoder();

function ask(name, request = {}) {
  const files = Object.fromEntries(Object.entries(state.files).map(([file, text]) => [file, encoder.encode(text)]));
  try {
    return JSON.parse(call(JSON.stringify({ ask: name, ...request }), files));
  } catch (error) {
    return { problems: [{ pointer: null, line: null, where: null, message: `the program stopped: ${error.message}; load the page again` }] };
  }
}

function parsedSpec(text) {
  try {
    const spec = JSON.parse(text);
    return spec !== null && typeof spec === 'object' ? spec : null;
  } catch {
    return null;
  }
}

// --- From the state to the page ---

function refresh({ sliding = false } = {}) {
  const reply = ask('optimize_and_figures', { spec: state.spec, kinds: ['optimum'], brief: true });
  const rest = controls.show(parsedSpec(state.spec), reply.problems ?? []);
  document.body.classList.toggle('stale', Boolean(reply.problems));
  showProblems(rest, reply.problems?.length ?? 0);
  if (reply.answer) {
    shownAnswer = { ...reply.answer, figures: figuresOf(reply.answer.figures) };
    showAnswer(shownAnswer, pinnedAnswer?.result ?? null);
    showExplained(shownAnswer.result, (code) => ask('explain', { code }).answer?.result);
    main.show(shownAnswer.figures[0], pinnedAnswer?.figures[0] ?? null);
    document.title = `${shownAnswer.result.name || 'tethercalc'} · tethercalc`;
  } else if (!shownAnswer) setText(byId('headline'), 'There is no answer yet.');
  if (!sliding) showView();
}

function showProblems(rest, count) {
  const list = byId('problems');
  const texts = rest.map(problemWords);
  if (count > rest.length) {
    const elsewhere = count - rest.length;
    texts.push(`${elsewhere === 1 ? 'One field is' : `${elsewhere} fields are`} not as allowed; see beside ${elsewhere === 1 ? 'it' : 'them'}. What is shown is the last answer.`);
  }
  const key = texts.join('\n');
  if (list.dataset.key === key) return;
  list.dataset.key = key;
  list.hidden = texts.length === 0;
  list.replaceChildren(...texts.map((text) => el('li', {}, text)));
}

function notice(words, bad = true) {
  byId('notices').replaceChildren(el('p', { class: bad ? 'note bad' : 'note' }, words, ' ',
    el('button', { type: 'button', class: 'quiet', onclick: () => byId('notices').replaceChildren() }, 'Close')));
}

const say = (words) => setText(byId('said'), words);

// --- Changes ---

const pending = new Map(); // path → value, put in before the next frame is drawn
let frame = 0;
let settling = 0;

function change(path, value, committed) {
  pending.set(path, value);
  if (committed) {
    applyPending();
    holdHeight(false);
    refresh();
    commit();
    return;
  }
  holdHeight(true);
  if (!frame) frame = requestAnimationFrame(redraw);
}

function redraw() {
  frame = 0;
  performance.mark('change');
  applyPending();
  refresh({ sliding: true });
  // uPlot draws in a microtask of its own; the measure ends behind it.
  queueMicrotask(() => queueMicrotask(() => performance.measure('redraw', 'change')));
  clearTimeout(settling);
  settling = setTimeout(showView, 150);
}

function applyPending() {
  for (const [path, value] of pending) {
    const reply = ask('set', { spec: state.spec, path, value });
    if (reply.answer) state.spec = reply.answer.spec;
    else showProblems(reply.problems, reply.problems.length);
  }
  pending.clear();
}

/** While a slider moves, the answer keeps the greatest height it had: nothing below it jumps. */
function holdHeight(hold) {
  const saying = document.querySelector('.saying');
  if (!hold) { saying.style.minHeight = ''; return; }
  saying.style.minHeight = `${Math.max(saying.offsetHeight, parseFloat(saying.style.minHeight) || 0)}px`;
}

let history_;
const commit = () => history_.push(state);

/** A whole new spec, from a file, an example, a log. */
function setSpec(spec, files = state.files) {
  state = { ...state, spec, files };
  refresh();
  commit();
}

function showState(next) {
  const pinnedChanged = next.pinned !== state.pinned || !pinnedAnswer;
  state = next;
  if (pinnedChanged) takePinned();
  selectTab(state.view, false);
  refresh();
}

// --- Pinned design ---

function takePinned() {
  pinnedAnswer = null;
  if (state.pinned !== null) {
    const { answer } = ask('optimize_and_figures', { spec: state.pinned, kinds: ['optimum'], brief: true });
    if (answer) pinnedAnswer = { ...answer, figures: figuresOf(answer.figures) };
    else state.pinned = null;
  }
  byId('pin').setAttribute('aria-pressed', String(state.pinned !== null));
  setText(byId('pin'), state.pinned !== null ? 'Unpin' : 'Pin this design');
}

function differences(before, after) {
  const [a, b] = [parsedSpec(before), parsedSpec(after)];
  if (!a || !b) return [];
  const words = (value) => (value === undefined ? 'not set' : typeof value === 'string' ? value : JSON.stringify(value));
  return about.fields.map(({ path }) => ({ path, before: words(valueAt(a, path)), after: words(valueAt(b, path)) }))
    .filter(({ before: was, after: is }) => was !== is);
}

// --- Views ---

function buildTabs() {
  const tabs = byId('tabs');
  tabs.replaceChildren(...views.map(([id, name]) => el('button', { type: 'button', role: 'tab', id: `tab-${id}`,
    'aria-controls': 'view', 'aria-selected': 'false', tabindex: '-1', onclick: () => { selectTab(id); commit(); } }, name)));
  tabs.addEventListener('keydown', (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const ids = views.map(([id]) => id);
    const next = ids[(ids.indexOf(state.view) + step + ids.length) % ids.length];
    selectTab(next);
    byId(`tab-${next}`).focus();
  });
}

function selectTab(id, show = true) {
  state.view = views.some(([known]) => known === id) ? id : 'sizes';
  for (const tab of byId('tabs').children) {
    const chosen = tab.id === `tab-${state.view}`;
    tab.setAttribute('aria-selected', String(chosen));
    tab.tabIndex = chosen ? 0 : -1;
  }
  byId('view').setAttribute('aria-labelledby', `tab-${state.view}`);
  if (show) showView();
}

let shownView = '';
function showView() {
  if (!shownAnswer) return showOnly(state.view === 'spec' ? specView() : state.view === 'learn' ? places.get('learn') : el('p', {}, 'There is no answer yet.'));
  // What a view shows follows from these; an unchanged one is left as it is, with its scroll and focus.
  const key = JSON.stringify([state.view, state.spec, state.pinned, document.body.classList.contains('stale'), motorsAsked]);
  if (key === shownView && byId('view').firstChild) return;
  shownView = key;
  side.length = 0;
  const made = { sizes: () => sizesTable(shownAnswer.result), whatif: whatIfView, motors: motorsView, envelope: envelopeView,
    cable: cableView, learn: () => places.get('learn'), spec: specView }[state.view]();
  showOnly(...[made].flat());
  for (const { picture, figure } of side) picture.show(figure);
}

function showOnly(...nodes) {
  byId('view').replaceChildren(...nodes.filter(Boolean));
}

function drawnBeside(figure) {
  const picture = new DrawnFigure({ heading: 'h3' });
  side.push({ picture, figure });
  return picture.node;
}

const told = (problems) => el('ul', { class: 'note bad' }, problems.map((problem) => el('li', {}, problemWords(problem))));
const commandLine = (words) => el('p', { class: 'command-line' }, el('code', {}, words));

function whatIfView() {
  if (!pinnedAnswer) {
    return el('div', {}, el('p', {}, 'Pin the design as it stands, then change it: both stand side by side, here, in the numbers above and in the curves.'),
      el('p', {}, el('button', { type: 'button', class: 'primary', onclick: togglePin }, 'Pin this design')));
  }
  return whatIfTable(shownAnswer.result, pinnedAnswer.result, differences(state.pinned, state.spec));
}

let motorsAsked = 'alike';
function motorsView() {
  const { answer, problems } = ask('compare', { spec: state.spec, motors: [motorsAsked] });
  const choose = el('select', { id: 'motors-asked', onchange() { motorsAsked = choose.value; showView(); } },
    el('option', { value: 'alike' }, 'alike in thrust'), el('option', { value: 'all' }, 'the whole library'));
  choose.value = motorsAsked;
  const head = el('p', {}, el('label', { for: 'motors-asked' }, 'Motors '), choose);
  if (problems) return [head, told(problems)];
  const current = valueAt(parsedSpec(state.spec), 'drone.motor');
  const drawn = ask('figures', { spec: state.spec, kinds: ['motors'], motors: [motorsAsked] }).answer;
  return [head, ...motorsTable(answer, current, (id) => change('drone.motor', id, true)),
    drawn ? drawnBeside(figuresOf(drawn.figures)[0]) : null, commandLine(`tethercalc compare spec.json --motors ${motorsAsked}`)];
}

function envelopeView() {
  const { answer, problems } = ask('envelope', { spec: state.spec });
  if (problems) return told(problems);
  const { greatest, curves } = answer.result;
  return [el('ul', { class: 'sentences' }, Object.values(greatest).filter((one) => one?.sentence).map(({ sentence }) => el('li', {}, sentence))),
    ...curves.filter(({ points }) => points.length > 1).length ? [drawnBeside(envelopeFigure(curves))] : [],
    el('details', {}, el('summary', {}, 'As the program prints it'), el('pre', { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': 'Envelope' }, answer.text)),
    commandLine(answer.command)];
}

/** "payload_g" → "payload (g)" */
const quantityWords = (name) => {
  const [, words, unit] = name.match(/^(.*?)_(m_s|m|g|deg)$/) ?? [null, name, ''];
  return unit ? `${words.replaceAll('_', ' ')} (${unit === 'm_s' ? 'm/s' : unit})` : words;
};

function envelopeFigure(curves) {
  const axis = (label, values) => ({ label, logarithmic: false, numbers: true, ticks: [],
    range: { lo: 0, hi: Math.max(...values.filter(Number.isFinite), 1e-9) * 1.05 } });
  return { heading: 'How far this cable carries', description: 'The greatest value of one quantity over another, as in the sentences above.',
    parts: curves.filter(({ points }) => points.length > 1).map(({ of, against, points }) => {
      const [x, y] = [against, of].map((name) => points.map((point) => point[name]));
      return { kind: 'panel', title: `${quantityWords(of).replace(/ \(.*/, '')} against ${quantityWords(against).replace(/ \(.*/, '')}`,
        x: axis(quantityWords(against), x), y: axis(quantityWords(of), y), top: null, key: [], scale: null,
        layers: [{ kind: 'curve', x, y, colour: 'blue', width: 1.4, dash: [], words: quantityWords(of) }] };
    }) };
}

function cableView() {
  const { answer, problems } = ask('shape', { spec: state.spec });
  if (problems) return told(problems);
  return [...figuresOf(answer.figures).map(drawnBeside),
    el('pre', { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': 'The cable as it hangs' }, answer.text)];
}

function specView() {
  const box = el('textarea', { id: 'spec-text', spellcheck: 'false', rows: 28, value: state.spec, onchange: () => setSpec(box.value) });
  return el('div', {}, el('p', {}, el('label', { for: 'spec-text' }, 'The spec, as the program reads it; a change counts when you leave the box')), box);
}

// --- Tools ---

function togglePin() {
  state = { ...state, pinned: state.pinned === null ? state.spec : null };
  takePinned();
  refresh();
  commit();
}

function fileName(ending) {
  const name = (shownAnswer?.result.name || 'design').toLowerCase().replace(/[^a-z0-9]+/g, '-').replace(/^-|-$/g, '').slice(0, 60);
  return `${name || 'design'}${ending}`;
}

const saves = [
  ['Spec (JSON)', () => {
    download('spec.json', state.spec, 'application/json');
    // A motor's table that the spec names goes with it.
    for (const [name, text] of Object.entries(state.files)) {
      if (valueAt(parsedSpec(state.spec), 'drone.motor') === name) download(name, text, 'text/csv');
    }
  }],
  ['Report (HTML)', () => save('report', {}, 'html', '.html', 'text/html')],
  ['Table (CSV)', () => save('csv', { of: { motors: 'compare', envelope: 'envelope', cable: 'shape' }[state.view] ?? 'optimize',
    ...(state.view === 'motors' ? { motors: [motorsAsked] } : {}) }, 'csv', '.csv', 'text/csv')],
  ['Figure (SVG)', () => save('svg', { kind: { motors: 'motors', cable: 'shape' }[state.view] ?? 'optimum',
    ...(state.view === 'motors' ? { motors: [motorsAsked] } : {}) }, 'svg', '.svg', 'image/svg+xml')],
];

/** Buttons that open below a summary, and close when one is pressed or something else is done. */
function menu(node, items) {
  const close = () => { node.open = false; };
  node.lastElementChild.replaceChildren(...items.map(([name, act]) => el('button', { type: 'button', onclick() { close(); act(); } }, name)));
  node.addEventListener('keydown', (event) => { if (event.key === 'Escape') { close(); node.firstElementChild.focus(); } });
  node.addEventListener('focusout', (event) => { if (event.relatedTarget && !node.contains(event.relatedTarget)) close(); });
  addEventListener('pointerdown', (event) => { if (!node.contains(event.target)) close(); });
}

function save(what, request, member, ending, type) {
  const { answer, problems } = ask(what, { spec: state.spec, ...request });
  if (problems) return notice(problems.map(problemWords).join(' '));
  download(fileName(ending), answer[member], type);
}

async function copy(text, words) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    // Without the right to the clipboard, as on file:// in some browsers, the old way still works.
    const box = el('textarea', { value: text, class: 'unseen' });
    document.body.append(box);
    box.select();
    document.execCommand('copy');
    box.remove();
  }
  say(words);
  notice(words, false);
  setTimeout(() => { if (byId('notices').textContent.startsWith(words)) byId('notices').replaceChildren(); }, 2500);
}

/** Specs, motor tables and logs find their place by what they hold. */
async function takeFiles(files) {
  const logs = [];
  for (const file of files) {
    const lower = file.name.toLowerCase();
    if (lower.endsWith('.json')) {
      if (file.size > specLimit) notice(`${file.name} has ${(file.size / 1e6).toFixed(0)} MB and is no spec.`);
      else setSpec(await file.text());
    } else if (lower.endsWith('.csv') && file.size < specLimit && /thrust/i.test((await file.slice(0, 4096).text()))) {
      useMotorFile(file.name, await file.text());
    } else logs.push(file);
  }
  if (logs.length) {
    selectTab('learn');
    byId('view').scrollIntoView({ block: 'nearest' });
    await learn.add(logs);
  }
}

function useMotorFile(name, text) {
  state = { ...state, files: { [name]: text } };
  change('drone.motor', name, true);
}

/** Opens the dialog of a field that is more than a number or a name. */
function edit(field) {
  const present = valueAt(parsedSpec(state.spec), field.path);
  const put = (value) => change(field.path, value, true);
  if (field.kind === 'motor') editMotor(present, put);
  else if (field.kind === 'efficiency' || field.kind === 'converter_masses') {
    const columns = field.fields.map(({ path }) => path);
    editTable({ title: field.kind === 'efficiency' ? 'The converter’s efficiency' : 'Converters', words: 'Paste the columns from a spreadsheet into any cell, or type them. Without rows there is no table.',
      heads: field.fields.map(({ path }) => path.replaceAll('_', ' ')),
      rows: Array.isArray(present) ? present.map((row) => columns.map((name) => row[name])) : [],
      use: (rows) => put(rows.length ? rows.map((row) => Object.fromEntries(columns.map((name, i) => [name, row[i]]))) : null) });
  } else editMaterial(field, present, put);
}

function editMotor(present, put) {
  const known = typeof present === 'object' && present !== null ? present : about.motors.find(({ id }) => id === present) ?? {};
  const points = (known.points ?? []).map((point) => (Array.isArray(point) ? point.map((value) => Number(value.toPrecision(12)))
    : [point.thrust_g, point.power_W ?? point.thrust_g / point.efficiency_g_per_W]));
  editTable({ title: 'The motor’s table', name: known.name ?? String(present ?? ''),
    words: 'Static thrust and electrical power of one motor with its propeller. Paste two columns from a spreadsheet into any cell, or a whole table with its heads.',
    heads: ['thrust g', 'power W'], rows: points,
    use: (rows, name) => put({ name: name || 'own motor', points: rows.map(([thrust, power]) => ({ thrust_g: thrust, power_W: power })) }),
    useFile: useMotorFile });
}

function editMaterial(field, present, put) {
  const fields = field.fields.filter(({ path }) => path !== 'id' && path !== 'source');
  const entries = field.kind === 'conductor' ? about.conductors : about.insulations;
  const entry = entries.find(({ id }) => id === present);
  // The library's list abbreviates units in its names; the first word tells the quantities apart.
  const first = (name) => name.split('_')[0];
  const known = entry ? Object.fromEntries(Object.entries(entry).map(([name, value]) => [fields.find(({ path }) => first(path) === first(name))?.path ?? name, value]))
    : typeof present === 'object' && present !== null ? present : {};
  editObject({ title: field.kind === 'conductor' ? 'A conductor of your own' : 'An insulation of your own',
    words: entry ? `To begin with, the values are those of ${entry.name}.` : 'Its values, as the spec holds them.', fields, values: known,
    use: (values) => put({ id: entry ? `${entry.id}, edited` : known.id, ...values }) });
}

const themes = ['auto', 'light', 'dark'];
function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  setText(byId('theme-name'), { auto: '◐ Auto', light: '☀ Light', dark: '☾ Dark' }[theme]);
  try { localStorage.setItem('theme', theme); } catch { /* some browsers keep nothing for files */ }
  takeColours();
  main.recolour();
  for (const { picture } of side) picture.recolour();
  learn?.recolour();
}

function wire() {
  menu(byId('examples'), about.examples.map(({ name, title, spec }) => [title || name, () => setSpec(spec)]));
  menu(byId('save'), saves);
  byId('open-spec').onchange = ({ target }) => { takeFiles([...target.files]).finally(() => { target.value = ''; }); };
  byId('undo').onclick = () => history.back();
  byId('redo').onclick = () => history.forward();
  byId('copy-link').onclick = async () => { await history_.settled(); copy(location.href, 'The link holds this design; it is copied.'); };
  byId('copy-command').onclick = () => copy(byId('command').textContent, 'The command is copied. It reads the spec as saved by “Save, Spec”.');
  byId('pin').onclick = togglePin;
  byId('theme').onclick = () => setTheme(themes[(themes.indexOf(document.documentElement.dataset.theme) + 1) % themes.length]);
  byId('find').oninput = ({ target }) => controls.filter(target.value);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => setTheme(document.documentElement.dataset.theme));
  // On a phone the answer is told again at the upper edge once its headline is out of sight.
  new IntersectionObserver(([entry]) => { byId('glance').hidden = entry.isIntersecting; }).observe(byId('tiles'));
  let depth = 0;
  const carriesFiles = (event) => [...(event.dataTransfer?.types ?? [])].includes('Files');
  const dropping = (change_) => { depth = Math.max(0, depth + change_); byId('dropping').hidden = depth === 0; };
  addEventListener('dragenter', (event) => { if (carriesFiles(event)) { event.preventDefault(); dropping(1); } });
  addEventListener('dragleave', (event) => { if (carriesFiles(event)) dropping(-1); });
  addEventListener('dragover', (event) => { if (carriesFiles(event)) event.preventDefault(); });
  addEventListener('drop', (event) => {
    if (!carriesFiles(event)) return;
    event.preventDefault();
    depth = 0;
    dropping(0);
    takeFiles([...event.dataTransfer.files]);
  });
}

/** A fresh worker, so that one that was stopped leaves nothing behind. */
function startWorker(program, script) {
  const address = URL.createObjectURL(new Blob([script], { type: 'text/javascript' }));
  const worker = new Worker(address);
  URL.revokeObjectURL(address);
  worker.postMessage({ program });
  return worker;
}

async function begin(script) {
  let theme = 'auto';
  try { theme = localStorage.getItem('theme') ?? 'auto'; } catch { /* as above */ }
  const program = await packedProgram(byId('program'));
  call = await openCore(program);
  about = ask('about').answer;
  setText(byId('version'), about.version);
  byId('curves').append(main.node);
  buildAnswer();
  buildTabs();
  controls = buildControls(byId('fields'), about, { change, edit });
  const learnPlace = el('div');
  places.set('learn', learnPlace);
  learn = buildLearn(learnPlace, { startWorker: () => startWorker(program, script), spec: () => state.spec,
    take(spec) { setSpec(spec); say('The design now has what the log shows.'); scrollTo({ top: 0 }); } });
  wire();
  setTheme(themes.includes(theme) ? theme : 'auto');
  history_ = makeHistory({ show: showState, fail: notice });
  history_.onchange(({ undo, redo }) => { byId('undo').disabled = !undo; byId('redo').disabled = !redo; });
  let first = null;
  try {
    first = await history_.first();
  } catch (error) {
    notice(error.message.replace('What the page showed before is still here.', 'Here is an example instead.'));
  }
  showState(first ?? { ...state, spec: about.examples[0].spec });
  await history_.replace(state);
  performance.mark('first answer');
}

/** `script`: this one's text, for workers. */
export const start = (script) => begin(script).catch((error) => {
  setText(byId('headline'), 'The calculator does not start in this browser.');
  byId('notices').replaceChildren(el('p', { class: 'note bad' },
    `It needs WebAssembly and CompressionStream, as current browsers have them (${error?.message ?? error}).`));
});
