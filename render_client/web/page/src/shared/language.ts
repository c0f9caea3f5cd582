// What the page says, in the reader's language: the sentences of the code are the English ones, the others come from the
// windows' catalogues (render_client/language), of which build.mjs makes a JSON file each with the page's sentences.
import { kLanguages } from '#proto/languages';

const kLongestWaitMs = 3000;

export type Catalogue = Record<string, string>;

let spoken: Catalogue = {};

export function speak(catalogue: Catalogue): void {
  spoken = catalogue;
}

// What others sent may be called as what every object has.
function said(text: string): string | undefined {
  return Object.hasOwn(spoken, text) ? spoken[text] : undefined;
}

function filled(text: string, parts: (string | number)[]): string {
  return text.replace(/\{(\d)\}/g, (place, n) => String(parts[Number(n) - 1] ?? place));
}

// `text` stands in the code as it is, or was marked; parts take the places of {1}, {2} ...
export function tr(text: string, ...parts: (string | number)[]): string {
  return filled(said(text) ?? text, parts);
}
// A sentence that means different things at different places.
export function trIn(context: string, text: string): string {
  return said(`${context}\u0004${text}`) ?? text;
}
// A sentence of a table, which tr() translates later.
export const trMark = <Text extends string>(text: Text): Text => text;

// What the address asks for (?lang=de), or else the first of the browser's languages that there is.
export function chosenLanguage(search: string, wanted: readonly string[]): string {
  const asked = new URLSearchParams(search).get('lang');
  const plain = (tag: string) => tag.toLowerCase().replace('_', '-');
  const tags = [...(asked ? [asked] : []), ...wanted].flatMap((tag) => [plain(tag), plain(tag).split('-')[0]]);
  const found = tags.map((tag) => kLanguages.find((one) => plain(one.code) === tag)?.code);
  return found.find((code) => code) ?? 'en';
}

// English is there already; what cannot be loaded stays English.
export async function loadLanguage(code: string): Promise<string> {
  if (code === 'en') return code;
  try {
    const answer = await fetch(`languages/${code}.json`, { signal: AbortSignal.timeout(kLongestWaitMs) });
    if (!answer.ok) return 'en';
    speak(await answer.json() as Catalogue);
    return code;
  } catch {
    return 'en';
  }
}

// The same address in another language; the tab keeps its ticket.
export function addressIn(code: string, address: string): string {
  const url = new URL(address);
  url.searchParams.set('lang', code);
  return url.href;
}
