import assert from 'node:assert/strict';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { createRequire } from 'node:module';
import { goldenSpecs } from '../../tests/page/golden_designs.mjs';
import { drop, example, field, launch, missing, open, pageFile, programSays, referenceData, root, saved, typeSpec } from './browser.mjs';

const skip = missing();
let browser;
before(async () => { if (!skip) browser = await launch(); });
after(() => browser?.close());

/** A test on a page of its own, which must have logged no error and asked for nothing. `without`: what is missing for it. */
const onPage = (name, body, { without = false, ...options } = {}) => test(name, { skip: skip || without, timeout: 120_000 }, async () => {
  const opened = await open(browser, options);
  try {
    await body(opened.page);
    assert.deepEqual(opened.errors, []);
    assert.deepEqual(opened.requests, []);
  } finally {
    await opened.close();
  }
});

function assertDigits(found, expected, path = '') {
  if (typeof expected === 'number') {
    const far = Math.abs(found - expected) > 1e-12 * Math.max(Math.abs(expected), 1e-300) * 5;
    assert.ok(!far, `${path}: ${found} instead of ${expected}`);
  } else if (expected !== null && typeof expected === 'object') {
    for (const key of Object.keys(expected)) assertDigits(found?.[key], expected[key], `${path}/${key}`);
  } else assert.equal(found, expected, path);
}

/** The table of numbers as saved, cell by cell as numbers where they are some. */
const cells = (csv) => csv.trim().split('\n').map((line) => line.split(',').map((cell) => (cell !== '' && Number.isFinite(Number(cell)) ? Number(cell) : cell)));

test('the page is one file of at most 500 kB with gzip', { skip }, () => {
  const page = readFileSync(pageFile);
  assert.ok(gzipSync(page, { level: 9 }).length <= 500_000);
  assert.doesNotMatch(page.toString(), /(src|href)=["']?https?:/);
});

onPage('the published design stands on the page as soon as it opens', async (page) => {
  assert.equal(await page.locator('#headline').textContent(), 'Fly 1.089 mm² of aluminium.');
  assertDigits(cells(await saved(page, 'Table')), cells(programSays(['optimize', '--format', 'csv', '-'], example('holybro-x500.json'))));
});

for (const name of ['hexacopter-400v.json', 'headroom-range.json']) {
  onPage(`${name} has the program's digits when typed as a spec`, async (page) => {
    await typeSpec(page, example(name));
    assertDigits(cells(await saved(page, 'Table')), cells(programSays(['optimize', '--format', 'csv', '-'], example(name))));
  });
}

const goldens = goldenSpecs(referenceData);
onPage("the golden designs have the program's digits when opened as files", async (page) => {
  assert.equal(goldens.length, 60);
  for (const [i, golden] of goldens.entries()) {
    const spec = JSON.stringify({ ...JSON.parse(golden), name: `golden ${i}` });
    await page.locator('#open-spec').setInputFiles({ name: 'golden.json', mimeType: 'application/json', buffer: Buffer.from(spec) });
    await page.waitForFunction((name) => document.getElementById('design-name').textContent === name, `golden ${i}`);
    assertDigits(cells(await saved(page, 'Table')), cells(programSays(['optimize', '--format', 'csv', '-'], spec)), `golden ${i}`);
  }
}, { without: goldens.length === 0 && 'the golden designs are not there' });

onPage("fields typed one by one give the program's digits for the same --set", async (page) => {
  const set = { 'drone.mass_g': '1533', 'tether.length_m': '47.5', 'supply.voltage_V': '131', 'flight.airspeed_m_s': '6.25' };
  for (const [path, value] of Object.entries(set)) {
    await field(page, path).fill(value);
    await field(page, path).press('Tab');
  }
  await page.selectOption('#f-tether-conductor', 'copper');
  const options = [...Object.entries(set), ['tether.conductor', 'copper']].flatMap(([path, value]) => ['--set', `${path}=${value}`]);
  const expected = programSays(['optimize', '--format', 'csv', '-', ...options], example('holybro-x500.json'));
  assertDigits(cells(await saved(page, 'Table')), cells(expected));
});

onPage('an answer of no names what would help', async (page) => {
  await field(page, 'supply.voltage_V').fill('40');
  await field(page, 'supply.voltage_V').press('Tab');
  assert.equal(await page.locator('#headline').textContent(), 'This design cannot fly as required.');
  const remedies = await page.locator('#remedies li').allTextContents();
  const printed = programSays(['optimize', '-', '--set', 'supply.voltage_V=40'], example('holybro-x500.json')).replace(/\s+/g, ' ');
  assert.ok(remedies.length >= 3);
  for (const remedy of remedies) assert.ok(printed.includes(remedy), remedy);
});

onPage('what limits the answer and each warning are explained as the program explains them', async (page) => {
  await field(page, 'flight.air_density_kg_m3').fill('0.9');
  await field(page, 'flight.air_density_kg_m3').press('Tab');
  const result = JSON.parse(programSays(['optimize', '-', '--set', 'flight.air_density_kg_m3=0.9', '--format', 'json'], example('holybro-x500.json')));
  await page.getByText('What this means, and what to do').click();
  await page.locator('#explained-codes h3 code').first().waitFor();
  const codes = await page.locator('#explained-codes h3 code').allTextContents();
  assert.deepEqual(codes, [result.optimum.limited_by, ...new Set(result.warning_codes)]);
  assert.ok(codes.length > 1);
  const titles = await page.locator('#explained-codes h3').allTextContents();
  for (const [i, code] of codes.entries()) assert.ok(programSays(['explain', code], '').includes(titles[i].replace(` ${code}`, '')), titles[i]);
  assert.ok((await page.locator('#explained-codes p').count()) >= 3 * codes.length);
});

onPage("a value out of range is told beside its field in the program's words, and the page lives on", async (page) => {
  await field(page, 'drone.mass_g').fill('3');
  await field(page, 'drone.mass_g').press('Tab');
  const words = await page.locator('#f-drone-mass_g-problem').textContent();
  assert.match(words, /3.*(at least 10|10 to)/);
  assert.equal(await field(page, 'drone.mass_g').getAttribute('aria-invalid'), 'true');
  await field(page, 'drone.mass_g').fill('1710');
  await field(page, 'drone.mass_g').press('Tab');
  assert.equal(await page.locator('#f-drone-mass_g-problem').isVisible(), false);
  assert.equal(await page.locator('#headline').textContent(), 'Fly 1.089 mm² of aluminium.');
});

onPage('what is no number is told, not dropped', async (page) => {
  await field(page, 'tether.length_m').fill('thirty');
  await field(page, 'tether.length_m').press('Tab');
  assert.match(await page.locator('#f-tether-length_m-problem').textContent(), /number/);
});

onPage('a broken spec is told with its line; the next one is answered', async (page) => {
  await typeSpec(page, '{\n  "drone": {\n    "mass_g": ,\n');
  assert.match(await page.locator('#problems').textContent(), /line 3/);
  await typeSpec(page, example('hexacopter-400v.json'));
  assert.equal(await page.locator('#problems').isVisible(), false);
  assert.equal(await page.locator('#headline').textContent(), 'Fly 0.1761 mm² of copper.');
});

onPage('a misspelt field is told with the closest one', async (page) => {
  await typeSpec(page, example('holybro-x500.json').replace('"mass_g"', '"mas_g"'));
  assert.match(await page.locator('#problems').textContent() + await page.locator('#fields').textContent(), /mass_g/);
});

onPage('hostile names stay texts', async (page) => {
  const name = '<img src=x onerror="document.title=\'broken into\'"><script>alert(1)</script>&amp;';
  const spec = JSON.parse(example('holybro-x500.json'));
  await typeSpec(page, JSON.stringify({ ...spec, name }));
  assert.equal(await page.locator('#design-name').textContent(), name);
  assert.equal(await page.locator('#design-name').locator('*').count(), 0);
  for (const tab of ['What if', 'Motors', 'Envelope', 'Cable', 'Spec']) await page.getByRole('tab', { name: tab, exact: true }).click();
  assert.notEqual(await page.title(), 'broken into');
});

onPage('the link holds the design, and the pinned one, for another page', async (page) => {
  await page.getByRole('button', { name: 'Pin this design' }).first().click();
  await field(page, 'tether.length_m').fill('45');
  await field(page, 'tether.length_m').press('Tab');
  await page.waitForFunction(() => !document.getElementById('undo').disabled && location.hash.length > 50);
  await page.waitForTimeout(200);
  const hash = await page.evaluate(() => location.hash);
  const headline = await page.locator('#headline').textContent();
  const other = await open(browser, { hash });
  assert.equal(await other.page.locator('#headline').textContent(), headline);
  assert.equal(await field(other.page, 'tether.length_m').inputValue(), '45');
  assert.equal(await other.page.locator('#pin').getAttribute('aria-pressed'), 'true');
  await other.close();
});

onPage('half a link is told, and the page lives on', async (page) => {
  await field(page, 'tether.length_m').fill('45');
  await field(page, 'tether.length_m').press('Tab');
  await page.waitForTimeout(200);
  const hash = await page.evaluate(() => location.hash);
  const other = await open(browser, { hash: hash.slice(0, hash.length / 2) });
  assert.match(await other.page.locator('#notices').textContent(), /link is damaged/);
  assert.equal(await other.page.locator('#headline').textContent(), 'Fly 1.089 mm² of aluminium.');
  assert.deepEqual(other.errors, []);
  await other.close();
});

onPage("the browser's buttons undo and redo", async (page) => {
  const length = field(page, 'tether.length_m');
  await length.fill('45');
  await length.press('Tab');
  await length.fill('60');
  await length.press('Tab');
  await page.waitForTimeout(300);
  await page.goBack();
  await page.waitForFunction(() => document.getElementById('f-tether-length_m').value === '45');
  await page.goBack();
  await page.waitForFunction(() => document.getElementById('f-tether-length_m').value === '30');
  assert.equal(await page.locator('#headline').textContent(), 'Fly 1.089 mm² of aluminium.');
  await page.goForward();
  await page.waitForFunction(() => document.getElementById('f-tether-length_m').value === '45');
});

onPage('a pinned design stands beside the present one', async (page) => {
  await page.getByRole('button', { name: 'Pin this design' }).first().click();
  await field(page, 'supply.voltage_V').fill('90');
  await field(page, 'supply.voltage_V').press('Tab');
  await page.getByRole('tab', { name: 'What if' }).click();
  const rows = await page.locator('#view').textContent();
  assert.match(rows, /supply\.voltage_V7590/);
  assert.match(rows, /1\.089/);
});

onPage('a motor from the comparison is put to use', async (page) => {
  await page.getByRole('tab', { name: 'Motors' }).click();
  const use = page.locator('#view').getByRole('button', { name: /^Use / }).first();
  const id = (await use.getAttribute('aria-label')).slice(4);
  await use.click();
  assert.equal(await field(page, 'drone.motor').inputValue(), id);
});

onPage('a motor table pasted from a spreadsheet is what is flown', async (page) => {
  await page.getByRole('button', { name: 'edit its table' }).click();
  const points = [[300, 30], [600, 75], [900, 135], [1300, 240]];
  await page.evaluate((text) => {
    const transfer = new DataTransfer();
    transfer.setData('text', text);
    document.querySelector('#value-dialog tbody input').dispatchEvent(new ClipboardEvent('paste', { clipboardData: transfer, bubbles: true, cancelable: true }));
  }, points.map((row) => row.join('\t')).join('\n'));
  await page.locator('#value-name').fill('pasted');
  await page.getByRole('button', { name: 'use these values' }).click();
  const spec = JSON.parse(await saved(page, 'Spec'));
  assert.deepEqual(spec.drone.motor.points.map((point) => [point.thrust_g, point.power_W]), points);
  assertDigits(cells(await saved(page, 'Table')), cells(programSays(['optimize', '--format', 'csv', '-'], JSON.stringify(spec))));
});

onPage('the report and the figure are saved whole', async (page) => {
  assert.match(await saved(page, 'Report'), /^<!doctype html>[\s\S]*<\/html>\s*$/i);
  assert.match(await saved(page, 'Figure'), /<svg[\s\S]*<\/svg>\s*$/);
});

/** The numbers of the first table of drag: front, top, linear, wind. */
const dragRows = (text) => text.match(/^ +(front_area_m2|top_area_m2|linear_m_s|wind_m_s).*$/gm);

onPage('a log dropped on the page gives the drag that the program finds', async (page) => {
  const log = join(root, 'examples/simulated-flight.csv');
  await page.getByRole('tab', { name: 'Learn from a log' }).click();
  await page.locator('#log-files').setInputFiles(log);
  await page.locator('.busy').waitFor({ state: 'hidden' });
  await page.locator('#learn-mass_g').fill('1549');
  await page.getByRole('button', { name: 'Drag', exact: true }).click();
  await page.locator('.learned pre').waitFor({ timeout: 60_000 });
  const found = dragRows(await page.locator('.learned pre').textContent());
  assert.deepEqual(found, dragRows(programSays(['drag', log, '--mass-g', '1549'], '')));
  await page.getByRole('button', { name: 'Use in this design' }).click();
  const { drag } = JSON.parse(await saved(page, 'Spec')).drone;
  assert.ok(drag.front_area_m2 > 0.0135 && drag.front_area_m2 < 0.0136, drag.front_area_m2);
});

onPage('what a log of an autopilot holds is told as it is dropped, packed or not', async (page) => {
  await page.getByRole('tab', { name: 'Learn from a log' }).click();
  const plain = readFileSync(join(root, 'examples/px4-flight.ulg'));
  await page.locator('#log-files').setInputFiles({ name: 'flight.ulg.gz', mimeType: 'application/gzip', buffer: gzipSync(plain) });
  await page.locator('.learned pre').waitFor({ timeout: 60_000 });
  const text = await page.locator('.learned pre').textContent();
  assert.match(text, /134729 bytes, 4806 messages/);
});

/** The example log of PX4 with the messages of its flight again and again, until it is so large. */
function longLog(bytes) {
  const log = readFileSync(join(root, 'examples/px4-flight.ulg'));
  const messages = [];
  let began = 16;  // a ULog's head; then each message has its size, its type and its contents
  while (began + 3 <= log.length) {
    const end = began + 3 + log.readUInt16LE(began);
    messages.push([String.fromCharCode(log[began + 2]), log.subarray(began, end)]);
    began = end;
  }
  const flown = Buffer.concat(messages.filter(([type]) => type === 'D').map(([, message]) => message));
  return Buffer.concat([log, ...Array(Math.ceil((bytes - log.length) / flown.length)).fill(flown)]);
}

onPage('a log of 200 MB is read as the program reads it, and the page stays at hand', async (page) => {
  const folder = mkdtempSync(join(tmpdir(), 'tethercalc-'));
  try {
    const file = join(folder, 'long.ulg');
    writeFileSync(file, longLog(200e6));
    await page.getByRole('tab', { name: 'Learn from a log' }).click();
    await page.locator('#log-files').setInputFiles(file);
    await page.locator('.learned pre').waitFor({ timeout: 100_000 });
    const held = (text) => [text.match(/\d+ bytes, \d+ messages/)?.[0], ...text.match(/vehicle_\w+ +\d+ .*/g) ?? []];
    const printed = held(programSays(['log', file], ''));
    assert.match(printed[0], /^200\d{6} bytes, 7\d{6} messages$/);
    assert.deepEqual(held(await page.locator('.learned pre').textContent()), printed);
    await field(page, 'tether.length_m').fill('20');
    await field(page, 'tether.length_m').press('Tab');
    assert.match(await page.locator('#headline').textContent(), /^Fly 0\.\d+ mm² of aluminium\.$/);
  } finally {
    rmSync(folder, { recursive: true });
  }
});

onPage('a file that is no log is told in words', async (page) => {
  await page.getByRole('tab', { name: 'Learn from a log' }).click();
  await page.locator('#log-files').setInputFiles({ name: 'holiday.jpg', mimeType: 'image/jpeg', buffer: Buffer.from('no log at all') });
  await page.locator('.learned .bad').waitFor();
  assert.match(await page.locator('.learned .bad').textContent(), /holiday\.jpg: .*log/);
  assert.equal(await page.locator('#headline').textContent(), 'Fly 1.089 mm² of aluminium.');
});

const flown = () => JSON.stringify({ ...JSON.parse(example('holybro-x500.json')),
  tether: { ...JSON.parse(example('holybro-x500.json')).tether, cross_section_mm2: 1.0886 } });

onPage("a power log dropped on the page gives the program's diagnosis", async (page) => {
  const log = join(root, 'examples/simulated-power.csv');
  await typeSpec(page, flown());
  await page.getByRole('tab', { name: 'Learn from a log' }).click();
  await page.locator('#log-files').setInputFiles(log);
  await page.getByRole('button', { name: 'Diagnose', exact: true }).click();
  await page.locator('.learned pre').waitFor({ timeout: 100_000 });
  // The table of what is ruled out has the most numbers.
  const ruledOut = (text) => text.slice(text.indexOf('Ruled out'), text.indexOf('What this log can never show')).trim();
  const printed = programSays(['diagnose', '-', '--power', log], flown());
  assert.ok(ruledOut(printed).length > 500);
  assert.equal(ruledOut(await page.locator('.learned pre').textContent()), ruledOut(printed));
});

const flight = join(referenceData, 'data/x500-flight.bin');
const withoutFlight = !existsSync(flight) && 'the published flight is not there';

onPage('the published flight, dropped on the page, has the drag that the program finds', async (page) => {
  await drop(page, flight);
  await page.locator('.learned pre').waitFor({ timeout: 60_000 });
  await page.locator('#learn-mass_g').fill('1549');
  await page.locator('#learn-pitch_offset_deg').fill('1.4955439766569403');
  await page.getByRole('button', { name: 'Drag', exact: true }).click();
  await page.getByRole('heading', { name: 'The drag that it shows' }).waitFor({ timeout: 60_000 });
  const given = ['drag', flight, '--mass-g', '1549', '--pitch-offset-deg', '1.4955439766569403', '--air-density', '1.293'];
  assert.equal(await page.locator('.learned pre').textContent(), programSays(given, ''));
  await page.getByRole('button', { name: 'Use in this design' }).click();
  const { drag } = JSON.parse(await saved(page, 'Spec')).drone;
  const found = JSON.parse(programSays([...given, '--format', 'json'], ''));
  for (const name of ['front_area_m2', 'top_area_m2', 'linear_m_s']) assert.ok(Math.abs(drag[name] / found[name].value - 1) < 1e-12, name);
}, { without: withoutFlight });

onPage("the published flight, dropped on the page, has the program's diagnosis", async (page) => {
  await drop(page, flight);
  await page.locator('.learned pre').waitFor({ timeout: 60_000 });
  await page.getByRole('button', { name: 'Diagnose', exact: true }).click();
  await page.getByRole('heading', { name: 'What the simulation gets wrong' }).waitFor({ timeout: 100_000 });
  const printed = programSays(['diagnose', '-', '--flight', flight], example('holybro-x500.json'));
  assert.equal(await page.locator('.learned pre').textContent(), printed);
}, { without: withoutFlight });

onPage('a cancelled calculation leaves the page as it was', async (page) => {
  await typeSpec(page, flown());
  const headline = await page.locator('#headline').textContent();
  await page.getByRole('tab', { name: 'Learn from a log' }).click();
  await page.locator('#log-files').setInputFiles(join(root, 'examples/simulated-power.csv'));
  await page.getByRole('button', { name: 'Diagnose', exact: true }).click();
  await page.getByRole('button', { name: 'cancel' }).click();
  assert.match(await page.locator('.learned').textContent(), /Stopped/);
  assert.equal(await page.locator('#headline').textContent(), headline);
  await page.getByRole('button', { name: 'Diagnose', exact: true }).isEnabled();
});

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
for (const colorScheme of ['light', 'dark']) {
  onPage(`nothing bars people who hear or type the page (${colorScheme})`, async (page) => {
    for (const tab of ['Sizes', 'What if', 'Motors', 'Envelope', 'Cable', 'Learn from a log', 'Spec']) {
      await page.getByRole('tab', { name: tab, exact: true }).click();
      await page.evaluate(axe);
      const { violations } = await page.evaluate(() => globalThis.axe.run());
      assert.deepEqual(violations.map(({ id, nodes }) => [tab, id, nodes.slice(0, 3).map(({ html }) => html)]), []);
    }
  }, { colorScheme });
}

onPage('on a phone nothing reaches beyond the side', async (page) => {
  for (const tab of ['Sizes', 'Motors', 'Envelope', 'Learn from a log', 'Spec']) {
    await page.getByRole('tab', { name: tab, exact: true }).click();
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= 390, tab);
  }
}, { viewport: { width: 390, height: 844 } });
