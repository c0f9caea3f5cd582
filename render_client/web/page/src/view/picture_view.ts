// One picture shows this; matrices, light and planes follow from it.
import {
  boxAround, centreOf, cornersOf, inverseRigid, matrixOf, norm, normalized, placed, product, radiusOf, sub,
  transformed, cross, dot, scale, type Box, type Mat4, type Pose, type Vec3,
} from '../math/linear';
import type { Work } from '../shared/messages';
import { cameraFromWorld, clipFromCamera, depthRange, halfTangent, type Camera, type DepthRange } from './camera';

export type StructureMode = 'behind' | 'exposed' | 'off';

export interface CutPlane {
  isOn: boolean;
  position: number;  // from the low (0) to the high end (1) of the bone's box along the axis, W
  isFlipped: boolean;  // false: the side above is hidden
}

export interface StructureLook {
  id: number;
  colour: Vec3;  // linear
  glow: number;  // 0 to 1: the burr is near
}

export interface Stroke {
  points: Vec3[];  // W
  colour: Vec3;  // sRGB
}

// The tool's outline where it is not.
export interface Ghost {
  X_WT: Pose;
  colour: Vec3;  // linear
}

export interface PictureView {
  camera: Camera;
  isEndoscope: boolean;
  X_WV: Pose;
  bone_V: Box;
  burrRadius: number;
  X_WT?: Pose;
  ghosts: Ghost[];
  toolReach: number;  // m, of the tool's points from its origin
  forceN?: Vec3;  // W
  wish?: Vec3;  // W: the mouse that holds the tool wants it there
  work: Work;
  load: number;  // of the burr, 0 to 1
  cuts: CutPlane[];  // across W's x, y, z
  opacity?: number;  // of transparent bone; none: opaque
  structures: StructureLook[];
  structureMode: StructureMode;
  pointers: Vec3[];  // W
  strokes: Stroke[];
}

export const kShadowSize = 2048;

export interface Frame {
  X_CV: Mat4;
  X_VC: Mat4;
  clipFromCamera: Mat4;
  clipFromModel: Mat4;
  nearFar: [number, number];
  tangents: [number, number];
  boneRadius: number;  // m
  bone_W: Box;
  keyDirection: Vec3;
  shadowFromCamera: Mat4;
  shadowTexel: number;
  lightReach: number;
  cuts_V: number[];  // three planes
  cuts_C: number[];
  isCut: boolean;
}

export function boneInWorld(view: PictureView): Box {
  return boxAround(cornersOf(view.bone_V).map((corner) => placed(view.X_WV, corner)));
}

// The range of depths that holds all there is; it changes in coarse steps, so that a tool that moves within what was
// seen last leaves it as it is.
export function neededRange(view: PictureView): DepthRange {
  const bone = boneInWorld(view), centre = centreOf(bone);
  let radius = Math.max(radiusOf(bone), 1e-3) * 1.01;
  for (const X of [view.X_WT, ...view.ghosts.map((ghost) => ghost.X_WT)])
    if (X) radius = Math.max(radius, norm(sub(X.p, centre)) + view.toolReach);
  return depthRange(view.camera, centre, 1.25 ** Math.ceil(Math.log(radius) / Math.log(1.25)));
}

const kNoCut = [0, 0, 0, 1];

function planesOf(view: PictureView, bone_W: Box): number[][] {
  return view.cuts.map((cut, axis) => {
    if (!cut.isOn) return kNoCut;
    const at = bone_W.low[axis] + cut.position * (bone_W.high[axis] - bone_W.low[axis]);
    const side = cut.isFlipped ? 1 : -1;
    const plane = [0, 0, 0, -side * at];
    plane[axis] = side;
    return plane;
  });
}

// X_AB takes B to A.
function planeIn(X_AB: Mat4, plane_B: number[]): number[] {
  const rotatedNormal = sub(transformed(X_AB, plane_B.slice(0, 3) as unknown as Vec3), transformed(X_AB, [0, 0, 0]));
  return [...rotatedNormal, plane_B[3] - dot(rotatedNormal, transformed(X_AB, [0, 0, 0]))];
}

// The light's shadow map covers the sphere.
function aimKeyLight(key_C: Vec3, centre_C: Vec3, radius: number): Mat4 {
  const half = Math.max(radius, 1e-4);
  const back = scale(key_C, -1);
  const right = normalized(cross([0, 1, 0], key_C)), up = cross(key_C, right);
  const m = new Float32Array(16);
  [right, up, back].forEach((row, i) => {
    for (let k = 0; k < 3; ++k) m[4 * k + i] = row[k] / half;
    m[12 + i] = -dot(row, centre_C) / half;
  });
  m[15] = 1;
  return m;
}

export function makeFrame(view: PictureView, aspect: number): Frame {
  const { camera } = view;
  const X_CW = cameraFromWorld(camera), X_CV = product(X_CW, matrixOf(view.X_WV));
  const range = neededRange(view), clip = clipFromCamera(camera, aspect, range);
  const bone_W = boneInWorld(view), boneRadius = Math.max(radiusOf(bone_W), 1e-4);
  const planes = planesOf(view, bone_W), X_VC = inverseRigid(X_CV), X_VW = inverseRigid(matrixOf(view.X_WV));
  const tangent = halfTangent(camera);
  const key = normalized(view.isEndoscope ? [-0.22, 0.32, 1] : [-0.55, 0.7, 0.62]);
  const shown = 2 * camera.focus * tangent * Math.hypot(1, aspect);
  const isClose = shown < boneRadius;
  const lit_W = isClose ? sub(camera.eye, scale(camera.back, camera.focus)) : centreOf(bone_W);
  const lit_radius = isClose ? shown : boneRadius;
  return {
    X_CV, X_VC,
    clipFromCamera: clip,
    clipFromModel: product(clip, X_CV),
    nearFar: [range.near, range.far],
    tangents: [tangent * aspect, tangent],
    boneRadius, bone_W,
    keyDirection: key,
    shadowFromCamera: aimKeyLight(key, transformed(X_CW, lit_W), lit_radius),
    shadowTexel: (2 * lit_radius) / kShadowSize,
    lightReach: view.isEndoscope ? 1.7 * camera.focus : 0,
    cuts_V: planes.flatMap((plane) => planeIn(X_VW, plane)),
    cuts_C: planes.flatMap((plane) => planeIn(X_CW, plane)),
    isCut: view.cuts.some((cut) => cut.isOn),
  };
}
