// The panel's part about the language of the page.
import { kLanguages } from '#proto/languages';
import { tr } from '../shared/language';
import { choice, type Section } from './panel';

export function languageSection(spoken: string, choose: (code: string) => void): Section {
  const at = kLanguages.findIndex((one) => one.code === spoken);
  return {
    title: tr('Language'),
    key: () => spoken,
    content: () => [choice(tr('Language'), kLanguages.map((one) => one.name), at, '', (i) => choose(kLanguages[i].code))],
  };
}
