// Pictures of 8 bits per channel: read from PNG, compared, spoiled.
import { readFileSync } from 'node:fs';
import { inflateSync } from 'node:zlib';

const kSoftness = 2;  // pixels: half the window of the soft focus
const kVisibleStep = 8;  // of 255, in any colour

export interface Picture {
  width: number;
  height: number;
  rgb: Uint8Array;
}

function paeth(left: number, up: number, corner: number): number {
  const [a, b, c] = [up - corner, left - corner, left + up - 2 * corner].map(Math.abs);
  return a <= b && a <= c ? left : b <= c ? up : corner;
}

// Each line of a PNG says from which neighbours its bytes are differences.
function unfiltered(bytes: Uint8Array, height: number, pixel: number): Uint8Array {
  const stride = bytes.length / height - 1, lines = new Uint8Array(height * stride);
  for (let y = 0; y < height; ++y) {
    const filter = bytes[y * (stride + 1)];
    for (let x = 0; x < stride; ++x) {
      const at = y * stride + x;
      const left = x < pixel ? 0 : lines[at - pixel], up = y === 0 ? 0 : lines[at - stride];
      const corner = x < pixel || y === 0 ? 0 : lines[at - stride - pixel];
      const guess = [0, left, up, (left + up) >> 1, paeth(left, up, corner)][filter];
      lines[at] = bytes[y * (stride + 1) + 1 + x] + guess;
    }
  }
  return lines;
}

// Without interlacing, as browsers and libpng write it.
export function readPng(file: string | Buffer): Picture {
  const png = typeof file === 'string' ? readFileSync(file) : file;
  const data: Buffer[] = [];
  for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at))
    if (png.toString('latin1', at + 4, at + 8) === 'IDAT') data.push(png.subarray(at + 8, at + 8 + png.readUInt32BE(at)));
  const width = png.readUInt32BE(16), height = png.readUInt32BE(20), channels = png[25] === 6 ? 4 : 3;
  if (png[24] !== 8 || (png[25] !== 2 && png[25] !== 6) || png[28] !== 0) throw new Error('a PNG of another kind');
  const lines = unfiltered(inflateSync(Buffer.concat(data)), height, channels);
  const rgb = new Uint8Array(3 * width * height);
  for (let i = 0; i < width * height; ++i) rgb.set(lines.subarray(channels * i, channels * i + 3), 3 * i);
  return { width, height, rgb };
}

// The mean over the pixels around each, along lines of `length` pixels that lie `stride` apart; beyond the edge is 0.
function blurred(values: Float32Array, length: number, stride: number): Float32Array {
  const means = new Float32Array(values.length), window = 2 * kSoftness + 1;
  for (let at = 0; at < values.length; ++at) {
    const place = Math.floor(at / stride) % length;
    const first = Math.max(place - kSoftness, 0) - place, last = Math.min(place + kSoftness, length - 1) - place;
    for (let k = first; k <= last; ++k) means[at] += values[at + k * stride] / window;
  }
  return means;
}

// The share of pixels that differ visibly after the same soft focus of both, as tests/gl/golden.cpp has it: edges, and
// the grain of bone, which no two drivers make quite alike, are nearly nothing then.
export function unlikeShare(a: Picture, b: Picture): number {
  if (a.width !== b.width || a.height !== b.height) return 1;
  const { width, height } = a, is_unlike = new Uint8Array(width * height);
  for (const channel of [0, 1, 2]) {
    const steps = Float32Array.from(is_unlike, (_, i) => a.rgb[3 * i + channel] - b.rgb[3 * i + channel]);
    blurred(blurred(steps, width, 1), height, width).forEach((step, i) => {
      if (Math.abs(step) > kVisibleStep) is_unlike[i] = 1;
    });
  }
  return is_unlike.reduce((sum, one) => sum + one, 0) / is_unlike.length;
}

export function mirrored({ width, height, rgb }: Picture): Picture {
  const across = (i: number) => i + 3 * (width - 1 - 2 * (Math.floor(i / 3) % width));
  return { width, height, rgb: rgb.map((_, i) => rgb[across(i)]) };
}

export function scaled({ width, height, rgb }: Picture, factor: number): Picture {
  return { width, height, rgb: rgb.map((value) => value * factor) };
}
