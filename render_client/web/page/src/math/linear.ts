// Vectors, rotations and matrices, as plain arrays: quaternions are (w, x, y, z), matrices are 4 x 4 by columns as
// OpenGL takes them, poses X_AB take coordinates in B to coordinates in A. Nothing is changed in place.

export type Vec3 = readonly [number, number, number];
export type Quat = readonly [number, number, number, number];
export type Mat4 = Float32Array;

export interface Pose {
  p: Vec3;
  q: Quat;
}

export const add = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a: Vec3, s: number): Vec3 => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const norm = (a: Vec3): number => Math.hypot(a[0], a[1], a[2]);
export const cross = (a: Vec3, b: Vec3): Vec3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

// The zero vector stays what it is.
export function normalized(a: Vec3): Vec3 {
  const length = norm(a);
  return length > 0 ? scale(a, 1 / length) : a;
}

// Any unit vector across `a`.
export function orthogonal(a: Vec3): Vec3 {
  const other: Vec3 = Math.abs(a[0]) < 0.7 * norm(a) ? [1, 0, 0] : [0, 1, 0];
  return normalized(cross(a, other));
}

export function multiplied(a: Quat, b: Quat): Quat {
  const [aw, ax, ay, az] = a, [bw, bx, by, bz] = b;
  return [
    aw * bw - ax * bx - ay * by - az * bz,
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
  ];
}

export const conjugate = (q: Quat): Quat => [q[0], -q[1], -q[2], -q[3]];

export function unit(q: Quat): Quat {
  const length = Math.hypot(...q);
  return length > 0 ? [q[0] / length, q[1] / length, q[2] / length, q[3] / length] : [1, 0, 0, 0];
}

export function rotated(q: Quat, v: Vec3): Vec3 {
  const u: Vec3 = [q[1], q[2], q[3]];
  const t = scale(cross(u, v), 2);
  return add(add(v, scale(t, q[0])), cross(u, t));
}

// The rotation by the length of `w` (rad) about it.
export function rotationOf(w: Vec3): Quat {
  const angle = norm(w);
  if (angle < 1e-12) return [1, 0, 0, 0];
  const s = Math.sin(angle / 2) / angle;
  return [Math.cos(angle / 2), w[0] * s, w[1] * s, w[2] * s];
}

// The shortest rotation that takes the direction a to the direction b.
export function rotationBetween(a: Vec3, b: Vec3): Quat {
  const u = normalized(a), v = normalized(b);
  const c = dot(u, v);
  if (c < -0.999999) return rotationOf(scale(orthogonal(u), Math.PI));
  return unit([1 + c, ...cross(u, v)]);
}

export function angleBetween(a: Quat, b: Quat): number {
  const c = Math.abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]);
  return 2 * Math.acos(Math.min(1, c));
}

export const placed = (X: Pose, v: Vec3): Vec3 => add(X.p, rotated(X.q, v));
export function inversePose(X: Pose): Pose {
  const q = conjugate(X.q);
  return { p: scale(rotated(q, X.p), -1), q };
}

// From the columns of the rotation and the place.
export function matrixOfAxes(x: Vec3, y: Vec3, z: Vec3, p: Vec3): Mat4 {
  return new Float32Array([...x, 0, ...y, 0, ...z, 0, ...p, 1]);
}

export function matrixOf(X: Pose): Mat4 {
  return matrixOfAxes(rotated(X.q, [1, 0, 0]), rotated(X.q, [0, 1, 0]), rotated(X.q, [0, 0, 1]), X.p);
}

export function product(a: Mat4, b: Mat4): Mat4 {
  const c = new Float32Array(16);
  for (let column = 0; column < 4; ++column)
    for (let row = 0; row < 4; ++row) {
      let sum = 0;
      for (let k = 0; k < 4; ++k) sum += a[4 * k + row] * b[4 * column + k];
      c[4 * column + row] = sum;
    }
  return c;
}

// Of a matrix that rotates and moves.
export function inverseRigid(m: Mat4): Mat4 {
  const row = (i: number): Vec3 => [m[i], m[4 + i], m[8 + i]];
  const p: Vec3 = [m[12], m[13], m[14]];
  const x: Vec3 = [m[0], m[1], m[2]], y: Vec3 = [m[4], m[5], m[6]], z: Vec3 = [m[8], m[9], m[10]];
  return matrixOfAxes(row(0), row(1), row(2), [-dot(x, p), -dot(y, p), -dot(z, p)]);
}

export function transformed(m: Mat4, v: Vec3): Vec3 {
  return [
    m[0] * v[0] + m[4] * v[1] + m[8] * v[2] + m[12],
    m[1] * v[0] + m[5] * v[1] + m[9] * v[2] + m[13],
    m[2] * v[0] + m[6] * v[1] + m[10] * v[2] + m[14],
  ];
}

export interface Box {
  low: Vec3;
  high: Vec3;
}

export function boxAround(points: Vec3[]): Box {
  const of = (pick: (...n: number[]) => number): Vec3 => [
    pick(...points.map((p) => p[0])),
    pick(...points.map((p) => p[1])),
    pick(...points.map((p) => p[2])),
  ];
  return { low: of(Math.min), high: of(Math.max) };
}

export function cornersOf(box: Box): Vec3[] {
  const { low, high } = box;
  return [0, 1, 2, 3, 4, 5, 6, 7].map((i): Vec3 => [
    i & 1 ? high[0] : low[0],
    i & 2 ? high[1] : low[1],
    i & 4 ? high[2] : low[2],
  ]);
}

export const centreOf = (box: Box): Vec3 => scale(add(box.low, box.high), 0.5);
export const radiusOf = (box: Box): number => norm(sub(box.high, box.low)) / 2;

export function joined(a: Box | undefined, b: Box): Box {
  return a ? boxAround([a.low, a.high, b.low, b.high]) : b;
}
