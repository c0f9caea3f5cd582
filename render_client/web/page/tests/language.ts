// What the page says in other languages than English, with node's own test runner.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { kCatalogues, kOthers, kSentences } from '#proto/catalogues';
import * as payloads from '../src/link/payloads';
import { whyNot } from '../src/orders';
import { Session } from '../src/session';
import { addressIn, chosenLanguage, speak, tr } from '../src/shared/language';
import { keyText, kKeys } from '../src/ui/key_table';
import { detailRows, faults, stateText } from '../src/ui/words';
import * as synthetic from './synthetic';

test('every sentence of the page is in the catalogues of the windows', () => {
  assert.ok(kSentences.length > 150, `${kSentences.length} sentences`);
  assert.ok(Object.keys(kCatalogues).length >= 2);
  for (const [code, { words }] of Object.entries(kCatalogues))
    for (const sentence of kSentences) {
      assert.ok(words[sentence], `${code} lacks ${JSON.stringify(sentence)}`);
      assert.deepEqual((words[sentence].match(/\{\d\}/g) ?? []).sort(), (sentence.match(/\{\d\}/g) ?? []).sort(), sentence);
    }
});

test('no text of several words is left out of the catalogues', () => {
  // What is logged or thrown, and names in the drawing.
  const kNotForPeople = [' is too long', ' of length 1', 'a sample was dropped:', 'bone depth', 'card chosen', 'model too large',
    'precision highp ', 'tool indices', 'tool shadow'];
  assert.deepEqual(kOthers.filter((text) => !kNotForPeople.includes(text)), []);
});

test('a language is that of the address, or the first of the browser that there is', () => {
  assert.equal(chosenLanguage('', ['de-AT', 'en']), 'de');
  assert.equal(chosenLanguage('?lang=sv', ['de-AT']), 'sv');
  assert.equal(chosenLanguage('?lang=en', ['de']), 'en');
  assert.equal(chosenLanguage('?lang=tlh', ['fi', 'sv-FI', 'de']), 'sv');
  assert.equal(chosenLanguage('', ['fi']), 'en');
  assert.equal(chosenLanguage('?lang=DE_at', []), 'de');
  assert.equal(chosenLanguage('?lang=../x', ['constructor']), 'en');
  assert.equal(addressIn('de', 'https://host/a?lang=en&b=1#t'), 'https://host/a?lang=de&b=1#t');
});

test('what the session says is said in the language that was chosen', () => {
  speak(Object.fromEntries(kSentences.map((sentence) => [sentence, `«${sentence.replace(/^.*\u0004/, '')}»`])));
  try {
    const session = new Session();
    session.take({ kind: 'status', status: payloads.statusOf(synthetic.status({ nodes: { count: 1, digest: 0n } }).payload) }, 0);
    assert.equal(tr('Back to {1}', 3), '«Back to 3»');
    assert.equal(tr('not of the page'), 'not of the page');
    for (const text of [stateText(session).value, whyNot('setAccuracy', session), ...detailRows(session, 30, 1, 1).map((row) => row.label).filter((label) => label !== 'simulated hand'),
      ...kKeys.map((one) => tr(one.meaning)), keyText('Shift+X')])
      assert.match(text, /^«.*»/);
  } finally {
    speak({});
  }
  assert.equal(tr('Back to {1}', 3), 'Back to 3');
});

test('what others call a thing is not taken for a sentence', () => {
  for (const name of ['constructor', 'toString', '__proto__']) {
    assert.equal(tr(name), name);
    assert.deepEqual(faults(name), []);
  }
});
