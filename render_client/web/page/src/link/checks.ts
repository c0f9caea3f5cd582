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

const kUnprintable = /[\p{Cc}\p{Cs}\u00ad\u061c\u180e\u200b\u200e\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb\u{e0000}-\u{e007f}]/gu;

// Without what common/text/foreign_text.h calls unprintable, and not too long.
export function shownText(text: string, most = kLongestText): string {
  return [...text.replace(kUnprintable, '')].slice(0, most).join('');
}
