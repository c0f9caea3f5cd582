// Cameras: the orbit, the first view of a scene, the endoscope; the same as render_client/look/camera. C is x right, y up,
// z out of the picture.
import {
  add, boxAround, cross, dot, inverseRigid, matrixOfAxes, norm, normalized, product, rotated, rotationOf, scale, sub,
  type Mat4, type Pose, type Vec3, centreOf,
} from '../math/linear';
import type { CameraWish } from '../shared/messages';

export const kFieldOfView = 0.52;  // rad, vertical
const kMaxElevation = 1.553;
const kMinDistance = 5e-4, kMaxDistance = 100;  // m
const kFitMargin = 1.06;
const kMaxDepthRatio = 5000;
const kDepthStep = 2 ** -24, kStepOfPixel = 0.01, kLines = 1000;  // as in camera.cpp
const kNearestFar = 1e-3;  // m

export interface Camera {
  eye: Vec3;  // W, m
  right: Vec3;  // the axes of C in W
  up: Vec3;
  back: Vec3;
  fieldOfView: number;
  focus: number;  // m
}

export interface DepthRange {
  near: number;
  far: number;
}

export const halfTangent = (camera: Camera) => Math.tan(camera.fieldOfView / 2);

export function cameraFromWorld(camera: Camera): Mat4 {
  return inverseRigid(matrixOfAxes(camera.right, camera.up, camera.back, camera.eye));
}

export function clipFromCamera(camera: Camera, aspect: number, { near, far }: DepthRange): Mat4 {
  const focal = 1 / halfTangent(camera);
  const m = new Float32Array(16);
  m[0] = focal / aspect;
  m[5] = focal;
  m[10] = -(far + near) / (far - near);
  m[14] = (-2 * far * near) / (far - near);
  m[11] = -1;
  return m;
}

export function depthRange(camera: Camera, centre: Vec3, radius: number): DepthRange {
  const depth = -dot(sub(centre, camera.eye), camera.back);
  const far = Math.max(depth + radius, kNearestFar);
  const resolved = (kDepthStep * camera.focus * kLines) / (kStepOfPixel * 2 * halfTangent(camera));
  return { near: Math.max(depth - radius, Math.min(Math.max(far / kMaxDepthRatio, resolved), far / 2)), far };
}

// The direction (W, not of unit length) through a place of the picture; both from -1 to 1, right and up.
export function rayThrough(camera: Camera, x: number, y: number, aspect: number): Vec3 {
  const t = halfTangent(camera);
  return sub(add(scale(camera.right, x * t * aspect), scale(camera.up, y * t)), camera.back);
}

export class Orbit {
  target: Vec3 = [0, 0, 0];
  distance = 0.3;
  azimuth = 0.61;
  elevation = 0.44;
  up: Vec3 = [0, 0, 1];

  static of(wish: CameraWish, corners: Vec3[], aspect: number): Orbit {
    const orbit = new Orbit();
    if (wish.up && norm(wish.up) > 1e-9) orbit.up = normalized(wish.up);
    orbit.azimuth = wish.azimuth;
    orbit.elevation = wish.elevation;
    orbit.turn(0, 0);
    orbit.fit(corners, aspect);
    if (wish.target) orbit.target = wish.target;
    if (wish.distance > 0) orbit.distance = wish.distance;
    orbit.zoom(1);
    return orbit;
  }

  wish(): CameraWish {
    const { target, distance, azimuth, elevation, up } = this;
    return { target, distance, azimuth, elevation, up };
  }

  turn(azimuth: number, elevation: number): void {
    this.azimuth = ((this.azimuth + azimuth + 3 * Math.PI) % (2 * Math.PI)) - Math.PI;
    this.elevation = Math.min(Math.max(this.elevation + elevation, -kMaxElevation), kMaxElevation);
  }

  zoom(factor: number): void {
    this.distance = Math.min(Math.max(this.distance * factor, kMinDistance), kMaxDistance);
  }

  // The picture follows by these fractions of its height.
  pan(right: number, up: number): void {
    const height = 2 * this.distance * Math.tan(kFieldOfView / 2);
    const axes = this.axes();
    this.target = sub(this.target, scale(add(scale(axes.right, right), scale(axes.up, up)), height));
  }

  fit(corners: Vec3[], aspect: number): void {
    if (corners.length === 0) return;
    this.target = centreOf(boxAround(corners));
    const { right, up, back } = this.axes();
    const ty = Math.tan(kFieldOfView / 2) / kFitMargin, tx = ty * aspect;
    let needed = kMinDistance;
    for (const corner of corners) {
      const p = sub(corner, this.target);
      needed = Math.max(needed, dot(p, back) + Math.abs(dot(p, right)) / tx, dot(p, back) + Math.abs(dot(p, up)) / ty);
    }
    this.distance = Math.min(needed, kMaxDistance);
  }

  view(): Camera {
    const axes = this.axes();
    return { ...axes, eye: add(this.target, scale(axes.back, this.distance)), fieldOfView: kFieldOfView, focus: this.distance };
  }

  private axes(): { right: Vec3; up: Vec3; back: Vec3 } {
    const anterior: Vec3 = [0, -1, 0];
    const reference: Vec3 = Math.abs(dot(this.up, anterior)) > 0.99 ? [0, 0, 1] : anterior;
    const front = normalized(sub(reference, scale(this.up, dot(this.up, reference))));
    const left = cross(this.up, front);
    const level = add(scale(front, Math.cos(this.azimuth)), scale(left, Math.sin(this.azimuth)));
    const back = add(scale(level, Math.cos(this.elevation)), scale(this.up, Math.sin(this.elevation)));
    const right = normalized(cross(this.up, back));
    return { right, up: cross(back, right), back };
  }
}

// The eye rides on the tool, behind the burr and a little beside it, and looks past it along the shaft.
export function endoscopeCamera(X_WT: Pose, burr_radius: number): Camera {
  const radius = Math.max(burr_radius, 1e-4), behind = 2.8, beside = 0.9, tilt = (8 * Math.PI) / 180;
  const q = rotationOf([-tilt, 0, 0]);
  // The columns of R_TC are -x, z, y of T.
  const inWorld = (v: Vec3): Vec3 => {
    const c = rotated(q, v);
    return rotated(X_WT.q, [-c[0], c[2], c[1]]);
  };
  return {
    eye: add(X_WT.p, rotated(X_WT.q, [0, behind * radius, beside * radius])),
    right: inWorld([1, 0, 0]),
    up: inWorld([0, 1, 0]),
    back: inWorld([0, 0, 1]),
    fieldOfView: (75 * Math.PI) / 180,
    focus: behind * radius,
  };
}

export interface Pixel {
  x: number;  // px of the picture, from its left upper corner
  y: number;
}

// Where a point in front of the eye is seen, and how far away it is; nothing behind the eye.
export function pixelOf(camera: Camera, p_W: Vec3, width: number, height: number): (Pixel & { depth: number }) | undefined {
  const d = sub(p_W, camera.eye);
  const depth = -dot(d, camera.back);
  if (depth <= 0) return undefined;
  const pixels = height / (2 * halfTangent(camera) * depth);
  return { x: width / 2 + dot(d, camera.right) * pixels, y: height / 2 - dot(d, camera.up) * pixels, depth };
}

// The six planes of what is seen, in the frame that the matrix takes to clip space.
export function frustumPlanes(clip: Mat4): number[][] {
  const row = (i: number) => [clip[i], clip[4 + i], clip[8 + i], clip[12 + i]];
  const w = row(3);
  return [0, 1, 2].flatMap((i) => [w.map((n, k) => n + row(i)[k]), w.map((n, k) => n - row(i)[k])]);
}

export function isBoxSeen(planes: number[][], low: Vec3, high: Vec3): boolean {
  return planes.every((n) => n[3] + [0, 1, 2].reduce((sum, i) => sum + n[i] * (n[i] > 0 ? high[i] : low[i]), 0) >= 0);
}

export { product };
