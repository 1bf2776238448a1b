// Makes the page of one file: program, style and scripts inline, under a policy that allows nothing else.
//
//   node page/bundle.mjs --program FILE.wasm --loader FILE.mjs --output FILE.html
//
// The loader defines loadCalculator(compiled module) → promise of call(request, files).
import { execFileSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { gzipSync } from 'node:zlib';
import { build } from 'esbuild';
import { moduleOf, streamsOf } from './src/wasm_streams.js';

const here = dirname(fileURLToPath(import.meta.url));
const { values: options } = parseArgs({ options: {
  program: { type: 'string' }, loader: { type: 'string' }, output: { type: 'string' } } });
for (const name of ['program', 'loader', 'output']) {
  if (!options[name]) { console.error(`bundle: --${name} is needed`); process.exit(2); }
}

/** A module of that name with these contents, for imports that are no file here. */
const module = (name, contents, loader) => ({ name, setup(builder) {
  builder.onResolve({ filter: new RegExp(`^${name}$`) }, ({ path }) => ({ path, namespace: name }));
  builder.onLoad({ filter: /.*/, namespace: name }, () => ({ contents, loader }));
} });
const program = module('tethercalc-program', `${readFileSync(options.loader, 'utf8')}\nexport default loadCalculator;`, 'js');
const text = async (entry) => (await build({ bundle: true, minify: true, format: 'iife', target: 'es2022',
  write: false, charset: 'utf8', legalComments: 'inline', logLevel: 'error', platform: 'browser', external: ['fs', 'path', 'crypto'],
  plugins: [program], entryPoints: [join(here, 'src', entry)] })).outputFiles[0].text;

const script = inlined(await text('entry.js'));
const css = (await build({ stdin: { contents: readFileSync(join(here, 'node_modules/uplot/dist/uPlot.min.css'), 'utf8') +
  readFileSync(join(here, 'styles.css'), 'utf8'), loader: 'css' }, minify: true, write: false })).outputFiles[0].text;

/** Nothing in a script may end its element. */
function inlined(source) { return source.replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--'); }
const hash = (source) => `'sha256-${createHash('sha256').update(source).digest('base64')}'`;

/** The program as packed_program.js unpacks it: its streams as .lzma, with their size in the head, which xz leaves open. */
function packed(streams) {
  const lzma = execFileSync('xz', ['--format=lzma', '--lzma1=preset=9e,lc=1,lp=0,pb=0,nice=273', '--stdout'],
    { input: streams, maxBuffer: 1 << 28 });
  lzma.writeBigUInt64LE(BigInt(streams.length), 5);
  return lzma.toString('base64');
}

const parts = {
  policy: ["default-src 'none'", `script-src ${hash(script)} 'wasm-unsafe-eval'`, `style-src ${hash(css)}`,
    'worker-src blob:', 'img-src data: blob:', "connect-src 'none'", "base-uri 'none'", "form-action 'none'"].join('; '),
  style: css,
  script,
};
const wasm = readFileSync(options.program);
const streams = streamsOf(wasm);
if (!wasm.equals(moduleOf(streams))) throw new Error('the program does not come back from its streams');
parts.program = packed(streams);
// Indentation is for those who read the source.
const page = readFileSync(join(here, 'index.html'), 'utf8').replaceAll(/\n\s+/g, '\n').replace(/\{\{(\w+)\}\}/g, (whole, name) => parts[name]);
mkdirSync(dirname(options.output), { recursive: true });
writeFileSync(options.output, page);
console.log(`${options.output}: ${Buffer.byteLength(page)} bytes, ${gzipSync(page, { level: 9 }).length} with gzip`);
