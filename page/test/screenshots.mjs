// Pictures of the page to look at: phone, tablet and desktop, light and dark, every view.
//   node page/test/screenshots.mjs FOLDER
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { launch, missing, open } from './browser.mjs';

const [folder = 'build/page/screenshots'] = process.argv.slice(2);
const why = missing();
if (why) { console.log(`SKIPPED: ${why}`); process.exit(0); }
mkdirSync(folder, { recursive: true });
const browser = await launch();
for (const [width, height] of [[390, 844], [768, 1024], [1440, 900]]) {
  for (const colorScheme of ['light', 'dark']) {
    const { page, close } = await open(browser, { viewport: { width, height }, colorScheme });
    const file = (name) => join(folder, `${width}-${colorScheme}-${name.replaceAll(' ', '-').toLowerCase()}.png`);
    await page.screenshot({ path: file('page'), fullPage: true });
    for (const tab of await page.getByRole('tab').all()) {
      await tab.click();
      await page.locator('#view').screenshot({ path: file(await tab.textContent()) });
    }
    await close();
  }
}
await browser.close();
console.log(`the pictures are in ${folder}`);
