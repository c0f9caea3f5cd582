// Which key does what: the keys of the native viewer (docs/reference/viewer.md) that mean something in a page.

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
  ['R', 'firstView', 'first view again', 'view'],
  ['X', 'cutX', 'cut-plane on, off', 'view'],
  ['Y', 'cutY', 'cut-plane on, off', 'view'],
  ['Z', 'cutZ', 'cut-plane on, off', 'view'],
  ['Shift+X', 'flipX', 'cut away the other side', 'view'],
  ['Shift+Y', 'flipY', 'cut away the other side', 'view'],
  ['Shift+Z', 'flipZ', 'cut away the other side', 'view'],
  ['[', 'cutLower', 'move the last cut-plane', 'view', true],
  [']', 'cutHigher', 'move the last cut-plane', 'view', true],
  ['T', 'transparency', 'transparent bone', 'view'],
  ['Shift+T', 'structures', 'structures: exposed, through bone, off', 'view'],
  ['E', 'endoscope', 'endoscope', 'view'],
  ['F', 'forceArrow', 'force arrow', 'view'],
  ['Left', 'orbitLeft', 'orbit', 'view', true],
  ['Right', 'orbitRight', 'orbit', 'view', true],
  ['Up', 'orbitUp', 'orbit', 'view', true],
  ['Down', 'orbitDown', 'orbit', 'view', true],
  ['+', 'zoomIn', 'zoom', 'view', true],
  ['=', 'zoomIn', 'zoom', 'view', true],
  ['-', 'zoomOut', 'zoom', 'view', true],
  ['M', 'panel', 'control panel', 'screen'],
  ['Shift+I', 'details', 'all figures', 'screen'],
  ['Shift+H', 'figures', 'figures on, off', 'screen'],
  ['J', 'largerText', 'larger text', 'screen', true],
  ['Shift+J', 'smallerText', 'smaller text', 'screen', true],
  ['Shift+M', 'sound', 'sound of milling', 'screen'],
  ['Shift+R', 'remarks', 'notes and strokes', 'screen'],
  ['Esc', 'look', 'back to looking around', 'screen'],
  ['H', 'help', 'this help', 'screen'],
  ['P', 'pause', 'pause milling, go on', 'session'],
  ['C', 'resetBone', 'put the bone back', 'session'],
  ['K', 'saveCheckpoint', 'save a checkpoint', 'session'],
  ['U', 'lastCheckpoint', 'back to the last checkpoint', 'session'],
  ['N', 'nextTool', 'next tool', 'session'],
  ['D', 'resetDevice', 'reset the device after a stop', 'session'],
  ['Shift+C', 'again', 'again: whole bone, the scripted hand anew', 'session'],
  ['0', 'accuracy0', 'accuracy of the scene file', 'session'],
  ['1', 'accuracy1', 'accuracy thesis_2012', 'session'],
  ['2', 'accuracy2', 'accuracy fast', 'session'],
  ['3', 'accuracy3', 'accuracy balanced', 'session'],
  ['4', 'accuracy4', 'accuracy exact', 'session'],
  ['Shift+N', 'nextScene', 'next scene of the lesson', 'session'],
  ['Shift+F', 'stopAttempt', 'end the attempt', 'session'],
  ['G', 'holdTool', 'hold the tool, let it go', 'tool'],
  ['I', 'toolDeeper', 'tool deeper', 'tool', true],
  ['O', 'toolNearer', 'tool nearer', 'tool', true],
];

const kNames: Record<string, string> = {
  Left: 'arrowleft', Right: 'arrowright', Up: 'arrowup', Down: 'arrowdown', Esc: 'escape',
};

export const kKeys: KeyBinding[] = kRows.map(([label, action, meaning, group, repeats]) => {
  const withShift = label.startsWith('Shift+'), name = withShift ? label.slice(6) : label;
  return { label, key: kNames[name] ?? name.toLowerCase(), withShift, action, meaning, group, repeats };
});

// Held keys mean something only while they are down.
export const kHeldKeys: [string, string, KeyBinding['group']][] = [
  ['L', 'point while held (instructor)', 'session'],
  ['B', 'mill while held', 'tool'],
  ['A', 'add material while held', 'tool'],
  ['V', 'turn the tool while held', 'tool'],
  ['Space', 'mouse for the camera while held', 'tool'],
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
