// How long the page takes: to its first answer, and for every redraw while a slider is dragged.
//   node page/test/bench.mjs
import { launch, missing, open } from './browser.mjs';

const why = missing();
if (why) { console.log(`SKIPPED: ${why}`); process.exit(0); }
const browser = await launch();
const { page, close } = await open(browser);
const first = await page.evaluate(() => performance.getEntriesByName('first answer')[0].startTime);
const slider = page.locator('.field[data-path="supply.voltage_V"] input[type="range"]');
const box = await slider.boundingBox();
await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
await page.mouse.down();
for (let i = 0; i < 300; ++i) {
  await page.mouse.move(box.x + box.width * (0.5 + 0.35 * Math.sin(i / 20)), box.y + box.height / 2);
  await page.waitForTimeout(8);
}
await page.mouse.up();
const times = (await page.evaluate(() => performance.getEntriesByName('redraw').map(({ duration }) => duration))).sort((a, b) => a - b);
const at = (share) => times[Math.min(times.length - 1, Math.floor(share * times.length))].toFixed(1);
console.log(`first answer ${first.toFixed(0)} ms after opening (wanted: under 1000)`);
console.log(`${times.length} redraws while sliding: median ${at(0.5)} ms (wanted: under 16), 95 % ${at(0.95)} ms, longest ${at(1)} ms (wanted: under 50)`);
await close();
await browser.close();
