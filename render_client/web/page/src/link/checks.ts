// What is common to all that is checked. A message that fails is dropped and counted.
export class Malformed extends Error {}

export const kLargestNumber = 1e6;
export const kLongestText = 512;
export const kUnitTolerance = 1e-3;

export function demand(is_so: boolean, what: string): void {
  if (!is_so) throw new Malformed(what);
}

export function within(value: number, low: number, high: number): number {
  demand(value >= low && value <= high, 'range');
  return value;
}

// Without control signs, without signs that turn the direction of what follows, and not too long.
export function shownText(text: string, most = kLongestText): string {
  return [...text.replace(/[\p{Cc}\p{Cs}\u200e\u200f\u202a-\u202e\u2066-\u2069]/gu, '')].slice(0, most).join('');
}
