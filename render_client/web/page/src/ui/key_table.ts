// Which key does what: the keys of the native viewer (docs/reference/viewer.md) that mean something in a page.
import { tr, trMark } from '../shared/language';

export type Action =
  | 'firstView' | 'cutX' | 'cutY' | 'cutZ' | 'flipX' | 'flipY' | 'flipZ' | 'cutLower' | 'cutHigher' | 'transparency'
  | 'structures' | 'endoscope' | 'forceArrow' | 'orbitLeft' | 'orbitRight' | 'orbitUp' | 'orbitDown' | 'zoomIn'
  | 'zoomOut' | 'panel' | 'figures' | 'details' | 'largerText' | 'smallerText' | 'help' | 'sound' | 'remarks' | 'look'
  | 'pause' | 'resetBone' | 'saveCheckpoint' | 'lastCheckpoint' | 'nextTool' | 'resetDevice' | 'again' | 'accuracy0'
  | 'accuracy1' | 'accuracy2' | 'accuracy3' | 'accuracy4' | 'nextScene' | 'stopAttempt' | 'holdTool' | 'toolDeeper'
  | 'toolNearer';

export interface KeyBinding {
  label: string;
  key: string;  // as KeyboardEvent.key says, letters in lower case
  withShift: boolean;
  action: Action;
  meaning: string;
  group: 'view' | 'screen' | 'session' | 'tool';
  repeats?: boolean;
}

const kRows: [string, Action, string, KeyBinding['group'], boolean?][] = [
  ['R', 'firstView', trMark('first view again'), 'view'],
  ['X', 'cutX', trMark('cut-plane on, off'), 'view'],
  ['Y', 'cutY', trMark('cut-plane on, off'), 'view'],
  ['Z', 'cutZ', trMark('cut-plane on, off'), 'view'],
  ['Shift+X', 'flipX', trMark('cut away the other side'), 'view'],
  ['Shift+Y', 'flipY', trMark('cut away the other side'), 'view'],
  ['Shift+Z', 'flipZ', trMark('cut away the other side'), 'view'],
  ['[', 'cutLower', trMark('move the last cut-plane'), 'view', true],
  [']', 'cutHigher', trMark('move the last cut-plane'), 'view', true],
  ['T', 'transparency', trMark('transparent bone'), 'view'],
  ['Shift+T', 'structures', trMark('structures: exposed, through bone, off'), 'view'],
  ['E', 'endoscope', trMark('endoscope'), 'view'],
  ['F', 'forceArrow', trMark('force arrow'), 'view'],
  [trMark('Left'), 'orbitLeft', trMark('orbit'), 'view', true],
  [trMark('Right'), 'orbitRight', trMark('orbit'), 'view', true],
  [trMark('Up'), 'orbitUp', trMark('orbit'), 'view', true],
  [trMark('Down'), 'orbitDown', trMark('orbit'), 'view', true],
  ['+', 'zoomIn', trMark('zoom'), 'view', true],
  ['=', 'zoomIn', trMark('zoom'), 'view', true],
  ['-', 'zoomOut', trMark('zoom'), 'view', true],
  ['M', 'panel', trMark('control panel'), 'screen'],
  ['Shift+I', 'details', trMark('all figures'), 'screen'],
  ['Shift+H', 'figures', trMark('figures on, off'), 'screen'],
  ['J', 'largerText', trMark('larger text'), 'screen', true],
  ['Shift+J', 'smallerText', trMark('smaller text'), 'screen', true],
  ['Shift+M', 'sound', trMark('sound of milling'), 'screen'],
  ['Shift+R', 'remarks', trMark('notes and strokes'), 'screen'],
  ['Esc', 'look', trMark('back to looking around'), 'screen'],
  ['H', 'help', trMark('this help'), 'screen'],
  ['P', 'pause', trMark('pause milling, go on'), 'session'],
  ['C', 'resetBone', trMark('put the bone back'), 'session'],
  ['K', 'saveCheckpoint', trMark('save a checkpoint'), 'session'],
  ['U', 'lastCheckpoint', trMark('back to the last checkpoint'), 'session'],
  ['N', 'nextTool', trMark('next tool'), 'session'],
  ['D', 'resetDevice', trMark('reset the device after a stop'), 'session'],
  ['Shift+C', 'again', trMark('again: whole bone, the scripted hand anew'), 'session'],
  ['0', 'accuracy0', trMark('accuracy of the scene file'), 'session'],
  ['1', 'accuracy1', trMark('accuracy thesis_2012'), 'session'],
  ['2', 'accuracy2', trMark('accuracy fast'), 'session'],
  ['3', 'accuracy3', trMark('accuracy balanced'), 'session'],
  ['4', 'accuracy4', trMark('accuracy exact'), 'session'],
  ['Shift+N', 'nextScene', trMark('next scene of the lesson'), 'session'],
  ['Shift+F', 'stopAttempt', trMark('end the attempt'), 'session'],
  ['G', 'holdTool', trMark('hold the tool, let it go'), 'tool'],
  ['I', 'toolDeeper', trMark('tool deeper'), 'tool', true],
  ['O', 'toolNearer', trMark('tool nearer'), 'tool', true],
];

const kNames: Record<string, string> = {
  Left: 'arrowleft', Right: 'arrowright', Up: 'arrowup', Down: 'arrowdown', Esc: 'escape',
};

export const kKeys: KeyBinding[] = kRows.map(([label, action, meaning, group, repeats]) => {
  const withShift = label.startsWith('Shift+'), name = withShift ? label.slice(6) : label;
  return { label, key: kNames[name] ?? name.toLowerCase(), withShift, action, meaning, group, repeats };
});

// As the key is called.
export function keyText(label: string): string {
  return label.startsWith('Shift+') ? `${tr('Shift')}+${label.slice(6)}` : tr(label);
}

// Held keys mean something only while they are down.
export const kHeldKeys: [string, string, KeyBinding['group']][] = [
  ['L', trMark('point while held (instructor)'), 'session'],
  ['B', trMark('mill while held'), 'tool'],
  ['A', trMark('add material while held'), 'tool'],
  ['V', trMark('turn the tool while held'), 'tool'],
  [trMark('Space'), trMark('mouse for the camera while held'), 'tool'],
];

export interface KeyPress {
  key: string;
  shiftKey: boolean;
  ctrlKey: boolean;
  metaKey: boolean;
  altKey: boolean;
  repeat: boolean;
}

export function actionOf(press: KeyPress): Action | undefined {
  if (press.ctrlKey || press.metaKey || press.altKey) return undefined;
  const key = press.key.toLowerCase(), is_sign = key.length === 1 && !/[a-z]/.test(key);
  const found = kKeys.find((one) => one.key === key && (is_sign || one.withShift === press.shiftKey));
  return found && (found.repeats || !press.repeat) ? found.action : undefined;
}

export const kPresets = ['scene', 'thesis_2012', 'fast', 'balanced', 'exact'];
