// The page's program, as WebAssembly in Node, against the program of the command line: the same
// answers to 12 digits.
//
//   node program_in_node.mjs LOADER.mjs PROGRAM.wasm TETHERCALC PROJECT SHARED
//
// SHARED is the folder of reference data; without it only the project's own examples are compared.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { goldenSpecs } from './golden_designs.mjs';

const [loader, wasm, tethercalc, project, shared] = process.argv.slice(2);
const load = new Function(`${readFileSync(loader, 'utf8')}\nreturn loadCalculator;`)();
const begun = performance.now();
const call = await load(readFileSync(wasm));
console.log(`loaded in ${(performance.now() - begun).toFixed(0)} ms`);
// Bytes that are no program, and a program that asks for what is not there, are refused rather than waited for.
await assert.rejects(load(Uint8Array.of(1, 2, 3)), WebAssembly.CompileError);
const needsMore = Uint8Array.of(0, 97, 115, 109, 1, 0, 0, 0, 1, 4, 1, 96, 0, 0, 2, 7, 1, 1, 120, 1, 121, 0, 0);
await assert.rejects(load(new WebAssembly.Module(needsMore)), TypeError);
const folder = mkdtempSync(join(tmpdir(), 'tethercalc-page-'));

const ask = (request, files) => {
  const reply = JSON.parse(call(JSON.stringify(request), files));
  assert.ok(reply.answer, JSON.stringify(reply.problems));
  return reply.answer;
};
const command = (...args) => {
  try {
    return execFileSync(tethercalc, args, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'], maxBuffer: 1 << 28 });
  } catch (error) {
    if (error.status === 1) return error.stdout;
    throw error;
  }
};

let numbers = 0;
let greatest = 0;
/**
 * Every number equal to `digits`, everything else exactly. An estimate and its interval have them as one: of a value
 * that may be zero, as a part of a wave's amplitude, the log knows no digit beyond its interval's own.
 */
function same(found, expected, where, digits = 12, size = 1e-9) {
  if (typeof expected === 'number' && typeof found === 'number') {
    const off = Math.abs(found - expected) / Math.max(Math.abs(expected), size);
    numbers += 1;
    greatest = Math.max(greatest, off);
    assert.ok(off < 10 ** -digits, `${where}: ${found} instead of ${expected}`);
  } else if (expected !== null && typeof expected === 'object') {
    assert.deepEqual(Object.keys(found), Object.keys(expected), where);
    const interval = (expected.ci95 ?? []).filter((end) => end !== null).map(Math.abs);
    const own = Math.max(size, ...interval);
    for (const key of Object.keys(expected)) same(found[key], expected[key], `${where}/${key}`, digits, own);
  } else {
    assert.equal(found, expected, where);
  }
}

function compareDesign(name, spec, digits = 12) {
  const file = join(folder, 'spec.json');
  writeFileSync(file, spec);
  const expected = command('optimize', file, '--format', 'json');
  const answer = ask({ ask: 'optimize', spec });
  same(answer.result, JSON.parse(expected), name, digits);
  assert.equal(answer.text, command('optimize', file), name);
}

try {
  const example = (name) => readFileSync(join(project, 'examples', name), 'utf8');
  for (const name of ['holybro-x500', 'headroom-range', 'hexacopter-400v', 'reference/hanging-offset',
    'reference/infeasible-power-hover', 'reference/every-effect']) {
    // Of a cable that hangs the solver ends within a tolerance, not at the same last digits.
    const text = example(`${name}.json`);
    compareDesign(name, text, text.includes('"solved"') ? 9 : 12);
  }
  const spec = example('holybro-x500.json');

  const golden = goldenSpecs(shared);
  golden.forEach((text, i) => compareDesign(`golden ${i}`, text));
  console.log(golden.length ? `${golden.length} golden designs` : 'the golden designs are not there');

  const compareDrag = (log, ...options) => {
    const bytes = readFileSync(log);
    const given = Object.fromEntries(options.map(([name, , value]) => [name, value]));
    const found = ask({ ask: 'drag', file: basename(log), ...given }, { [basename(log)]: bytes });
    same(found.result, JSON.parse(command('drag', log, '--format', 'json', ...options.flatMap(([, name, value]) => [name, String(value)]))),
      basename(log));
  };
  compareDrag(join(project, 'examples/simulated-flight.csv'), ['mass_g', '--mass-g', 1550]);
  const flight = shared && join(shared, 'data/x500-flight.bin');
  if (flight && existsSync(flight)) {
    compareDrag(flight, ['mass_g', '--mass-g', 1549], ['pitch_offset_deg', '--pitch-offset-deg', 1.4955439766569403],
      ['from', '--from', '25%'], ['to', '--to', '90%']);
  }

  const compareDiagnosis = (specFile, kind, log) => {
    const text = readFileSync(specFile, 'utf8');
    const name = basename(log);
    const began = performance.now();
    const found = ask({ ask: 'diagnose', spec: text, ...(kind === 'flight' ? { flights: [name] } : { power: name }) }, { [name]: readFileSync(log) });
    const took = performance.now() - began;
    const expected = JSON.parse(command('diagnose', specFile, `--${kind}`, log, '--format', 'json'));
    assert.deepEqual(found.result.findings.map(({ effect }) => effect), expected.findings.map(({ effect }) => effect));
    same(found.result.findings, expected.findings, name);
    // Elsewhere stand also numbers of which the log knows next to nothing, and so not twelve digits.
    same(found.result, expected, name, 10);
    console.log(`diagnosis of ${name}: ${found.result.findings.map(({ effect }) => effect).join(', ') || 'nothing found'} in ${took.toFixed(0)} ms`);
  };
  compareDiagnosis(join(project, 'examples/holybro-x500.json'), 'flight', join(project, 'examples/simulated-flight.csv'));
  if (flight && existsSync(flight)) compareDiagnosis(join(project, 'examples/holybro-x500.json'), 'flight', flight);

  const slider = { ask: 'optimize_and_figures', spec, kinds: ['optimum'], brief: true };
  const times = [];
  for (let i = 0; i < 200; ++i) {
    const changed = ask({ ask: 'set', spec, path: 'supply.voltage_V', value: 60 + i / 10 }).spec;
    const before = process.cpuUsage();
    call(JSON.stringify({ ...slider, spec: changed }));
    const { user, system } = process.cpuUsage(before);
    times.push((user + system) / 1000);
  }
  times.sort((a, b) => a - b);
  console.log(`optimize_and_figures: ${times[0].toFixed(2)} ms of CPU at least, median ${times[100].toFixed(2)} ms`);
  // Half of a frame; the least, for other programs on the machine only make it more.
  assert.ok(times[0] <= 8);

  // Nothing of what was given is kept.
  const big = new Uint8Array(1 << 27).fill(120);
  for (let i = 0; i < 20; ++i) {
    assert.ok(JSON.parse(call('{"ask":"log","file":"big.bin"}', { 'big.bin': big })).problems);
  }
  for (const hostile of ['', '{', '\u0000', '[['.repeat(5000), JSON.stringify({ ask: 'optimize', spec: '{'.repeat(100000) })]) {
    assert.ok(JSON.parse(call(hostile)).problems);
  }
  // What exceptions leave behind goes with the program, which begins anew between calls.
  for (let i = 0; i < 300; ++i) {
    assert.ok(JSON.parse(call(JSON.stringify({ ask: 'optimize', spec: '{"drone": {"mass_g": -1}}' }))).problems);
    await new Promise((resume) => { setImmediate(resume); });
  }
  assert.equal(ask({ ask: 'optimize', spec }).headline, 'Fly 1.089 mm² of aluminium.');
  console.log(`${numbers} numbers compared, the greatest difference ${greatest.toExponential(1)}`);
} finally {
  rmSync(folder, { recursive: true });
}
