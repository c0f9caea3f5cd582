// The same node with a third of its triangles, for pictures that a processor has to draw while the view moves: vertices
// that lie together in a cell become one of them. Those at the node's border stay, so that no crack opens to the next.
import { kVertexBytes } from '../shared/messages';

const kCell = 3;  // lengths of a triangle's edge
const kProbed = 64;  // triangles, of which the length is taken

function meanEdge(at: (v: number, i: number) => number, indices: Uint32Array): number {
  let sum = 0, count = 0;
  const step = Math.max(1, Math.floor(indices.length / 3 / kProbed));
  for (let t = 0; 3 * t < indices.length; t += step, ++count) {
    const [a, b] = [indices[3 * t], indices[3 * t + 1]];
    sum += Math.hypot(at(a, 0) - at(b, 0), at(a, 1) - at(b, 1), at(a, 2) - at(b, 2));
  }
  return sum / count;
}

// Edges of one triangle only have no other way round.
function borderOf(indices: Uint32Array, vertices: number): Uint8Array {
  const edges = new Set<number>(), border = new Uint8Array(vertices);
  const each = (act: (a: number, b: number) => void) => {
    for (let i = 0; i < indices.length; i += 3)
      for (let k = 0; k < 3; ++k) act(indices[i + k], indices[i + ((k + 1) % 3)]);
  };
  each((a, b) => edges.add(a * vertices + b));
  each((a, b) => {
    if (!edges.has(b * vertices + a)) border[a] = border[b] = 1;
  });
  return border;
}

export function coarseIndices(bytes: Uint8Array, indices: Uint32Array): Uint32Array {
  const view = new DataView(bytes.buffer, bytes.byteOffset), count = bytes.length / kVertexBytes;
  const at = (v: number, i: number) => view.getUint16(v * kVertexBytes + 2 * i, true);
  const cell = Math.max(kCell * meanEdge(at, indices), 1), border = borderOf(indices, count);
  const first = new Map<number, number>(), stands_for = new Uint32Array(count);
  for (let v = 0; v < count; ++v) {
    stands_for[v] = v;
    if (border[v]) continue;
    const key = [0, 1, 2].reduce((sum, i) => sum * 65536 + Math.floor(at(v, i) / cell), 0);
    stands_for[v] = first.get(key) ?? v;
    if (stands_for[v] === v) first.set(key, v);
  }
  const coarse: number[] = [];
  for (let i = 0; i < indices.length; i += 3) {
    const a = stands_for[indices[i]], b = stands_for[indices[i + 1]], c = stands_for[indices[i + 2]];
    if (a !== b && b !== c && c !== a) coarse.push(a, b, c);
  }
  return Uint32Array.from(coarse);
}
