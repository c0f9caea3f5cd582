// From the payloads of the topics to what the page shows. All throw Malformed, or what the decoder throws.
import { fromBinary } from '@bufbuild/protobuf';
import * as wire from '#proto/topics_pb';
import type {
  AttemptView, CameraWish, EffectView, LessonView, RemarkView, SceneChoiceView, ScenePictureView, SceneView, SoundWish, StatusView,
  ToolMesh, ToolView, TrainingView, ViewerView,
} from '../shared/messages';
import { Role } from '../shared/messages';
import type { Vec3 } from '../math/linear';
import {
  bounded, demand, finite, sane, saneOrNone, quaternion, shownName, shownText, time, vector, vectorOrNone, within,
} from './checks';

const kMaxFigures = 16;
const kMostMaterials = 255;
const kMostTools = 64;
const kMostListed = 64;  // checkpoints, warnings, scenes, structures
const kMostAttempts = 256;
const kMostPictureBytes = 64 << 10;
const kMostRemarkPoints = 300;
const kMostToolVertices = 1 << 20;

function epochOf(epoch: bigint): string {
  demand(epoch !== 0n, 'epoch');
  return String(epoch);
}

function toolMeshOf(mesh: wire.TriangleMesh | undefined): ToolMesh {
  const count = (mesh?.verticesM.length ?? 0) / 3;
  const vertices = Float32Array.from(mesh?.verticesM ?? []), normals = Float32Array.from(mesh?.normals ?? []);
  const indices = Uint32Array.from(mesh?.indices ?? []);
  demand(Number.isInteger(count) && count <= kMostToolVertices && normals.length === vertices.length, 'tool');
  demand(indices.length % 3 === 0 && indices.every((i) => i < count), 'tool indices');
  vertices.forEach(sane);
  normals.forEach(sane);
  return { vertices, normals, indices };
}

function cameraOf(camera: wire.Camera): CameraWish {
  return {
    target: camera.hasTarget ? vector(camera.targetM) : undefined,
    distance: within(camera.distanceM, 0, 1e6),
    azimuth: sane(camera.azimuthRad),
    elevation: sane(camera.elevationRad),
    up: vectorOrNone(camera.up),
  };
}

function soundOf(info: wire.SceneInfo): SoundWish | undefined {
  const sound = info.viewerEffects?.millingSound;
  if (!sound) return undefined;
  return {
    volume: within(sound.volume ?? 0.5, 0, 1),
    flutes: within(sound.flutes ?? 8, 1, 64),
    idleLevel: within(sound.idleLevel ?? 0.3, 0, 1),
    fullSpeedRpm: within(sound.fullSpeedRpm ?? 30000, 100, 200000),
    fullPowerW: within(sound.fullPowerW ?? 10, 0.01, 1000),
  };
}

export function sceneOf(payload: Uint8Array): SceneView {
  const info = fromBinary(wire.SceneInfoSchema, payload);
  const part = (value: number | undefined) => within(value ?? 1, 0, 1);
  return {
    epoch: epochOf(info.epoch),
    revision: info.revision,
    name: shownName(info.name),
    X_WV: { p: vector(info.pWVM), q: quaternion(info.qWV) },
    boneLow: vector(info.boneMinM),
    boneHigh: vector(info.boneMaxM),
    burrRadius: within(info.burrRadiusM, 0, 1e6),
    tool: toolMeshOf(info.tool),
    camera: info.camera && cameraOf(info.camera),
    toolNames: bounded(info.toolNames, kMostTools).map(shownName),
    toolIndex: info.toolIndex,
    materials: bounded(info.materials, kMostMaterials).map((m) => ({
      name: shownName(m.name ?? ''),
      colour: m.color && ([part(m.color.red), part(m.color.green), part(m.color.blue)] as Vec3),
      isProtected: m.isProtected ?? false,
    })),
    sound: soundOf(info),
  };
}

function effectsOf(state: wire.EffectState): EffectView {
  return {
    events: state.events,
    spinSpeed: saneOrNone(state.spinSpeed),
    burrForceN: saneOrNone(state.burrForceN),
    cuttingPowerW: saneOrNone(state.cuttingPowerW),
    temperatureC: saneOrNone(state.temperatureC),
    necroticMm3: saneOrNone(state.necroticMm3),
    protectedDistanceM: saneOrNone(state.protectedDistanceM),
    damagedMm3: saneOrNone(state.damagedMm3),
    protectedId: state.protectedId,
    eventId: state.eventId,
    figures: bounded(state.figures, kMaxFigures).map((figure) => ({
      words: shownName(figure.words), value: sane(figure.value), unit: shownName(figure.unit),
    })),
  };
}

export function toolOf(payload: Uint8Array): ToolView {
  const state = fromBinary(wire.ToolStateSchema, payload);
  return {
    epoch: epochOf(state.epoch),
    tick: String(state.tick),
    X_WT: { p: vector(state.pWTM), q: quaternion(state.qWT) },
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
    damagedMm3: saneOrNone(training.damagedMm3),
    leastDistanceMm: saneOrNone(training.leastDistanceMm),
    nearestStructure: shownName(training.nearestStructure),
    maxProtectedForceN: saneOrNone(training.maxProtectedForceN),
    necroticMm3: saneOrNone(training.necroticMm3),
    maxTemperatureC: saneOrNone(training.maxTemperatureC),
    warnings: bounded(training.warnings, kMostListed).map((text) => shownText(text)),
  };
}

export function statusOf(payload: Uint8Array): StatusView {
  const status = fromBinary(wire.StatusSchema, payload);
  const device = status.device;
  return {
    epoch: epochOf(status.epoch),
    scene: shownText(status.scene),
    preset: shownText(status.preset),
    ticks: Number(status.ticks),
    rateHz: finite(status.rateHz),
    tickP50Us: finite(status.tickP50Us),
    tickP99Us: finite(status.tickP99Us),
    faultText: shownText(status.faultText),
    removedMm3: finite(status.removedMm3),
    nodeCount: status.nodeCount,
    lastCommandSequence: status.lastCommandSequence,
    lastCommandSender: String(status.lastCommandSender),
    lastCommandResult: shownText(status.lastCommandResult),
    deviceStale: status.deviceStale,
    sessionS: time(status.sessionS),
    isMillingPaused: status.isMillingPaused,
    checkpoints: bounded(status.checkpoints, kMostListed).map((c) => ({
      id: c.id, sessionS: time(c.sessionS), removedMm3: finite(c.removedMm3),
    })),
    isModelPartial: status.isModelPartial,
    training: status.training && trainingOf(status.training),
    device: device && {
      name: shownName(device.name), kind: device.kind, state: device.state, stopCause: device.stopCause,
      isSimulated: device.isSimulated, forceWaits: device.forceWaits,
    },
  };
}

function choiceOf(scene: wire.SceneChoice): SceneChoiceView {
  demand(scene.id !== '' && scene.id.length <= 64 && scene.picture.length <= kMostPictureBytes, 'scene');
  return {
    id: scene.id,
    title: shownName(scene.title),
    task: shownText(scene.task),
    tools: bounded(scene.tools, kMostTools).map(shownName),
    expectedS: time(scene.expectedS),
    picture: scene.picture.length > 0 ? scene.picture.slice() : undefined,
    problem: shownText(scene.problem),
  };
}

function attemptOf(attempt: wire.Attempt): AttemptView {
  return {
    number: attempt.number,
    trainee: shownName(attempt.trainee),
    sceneId: shownName(attempt.sceneId),
    timeS: time(attempt.timeS),
    removedMm3: sane(attempt.removedMm3),
    maxForceN: sane(attempt.maxForceN),
    training: attempt.training && trainingOf(attempt.training),
    structuresTouched: bounded(attempt.structuresTouched, kMostListed).map(shownName),
  };
}

export function lessonOf(payload: Uint8Array): LessonView {
  const lesson = fromBinary(wire.LessonSchema, payload);
  return {
    epoch: epochOf(lesson.epoch),
    scenes: bounded(lesson.scenes, kMostListed).map(choiceOf),
    sceneId: lesson.sceneId,
    isRunning: lesson.isRunning,
    trainee: shownName(lesson.trainee),
    attempts: bounded(lesson.attempts, kMostAttempts).map(attemptOf),
    changingTo: shownName(lesson.changingTo),
  };
}

export function pictureOf(payload: Uint8Array): ScenePictureView {
  const picture = fromBinary(wire.ScenePictureSchema, payload);
  demand(picture.png.length <= kMostPictureBytes, 'picture');
  return { epoch: epochOf(picture.epoch), sceneId: picture.sceneId, png: picture.png.slice() };
}

function roleOf(role: wire.Viewer_Role): Role {
  demand(role >= Role.Viewer && role <= Role.Examiner, 'role');
  return role as number as Role;
}

export function viewerOf(payload: Uint8Array): ViewerView {
  const viewer = fromBinary(wire.ViewerSchema, payload);
  const role = roleOf(viewer.role);
  return {
    sender: String(viewer.sender),
    name: shownName(viewer.name),
    role,
    frameRateHz: within(viewer.frameRateHz, 0, 1e6),
    isComplete: viewer.isComplete,
    pointer: role === Role.Instructor ? vectorOrNone(viewer.pointerM) : undefined,
    isHolding: viewer.isHolding && role !== Role.Viewer,
    link: shownText(viewer.link, 16),
    camera: viewer.camera && cameraOf(viewer.camera),
  };
}

export function remarkOf(payload: Uint8Array): RemarkView {
  const remark = fromBinary(wire.RemarkSchema, payload);
  epochOf(remark.epoch);
  const numbers = bounded(remark.pointsM, 3 * kMostRemarkPoints);
  demand(numbers.length % 3 === 0, 'points');
  const points: Vec3[] = [];
  for (let i = 0; i < numbers.length; i += 3) points.push(vector(numbers.slice(i, i + 3)));
  const channel = (shift: number) => ((remark.color >> shift) & 0xff) / 255;
  return {
    number: remark.number,
    author: shownName(remark.author),
    role: roleOf(remark.role),
    sessionS: time(remark.sessionS),
    note: shownText(remark.note, 300),
    points,
    colour: [channel(16), channel(8), channel(0)],
  };
}
