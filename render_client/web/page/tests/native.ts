// The page's picture is the native viewer's: node native.mjs PAGE_DIR PICTURES_DIR RENDER_CLIENT
// Both see one session, through a stand-in for the gateway. Then page and picture are spoiled, to prove that the
// comparison sees it. Without a browser it ends with 77: skipped.
import assert from 'node:assert/strict';
import { execFile, execFileSync } from 'node:child_process';
import { X509Certificate } from 'node:crypto';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { promisify } from 'node:util';
import type { Page } from 'playwright-core';
import { startChromium } from './chromium';
import { mirrored, readPng, scaled, unlikeShare, type Picture } from './picture';
import { startStandIn } from './stand_in';
import { boneNodes, furrowed } from './synthetic';

const kWidth = 480, kHeight = 360, kTriangles = 20000;
const kObserver = 1;
const kPatienceMs = 20_000, kPauseMs = 150;
const [page_dir, pictures, render_client] = process.argv.slice(2);

interface View {
  name: string;
  keys: string[];  // bring the page to it from the view before
  words: string[];  // bring the native viewer to it
  tolerated: number;  // share of the pixels
}
const kThroughBone = ['--structures', 'through-bone'];
// The cut face is nothing but grain.
const kViews: View[] = [
  { name: 'opaque', keys: [], words: [], tolerated: 0.006 },
  { name: 'through bone', keys: ['Shift+T'], words: kThroughBone, tolerated: 0.006 },
  { name: 'transparent', keys: ['t'], words: ['--transparent', ...kThroughBone], tolerated: 0.006 },
  { name: 'cut', keys: ['t', 'z'], words: ['--cut-z', '0.5', ...kThroughBone], tolerated: 0.03 },
];

// Words of the shaders, and what stands in their place. Seen in the second view.
const kSpoiled = [
  { what: 'no fill light', from: 'vec3(0.60, 0.70, 0.92) * 0.30', to: 'vec3(0.0)' },
  { what: 'no ambient occlusion', from: 'float occlusion = sum / weights;', to: 'float occlusion = 1.0;' },
  { what: 'no structure', from: 'if (is_behind) {', to: 'if (is_behind) { discard;' },
  { what: 'nothing shines through', from: 'textureLod(near_structures, at, 0.0)', to: 'vec4(0.0, 0.0, 0.0, 1.0)' },
  { what: 'another material', from: '+ point.material.rgb', to: '+ 0.9 * point.material.rrr' },
];
type Spoiled = (typeof kSpoiled)[number];

const folder = mkdtempSync(join(tmpdir(), 'page_native_'));
mkdirSync(pictures, { recursive: true });

function makeCertificate(): { key: string; cert: string; fingerprint: string } {
  const [key, cert] = ['key.pem', 'cert.pem'].map((name) => join(folder, name));
  execFileSync('openssl', ['req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:P-256', '-nodes', '-days', '2',
    '-subj', '/CN=127.0.0.1', '-keyout', key, '-out', cert], { stdio: 'pipe' });
  const fingerprint = new X509Certificate(readFileSync(cert)).fingerprint256.replaceAll(':', '');
  return { key: readFileSync(key, 'utf8'), cert: readFileSync(cert, 'utf8'), fingerprint };
}

const certificate = makeCertificate();
const { browser, close } = await startChromium(kWidth, kHeight);
const stand_in = await startStandIn({
  page: page_dir, role: kObserver, nodes: boneNodes(kTriangles, furrowed), hasOthers: false, tls: certificate,
});

async function nativePicture({ name, words }: View): Promise<Picture> {
  const out = join(folder, name), config = join(folder, `config_${name}`);
  await promisify(execFile)(render_client, [
    '--connect', stand_in.url.replace('https', 'wss'), '--fingerprint', certificate.fingerprint, '--offscreen', '--out', out,
    '--size', `${kWidth}x${kHeight}`, '--frames', '1', '--wait-complete', '--timeout-s', String(kPatienceMs / 1000),
    '--quality', 'quick', '--no-hud', '--no-effects', '--no-handpiece', ...words,
  ], { env: { ...process.env, BONEMILL_TOKEN: 'invited', XDG_CONFIG_HOME: config } });
  const png = readFileSync(join(out, 'frame_0000.png'));
  writeFileSync(join(pictures, `native_${name}.png`), png);
  return readPng(png);
}

// Nothing but the picture. What spoil() says happens to the text of each shader.
async function open(): Promise<Page> {
  const page = await browser.newPage();
  await page.addInitScript(() => {
    const real = WebGL2RenderingContext.prototype.shaderSource;
    WebGL2RenderingContext.prototype.shaderSource = function (shader, text) {
      const { from, to, done } = document.documentElement.dataset;
      const spoiled = from === undefined ? text : text.replaceAll(from, to!);
      if (spoiled !== text) document.documentElement.dataset.done = String(Number(done ?? 0) + 1);
      real.call(this, shader, spoiled);
    };
  });
  await page.goto(`${stand_in.url}#invited`);
  await page.evaluate(() => {
    for (const one of document.body.children) if (one.id !== 'picture') (one as HTMLElement).style.visibility = 'hidden';
  });
  return page;
}

// The page makes its shaders anew where the graphics card has lost them. Returns how many were spoiled.
async function spoil(page: Page, { from, to }: Spoiled): Promise<number> {
  return page.evaluate(async (wish) => {
    const canvas = document.getElementById('picture') as HTMLCanvasElement;
    Object.assign(document.documentElement.dataset, { ...wish, done: '0' });
    const card = canvas.getContext('webgl2')!.getExtension('WEBGL_lose_context')!;
    const heard = (event: string) => new Promise((done) => canvas.addEventListener(event, done, { once: true }));
    const [lost, restored] = ['webglcontextlost', 'webglcontextrestored'].map(heard);
    card.loseContext();
    await lost;
    await new Promise((done) => setTimeout(done));
    card.restoreContext();
    await restored;
    return Number(document.documentElement.dataset.done);
  }, { from, to });
}

// The first picture that is as wanted, or the last one. A picture becomes fine when it rests.
async function shot(page: Page, name: string, is_wanted: (picture: Picture, before?: Picture) => boolean): Promise<Picture> {
  let before: Picture | undefined;
  for (const end = Date.now() + kPatienceMs; ;) {
    const picture = readPng(await page.screenshot({ path: join(pictures, `page_${name}.png`) }));
    if (is_wanted(picture, before) || Date.now() > end) return picture;
    before = picture;
    await page.waitForTimeout(kPauseMs);
  }
}

function see(what: string, share: number): number {
  console.log(`${what}: ${(100 * share).toFixed(2)} % of the pixels differ`);
  return share;
}

async function looksNative(page: Page, native: Picture[]): Promise<void> {
  for (const [i, { name, keys, tolerated }] of kViews.entries()) {
    for (const key of keys) await page.keyboard.press(key);
    const share = (picture: Picture) => unlikeShare(picture, native[i]);
    const shown = await shot(page, name, (picture) => share(picture) <= tolerated);
    assert.ok(see(name, share(shown)) <= tolerated, `${name}: page and native viewer show another picture, see ${pictures}`);
    assert.ok(see(`${name}, mirrored`, share(mirrored(shown))) > tolerated);
    assert.ok(see(`${name}, darker by 5 %`, share(scaled(shown, 0.95))) > tolerated);
  }
}

async function spoiledIsSeen(page: Page, native: Picture): Promise<void> {
  for (const one of kSpoiled) {
    assert.ok((await spoil(page, one)) > 0, `the shaders have changed: ${one.from}`);
    const shown = await shot(page, 'spoiled', (picture, before) => before !== undefined && unlikeShare(picture, before) === 0);
    assert.ok(see(one.what, unlikeShare(shown, native)) > kViews[0].tolerated);
  }
}

try {
  const [page, native] = await Promise.all([open(), Promise.all(kViews.map(nativePicture))]);
  await looksNative(page, native);
  await page.keyboard.press('z');
  await spoiledIsSeen(page, native[1]);
} catch (error) {
  console.error(error);
  process.exitCode = 1;
} finally {
  await close();
  await stand_in.close();
  rmSync(folder, { recursive: true, force: true });
}
