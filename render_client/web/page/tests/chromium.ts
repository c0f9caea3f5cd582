// Debian's chromium without a graphics card, for tests.
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { chromium, type BrowserContext } from 'playwright-core';

const kChromium = '/usr/bin/chromium';
const kSkipped = 77;
const kFlags = [
  '--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', '--disable-quic', '--no-first-run',
  '--disable-background-networking', '--disable-component-update', '--disable-sync', '--disable-dev-shm-usage',
];

export interface Chromium {
  browser: BrowserContext;
  close(): Promise<void>;
}

// Where there is none the process ends as a test that was skipped.
export async function startChromium(width: number, height: number): Promise<Chromium> {
  if (!existsSync(kChromium)) {
    console.log('skipped: there is no chromium');
    process.exit(kSkipped);
  }
  const profile = mkdtempSync(join(tmpdir(), 'page_profile_'));
  const browser = await chromium.launchPersistentContext(profile, {
    executablePath: kChromium, headless: true, args: kFlags, viewport: { width, height }, ignoreHTTPSErrors: true,
  });
  const close = async () => {
    await browser.close();
    rmSync(profile, { recursive: true, force: true });
  };
  return { browser, close };
}
