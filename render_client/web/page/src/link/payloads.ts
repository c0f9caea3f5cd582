// From the payloads of the topics to what the page shows. All throw Malformed, or what the decoder throws: each field is
// checked by read(), and here only what must go together.
import * as wire from './wire';
import type {
  AttemptView, CameraWish, EffectView, LessonView, RemarkView, SceneChoiceView, ScenePictureView, SceneView, SoundWish, StatusView,
  ToolMesh, ToolView, TrainingView, ViewerView,
} from '../shared/messages';
import { Role } from '../shared/messages';
import { mayHoldTool, mayPoint } from '../shared/commands';
import type { Quat, Vec3 } from '../math/linear';
import { read } from './bounds';
import { demand, shownText } from './checks';

const kMaxNote = 300;  // letters
const kMaxMaterialName = 64;

const vector = (numbers: readonly number[]) => numbers as unknown as Vec3;
const vectorOrNone = (numbers: readonly number[]) => (numbers.length === 0 ? undefined : vector(numbers));

function quaternion(numbers: readonly number[]): Quat {
  const length = Math.hypot(...numbers);
  return [numbers[0] / length, numbers[1] / length, numbers[2] / length, numbers[3] / length];
}

function toolMeshOf(mesh: wire.TriangleMesh | undefined): ToolMesh {
  const count = (mesh?.verticesM.length ?? 0) / 3;
  const vertices = Float32Array.from(mesh?.verticesM ?? []), normals = Float32Array.from(mesh?.normals ?? []);
  const indices = Uint32Array.from(mesh?.indices ?? []);
  demand(Number.isInteger(count) && normals.length === vertices.length, 'tool');
  demand(indices.length % 3 === 0 && indices.every((i) => i < count), 'tool indices');
  return { vertices, normals, indices };
}

function cameraOf(camera: wire.Camera): CameraWish {
  demand(!camera.hasTarget || camera.targetM.length === 3, 'target');
  return {
    target: camera.hasTarget ? vector(camera.targetM) : undefined,
    distance: camera.distanceM,
    azimuth: camera.azimuthRad,
    elevation: camera.elevationRad,
    up: vectorOrNone(camera.up),
  };
}

function soundOf(info: wire.SceneInfo): SoundWish | undefined {
  const sound = info.viewerEffects?.millingSound;
  if (!sound) return undefined;
  return {
    volume: sound.volume ?? 0.5,
    flutes: sound.flutes ?? 8,
    idleLevel: sound.idleLevel ?? 0.3,
    fullSpeedRpm: sound.fullSpeedRpm ?? 30000,
    fullPowerW: sound.fullPowerW ?? 10,
  };
}

export function sceneOf(payload: Uint8Array): SceneView {
  const info = read(wire.SceneInfoSchema, payload);
  return {
    epoch: String(info.epoch),
    revision: info.revision,
    name: info.name,
    title: info.title || info.name,
    X_WV: { p: vector(info.pWVM), q: quaternion(info.qWV) },
    boneLow: vector(info.boneMinM),
    boneHigh: vector(info.boneMaxM),
    burrRadius: info.burrRadiusM,
    otherFirstLeaf: info.otherFirstLeaf || Infinity,
    tool: toolMeshOf(info.tool),
    camera: info.camera && cameraOf(info.camera),
    toolNames: info.toolNames,
    toolIndex: info.toolIndex,
    materials: info.materials.map((m) => ({
      name: shownText(m.name ?? '', kMaxMaterialName),
      colour: m.color && ([m.color.red ?? 1, m.color.green ?? 1, m.color.blue ?? 1] as Vec3),
      isProtected: m.isProtected ?? false,
    })),
    sound: soundOf(info),
  };
}

function effectsOf(state: wire.EffectState): EffectView {
  return {
    events: state.events,
    removedMm3: state.removedMm3,
    spinSpeed: state.spinSpeed,
    burrForceN: state.burrForceN,
    cuttingPowerW: state.cuttingPowerW,
    temperatureC: state.temperatureC,
    necroticMm3: state.necroticMm3,
    protectedDistanceM: state.protectedDistanceM,
    damagedMm3: state.damagedMm3,
    protectedId: state.protectedId,
    eventId: state.eventId,
    figures: state.figures.map(({ words, value, unit }) => ({ words, value, unit })),
  };
}

export function toolOf(payload: Uint8Array): ToolView {
  const state = read(wire.ToolStateSchema, payload);
  return {
    epoch: String(state.epoch),
    tick: String(state.tick),
    X_WT: { p: vector(state.pWTM), q: quaternion(state.qWT) },
    contacts: state.contacts,
    X_WT_device: { p: vector(state.pWTDeviceM), q: quaternion(state.qWTDevice) },
    X_WT_expert: state.pWTExpertM.length > 0 ? { p: vector(state.pWTExpertM), q: quaternion(state.qWTExpert) } : undefined,
    forceN: vector(state.forceN),
    buttons: state.buttons,
    waitsForRelease: state.waitsForRelease,
    deviceState: state.deviceState,
    stopCause: state.stopCause,
    effects: state.effects && effectsOf(state.effects),
  };
}

function trainingOf(training: wire.Training): TrainingView {
  return {
    damagedMm3: training.damagedMm3,
    leastDistanceMm: training.leastDistanceMm,
    nearestStructure: training.nearestStructure,
    maxProtectedForceN: training.maxProtectedForceN,
    necroticMm3: training.necroticMm3,
    maxTemperatureC: training.maxTemperatureC,
    warnings: training.warnings,
  };
}

export function statusOf(payload: Uint8Array): StatusView {
  const status = read(wire.StatusSchema, payload);
  const device = status.device;
  return {
    epoch: String(status.epoch),
    scene: status.scene,
    preset: status.preset,
    ticks: Number(status.ticks),
    rateHz: status.rateHz,
    tickP50Us: status.tickP50Us,
    tickP99Us: status.tickP99Us,
    faultText: status.faultText,
    removedMm3: status.removedMm3,
    nodeCount: status.nodeCount,
    lastCommandSequence: status.lastCommandSequence,
    lastCommandSender: String(status.lastCommandSender),
    lastCommandResult: status.lastCommandResult,
    isLastCommandDone: status.lastCommandOutcome === wire.Outcome.DONE,
    deviceStale: status.deviceStale,
    sessionS: status.sessionS,
    isMillingPaused: status.isMillingPaused,
    checkpoints: status.checkpoints.map((c) => ({
      id: c.id, sessionS: c.sessionS, removedMm3: c.removedMm3,
    })),
    isModelPartial: status.isModelPartial,
    training: status.training && trainingOf(status.training),
    device: device && {
      name: device.name, kind: device.kind, state: device.state, stopCause: device.stopCause,
      isSimulated: device.isSimulated, forceWaits: device.forceWaits,
      script: device.script && { hasEnded: device.script.hasEnded, takenOverBy: String(device.script.takenOverBy) },
    },
  };
}

function choiceOf(scene: wire.SceneChoice): SceneChoiceView {
  return {
    id: scene.id,
    title: scene.title,
    task: scene.task,
    tools: scene.tools,
    expectedS: scene.expectedS,
    picture: scene.picture.length > 0 ? scene.picture.slice() : undefined,
    problem: scene.problem,
    isMadeFirst: scene.isMadeFirst,
  };
}

function attemptOf(attempt: wire.Attempt): AttemptView {
  return {
    number: attempt.number,
    trainee: attempt.trainee,
    sceneId: attempt.sceneId,
    timeS: attempt.timeS,
    removedMm3: attempt.removedMm3,
    maxForceN: attempt.maxForceN,
    training: attempt.training && trainingOf(attempt.training),
    structuresTouched: attempt.structuresTouched,
  };
}

export function lessonOf(payload: Uint8Array): LessonView {
  const lesson = read(wire.LessonSchema, payload);
  return {
    epoch: String(lesson.epoch),
    scenes: lesson.scenes.map(choiceOf),
    sceneId: lesson.sceneId,
    isRunning: lesson.isRunning,
    trainee: lesson.trainee,
    attempts: lesson.attempts.map(attemptOf),
    changingTo: lesson.changingTo,
  };
}

export function pictureOf(payload: Uint8Array): ScenePictureView {
  const picture = read(wire.ScenePictureSchema, payload);
  return { epoch: String(picture.epoch), sceneId: picture.sceneId, png: picture.png.slice() };
}

export function viewerOf(payload: Uint8Array): ViewerView {
  const viewer = read(wire.ViewerSchema, payload);
  const role = viewer.role as number as Role;
  return {
    sender: String(viewer.sender),
    name: viewer.name,
    role,
    frameRateHz: viewer.frameRateHz,
    isComplete: viewer.isComplete,
    pointer: mayPoint(role) ? vectorOrNone(viewer.pointerM) : undefined,
    isHolding: viewer.isHolding && mayHoldTool(role),
    link: viewer.link,
    camera: viewer.camera && cameraOf(viewer.camera),
  };
}

export function remarkOf(payload: Uint8Array): RemarkView {
  const remark = read(wire.RemarkSchema, payload);
  const numbers = remark.pointsM;
  demand(numbers.length % 3 === 0, 'points');
  const points: Vec3[] = [];
  for (let i = 0; i < numbers.length; i += 3) points.push(vector(numbers.slice(i, i + 3)));
  const channel = (shift: number) => ((remark.color >> shift) & 0xff) / 255;
  return {
    number: remark.number,
    author: remark.author,
    role: remark.role as number as Role,
    sessionS: remark.sessionS,
    note: shownText(remark.note, kMaxNote),
    points,
    colour: [channel(16), channel(8), channel(0)],
  };
}
