// The bone on the graphics card: one vertex and one index buffer per chunk of space, in which every node has a piece.
// A node that comes anew goes where it lay if it fits; else to the end, and its old triangles become points. A chunk
// that is full or mostly holes is laid out anew from what is kept here. A chunk is one draw call.
import { joined, type Box, type Vec3 } from '../math/linear';
import { kVertexBytes, type PlacedNode } from '../shared/messages';
import { isBoxSeen } from './camera';
import type { Gl, Program } from './gl';

const kRoom = 1.25;  // of a node's piece over what it needs now
const kLeastVertices = 256;

export type Level = 'indices' | 'coarse';  // all triangles, or few

// Where a piece lies in a buffer, and how much room it has there.
interface Span {
  at: number;
  room: number;
}

interface Piece {
  node: PlacedNode;
  vertices: Span;
  indices: Span;
  coarse: Span;
}

const roomFor = (n: number) => Math.ceil((n * kRoom) / 12) * 12;
const vertexCount = (node: PlacedNode) => node.vertices.length / kVertexBytes;

// A buffer with pieces one behind the other.
class Space {
  end = 0;
  readonly buffer: WebGLBuffer;
  private size = 0;

  constructor(private readonly gl: Gl, private readonly target: number, private readonly bytes: number) {
    this.buffer = gl.createBuffer();
  }

  hasRoom(n: number): boolean {
    return this.end + roomFor(n) <= this.size;
  }

  take(n: number): Span {
    const span = { at: this.end, room: roomFor(n) };
    this.end += span.room;
    return span;
  }

  // Room for what was taken, and more; what the buffer held is gone.
  allocate(least: number): void {
    this.size = Math.max(least, Math.ceil(1.6 * this.end));
    this.gl.bindVertexArray(null);
    this.gl.bindBuffer(this.target, this.buffer);
    this.gl.bufferData(this.target, this.size * this.bytes, this.gl.DYNAMIC_DRAW);
  }

  write(at: number, data: Uint8Array | Uint32Array): void {
    this.gl.bindVertexArray(null);
    this.gl.bindBuffer(this.target, this.buffer);
    this.gl.bufferSubData(this.target, at * this.bytes, data);
  }
}

export class Chunk {
  readonly pieces = new Map<number, Piece>();
  readonly step: Vec3;  // m
  low: Vec3 = [0, 0, 0];
  high: Vec3 = [0, 0, 0];
  private readonly vertices: Space;
  private readonly spaces: Record<Level, Space>;
  private readonly layouts: Record<Level, WebGLVertexArrayObject>;

  constructor(private readonly gl: Gl, readonly origin: Vec3, step: number) {
    this.step = [step, step, step];
    this.vertices = new Space(gl, gl.ARRAY_BUFFER, kVertexBytes);
    this.spaces = { indices: new Space(gl, gl.ELEMENT_ARRAY_BUFFER, 4), coarse: new Space(gl, gl.ELEMENT_ARRAY_BUFFER, 4) };
    this.layouts = { indices: this.layOutOf('indices'), coarse: this.layOutOf('coarse') };
  }

  set(node: PlacedNode): void {
    const old = this.pieces.get(node.leaf);
    const fits = old && vertexCount(node) <= old.vertices.room && node.indices.length <= old.indices.room && node.coarse.length <= old.coarse.room;
    if (fits) {
      old.node = node;
      this.write(old);
    } else {
      if (old) this.erase(old);
      this.append(node);
    }
    this.measure();
  }

  remove(leaf: number): void {
    const piece = this.pieces.get(leaf);
    if (!piece) return;
    this.erase(piece);
    this.pieces.delete(leaf);
    this.measure();
  }

  draw(level: Level = 'indices'): number {
    const count = this.spaces[level].end;
    if (count === 0) return 0;
    this.gl.bindVertexArray(this.layouts[level]);
    this.gl.drawElements(this.gl.TRIANGLES, count, this.gl.UNSIGNED_INT, 0);
    return count / 3;
  }

  free(): void {
    for (const level of ['indices', 'coarse'] as const) {
      this.gl.deleteVertexArray(this.layouts[level]);
      this.gl.deleteBuffer(this.spaces[level].buffer);
    }
    this.gl.deleteBuffer(this.vertices.buffer);
  }

  private layOutOf(level: Level): WebGLVertexArrayObject {
    const { gl } = this, layout = gl.createVertexArray();
    gl.bindVertexArray(layout);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.vertices.buffer);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.spaces[level].buffer);
    const attributes = [[3, gl.UNSIGNED_SHORT, 0], [2, gl.BYTE, 6], [1, gl.UNSIGNED_BYTE, 8], [1, gl.UNSIGNED_BYTE, 9]];
    attributes.forEach(([size, type, at], i) => {
      gl.enableVertexAttribArray(i);
      gl.vertexAttribPointer(i, size, type, false, kVertexBytes, at);
    });
    gl.bindVertexArray(null);
    return layout;
  }

  private append(node: PlacedNode): void {
    const { vertices, spaces } = this;
    const has_room = vertices.hasRoom(vertexCount(node)) && spaces.indices.hasRoom(node.indices.length) && spaces.coarse.hasRoom(node.coarse.length);
    const piece = this.placed(node);
    this.pieces.set(node.leaf, piece);
    if (has_room) this.write(piece);
    else this.layOutAnew();
  }

  private placed(node: PlacedNode): Piece {
    return {
      node, vertices: this.vertices.take(vertexCount(node)), indices: this.spaces.indices.take(node.indices.length),
      coarse: this.spaces.coarse.take(node.coarse.length),
    };
  }

  // All pieces one after the other, without holes.
  private layOutAnew(): void {
    const { vertices, spaces } = this;
    for (const space of [vertices, spaces.indices, spaces.coarse]) space.end = 0;
    for (const [leaf, piece] of this.pieces) this.pieces.set(leaf, this.placed(piece.node));
    vertices.allocate(kLeastVertices);
    for (const space of [spaces.indices, spaces.coarse]) space.allocate(6 * kLeastVertices);
    for (const piece of this.pieces.values()) this.write(piece);
  }

  private write(piece: Piece): void {
    this.vertices.write(piece.vertices.at, piece.node.vertices);
    for (const level of ['indices', 'coarse'] as const) {
      const shifted = new Uint32Array(piece[level].room);  // what is left over are points
      piece.node[level].forEach((index, i) => (shifted[i] = index + piece.vertices.at));
      this.spaces[level].write(piece[level].at, shifted);
    }
  }

  private erase(piece: Piece): void {
    for (const level of ['indices', 'coarse'] as const)
      this.spaces[level].write(piece[level].at, new Uint32Array(piece[level].room));
  }

  private measure(): void {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (const { node } of this.pieces.values())
      for (let i = 0; i < 3; ++i) {
        low[i] = Math.min(low[i], node.low[i]);
        high[i] = Math.max(high[i], node.high[i]);
      }
    this.low = low as unknown as Vec3;
    this.high = high as unknown as Vec3;
  }
}

export class BoneStore {
  triangles = 0;
  changed?: Box;  // V: around what was set and removed since somebody took it
  private readonly chunks = new Map<string, Chunk>();
  private readonly chunkOf = new Map<number, string>();

  constructor(private readonly gl: Gl) {}

  get nodes(): number {
    return this.chunkOf.size;
  }

  get hasMilled(): boolean {
    for (const chunk of this.chunks.values())
      for (const { node } of chunk.pieces.values()) if (node.isMilled) return true;
    return false;
  }

  set(node: PlacedNode): void {
    if (this.chunkOf.get(node.leaf) !== node.chunk) this.remove(node.leaf);
    let chunk = this.chunks.get(node.chunk);
    if (!chunk) this.chunks.set(node.chunk, (chunk = new Chunk(this.gl, node.origin, node.step)));
    const old = chunk.pieces.get(node.leaf)?.node;
    this.triangles += (node.indices.length - (old?.indices.length ?? 0)) / 3;
    this.changed = joined(old ? joined(this.changed, old) : this.changed, node);
    chunk.set(node);
    this.chunkOf.set(node.leaf, node.chunk);
  }

  remove(leaf: number): void {
    const key = this.chunkOf.get(leaf);
    const chunk = key === undefined ? undefined : this.chunks.get(key);
    if (!chunk || key === undefined) return;
    const old = chunk.pieces.get(leaf)!.node;
    this.triangles -= old.indices.length / 3;
    this.changed = joined(this.changed, old);
    chunk.remove(leaf);
    this.chunkOf.delete(leaf);
    if (chunk.pieces.size > 0) return;
    chunk.free();
    this.chunks.delete(key);
  }

  clear(): void {
    for (const chunk of this.chunks.values()) chunk.free();
    this.chunks.clear();
    this.chunkOf.clear();
    this.triangles = 0;
  }

  // All nodes, as they were set: for a context that was lost.
  all(): PlacedNode[] {
    return [...this.chunks.values()].flatMap((chunk) => [...chunk.pieces.values()].map((piece) => piece.node));
  }

  // The nearest chunks first, so that what they hide costs little. The program is in use.
  draw(program: Program, planes: number[][], eye_V: Vec3, level: Level): number {
    const away = (chunk: Chunk) =>
      [0, 1, 2].reduce((sum, i) => sum + ((chunk.low[i] + chunk.high[i]) / 2 - eye_V[i]) ** 2, 0);
    const seen = [...this.chunks.values()].filter((chunk) => isBoxSeen(planes, chunk.low, chunk.high));
    seen.sort((a, b) => away(a) - away(b));
    let triangles = 0;
    for (const chunk of seen) {
      program.set({ origin: chunk.origin, step: chunk.step });
      triangles += chunk.draw(level);
    }
    this.gl.bindVertexArray(null);
    return triangles;
  }
}
