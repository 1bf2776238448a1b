// The page in headless Chromium, watched: what it logs as an error and what it asks of a network are kept.
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

export const root = resolve(dirname(fileURLToPath(import.meta.url)), '../..');
export const pageFile = process.env.TETHERCALC_PAGE ?? join(root, 'build/page/tethercalc.html');
/** What the project reads but does not ship; tests that need it are skipped where it is absent. */
export const referenceData = process.env.TETHERCALC_REFERENCE_DATA ?? join(root, '../shared');
const program = process.env.TETHERCALC_PROGRAM ?? join(root, 'build/release/tethercalc');

/** Without the page or a browser there is nothing to test. */
export function missing() {
  if (!existsSync(pageFile)) return `${pageFile} is not built (scripts/build-page)`;
  if (!existsSync(program)) return `${program} is not built`;
  return existsSync('/usr/bin/chromium') ? false : 'chromium is not installed';
}

export const launch = () => chromium.launch({ executablePath: '/usr/bin/chromium', args: ['--no-sandbox'] });

/** What the program answers on the command line; `optimize` of a design that cannot fly ends with 1. */
export function programSays(args, input) {
  try {
    return execFileSync(program, args, { input, encoding: 'utf8', stdio: ['pipe', 'pipe', 'ignore'] });
  } catch (error) {
    if (error.status === 1) return error.stdout;
    throw error;
  }
}

export const example = (name) => readFileSync(join(root, 'examples', name), 'utf8');

/** Opens the page from its file. `errors` and `requests` fill while it lives. */
export async function open(browser, { hash = '', ...context } = {}) {
  const frame = await browser.newContext({ viewport: { width: 1440, height: 900 }, acceptDownloads: true, ...context });
  const page = await frame.newPage();
  const errors = [];
  const requests = [];
  page.on('console', (message) => { if (message.type() === 'error') errors.push(message.text()); });
  page.on('pageerror', (error) => errors.push(String(error)));
  page.on('request', (request) => { if (!/^(file|blob|data):/.test(request.url())) requests.push(request.url()); });
  await page.goto(pathToFileURL(pageFile).href + hash);
  await ready(page);
  return { page, errors, requests, close: () => frame.close() };
}

/** The first answer stands on the page. */
export const ready = (page) => page.waitForFunction(() => performance.getEntriesByName('first answer').length > 0);

export const field = (page, path) => page.locator(`#f-${path.replaceAll('.', '-')}`);

/** Puts a spec in by the box of the view "Spec". */
export async function typeSpec(page, text) {
  await page.getByRole('tab', { name: 'Spec', exact: true }).click();
  await page.locator('#spec-text').fill(text);
  await page.locator('#headline').click(); // leaves the box
}

/** Drops a file upon the page, as from a folder. */
export async function drop(page, file) {
  const input = await page.evaluateHandle(() => Object.assign(document.createElement('input'), { type: 'file' }));
  await input.setInputFiles(file);
  await input.evaluate(({ files }) => {
    const dataTransfer = new DataTransfer();
    for (const dropped of files) dataTransfer.items.add(dropped);
    document.body.dispatchEvent(new DragEvent('drop', { dataTransfer, bubbles: true, cancelable: true }));
  });
}

/** What the item of "Save" gives, as a text. */
export async function saved(page, what) {
  await page.locator('#save summary').click();
  const [file] = await Promise.all([page.waitForEvent('download'), page.locator('#save').getByRole('button', { name: what }).click()]);
  return readFileSync(await file.path(), 'utf8');
}
