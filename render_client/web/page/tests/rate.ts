// How fast the page of a running gateway draws: node rate.mjs LINK [PICTURE.png]
// LINK is what deploy/security/invite printed. Waits for the whole model, then turns the view for 6 s, three times, and takes a
// picture while it turns once more.
import { startChromium } from './chromium';
import { picturesPerSecond } from './turning';

const kPatienceMs = 60_000, kTurns = 3, kTurnS = 6, kPauseMs = 1000;
const [link, picture] = process.argv.slice(2);

const { browser, close } = await startChromium(1280, 720);
try {
  const page = await browser.newPage();
  await page.setViewportSize({ width: 1280, height: 720 });
  await page.goto(link);
  const state = () => page.evaluate(() => document.getElementById('state')?.innerText ?? '');
  const start = Date.now();
  while (!(await state()).includes('live')) {
    if (Date.now() - start > kPatienceMs) throw new Error(`the page says '${await state()}', not 'live'`);
    await page.waitForTimeout(100);
  }
  console.log(`live after ${((Date.now() - start) / 1000).toFixed(1)} s`);
  for (let turn = 0; turn < kTurns; ++turn) {
    await page.waitForTimeout(kPauseMs);
    console.log(`${(await picturesPerSecond(page, kTurnS)).toFixed(1)} pictures per second`);
  }
  if (picture) await Promise.all([picturesPerSecond(page, kTurnS), page.waitForTimeout(2 * kPauseMs).then(() => page.screenshot({ path: picture }))]);
} finally {
  await close();
}
