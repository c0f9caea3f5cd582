// The page's sentences, which stand in the code as tr('...'), trMark('...') and trIn('where', '...'), and what the windows'
// catalogues (render_client/language/*.po) make of them.
import { readdirSync, readFileSync } from 'node:fs';
import { basename, join } from 'node:path';

const kBetween = '\u0004';  // of where and sentence, as gettext has it

function sourcesIn(folder) {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    const path = join(folder, entry.name);
    return entry.isDirectory() ? sourcesIn(path) : path.endsWith('.ts') ? [path] : [];
  });
}

// All of them, and the texts of two words or more that are none: for the tests to look at.
export function sentencesIn(ts, folder) {
  const sentences = new Set(), others = new Set();
  const isText = (node) => ts.isStringLiteral(node) || ts.isNoSubstitutionTemplateLiteral(node);
  const isLink = (node) => ts.isImportDeclaration(node.parent) || ts.isExportDeclaration(node.parent) || ts.isLiteralTypeNode(node.parent);
  const look = (node) => {
    const called = ts.isCallExpression(node) && ts.isIdentifier(node.expression) ? node.expression.text : '';
    if (['tr', 'trMark', 'trIn'].includes(called)) {
      const words = node.arguments.slice(0, called === 'trIn' ? 2 : 1);
      if (words.every(isText)) sentences.add(words.map((word) => word.text).join(kBetween));
      words.filter((word) => !isText(word)).forEach(look);
      node.arguments.slice(words.length).forEach(look);
      return;
    }
    if ((isText(node) && !isLink(node)) || ts.isTemplateHead(node) || ts.isTemplateMiddle(node) || ts.isTemplateTail(node))
      if (/[a-z]+[,:]? [a-z]+/i.test(node.text)) others.add(node.text);
    if (!ts.isNewExpression(node) || node.expression.getText() !== 'Error') ts.forEachChild(node, look);
  };
  for (const file of sourcesIn(folder)) look(ts.createSourceFile(file, readFileSync(file, 'utf8'), ts.ScriptTarget.ES2022, true));
  return { sentences: [...sentences].sort(), others: [...others].sort() };
}

// A file of gettext; entries that are fuzzy or empty are left out.
function catalogueOf(file) {
  const found = {};
  for (const block of readFileSync(file, 'utf8').split(/\n\n+/)) {
    if (/^#,.*fuzzy/m.test(block)) continue;
    const parts = { msgctxt: '', msgid: '', msgstr: '' };
    let name = '';
    for (const line of block.split('\n').filter((one) => one && !one.startsWith('#'))) {
      const [, word, text] = /^(\w*) ?(".*")$/.exec(line);
      name = word || name;
      parts[name] += JSON.parse(text);
    }
    if (parts.msgid && parts.msgstr) found[(parts.msgctxt ? parts.msgctxt + kBetween : '') + parts.msgid] = parts.msgstr;
  }
  return found;
}

// By language: its own name, and the page's sentences in it.
export function cataloguesIn(folder, sentences) {
  const files = readdirSync(folder).filter((name) => name.endsWith('.po')).sort();
  return Object.fromEntries(files.map((name) => {
    const all = catalogueOf(join(folder, name)), code = basename(name, '.po');
    return [code, { name: all.English ?? code, words: Object.fromEntries(sentences.filter((one) => all[one]).map((one) => [one, all[one]])) }];
  }));
}
