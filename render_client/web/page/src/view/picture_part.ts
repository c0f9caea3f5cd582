// The part of a picture in which something has changed.
import { cornersOf, transformed, type Box, type Mat4 } from '../math/linear';

export interface Part {
  x: number;  // pixels, from the left lower corner
  y: number;
  width: number;
  height: number;
}

const kMargin = 3;  // pixels
const kMost = 0.6;  // of the picture: beyond that all of it is drawn

// Where a box (model frame) is seen; none: it may be anywhere.
export function partOf(box: Box, clip_from_model: Mat4, width: number, height: number): Part | undefined {
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  for (const corner of cornersOf(box)) {
    const m = clip_from_model, w = m[3] * corner[0] + m[7] * corner[1] + m[11] * corner[2] + m[15];
    if (w <= 1e-9) return undefined;
    const clip = transformed(m, corner);
    for (const i of [0, 1]) {
      low[i] = Math.min(low[i], clip[i] / w);
      high[i] = Math.max(high[i], clip[i] / w);
    }
  }
  const pixels = (share: number, size: number) => (Math.min(Math.max(share, -1), 1) * 0.5 + 0.5) * size;
  return grown({
    x: pixels(low[0], width), y: pixels(low[1], height),
    width: pixels(high[0], width) - pixels(low[0], width), height: pixels(high[1], height) - pixels(low[1], height),
  }, kMargin, width, height);
}

// So many pixels more to all sides, as whole pixels of the picture.
export function grown(part: Part, by: number, width: number, height: number): Part {
  const x = Math.max(0, Math.floor(part.x - by)), y = Math.max(0, Math.floor(part.y - by));
  const right = Math.min(width, Math.ceil(part.x + part.width + by)), top = Math.min(height, Math.ceil(part.y + part.height + by));
  return { x, y, width: Math.max(0, right - x), height: Math.max(0, top - y) };
}

export const isLarge = (part: Part, width: number, height: number) => part.width * part.height > kMost * width * height;

// Takes the part of clip space to all of it.
export function clipOfPart(part: Part, width: number, height: number): Mat4 {
  const m = new Float32Array(16), sx = width / Math.max(part.width, 1), sy = height / Math.max(part.height, 1);
  m[0] = sx;
  m[5] = sy;
  m[10] = m[15] = 1;
  m[12] = sx * (1 - (2 * part.x + part.width) / width);
  m[13] = sy * (1 - (2 * part.y + part.height) / height);
  return m;
}
