// What the session says in words: states, stops, faults, alerts; those of the native viewer (render_client/look/hud).
import { figureText, readableText, shortened } from '../shared/format';
import { Role, type DeviceView, type EffectView, type LessonView, type SceneView, type ToolView, type TrainingView, type Work } from '../shared/messages';
import { tr, trIn, trMark } from '../shared/language';
import type { Session } from '../session';

export type Tone = 'plain' | 'good' | 'warning' | 'alarm';
export interface Row {
  label: string;
  value: string;
  tone?: Tone;
}

export const kRoleNames: Record<Role, string> = {
  [Role.Viewer]: trMark('observer'), [Role.Operator]: trMark('operator'), [Role.Instructor]: trMark('instructor'), [Role.Examiner]: trMark('examiner'),
};

const kStates = [trMark('disconnected'), trMark('connected'), trMark('homing'), trMark('ready'), trMark('engaged'), trMark('paused'), trMark('protective stop'), trMark('emergency stop'), trMark('fault')];
const kCauses: [string, string][] = [
  [trMark('none'), ''],
  [trMark('device lost'), trMark('Check cable and power of the device.')],
  [trMark('implausible pose'), trMark('Move the handle to the middle of its workspace and calibrate again.')],
  [trMark('pose jumped'), trMark('Check the encoders and their cables, and calibrate again.')],
  [trMark('position sensor stuck'), trMark('Move the handle; if its position stands still, check the encoders.')],
  [trMark('too fast'), trMark('Hold the handle and reset.')],
  [trMark('too much power'), trMark('Hold the handle, move the tool out of the bone and reset.')],
  [trMark('too much energy'), trMark('Hold the handle, move the tool out of the bone and reset.')],
  [trMark('force is not what was ordered'), trMark('Check motors and amplifiers, then reset.')],
  [trMark('near a singularity'), trMark('Move the handle back to the middle of its workspace and reset.')],
  [trMark('motor too hot'), trMark('Let the motors cool down, then reset.')],
  [trMark('emergency stop'), trMark('Unlock the emergency stop, then reset.')],
  [trMark('device fault'), trMark("Look up the device's own fault number in its manual, then reset.")],
  [trMark('packets come late'), trMark('The wire keeps packets back: give the device a network of its own, then reset.')],
];
const kStopped = [0, 6, 7, 8];

const kTooSlow = trMark("The session's computer, which has the handle, was too slow for a moment: the force may have been rough.");
const kFaults: Record<string, [string, Tone]> = {
  overrun: [kTooSlow, 'warning'],
  stale_device: [trMark('The handle was not heard of for a moment, and its force went off. If it happens again, check its cable.'), 'alarm'],
  bad_device_pose: [trMark('The handle reported an impossible place, which was ignored. If it happens again, tell your instructor.'), 'alarm'],
  solve: [trMark('The force faded: the computer could not calculate it. Lift the tool off the bone until you feel it again.'), 'alarm'],
  shell_overflow: [trMark('A part of the milled surface cannot be felt: the memory for it is full. Trust the picture there.'), 'warning'],
  contact_overflow: [kTooSlow, 'warning'],
  volume_full: [trMark("The computer's memory is full: some bone was not removed. End the attempt and tell your instructor."), 'alarm'],
  implausible_device: [trMark('The handle sent impossible data, which were ignored. If it happens again, tell your instructor.'), 'alarm'],
};

export const Event = { Stalled: 1, Near: 2, Touched: 4, Damaged: 8, TooHot: 16 } as const;
const kHarm = Event.Touched | Event.Damaged;
const kWarm = 42;  // °C

export function structureName(id: number, scene?: SceneView): string {
  const material = id > 0 ? scene?.materials[id - 1] : undefined;
  return material ? material.name || tr('material {1}', id) : tr('protected');
}

// In the air the burr only turns.
const kWork: Record<Work, string> = { idle: trMark('idle'), removing: trMark('removing'), turning: trMark('turning'), adding: trMark('adding') };

export function workOf(tool?: ToolView): Work {
  if (!tool || tool.waitsForRelease) return 'idle';
  if (tool.buttons & 1) return !tool.effects || tool.contacts > 0 || tool.effects.removedMm3 > 0 ? 'removing' : 'turning';
  return tool.buttons & 2 ? 'adding' : 'idle';
}

// How hard the burr works, 0 to 1: all where it presses with 2 N.
export function loadOf(tool?: ToolView): number {
  const pressed = tool ? (tool.effects?.burrForceN ?? Math.hypot(...tool.forceN)) : 0;
  return Number.isFinite(pressed) ? Math.min(Math.max(pressed / 2, 0), 1) : 0;
}

const stateName = (state: number) => tr(kStates[state] ?? trMark('unknown state'));

export function deviceStateText(device: DeviceView): string {
  return device.isSimulated ? tr('{1}, simulated', stateName(device.state)) : stateName(device.state);
}

function effectRows(effects: EffectView, scene: SceneView | undefined, events: number): Row[] {
  const rows: Row[] = [];
  const volume = (label: string, mm3: number) =>
    rows.push({ label, value: mm3 > 0 ? readableText(mm3, ' mm³') : trIn('volume', 'none'), tone: mm3 > 0 ? 'alarm' : 'good' });
  const { protectedDistanceM, damagedMm3, temperatureC, necroticMm3 } = effects;
  if (protectedDistanceM !== undefined) {
    const mm = protectedDistanceM * 1000;
    rows.push({
      label: shortened(structureName(effects.protectedId, scene), 16),
      value: mm <= 0 ? tr('touched') : readableText(mm, ' mm'),
      tone: events & kHarm || mm <= 0 ? 'alarm' : events & Event.Near ? 'warning' : 'plain',
    });
  } else if (damagedMm3 !== undefined) {
    rows.push({ label: tr('Protected'), value: tr('far') });
  }
  if (damagedMm3 !== undefined) volume(tr('Damaged'), damagedMm3);
  if (temperatureC !== undefined)
    rows.push({
      label: tr('Hottest bone'), value: figureText(temperatureC, 1, ' °C'),
      tone: events & Event.TooHot ? 'alarm' : temperatureC >= kWarm ? 'warning' : 'plain',
    });
  if (necroticMm3 !== undefined) volume(tr('Necrosis'), necroticMm3);
  for (const { words, value, unit } of effects.figures)
    rows.push({ label: shortened(words, 16), value: readableText(value, ` ${unit}`) });
  return rows;
}

export function taskRows(session: Session, events: number): Row[] {
  const { scene, tool, status } = session, rows: Row[] = [];
  if (scene && scene.toolNames.length > 1) rows.push({ label: tr('Tool'), value: shortened(scene.toolNames[scene.toolIndex] ?? '', 24) });
  if (tool) {
    rows.push({ label: tr('Force'), value: readableText(Math.hypot(...tool.forceN), ' N') });
    const work = workOf(tool);
    if (events & Event.Stalled) rows.push({ label: tr('Burr'), value: tr('stalled'), tone: 'alarm' });
    else if (status?.isMillingPaused) rows.push({ label: tr('Burr'), value: tr('paused'), tone: 'warning' });
    else if (tool.waitsForRelease && tool.buttons !== 0) rows.push({ label: tr('Burr'), value: tr('release the pedal'), tone: 'warning' });
    else rows.push({ label: tr('Burr'), value: tr(kWork[work]), tone: work === 'idle' || work === 'turning' ? 'plain' : 'warning' });
  }
  if (status) {
    const mm3 = status.removedMm3;
    rows.push({ label: mm3 < 0 ? tr('Added') : tr('Removed'), value: readableText(Math.abs(mm3), ' mm³') });
  }
  return tool?.effects ? [...rows, ...effectRows(tool.effects, scene, events)] : rows;
}

export function detailRows(session: Session, frame_rate: number, nodes: number, triangles: number): Row[] {
  const { status, tool } = session, rows: Row[] = [];
  if (status) {
    rows.push({ label: tr('Loop'), value: figureText(status.rateHz, 0, ' Hz') });
    rows.push({ label: tr('Tick p50 / p99'), value: `${figureText(status.tickP50Us, 0, '')} / ${figureText(status.tickP99Us, 0, ' µs')}` });
    rows.push({ label: tr('Accuracy'), value: shortened(status.preset, 24) });
    if (status.device) rows.push({ label: shortened(status.device.name || tr('Device'), 14), value: deviceStateText(status.device) });
  }
  if (tool) rows.push({ label: tr('Tick no.'), value: tool.tick });
  if (tool?.effects?.spinSpeed !== undefined)
    rows.push({ label: tr('Spindle'), value: figureText((tool.effects.spinSpeed * 30) / Math.PI, 0, ' rpm') });
  rows.push({ label: tr('Model'), value: tr('{1} parts, {2}k triangles', nodes, Math.round(triangles / 1000)) });
  rows.push({ label: tr('Page'), value: tr('{1} pictures/s', figureText(frame_rate, 0, '')) });
  return rows;
}

export function stateText(session: Session): Row {
  const { connection, status } = session;
  if (connection.state === 'refused') return { label: '', value: tr('refused'), tone: 'alarm' };
  if (connection.state === 'away') return { label: '', value: tr('connection lost'), tone: 'alarm' };
  if (connection.state === 'opening') return { label: '', value: tr('opening the session'), tone: 'warning' };
  if (session.hasEnded) return { label: '', value: tr('ended') };
  if (!session.hasServer) return { label: '', value: session.scene ? tr('server lost') : tr('waiting for a server'), tone: session.scene ? 'alarm' : 'warning' };
  if (!session.hasBeenComplete)
    return { label: '', value: tr('receiving the bone, {1} of {2} parts', session.nodes, status?.nodeCount ?? '…'), tone: 'warning' };
  return { label: '', value: tr('live'), tone: 'good' };
}

export function alertText(events: number, structure: number, scene?: SceneView): { text: string; tone: Tone } | undefined {
  const name = structureName(structure, scene);
  let text = '', tone: Tone = 'alarm';
  if (events & Event.Damaged) text = tr('Damages {1}', name);
  else if (events & Event.Touched) text = tr('Touches {1}', name);
  else if (events & Event.Near) [text, tone] = [tr('Near {1}', name), 'warning'];
  if (events & Event.TooHot) [text, tone] = [text ? tr('{1}, bone too hot', text) : tr('Bone too hot'), 'alarm'];
  return text ? { text, tone } : undefined;
}

// What stands in the way of the session, in sentences.
export function conditions(session: Session): { text: string; tone: Tone }[] {
  const { status, tool } = session, list: { text: string; tone: Tone }[] = [];
  if (session.connection.state !== 'open') return list;
  if (session.hasEnded) return [{ text: tr('The session has ended. Wait: the next one is shown here when somebody starts it.'), tone: 'plain' }];
  if (!session.hasServer && session.scene)
    return [{ text: tr("The picture stands still, for there is no connection; the burr may still cut. Release the pedal. If it lasts, tell your instructor."), tone: 'alarm' }];
  const device = status?.device;
  if (device) {
    const state = tool ? tool.deviceState : device.state, name = device.name || tr('Device');
    const [cause, todo] = kCauses[tool ? tool.stopCause : device.stopCause] ?? [trMark('unknown cause'), trMark('Restart device_daemon.')];
    const stop = cause === 'none' || cause === kStates[state] ? stateName(state) : `${stateName(state)}, ${tr(cause)}`;
    if (kStopped.includes(state)) list.push({ text: `${name}: ${stop}. ${tr(todo)}`, tone: 'alarm' });
    if ((state === 3 || state === 5) && device.forceWaits) list.push({ text: tr('{1} is {2}: {3}.', name, stateName(state), tr('move the tool away from the bone')), tone: 'warning' });
  }
  if (device?.script?.hasEnded) list.push({ text: tr('The automatic demonstration has ended.'), tone: 'plain' });
  if (tool?.waitsForRelease && tool.buttons !== 0 && !status?.isMillingPaused)
    list.push({ text: tr('The bone is whole again. Release the pedal: pressed anew, it cuts.'), tone: 'warning' });
  if (status?.deviceStale && status.ticks > 0) list.push({ text: tr('The handle sends nothing: there is no force. Check its cable and switch.'), tone: 'alarm' });
  return list;
}

// What people call the scene of this id.
export function titleOf(lesson?: LessonView, id = ''): string {
  return lesson?.scenes.find((scene) => scene.id === id)?.title || id;
}

export function faults(fault_text: string): { text: string; tone: Tone }[] {
  const names = [...new Set(fault_text.split(/[\s,]+/).filter(Boolean))];
  return names.filter((name) => Object.hasOwn(kFaults, name)).map((name) => ({ text: tr(kFaults[name][0]), tone: kFaults[name][1] }));
}

export function trainingRows(training: TrainingView): Row[] {
  const rows: Row[] = [];
  const bad = (mm3: number): Tone => (mm3 > 0 ? 'alarm' : 'good');
  const volume = (mm3: number) => (mm3 > 0 ? readableText(mm3, ' mm³') : trIn('volume', 'none'));
  if (training.damagedMm3 !== undefined) rows.push({ label: tr('Damaged'), value: volume(training.damagedMm3), tone: bad(training.damagedMm3) });
  if (training.leastDistanceMm !== undefined)
    rows.push({
      label: training.nearestStructure
        ? tr('Least distance to {1}', shortened(training.nearestStructure, 24)) : tr('Least distance to a protected structure'),
      value: readableText(training.leastDistanceMm, ' mm'),
    });
  if (training.maxProtectedForceN !== undefined) rows.push({ label: tr('Largest force on a protected structure'), value: readableText(training.maxProtectedForceN, ' N') });
  if (training.necroticMm3 !== undefined) rows.push({ label: tr('Necrosis'), value: volume(training.necroticMm3), tone: bad(training.necroticMm3) });
  if (training.maxTemperatureC !== undefined) rows.push({ label: tr('Hottest bone'), value: figureText(training.maxTemperatureC, 1, ' °C') });
  return rows;
}
