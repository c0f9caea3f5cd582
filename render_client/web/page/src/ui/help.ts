// The help over the picture: fingers, mouse and keys.
import { byId, make } from './dom';
import { kHeldKeys, kKeys, keyText } from './key_table';
import { tr, trMark } from '../shared/language';

const kMouse: [string, string][] = [
  [trMark('left drag, one finger'), trMark('orbit')], [trMark('right drag, two fingers'), trMark('pan')], [trMark('wheel, pinch'), trMark('zoom')],
  [trMark('double click, double tap'), trMark('orbit around that point')], [trMark('ctrl + left drag'), trMark('point with the laser (instructor)')],
];
const kHolding: [string, string][] = [
  [trMark('move'), trMark('the tool follows')], [trMark('wheel'), trMark('deeper, nearer')], [trMark('left held'), trMark('mill; with shift: add material')],
  [trMark('right drag'), trMark('turn the tool')], [trMark('middle drag'), trMark('orbit, with shift pan')],
];
const kTitles = { view: trMark('View'), screen: trMark('Screen'), session: trMark('Session (operator, instructor)'), tool: trMark('Tool in the mouse (operator)') };

function section(title: string, rows: [string, string][]): HTMLElement {
  const list = rows.flatMap(([key, meaning]) => [make('dt', { text: keyText(key) }), make('dd', { text: tr(meaning) })]);
  return make('section', {}, make('h2', { text: tr(title) }), make('dl', {}, ...list));
}

export function toggleHelp(): void {
  const help = byId('help');
  if (help.childElementCount === 0) {
    const groups = ['view', 'screen', 'session', 'tool'] as const;
    help.append(section(trMark('Mouse and fingers'), kMouse), ...groups.map((group) => section(kTitles[group], [
      ...kKeys.filter((one) => one.group === group).map((one): [string, string] => [one.label, one.meaning]),
      ...kHeldKeys.filter((one) => one[2] === group).map((one): [string, string] => [one[0], one[1]]),
    ])), section(trMark('Mouse while it holds the tool'), kHolding));
    help.addEventListener('click', () => (help.hidden = true));
  }
  help.hidden = !help.hidden;
}
