// How fast the page draws.
import type { Page } from 'playwright-core';

// Pictures per second while the view turns without a pause, after a second of turning.
export async function picturesPerSecond(page: Page, seconds: number): Promise<number> {
  return page.evaluate(async (span) => {
    const canvas = document.getElementById('picture')!;
    const press = (type: string, x: number, y: number) =>
      canvas.dispatchEvent(new PointerEvent(type, { pointerId: 1, pointerType: 'mouse', button: 0, buttons: 1, clientX: x, clientY: y, bubbles: true }));
    canvas.setPointerCapture = () => undefined;
    press('pointerdown', 400, 360);
    const start = performance.now();
    let pictures = 0, pixel = 0, now = start;
    while (now - start < 1000 * (span + 1)) {
      press('pointermove', 400 + ++pixel, 360);
      await new Promise((done) => requestAnimationFrame(done));
      now = performance.now();
      if (now - start > 1000) ++pictures;
    }
    press('pointerup', 400 + pixel, 360);
    return pictures / span;
  }, seconds);
}
