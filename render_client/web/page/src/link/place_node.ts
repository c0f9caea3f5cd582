// Brings a decoded node into the form in which it is drawn. Nodes are drawn many at a time, by chunks of space: all of
// a chunk count their positions in the same steps, from the same origin, in 16 bits, which is some micrometres.
//
// A vertex has 12 bytes: x, y, z (uint16), the octahedral normal (2 int8), material and mottling (uint8), 2 unused.
import type { Vec3 } from '../math/linear';
import { kMilledBit, kVertexBytes, type PlacedNode } from '../shared/messages';
import type { DecodedNode } from './node_codec';
import { kPackedBytes } from './node_codec';
import { coarseIndices } from './coarse_indices';
import { mottlingAt } from './mottling';

const kChunksAlong = 6;  // the longest side of the bone
// A node belongs to the chunk that its middle lies in, and may reach so many chunks beyond it.
const kReach = 2;
const kGrain = 0.045;  // size of the mottling over the bone's radius
const kSteps = 65535;
const kChunkSteps = kSteps / (1 + 2 * kReach);  // a whole number: all chunks count in one grid
const kStepsPerVoxel = 256;  // of a node, as the server streams it
const kCoarseVoxels = 2.5;  // a cell along a border between nodes

export class Placement {
  private readonly cell: number;  // m, of a chunk
  private readonly step: number;  // m
  private readonly grain: number;  // m

  // The bone lies between the two (V); a mesh of its own, that is to be one chunk, says so.
  constructor(private readonly low: Vec3, high: Vec3, chunks_along = kChunksAlong) {
    const size = [0, 1, 2].map((i) => Math.max(high[i] - low[i], 1e-4));
    this.cell = Math.max(...size) / chunks_along;
    this.step = (this.cell * (1 + 2 * kReach)) / kSteps;
    this.grain = (kGrain * Math.hypot(...size)) / 2;
  }

  place(leaf: number, node: DecodedNode): PlacedNode {
    const { low, high } = boxOf(node);
    const cells = [0, 1, 2].map((i) => Math.floor(((low[i] + high[i]) / 2 - this.low[i]) / this.cell));
    const origin = cells.map((n, i) => this.low[i] + (n - kReach) * this.cell) as unknown as Vec3;
    const vertices = this.verticesOf(node, origin);
    const steps = cells.map((n) => (n - kReach) * kChunkSteps) as unknown as Vec3;
    const cell = Math.max((kCoarseVoxels * kStepsPerVoxel * node.step[0]) / this.step, 1);
    const { indices } = node, coarse = coarseIndices(vertices, indices, { origin: steps, cell });
    const isMilled = node.materials?.some((material) => (material & kMilledBit) !== 0) ?? false;
    return { leaf, chunk: cells.join(' '), origin, step: this.step, low, high, vertices, indices, coarse, isMilled };
  }

  private verticesOf(node: DecodedNode, origin: Vec3): Uint8Array {
    const from = new DataView(node.packed.buffer, node.packed.byteOffset, node.packed.byteLength);
    const bytes = new Uint8Array(node.vertexCount * kVertexBytes);
    const to = new DataView(bytes.buffer);
    const p = [0, 0, 0];
    for (let v = 0; v < node.vertexCount; ++v) {
      const at = v * kPackedBytes, out = v * kVertexBytes;
      for (let i = 0; i < 3; ++i) {
        p[i] = node.origin[i] + node.step[i] * from.getUint16(at + 2 * i, true);
        const steps = Math.round((p[i] - origin[i]) / this.step);
        to.setUint16(out + 2 * i, Math.min(Math.max(steps, 0), kSteps), true);
      }
      bytes[out + 6] = node.packed[at + 6];
      bytes[out + 7] = node.packed[at + 7];
      bytes[out + 8] = node.materials ? node.materials[v] : 0;
      bytes[out + 9] = Math.round(255 * mottlingAt(p[0], p[1], p[2], this.grain));
    }
    return bytes;
  }
}

function boxOf(node: DecodedNode): { low: Vec3; high: Vec3 } {
  const low = [kSteps, kSteps, kSteps], high = [0, 0, 0];
  const from = new DataView(node.packed.buffer, node.packed.byteOffset, node.packed.byteLength);
  for (let v = 0; v < node.vertexCount; ++v)
    for (let i = 0; i < 3; ++i) {
      const steps = from.getUint16(v * kPackedBytes + 2 * i, true);
      if (steps < low[i]) low[i] = steps;
      if (steps > high[i]) high[i] = steps;
    }
  const placed = (n: number[]) => n.map((steps, i) => node.origin[i] + node.step[i] * steps) as unknown as Vec3;
  return { low: placed(low), high: placed(high) };
}
