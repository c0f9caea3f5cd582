// What the session says in words: states, stops, faults, alerts; those of the native viewer (render_client/look/hud).
import { figureText, readableText, shortened } from '../shared/format';
import { Role, type DeviceView, type EffectView, type LessonView, type SceneView, type ToolView, type TrainingView, type Work } from '../shared/messages';
import type { Session } from '../session';

export type Tone = 'plain' | 'good' | 'warning' | 'alarm';
export interface Row {
  label: string;
  value: string;
  tone?: Tone;
}

export const kRoleNames: Record<Role, string> = {
  [Role.Viewer]: 'observer', [Role.Operator]: 'operator', [Role.Instructor]: 'instructor', [Role.Examiner]: 'examiner',
};

const kStates = ['disconnected', 'connected', 'homing', 'ready', 'engaged', 'paused', 'protective stop', 'emergency stop', 'fault'];
const kCauses: [string, string][] = [
  ['none', ''],
  ['device lost', 'Check cable and power of the device.'],
  ['implausible pose', 'Move the handle to the middle of its workspace and calibrate again.'],
  ['pose jumped', 'Check the encoders and their cables, and calibrate again.'],
  ['position sensor stuck', 'Move the handle; if its position stands still, check the encoders.'],
  ['too fast', 'Hold the handle and reset.'],
  ['too much power', 'Hold the handle, move the tool out of the bone and reset.'],
  ['too much energy', 'Hold the handle, move the tool out of the bone and reset.'],
  ['force is not what was ordered', 'Check motors and amplifiers, then reset.'],
  ['near a singularity', 'Move the handle back to the middle of its workspace and reset.'],
  ['motor too hot', 'Let the motors cool down, then reset.'],
  ['emergency stop', 'Unlock the emergency stop, then reset.'],
  ['device fault', "Look up the device's own fault number in its manual, then reset."],
  ['packets come late', 'The wire keeps packets back: give the device a network of its own, then reset.'],
];
const kStopped = [0, 6, 7, 8];

const kTooSlow = "The session's computer, which has the handle, was too slow for a moment: the force may have been rough.";
const kFaults: Record<string, [string, Tone]> = {
  overrun: [kTooSlow, 'warning'],
  stale_device: ['The handle was not heard of for a moment, and its force went off. If it happens again, check its cable.', 'alarm'],
  bad_device_pose: ['The handle reported an impossible place, which was ignored. If it happens again, tell your instructor.', 'alarm'],
  solve: ['The force faded: the computer could not calculate it. Lift the tool off the bone until you feel it again.', 'alarm'],
  shell_overflow: ['A part of the milled surface cannot be felt: the memory for it is full. Trust the picture there.', 'warning'],
  contact_overflow: [kTooSlow, 'warning'],
  volume_full: ["The computer's memory is full: some bone was not removed. End the attempt and tell your instructor.", 'alarm'],
  implausible_device: ['The handle sent impossible data, which were ignored. If it happens again, tell your instructor.', 'alarm'],
};

export const Event = { Stalled: 1, Near: 2, Touched: 4, Damaged: 8, TooHot: 16 } as const;
const kHarm = Event.Touched | Event.Damaged;
const kWarm = 42;  // °C

export function structureName(id: number, scene?: SceneView): string {
  const material = id > 0 ? scene?.materials[id - 1] : undefined;
  return material ? material.name || `material ${id}` : 'protected';
}

// In the air the burr only turns.
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

export function deviceStateText(device: DeviceView): string {
  return (kStates[device.state] ?? 'unknown state') + (device.isSimulated ? ', simulated' : '');
}

function effectRows(effects: EffectView, scene: SceneView | undefined, events: number): Row[] {
  const rows: Row[] = [];
  const volume = (label: string, mm3: number) =>
    rows.push({ label, value: mm3 > 0 ? readableText(mm3, ' mm³') : 'none', tone: mm3 > 0 ? 'alarm' : 'good' });
  const { protectedDistanceM, damagedMm3, temperatureC, necroticMm3 } = effects;
  if (protectedDistanceM !== undefined) {
    const mm = protectedDistanceM * 1000;
    rows.push({
      label: shortened(structureName(effects.protectedId, scene), 16),
      value: mm <= 0 ? 'touched' : readableText(mm, ' mm'),
      tone: events & kHarm || mm <= 0 ? 'alarm' : events & Event.Near ? 'warning' : 'plain',
    });
  } else if (damagedMm3 !== undefined) {
    rows.push({ label: 'Protected', value: 'far' });
  }
  if (damagedMm3 !== undefined) volume('Damaged', damagedMm3);
  if (temperatureC !== undefined)
    rows.push({
      label: 'Hottest bone', value: figureText(temperatureC, 1, ' °C'),
      tone: events & Event.TooHot ? 'alarm' : temperatureC >= kWarm ? 'warning' : 'plain',
    });
  if (necroticMm3 !== undefined) volume('Necrosis', necroticMm3);
  for (const { words, value, unit } of effects.figures)
    rows.push({ label: shortened(words, 16), value: readableText(value, ` ${unit}`) });
  return rows;
}

export function taskRows(session: Session, events: number): Row[] {
  const { scene, tool, status } = session, rows: Row[] = [];
  if (scene && scene.toolNames.length > 1) rows.push({ label: 'Tool', value: shortened(scene.toolNames[scene.toolIndex] ?? '', 24) });
  if (tool) {
    rows.push({ label: 'Force', value: readableText(Math.hypot(...tool.forceN), ' N') });
    const work = workOf(tool);
    if (events & Event.Stalled) rows.push({ label: 'Burr', value: 'stalled', tone: 'alarm' });
    else if (status?.isMillingPaused) rows.push({ label: 'Burr', value: 'paused', tone: 'warning' });
    else if (tool.waitsForRelease && tool.buttons !== 0) rows.push({ label: 'Burr', value: 'release the pedal', tone: 'warning' });
    else rows.push({ label: 'Burr', value: work, tone: work === 'idle' || work === 'turning' ? 'plain' : 'warning' });
  }
  if (status) {
    const mm3 = status.removedMm3;
    rows.push({ label: mm3 < 0 ? 'Added' : 'Removed', value: readableText(Math.abs(mm3), ' mm³') });
  }
  return tool?.effects ? [...rows, ...effectRows(tool.effects, scene, events)] : rows;
}

export function detailRows(session: Session, frame_rate: number, nodes: number, triangles: number): Row[] {
  const { status, tool } = session, rows: Row[] = [];
  if (status) {
    rows.push({ label: 'Loop', value: figureText(status.rateHz, 0, ' Hz') });
    rows.push({ label: 'Tick', value: `${figureText(status.tickP50Us, 0, '')} / ${figureText(status.tickP99Us, 0, ' µs')}` });
    rows.push({ label: 'Accuracy', value: shortened(status.preset, 24) });
    if (status.device) rows.push({ label: shortened(status.device.name || 'Device', 14), value: deviceStateText(status.device) });
  }
  if (tool) rows.push({ label: 'Tick no.', value: tool.tick });
  if (tool?.effects?.spinSpeed !== undefined)
    rows.push({ label: 'Spindle', value: figureText((tool.effects.spinSpeed * 30) / Math.PI, 0, ' rpm') });
  rows.push({ label: 'Model', value: `${nodes} parts, ${Math.round(triangles / 1000)}k triangles` });
  rows.push({ label: 'Page', value: figureText(frame_rate, 0, ' pictures/s') });
  return rows;
}

export function stateText(session: Session): Row {
  const { connection, status } = session;
  if (connection.state === 'refused') return { label: '', value: 'refused', tone: 'alarm' };
  if (connection.state === 'away') return { label: '', value: 'connection lost', tone: 'alarm' };
  if (connection.state === 'opening') return { label: '', value: 'opening the session', tone: 'warning' };
  if (session.hasEnded) return { label: '', value: 'ended' };
  if (!session.hasServer) return { label: '', value: session.scene ? 'server lost' : 'waiting for a server', tone: session.scene ? 'alarm' : 'warning' };
  if (!session.hasBeenComplete)
    return { label: '', value: `receiving the bone, ${session.nodes} of ${status?.nodeCount ?? '…'} parts`, tone: 'warning' };
  return { label: '', value: 'live', tone: 'good' };
}

export function alertText(events: number, structure: number, scene?: SceneView): { text: string; tone: Tone } | undefined {
  const name = structureName(structure, scene);
  let text = '', tone: Tone = 'alarm';
  if (events & Event.Damaged) text = `Damages ${name}`;
  else if (events & Event.Touched) text = `Touches ${name}`;
  else if (events & Event.Near) [text, tone] = [`Near ${name}`, 'warning'];
  if (events & Event.TooHot) [text, tone] = [text ? `${text}, bone too hot` : 'Bone too hot', 'alarm'];
  return text ? { text, tone } : undefined;
}

// What stands in the way of the session, in sentences.
export function conditions(session: Session): { text: string; tone: Tone }[] {
  const { status, tool } = session, list: { text: string; tone: Tone }[] = [];
  if (session.connection.state !== 'open') return list;
  if (session.hasEnded) return [{ text: 'The session has ended. Wait: the next one is shown here when somebody starts it.', tone: 'plain' }];
  if (!session.hasServer && session.scene)
    return [{ text: "The picture stands still, for there is no connection; the burr may still cut. Release the pedal. If it lasts, tell your instructor.", tone: 'alarm' }];
  const device = status?.device;
  if (device) {
    const state = tool ? tool.deviceState : device.state, name = device.name || 'Device';
    const [cause, todo] = kCauses[tool ? tool.stopCause : device.stopCause] ?? ['unknown cause', 'Restart device_daemon.'];
    const stop = cause === 'none' || cause === kStates[state] ? '' : `, ${cause}`;
    if (kStopped.includes(state)) list.push({ text: `${name}: ${kStates[state]}${stop}. ${todo}`, tone: 'alarm' });
    if ((state === 3 || state === 5) && device.forceWaits) list.push({ text: `${name} is ${kStates[state]}: move the tool away.`, tone: 'warning' });
  }
  if (device?.script?.hasEnded) list.push({ text: 'The automatic demonstration has ended.', tone: 'plain' });
  if (tool?.waitsForRelease && tool.buttons !== 0 && !status?.isMillingPaused)
    list.push({ text: 'The bone is whole again. Release the pedal: pressed anew, it cuts.', tone: 'warning' });
  if (status?.deviceStale && status.ticks > 0) list.push({ text: 'The handle sends nothing: there is no force. Check its cable and switch.', tone: 'alarm' });
  return list;
}

// What people call the scene of this id.
export function titleOf(lesson?: LessonView, id = ''): string {
  return lesson?.scenes.find((scene) => scene.id === id)?.title || id;
}

export function faults(fault_text: string): { text: string; tone: Tone }[] {
  const names = [...new Set(fault_text.split(/[\s,]+/).filter(Boolean))];
  return names.filter((name) => kFaults[name]).map((name) => ({ text: kFaults[name][0], tone: kFaults[name][1] }));
}

export function trainingRows(training: TrainingView): Row[] {
  const rows: Row[] = [];
  const bad = (mm3: number): Tone => (mm3 > 0 ? 'alarm' : 'good');
  const volume = (mm3: number) => (mm3 > 0 ? readableText(mm3, ' mm³') : 'none');
  if (training.damagedMm3 !== undefined) rows.push({ label: 'Damaged', value: volume(training.damagedMm3), tone: bad(training.damagedMm3) });
  if (training.leastDistanceMm !== undefined)
    rows.push({
      label: `Least distance to ${shortened(training.nearestStructure || 'a protected structure', 24)}`,
      value: readableText(training.leastDistanceMm, ' mm'),
    });
  if (training.maxProtectedForceN !== undefined) rows.push({ label: 'Largest force on it', value: readableText(training.maxProtectedForceN, ' N') });
  if (training.necroticMm3 !== undefined) rows.push({ label: 'Necrosis', value: volume(training.necroticMm3), tone: bad(training.necroticMm3) });
  if (training.maxTemperatureC !== undefined) rows.push({ label: 'Hottest bone', value: figureText(training.maxTemperatureC, 1, ' °C') });
  return rows;
}
