// Builds the page: node build.mjs --source DIR --shaders DIR --proto DIR --languages DIR --work DIR --out DIR
// In the work folder lie copies of the sources, the packages (npm ci, when package-lock.json changed) and the code made
// from proto/, and contained.json names the packages that the page holds; the out folder gets index.html, page.css and the three scripts, each also compressed, and a JSON file for each language, of the windows' catalogues.
import { execFileSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { gzipSync } from 'node:zlib';
import { cataloguesIn, sentencesIn } from './languages.mjs';

const options = Object.fromEntries(process.argv.slice(2).map((word, i, all) => (word.startsWith('--') ? [word.slice(2), resolve(all[i + 1] ?? '')] : ['', ''])));
const { source, shaders, proto, languages, work, out } = options;
if (!source || !shaders || !proto || !languages || !work || !out)
  throw new Error('usage: node build.mjs --source DIR --shaders DIR --proto DIR --languages DIR --work DIR --out DIR');
const kMostPageBytes = 200_000;  // compressed, of all that a guest loads

function run(program, ...args) {
  execFileSync(program, args, { cwd: work, stdio: ['ignore', 'inherit', 'inherit'] });
}

mkdirSync(work, { recursive: true });
mkdirSync(out, { recursive: true });
const lock = readFileSync(join(source, 'package-lock.json'), 'utf8');
const installed = join(work, 'installed-lock.json');
for (const file of ['package.json', 'package-lock.json', '.npmrc', 'tsconfig.json']) cpSync(join(source, file), join(work, file));
if (!existsSync(installed) || readFileSync(installed, 'utf8') !== lock) {
  try {
    run('npm', 'ci', '--no-audit', '--no-fund', '--loglevel=error');
  } catch {
    console.error('page: npm ci failed: is there a network? cmake -DBONEMILL_PAGE=OFF builds everything else.');
    process.exit(1);
  }
  writeFileSync(installed, lock);
}
for (const [folder, from] of [['src', join(source, 'src')], ['tests', join(source, 'tests')], ['shaders', shaders]]) {
  rmSync(join(work, folder), { recursive: true, force: true });
  cpSync(from, join(work, folder), { recursive: true });
}
mkdirSync(join(work, 'generated'), { recursive: true });
const protos = readdirSync(proto).filter((name) => /^(bounds|gateway|topics|densities|scene)(_\w+)?\.proto$/.test(name)).map((name) => join(proto, name));
run('protoc', '-I', proto, `--plugin=protoc-gen-es=${join(work, 'node_modules/.bin/protoc-gen-es')}`, '--es_out=generated', '--es_opt=target=ts', ...protos);
const fromWork = createRequire(join(work, 'package.json'));
writeFileSync(join(work, 'generated/command_rows.ts'), commandRows());
const { sentences, others } = sentencesIn(fromWork('typescript'), join(work, 'src')), catalogues = cataloguesIn(languages, sentences);
const offered = [{ code: 'en', name: 'English' }, ...Object.entries(catalogues).map(([code, { name }]) => ({ code, name }))];
writeFileSync(join(work, 'generated/languages.ts'), `export const kLanguages = ${JSON.stringify(offered)};\n`);
writeFileSync(join(work, 'generated/catalogues.ts'),
  `export const kSentences: string[] = ${JSON.stringify(sentences)}, kOthers: string[] = ${JSON.stringify(others)};\n` +
  `export const kCatalogues: Record<string, { name: string; words: Record<string, string> }> = ${JSON.stringify(catalogues)};\n`);
run(process.execPath, join(work, 'node_modules/typescript/bin/tsc'), '--noEmit');

// The option (row) of each action of Command, as a table that needs no Protobuf.
function commandRows() {
  const { createFileRegistry, fromBinary, getOption, toJson } = fromWork('@bufbuild/protobuf');
  const { FileDescriptorSetSchema } = fromWork('@bufbuild/protobuf/wkt');
  run('protoc', '-I', proto, '--include_imports', '--descriptor_set_out=generated/topics.bin', join(proto, 'topics.proto'));
  const registry = createFileRegistry(fromBinary(FileDescriptorSetSchema, readFileSync(join(work, 'generated/topics.bin'))));
  const row = registry.getExtension('bonemill.topics.row');
  const actions = registry.getMessage('bonemill.topics.Command').fields.filter((field) => field.oneof);
  const rows = Object.fromEntries(actions.map((field) => [field.localName, toJson(row.message, getOption(field, row))]));
  return `// Made from proto/topics_commands.proto by build.mjs.\nexport const kCommandRows = ${JSON.stringify(rows, null, 2)};\n`;
}

// A shader is its text, with the files that it includes in their places and without what only readers need.
function shaderText(file) {
  const whole = readFileSync(file, 'utf8').replace(/#include "(.*)"\n/g, (_, name) => shaderText(join(dirname(file), name)));
  return whole.replace(/ *\/\/.*$/gm, '').replace(/^\s+/gm, '');
}
const glsl = {
  name: 'glsl',
  setup: (made) => made.onLoad({ filter: /\.glsl$/ }, ({ path }) => ({ contents: shaderText(path), loader: 'text' })),
};

const { build } = fromWork('esbuild');
const common = { absWorkingDir: work, bundle: true, format: 'esm', legalComments: 'eof', logLevel: 'warning', plugins: [glsl] };
const made = await build({
  ...common, metafile: true, minify: true, target: 'es2022', outdir: out,
  entryPoints: { page: 'src/main.ts', link: 'src/link/link_worker.ts', sound: 'src/sound/sound_worklet.ts' },
});
// Which packages the page holds, for deploy/security/make-sbom.
const parts = Object.values(made.metafile.outputs).flatMap(({ inputs }) => Object.keys(inputs).filter((file) => inputs[file].bytesInOutput > 0));
const packages = parts.map((file) => /^.*node_modules\/(@[^/]+\/)?[^/]+/.exec(file)?.[0]).filter((folder) => folder);
writeFileSync(join(work, 'contained.json'), JSON.stringify([...new Set(packages)].sort()));
await build({
  ...common, platform: 'node', target: 'node18', outdir: join(work, 'tests_out'), outExtension: { '.js': '.mjs' },
  entryPoints: { unit: 'tests/unit.ts', language: 'tests/language.ts', journal: 'tests/journal.ts', foxglove: 'tests/foxglove.ts', stand_in: 'tests/stand_in.ts', browser: 'tests/browser.ts', native: 'tests/native.ts', rate: 'tests/rate.ts' },
  external: ['playwright-core', 'ws'],
});

let total = 0;
for (const file of ['index.html', 'page.css', 'page.js', 'link.js', 'sound.js']) {
  if (!file.endsWith('.js')) cpSync(join(source, file), join(out, file));
  const packed = gzipSync(readFileSync(join(out, file)), { level: 9 });
  writeFileSync(join(out, `${file}.gz`), packed);
  total += packed.length;
}
rmSync(join(out, 'languages'), { recursive: true, force: true });
mkdirSync(join(out, 'languages'));
for (const [code, { words }] of Object.entries(catalogues)) {
  writeFileSync(join(out, `languages/${code}.json`), JSON.stringify(words));
  writeFileSync(join(out, `languages/${code}.json.gz`), gzipSync(JSON.stringify(words), { level: 9 }));
}
console.log(`page: ${total} bytes compressed`);
if (total > kMostPageBytes) throw new Error(`the page is too large: ${total} of ${kMostPageBytes} bytes`);
