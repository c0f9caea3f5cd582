// How far it is from any place near the structures to the next of them, and its colour, in samples on a grid: what
// shines through thin bone is made of it, as render_client/look/structures/near_structures.h has it.
import { kVertexBytes, type StructureSurface } from '../shared/messages';
import type { UniformValue } from './gl';
import { add, boxAround, joined, norm, scale, sub, type Box, type Vec3 } from '../math/linear';

const kMostShine = 0.75, kShineReach = 2e-3, kShineLength = 0.6e-3;  // share, m, m
const kFinest = 4e-4, kMaxSamples = 1 << 19;
const kDot = 0.5;  // steps of the grid between the points that stand for a surface
const kMostParts = 64;  // of a triangle's side, however large it is

export interface NearStructures {
  first: Vec3;  // V, m: of the first sample
  step: number;  // m
  size: Vec3;  // samples
  samples: Uint8Array;  // x fastest: linear colour of the nearest structure, distance as a share of kShineReach
}

interface Coloured {
  surface: StructureSurface;
  colour: Vec3;  // linear
}

// Calls visit(place in V) for points of all triangles that are `apart` from each other, m.
function forEachPoint({ node }: StructureSurface, apart: number, visit: (x: number, y: number, z: number) => void): void {
  const view = new DataView(node.vertices.buffer, node.vertices.byteOffset);
  const at = (i: number): Vec3 => {
    const steps: Vec3 = [0, 2, 4].map((byte) => view.getUint16(kVertexBytes * i + byte, true)) as unknown as Vec3;
    return add(node.origin, scale(steps, node.step));
  };
  for (let t = 0; t < node.indices.length; t += 3) {
    const a = at(node.indices[t]), ab = sub(at(node.indices[t + 1]), a), ac = sub(at(node.indices[t + 2]), a);
    const longest = Math.max(norm(ab), norm(ac), norm(sub(ac, ab)));
    const parts = Math.min(kMostParts, Math.max(1, Math.ceil(longest / apart)));
    for (let i = 0; i <= parts; ++i)
      for (let j = 0; j <= parts - i; ++j) {
        const u = i / parts, v = j / parts;
        visit(a[0] + u * ab[0] + v * ac[0], a[1] + u * ab[1] + v * ac[1], a[2] + u * ab[2] + v * ac[2]);
      }
  }
}

function boxOf({ node }: StructureSurface): Box {
  const view = new DataView(node.vertices.buffer, node.vertices.byteOffset), most = [0, 0, 0];
  for (let at = 0; at < node.vertices.length; at += kVertexBytes)
    for (let axis = 0; axis < 3; ++axis) most[axis] = Math.max(most[axis], view.getUint16(at + 2 * axis, true));
  return boxAround([node.origin, add(node.origin, scale(most as unknown as Vec3, node.step))]);
}

// Uniforms of the bone's shader; where nothing is to shine through, bone looks as it is.
export function shineUniforms(near: NearStructures, shines: boolean): Record<string, UniformValue> {
  return {
    near_first: near.first.map((n) => n - near.step / 2),  // a texture's corner is half a sample before its first one
    near_extent: near.size.map((n) => n * near.step),
    shine: [shines ? kMostShine : 0, kShineLength, kShineReach, kShineReach],
  };
}

export function nearStructures(structures: Coloured[]): NearStructures | undefined {
  let box: Box | undefined;
  for (const { surface } of structures) box = joined(box, boxOf(surface));
  if (!box) return undefined;
  const wide = sub(box.high, box.low).map((n) => n + 2 * kShineReach);
  const sizeOf = (step: number) => wide.map((n) => Math.ceil(n / step) + 1) as unknown as Vec3;
  let step = kFinest;
  while (sizeOf(step).reduce((product, n) => product * n, 1) > kMaxSamples) step *= 1.05;
  const first = box.low.map((n) => n - kShineReach) as unknown as Vec3, size = sizeOf(step);
  const samples = new Uint8Array(4 * size[0] * size[1] * size[2]), squares = new Float32Array(samples.length / 4).fill(kShineReach ** 2);
  for (let at = 3; at < samples.length; at += 4) samples[at] = 255;
  for (const { surface, colour } of structures) {
    const bytes = colour.map((part) => Math.round(255 * Math.min(Math.max(part, 0), 1)));
    forEachPoint(surface, kDot * step, (x, y, z) => spread([x - first[0], y - first[1], z - first[2]], step, size, squares, samples, bytes));
  }
  for (let n = 0; n < squares.length; ++n) samples[4 * n + 3] = Math.round((255 * Math.sqrt(squares[n])) / kShineReach);
  return { first, step, size, samples };
}

// The samples around a point that are nearer to it than to all before take its colour.
function spread(p: Vec3, step: number, size: Vec3, squares: Float32Array, samples: Uint8Array, colour: number[]): void {
  const low = p.map((n) => Math.max(0, Math.ceil((n - kShineReach) / step)));
  const high = p.map((n, axis) => Math.min(size[axis] - 1, Math.floor((n + kShineReach) / step)));
  for (let k = low[2]; k <= high[2]; ++k)
    for (let j = low[1]; j <= high[1]; ++j) {
      const beside = (k * step - p[2]) ** 2 + (j * step - p[1]) ** 2;
      if (beside >= kShineReach ** 2) continue;
      for (let i = low[0], n = low[0] + size[0] * (j + size[1] * k); i <= high[0]; ++i, ++n) {
        const square = beside + (i * step - p[0]) ** 2;
        if (square >= squares[n]) continue;
        squares[n] = square;
        samples[4 * n] = colour[0], samples[4 * n + 1] = colour[1], samples[4 * n + 2] = colour[2];
      }
    }
}
