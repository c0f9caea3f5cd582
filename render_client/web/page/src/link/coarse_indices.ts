// The same node with far fewer triangles, for pictures that a processor has to draw while the view moves: vertices that
// lie together in a cell become one of them. The node beside it must do the same with those that both have, or a crack
// would open: where a border lies in a plane between two nodes, the cells are those of space, and the vertex that stands
// for the others follows from their positions alone. All other vertices of the border stay.
import { kVertexBytes } from '../shared/messages';
import type { Vec3 } from '../math/linear';

const kCell = 3;  // lengths of a triangle's edge
const kProbed = 64;  // triangles, of which the length is taken

export interface Grid {
  origin: Vec3;  // of the node's chunk, in steps from that of all chunks: whole numbers
  cell: number;  // steps, for borders: the same in all nodes
}

function meanEdge(at: (v: number, i: number) => number, indices: Uint32Array): number {
  let sum = 0, count = 0;
  const step = Math.max(1, Math.floor(indices.length / 3 / kProbed));
  for (let t = 0; 3 * t < indices.length; t += step, ++count) {
    const [a, b] = [indices[3 * t], indices[3 * t + 1]];
    sum += Math.hypot(at(a, 0) - at(b, 0), at(a, 1) - at(b, 1), at(a, 2) - at(b, 2));
  }
  return sum / count;
}

const kInside = 0, kStays = 8;

// Per vertex: inside, a bit for each axis across which the border's plane lies there, or one that stays. Edges of one
// triangle only have no other way round.
function borderOf(at: (v: number, i: number) => number, indices: Uint32Array, vertices: number): Uint8Array {
  const edges = new Set<number>(), border = new Uint8Array(vertices);
  const low = [Infinity, Infinity, Infinity], high = [-1, -1, -1];
  for (let v = 0; v < vertices; ++v)
    for (let i = 0; i < 3; ++i) {
      low[i] = Math.min(low[i], at(v, i));
      high[i] = Math.max(high[i], at(v, i));
    }
  const planeOf = (a: number, b: number) => {
    const planes = [0, 1, 2].filter((i) => at(a, i) === at(b, i) && (at(a, i) === low[i] || at(a, i) === high[i]));
    return planes.length === 1 ? 1 << planes[0] : kStays;
  };
  const each = (act: (a: number, b: number) => void) => {
    for (let i = 0; i < indices.length; i += 3)
      for (let k = 0; k < 3; ++k) act(indices[i + k], indices[i + ((k + 1) % 3)]);
  };
  each((a, b) => edges.add(a * vertices + b));
  each((a, b) => {
    if (edges.has(b * vertices + a)) return;
    const plane = planeOf(a, b);
    border[a] |= plane;
    border[b] |= plane;
  });
  return border;
}

export function coarseIndices(bytes: Uint8Array, indices: Uint32Array, grid: Grid): Uint32Array {
  const view = new DataView(bytes.buffer, bytes.byteOffset), count = bytes.length / kVertexBytes;
  const at = (v: number, i: number) => view.getUint16(v * kVertexBytes + 2 * i, true);
  const cell = Math.max(kCell * meanEdge(at, indices), 1), border = borderOf(at, indices, count);
  const isBefore = (a: number, b: number) => at(a, 0) - at(b, 0) || at(a, 1) - at(b, 1) || at(a, 2) - at(b, 2);
  const keys = new Array<string>(count), first = new Map<string, number>();
  for (let v = 0; v < count; ++v) {
    const axis = [1, 2, 4].indexOf(border[v]);
    if (border[v] !== kInside && axis < 0) continue;  // where planes meet, or there is none
    const cells = [0, 1, 2].map((i) =>
      axis < 0 ? Math.floor(at(v, i) / cell) : i === axis ? at(v, i) : Math.floor((grid.origin[i] + at(v, i)) / grid.cell));
    keys[v] = `${axis} ${cells.join(' ')}`;
    const there = first.get(keys[v]);
    if (there === undefined || (axis >= 0 && isBefore(v, there) < 0)) first.set(keys[v], v);
  }
  const stands_for = Uint32Array.from({ length: count }, (_, v) => (keys[v] === undefined ? v : first.get(keys[v])!));
  const coarse: number[] = [];
  for (let i = 0; i < indices.length; i += 3) {
    const a = stands_for[indices[i]], b = stands_for[indices[i + 1]], c = stands_for[indices[i + 2]];
    if (a !== b && b !== c && c !== a) coarse.push(a, b, c);
  }
  return Uint32Array.from(coarse);
}
