// The help over the picture: fingers, mouse and keys.
import { byId, make } from './dom';
import { kHeldKeys, kKeys } from './key_table';

const kMouse: [string, string][] = [
  ['left drag, one finger', 'orbit'], ['right drag, two fingers', 'pan'], ['wheel, pinch', 'zoom'],
  ['double click, double tap', 'orbit around that point'], ['ctrl + left drag', 'point with the laser (instructor)'],
];
const kHolding: [string, string][] = [
  ['move', 'the tool follows'], ['wheel', 'deeper, nearer'], ['left held', 'mill; with shift: add material'],
  ['right drag', 'turn the tool'], ['middle drag', 'orbit, with shift pan'],
];
const kTitles = { view: 'View', screen: 'Screen', session: 'Session (operator, instructor)', tool: 'Tool in the mouse (operator)' };

function section(title: string, rows: [string, string][]): HTMLElement {
  const list = rows.flatMap(([key, meaning]) => [make('dt', { text: key }), make('dd', { text: meaning })]);
  return make('section', {}, make('h2', { text: title }), make('dl', {}, ...list));
}

export function toggleHelp(): void {
  const help = byId('help');
  if (help.childElementCount === 0) {
    const groups = ['view', 'screen', 'session', 'tool'] as const;
    help.append(section('Mouse and fingers', kMouse), ...groups.map((group) => section(kTitles[group], [
      ...kKeys.filter((one) => one.group === group).map((one): [string, string] => [one.label, one.meaning]),
      ...kHeldKeys.filter((one) => one[2] === group).map((one): [string, string] => [one[0], one[1]]),
    ])), section('Mouse while it holds the tool', kHolding));
    help.addEventListener('click', () => (help.hidden = true));
  }
  help.hidden = !help.hidden;
}
