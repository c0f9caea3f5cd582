// Decodes one node's surface, as common/mesh_codec/mesh_codec.cpp does, with all its checks.
import { fromBinary } from '@bufbuild/protobuf';
import { MeshoptDecoder } from 'meshoptimizer/decoder';
import * as wire from '#proto/topics_scene_pb';
import type { Vec3 } from '../math/linear';
import { demand, within } from './checks';

export const kPackedBytes = 8;  // of a vertex on the wire: three uint16, two int8
const kFarthest = 1e6;  // m
const kLargestStep = 1;  // m
// meshoptimizer spends at least one byte on each triangle.
const kMostIndicesPerByte = 3;

export interface DecodedNode {
  epoch: bigint;
  revision: number;
  origin: Vec3;  // V, m: vertex = origin + step (x, y, z)
  step: Vec3;
  vertexCount: number;
  packed: Uint8Array;  // kPackedBytes each
  indices: Uint32Array;
  materials?: Uint8Array;  // 1 + index in the scene's list, 0: none; and kMilledBit of shared/messages.ts
}

export const decoderReady: Promise<void> = MeshoptDecoder.ready;

// As many as there are vertices.
export function decodeMaterials(coded: Uint8Array, vertices: number): Uint8Array {
  const materials = new Uint8Array(vertices);
  let done = 0;
  for (let at = 0; at < coded.length;) {
    const material = coded[at++];
    let length = 0;
    for (let shift = 0; ; shift += 7) {
      demand(at < coded.length && shift <= 28, 'materials');
      const byte = coded[at++];
      length += (byte & 0x7f) * 2 ** shift;
      if (byte < 0x80) break;
    }
    demand(length > 0 && length <= vertices - done, 'materials');
    materials.fill(material, done, done + length);
    done += length;
  }
  demand(done === vertices, 'materials');
  return materials;
}

function positiveVector(numbers: number[], most: number): Vec3 {
  demand(numbers.length === 3 && numbers.every((n) => n > 0 && n <= most), 'step');
  return [numbers[0], numbers[1], numbers[2]];
}

export function decodeNode(payload: Uint8Array): DecodedNode {
  const message = fromBinary(wire.NodeMeshSchema, payload);
  const origin = message.originM;
  demand(message.epoch !== 0n && origin.length === 3, 'node');
  origin.forEach((n) => within(n, -kFarthest, kFarthest));
  const step = positiveVector(message.stepM, kLargestStep);
  const { vertexCount, indexCount } = message;
  demand(indexCount > 0 && indexCount % 3 === 0 && indexCount <= kMostIndicesPerByte * message.indices.length &&
         vertexCount <= indexCount, 'counts');
  const packed = new Uint8Array(vertexCount * kPackedBytes), indices = new Uint32Array(indexCount);
  MeshoptDecoder.decodeVertexBuffer(packed, vertexCount, kPackedBytes, message.vertices);
  MeshoptDecoder.decodeIndexBuffer(new Uint8Array(indices.buffer), indexCount, 4, message.indices);
  for (let i = 0; i < indexCount; ++i) demand(indices[i] < vertexCount, 'index');
  const materials = message.materials.length > 0 ? decodeMaterials(message.materials, vertexCount) : undefined;
  return {
    epoch: message.epoch, revision: message.revision, origin: [origin[0], origin[1], origin[2]], step,
    vertexCount, packed, indices, materials,
  };
}
