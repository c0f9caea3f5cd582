// The page in a real browser, with a stand-in for the gateway: node browser.mjs PAGE_DIR PICTURES_DIR [TRIANGLES]
// Says what is wrong and ends with 1, or says how fast it draws. Without a browser it ends with 77: skipped.
import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { startChromium } from './chromium';
import { startStandIn } from './stand_in';
import { boneNodes, dented } from './synthetic';
import { picturesPerSecond } from './turning';

const kInstructor = 2;
const [page_dir, pictures = mkdtempSync(join(tmpdir(), 'page_')), triangles = '20000'] = process.argv.slice(2);

mkdirSync(pictures, { recursive: true });
const { browser, close } = await startChromium(1280, 720);
const stand_in = await startStandIn({ page: page_dir, role: kInstructor, nodes: boneNodes(Number(triangles)), hasOthers: true });
const faults: string[] = [];

const requests: string[] = [];

async function open(width: number, height: number, hash = '#invited', search = ''): Promise<Page> {
  const page = await browser.newPage();
  await page.setViewportSize({ width, height });
  page.on('console', (message) => {
    if (message.type() === 'error' || message.type() === 'warning') faults.push(`console: ${message.text()}`);
  });
  page.on('pageerror', (error) => faults.push(`page: ${error.message}`));
  page.on('request', (request) => {
    requests.push(request.url());
    if (!/^(http|ws):\/\/127\.0\.0\.1|^(data|blob):/.test(request.url())) faults.push(`request: ${request.url()}`);
  });
  await page.goto(stand_in.url + search + hash);
  return page;
}

// The page's policy forbids what playwright would wait with: so this asks again and again.
async function has(page: Page, id: string, text: string): Promise<void> {
  let shown: string | null | undefined = '';
  for (let i = 0; i < 200; ++i) {
    shown = await page.evaluate((where) => document.getElementById(where)?.innerText, id);
    if (shown?.includes(text)) return;
    await page.waitForTimeout(100);
  }
  throw new Error(`#${id} says '${shown}', not '${text}'`);
}
const stateIs = (page: Page, text: string) => has(page, 'state', text);
const ordered = async (action: string) => {
  for (let i = 0; i < 50; ++i) {
    const found = stand_in.heard.find((one) => one.kind.case === 'command' && one.kind.value.action.case === action);
    if (found) return found;
    await new Promise((done) => setTimeout(done, 100));
  }
  throw new Error(`no command ${action} came`);
};

// Where bone is milled only a part of the picture is drawn anew: it is the picture that is drawn whole.
async function milled(page: Page): Promise<void> {
  const clip = { x: 300, y: 60, width: 640, height: 510 };  // without figures and notices
  const before = await page.screenshot({ clip });
  const old = boneNodes(Number(triangles)), milled = boneNodes(Number(triangles), dented, 2);
  stand_in.show(milled.filter((node, i) => !Buffer.from(node.payload.subarray(40)).equals(Buffer.from(old[i].payload.subarray(40)))));
  await page.waitForTimeout(900);
  const part = await page.screenshot({ clip, path: join(pictures, 'milled.png') });
  for (let i = 0; i < 2; ++i) {
    await page.keyboard.press('x');
    await page.waitForTimeout(900);
  }
  const whole = await page.screenshot({ clip, path: join(pictures, 'milled_whole.png') });
  assert.ok(!part.equals(before) && part.equals(whole), 'the milled part was drawn as the whole');
}

async function desktop(): Promise<void> {
  const page = await open(1280, 720);
  await stateIs(page, 'live');
  assert.equal(new URL(page.url()).hash, '', 'the token is gone from the address');
  assert.equal(await page.evaluate(() => sessionStorage.getItem('bonemill.token')), 'ticket');
  await page.waitForTimeout(700);
  await page.screenshot({ path: join(pictures, 'desktop.png') });
  await has(page, 'labels', 'Dr. Weber');
  await has(page, 'labels', 'Thin <i id="bad">here</i>');
  assert.equal(await page.evaluate(() => document.getElementById('bad')), null, 'what others write is no markup');
  await page.getByRole('button', { name: 'Sound' }).click();
  await page.waitForTimeout(300);
  assert.equal(await page.getByRole('button', { name: 'Sound' }).getAttribute('aria-pressed'), 'true');
  await page.keyboard.press('Shift+M');
  await page.keyboard.press('p');
  await ordered('pauseMilling');
  await has(page, 'notices', 'pause milling: done');
  await page.keyboard.press('m');
  await page.keyboard.press('x');
  await has(page, 'panel', 'Mill the ball open');
  await page.waitForTimeout(700);
  await page.screenshot({ path: join(pictures, 'cut_panel.png') });
  await page.keyboard.press('m');
  await page.keyboard.press('x');
  await page.keyboard.press('t');
  await page.waitForTimeout(700);
  await page.screenshot({ path: join(pictures, 'transparent.png') });
  await page.keyboard.press('t');
  await page.getByRole('button', { name: 'Draw' }).click();
  await page.mouse.move(600, 330);
  await page.mouse.down();
  await page.mouse.move(660, 420, { steps: 12 });
  await page.mouse.up();
  const stroke = await ordered('addRemark');
  assert.ok(stroke.kind.case === 'command' && stroke.kind.value.action.case === 'addRemark' && stroke.kind.value.action.value.pointsM.length >= 12);
  await page.keyboard.press('Escape');
  await page.keyboard.press('e');
  await page.waitForTimeout(700);
  await page.screenshot({ path: join(pictures, 'endoscope.png') });
  await page.keyboard.press('e');
  await milled(page);
  console.log(`pictures per second while the view turns: ${(await picturesPerSecond(page, 3)).toFixed(1)}`);
  stand_in.cut();
  await has(page, 'banner', 'Away for');
  await page.screenshot({ path: join(pictures, 'away.png') });
  await stateIs(page, 'live');
  const again = stand_in.heard.filter((one) => one.kind.case === 'hello').at(-1)!;
  assert.ok(again.kind.case === 'hello' && again.kind.value.token === 'ticket' && again.kind.value.leaves.length > 300);
  await page.close();
}

// One finger turns the bone, two come nearer.
async function fingers(page: Page): Promise<void> {
  const clip = { x: 0, y: 240, width: 390, height: 400 }, shots = [await page.screenshot({ clip })];
  for (const count of [1, 2]) {
    await page.evaluate(async (all) => {
      const canvas = document.getElementById('picture')!;
      canvas.setPointerCapture = () => undefined;  // these fingers are none
      const touch = (type: string, id: number, x: number) => canvas.dispatchEvent(
        new PointerEvent(type, { pointerId: id, pointerType: 'touch', button: 0, buttons: 1, clientX: x, clientY: 400, bubbles: true }));
      for (let id = 0; id < all; ++id) touch('pointerdown', 10 + id, 150 + 60 * id);
      for (let step = 0; step < 10; ++step)
        for (let id = 0; id < all; ++id) touch('pointermove', 10 + id, 150 + 60 * id + (id === 1 ? 8 : -8) * step);
      for (let id = 0; id < all; ++id) touch('pointerup', 10 + id, 150);
    }, count);
    await page.waitForTimeout(900);
    shots.push(await page.screenshot({ clip, path: join(pictures, `phone_${count}.png`) }));
  }
  assert.ok(!shots[1].equals(shots[0]) && !shots[2].equals(shots[1]), 'fingers move the view');
}

async function phone(): Promise<void> {
  const page = await open(390, 844);
  await stateIs(page, 'live');
  await page.waitForTimeout(700);
  await page.screenshot({ path: join(pictures, 'phone.png') });
  await fingers(page);
  await page.getByRole('button', { name: '☰' }).click();
  await page.waitForTimeout(300);
  await page.screenshot({ path: join(pictures, 'phone_panel.png') });
  await page.close();
}

// In the language of the address; another one is chosen in the panel, with the same invitation.
async function translated(): Promise<void> {
  assert.ok(!requests.some((url) => url.includes('languages')), 'English needs no catalogue');
  const page = await open(1280, 720, '#invited', '?lang=de');
  await stateIs(page, 'live');
  await page.keyboard.press('m');
  await has(page, 'panel', 'Sitzung');
  await has(page, 'panel', 'Ihre Rolle: ');
  await page.keyboard.press('h');
  await has(page, 'help', 'Shift+N');
  await has(page, 'help', 'nächste Übung der Lektion');
  await page.screenshot({ path: join(pictures, 'german_help.png') });
  await page.keyboard.press('h');
  await page.screenshot({ path: join(pictures, 'german.png') });
  await Promise.all([page.waitForURL(/\?lang=sv$/), page.getByRole('combobox', { name: 'Sprache' }).selectOption('Svenska')]);
  await stateIs(page, 'direkt');
  await page.keyboard.press('m');
  await has(page, 'panel', 'Din roll: ');
  assert.deepEqual([new URL(page.url()).search, await page.evaluate(() => document.documentElement.lang)], ['?lang=sv', 'sv']);
  await page.close();
}

async function refused(): Promise<void> {
  const page = await open(1280, 720, '#wrong');
  await has(page, 'banner', 'This invitation is not known');
  await page.close();
}

try {
  await desktop();
  await phone();
  await translated();
  await refused();
  assert.deepEqual(faults, []);
  console.log(`the page works; pictures lie in ${pictures}`);
} catch (error) {
  console.error(error, faults);
  process.exitCode = 1;
} finally {
  await close();
  await stand_in.close();
}
