// What comes over the network is believed after these checks only, which are those of the native viewer
// (render_client/link/subscribe/payloads.cpp). A message that fails one is dropped and counted.
import type { Quat, Vec3 } from '../math/linear';

export class Malformed extends Error {}

export const kLargestNumber = 1e6;
export const kLongestSession = 1e9;  // s
export const kLongestName = 64;  // letters
export const kLongestText = 512;
const kUnitTolerance = 1e-3;

export function demand(is_so: boolean, what: string): void {
  if (!is_so) throw new Malformed(what);
}

// Finite, and small enough that what is computed from it stays so.
export function sane(value: number): number {
  demand(Math.abs(value) <= kLargestNumber, 'number');
  return value;
}
export const saneOrNone = (value: number | undefined) => (value === undefined ? undefined : sane(value));

export function finite(value: number): number {
  demand(Number.isFinite(value), 'number');
  return value;
}

export function within(value: number, low: number, high: number): number {
  demand(value >= low && value <= high, 'range');
  return value;
}

export const time = (seconds: number) => within(seconds, 0, kLongestSession);

export function vector(numbers: readonly number[]): Vec3 {
  demand(numbers.length === 3, 'vector');
  return [sane(numbers[0]), sane(numbers[1]), sane(numbers[2])];
}
export const vectorOrNone = (numbers: readonly number[]) => (numbers.length === 0 ? undefined : vector(numbers));

export function quaternion(numbers: readonly number[]): Quat {
  demand(numbers.length === 4, 'quaternion');
  const length = Math.hypot(...numbers);
  demand(Math.abs(length - 1) < kUnitTolerance, 'unit quaternion');
  return [numbers[0] / length, numbers[1] / length, numbers[2] / length, numbers[3] / length];
}

export function bounded<T>(list: readonly T[], most: number): readonly T[] {
  demand(list.length <= most, 'too many');
  return list;
}

// Without control signs, without signs that turn the direction of what follows, and not too long.
export function shownText(text: string, most = kLongestText): string {
  return [...text.replace(/[\p{Cc}\p{Cs}\u200e\u200f\u202a-\u202e\u2066-\u2069]/gu, '')].slice(0, most).join('');
}
export const shownName = (text: string) => shownText(text, kLongestName);
