// What the link (a worker: socket, protobuf, decoding) and the page (pictures, buttons) say to each other. All of it
// was checked by the link: numbers are finite and bounded, texts printable and bounded. 64-bit numbers are texts.
import type { Command } from '#proto/topics_commands_pb';
import type { Pose, Quat, Vec3 } from '../math/linear';

export enum Role { Viewer = 0, Operator = 1, Instructor = 2, Examiner = 3 }

export interface CameraWish {
  target?: Vec3;  // W
  distance: number;  // m; 0: the bone fills the picture
  azimuth: number;
  elevation: number;
  up?: Vec3;
}

export interface MaterialView {
  name: string;
  colour?: Vec3;  // sRGB, 0 to 1
  isProtected: boolean;
}

export interface SoundWish {
  volume: number;
  flutes: number;
  idleLevel: number;
  fullSpeedRpm: number;
  fullPowerW: number;
}

export interface ToolMesh {
  vertices: Float32Array;
  normals: Float32Array;
  indices: Uint32Array;
}

export interface SceneView {
  otherFirstLeaf: number;  // from here on leaves are of another bone, which this page does not show
  epoch: string;
  revision: number;
  name: string;
  title: string;
  X_WV: Pose;
  boneLow: Vec3;  // V, m
  boneHigh: Vec3;
  burrRadius: number;  // m
  tool: ToolMesh;
  camera?: CameraWish;
  toolNames: string[];
  toolIndex: number;
  materials: MaterialView[];
  sound?: SoundWish;
}

// What the burr does to the bone.
export type Work = 'idle' | 'turning' | 'removing' | 'adding';

export interface EffectView {
  events: number;
  removedMm3: number;  // since the tool state before
  spinSpeed?: number;
  burrForceN?: number;
  cuttingPowerW?: number;
  temperatureC?: number;
  necroticMm3?: number;
  protectedDistanceM?: number;
  damagedMm3?: number;
  protectedId: number;
  eventId: number;
  figures: { words: string; value: number; unit: string }[];
}

export interface ToolView {
  epoch: string;
  tick: string;
  X_WT: Pose;
  contacts: number;
  X_WT_device: Pose;
  X_WT_expert?: Pose;  // where an expert's tool was
  forceN: Vec3;
  buttons: number;
  waitsForRelease: boolean;
  deviceState: number;
  stopCause: number;
  effects?: EffectView;
}

export interface CheckpointView {
  id: number;
  sessionS: number;
  removedMm3: number;
}

export interface TrainingView {
  damagedMm3?: number;
  leastDistanceMm?: number;
  nearestStructure: string;
  maxProtectedForceN?: number;
  necroticMm3?: number;
  maxTemperatureC?: number;
  warnings: string[];
}

export interface DeviceView {
  name: string;
  kind: number;
  state: number;
  stopCause: number;
  isSimulated: boolean;
  forceWaits: boolean;
  script?: ScriptView;
}

// A scripted hand that has done all of its script, or made way for the mouse of viewers.
export interface ScriptView {
  hasEnded: boolean;
  takenOverBy: string;  // a sender; '0': nobody
}

export interface StatusView {
  epoch: string;
  scene: string;
  preset: string;
  ticks: number;
  rateHz: number;
  tickP50Us: number;
  tickP99Us: number;
  faultText: string;
  removedMm3: number;
  nodeCount: number;
  lastCommandSequence: number;
  lastCommandSender: string;
  lastCommandResult: string;
  isLastCommandDone: boolean;
  deviceStale: boolean;
  sessionS: number;
  isMillingPaused: boolean;
  checkpoints: CheckpointView[];
  isModelPartial: boolean;
  training?: TrainingView;
  device?: DeviceView;
}

export interface SceneChoiceView {
  id: string;
  title: string;
  task: string;
  tools: string[];
  expectedS: number;
  picture?: Uint8Array;  // PNG
  problem: string;
  isMadeFirst: boolean;
}

// Of one of LessonView.scenes.
export interface ScenePictureView {
  epoch: string;
  sceneId: string;
  png: Uint8Array;
}

export interface AttemptView {
  number: number;
  trainee: string;
  sceneId: string;
  timeS: number;
  removedMm3: number;
  maxForceN: number;
  training?: TrainingView;
  structuresTouched: string[];
}

export interface LessonView {
  epoch: string;
  scenes: SceneChoiceView[];
  sceneId: string;
  isRunning: boolean;
  trainee: string;
  attempts: AttemptView[];
  changingTo: string;
}

export interface ViewerView {
  sender: string;
  name: string;
  role: Role;
  frameRateHz: number;
  isComplete: boolean;
  pointer?: Vec3;  // W
  isHolding: boolean;
  link: string;
  camera?: CameraWish;
}

export interface RemarkView {
  number: number;
  author: string;
  role: Role;
  sessionS: number;
  note: string;
  points: Vec3[];  // W
  colour: Vec3;  // sRGB, 0 to 1
}

// A node, placed into its chunk: see link/place_node.ts.
export interface PlacedNode {
  leaf: number;
  chunk: string;
  origin: Vec3;  // V, m: vertex = origin + step (x, y, z)
  step: number;  // m
  low: Vec3;  // V, m: the node's own box
  high: Vec3;
  vertices: Uint8Array;  // kVertexBytes each
  indices: Uint32Array;
  coarse: Uint32Array;  // fewer triangles of the same vertices
  isMilled: boolean;  // somewhere
}
export const kVertexBytes = 12;
// In a vertex' material: milling opened the bone there.
export const kMilledBit = 0x80;

// A mesh of its own, in the same vertices.
export interface StructureSurface {
  id: number;  // 1 + index of its material
  warningDistance: number;  // m
  node: PlacedNode;
}

// An action of the protocol with what it takes; a bool is true if it is not given. A remark has only what a guest says.
type Said = Extract<Command['action'], { case: string }>;
type OrderOf<S> = S extends { case: infer Action; value: infer Value }
  ? Value extends boolean ? { action: Action; value?: boolean }
    : Value extends string | number ? { action: Action; value: Value }
      : Action extends 'addRemark' ? { action: Action; note: string; points: Vec3[]; colour: number } : never
  : never;
export type CommandOrder = OrderOf<Said>;

export type ToLink =
  | { kind: 'open'; url: string; token: string }
  | { kind: 'retry' }
  | { kind: 'command'; order: CommandOrder }
  | { kind: 'announce'; frameRateHz: number; isComplete: boolean; pointer?: Vec3; isHolding: boolean; camera?: CameraWish }
  | { kind: 'hand'; p: Vec3; q: Quat; buttons: number; isHolding: boolean }
  // So many bytes of frames have been taken up, in all of this connection.
  | { kind: 'taken'; bytes: number; connection: number };

export type FromLink =
  | { kind: 'away'; reason: string; sinceMs: number; nextTryMs: number }
  | { kind: 'refused'; reason: string }
  | { kind: 'welcome'; ticket: string; name: string; role: Role; sender: string; expiresMs: number }
  | { kind: 'server'; hasServer: boolean; hasEnded: boolean }
  | { kind: 'epoch'; epoch: string }
  | { kind: 'scene'; scene: SceneView }
  | { kind: 'tool'; tool: ToolView }
  | { kind: 'status'; status: StatusView }
  | { kind: 'lesson'; lesson: LessonView }
  | { kind: 'picture'; scene: number; picture: ScenePictureView }
  | { kind: 'viewer'; sender: string; viewer?: ViewerView }
  | { kind: 'remark'; key: string; remark?: RemarkView }
  | { kind: 'structure'; id: number; surface?: StructureSurface }
  | { kind: 'nodes'; placed: PlacedNode[]; gone: number[] }
  | { kind: 'outcome'; order: CommandOrder; isDone: boolean; result: string }
  | { kind: 'frame'; bytes: number; connection: number };
