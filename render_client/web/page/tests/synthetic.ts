// A session that nobody milled: a bumpy ball in nodes, a burr, a nerve below thin bone; coded as the server codes them.
import { create, fromBinary, toBinary } from '@bufbuild/protobuf';
import { MeshoptEncoder } from 'meshoptimizer/encoder';
import * as wire from '../src/link/wire';
import { Sample_Topic, SampleSchema, type Sample } from '#proto/gateway_pb';

export const kEpoch = 1_790_000_000_000_000_000n;
export const kRadius = 0.01;  // m
const kTiles = 8;  // nodes along an edge of a cube's face
const kStep = 2e-7;  // m
const kCodecLevel = 2, kCodecVersion = 0;  // of the server's meshoptimizer

await MeshoptEncoder.ready;

type V3 = [number, number, number];

const unit = (v: V3): V3 => {
  const n = Math.hypot(...v);
  return [v[0] / n, v[1] / n, v[2] / n];
};

function octahedral(n: V3): [number, number] {
  const s = Math.abs(n[0]) + Math.abs(n[1]) + Math.abs(n[2]);
  let [u, v] = [n[0] / s, n[1] / s];
  if (n[2] < 0) [u, v] = [(1 - Math.abs(v)) * (u < 0 ? -1 : 1), (1 - Math.abs(u)) * (v < 0 ? -1 : 1)];
  return [Math.round(u * 127), Math.round(v * 127)];
}

export interface Surface {
  points: V3[];
  normals: V3[];
  indices: number[];
}

export function nodeMesh(surface: Surface, revision = 1, material = 0, least_step = kStep): Uint8Array {
  const low = [0, 1, 2].map((i) => Math.min(...surface.points.map((p) => p[i]))) as V3;
  const span = Math.max(...surface.points.map((p) => Math.max(...p.map((x, i) => x - low[i]))));
  const step = Math.max(least_step, span / 60000);
  const vertices = new Uint8Array(8 * surface.points.length), view = new DataView(vertices.buffer);
  surface.points.forEach((p, v) => {
    p.forEach((x, i) => view.setUint16(8 * v + 2 * i, Math.round((x - low[i]) / step), true));
    octahedral(surface.normals[v]).forEach((x, i) => view.setInt8(8 * v + 6 + i, x));
  });
  const indices = new Uint8Array(Uint32Array.from(surface.indices).buffer);
  return toBinary(wire.NodeMeshSchema, create(wire.NodeMeshSchema, {
    epoch: kEpoch, revision, originM: low, stepM: [step, step, step],
    vertexCount: surface.points.length, indexCount: surface.indices.length,
    vertices: MeshoptEncoder.encodeVertexBufferLevel(vertices, surface.points.length, 8, kCodecLevel, kCodecVersion),
    indices: MeshoptEncoder.encodeIndexBuffer(indices, surface.indices.length, 4),
    materials: material ? materialRun(material, surface.points.length) : new Uint8Array(),
  }));
}

function materialRun(material: number, count: number): Uint8Array {
  const bytes = [material];
  for (; count > 0x7f; count >>= 7) bytes.push((count & 0x7f) | 0x80);
  return Uint8Array.from([...bytes, count]);
}

// A piece of a ball around `centre`, whose radius is that of the direction.
function tile(face: number, a: number, b: number, tiles: number, cells: number, centre: V3, radius: (n: V3) => number): Surface {
  const surface: Surface = { points: [], normals: [], indices: [] }, side = face < 3 ? 1 : -1, axis = face % 3;
  const direction = (u: number, v: number): V3 => {
    const d: V3 = [0, 0, 0];
    d[axis] = side;
    d[(axis + 1) % 3] = Math.tan((u * Math.PI) / 4);
    d[(axis + 2) % 3] = Math.tan((v * Math.PI) / 4);
    return unit(d);
  };
  const at = (u: number, v: number): V3 => {
    const n = direction(u, v), r = radius(n);
    return [centre[0] + n[0] * r, centre[1] + n[1] * r, centre[2] + n[2] * r];
  };
  for (let j = 0; j <= cells; ++j)
    for (let i = 0; i <= cells; ++i) {
      const u = (2 * (a + i / cells)) / tiles - 1, v = (2 * (b + j / cells)) / tiles - 1, e = 1e-3;
      const p = at(u, v), pu = at(u + e, v), pv = at(u, v + e);
      const [x, y] = [pu.map((n, k) => n - p[k]), pv.map((n, k) => n - p[k])];
      const n = unit([x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]);
      surface.points.push(p);
      surface.normals.push(side > 0 ? n : [-n[0], -n[1], -n[2]]);
    }
  for (let j = 0; j < cells; ++j)
    for (let i = 0; i < cells; ++i) {
      const k = j * (cells + 1) + i, quad = [k, k + 1, k + cells + 2, k, k + cells + 2, k + cells + 1];
      surface.indices.push(...(side > 0 ? quad : quad.map((_, n) => quad[n - (n % 3) + [0, 2, 1][n % 3]])));
    }
  return surface;
}

const bumpy = (n: V3) => kRadius * (1 + 0.04 * Math.sin(9 * n[0]) * Math.sin(8 * n[1] + 1) * Math.sin(7 * n[2] + 2));

export const sample = (topic: Sample_Topic, key: number | bigint, payload: Uint8Array, revision = 0): Sample =>
  create(SampleSchema, { topic, key: BigInt(key), payload, revision });

// With a dent in front, which somebody has milled.
export function dented(n: V3): number {
  const depth = 0.15 * Math.exp(-30 * ((n[0] - 0.1) ** 2 + (n[1] + 0.9) ** 2 + (n[2] - 0.35) ** 2));
  return depth > 0.02 ? bumpy(n) * (1 - depth + 0.02) : bumpy(n);
}

// With furrows, into which less light comes.
export const furrowed = (n: V3) => bumpy(n) * (1 - 0.1 * Math.max(Math.sin(14 * n[2]), 0) ** 4);

// About so many triangles.
export function boneNodes(triangles: number, radius = bumpy, revision = 1): Sample[] {
  const cells = Math.max(1, Math.round(Math.sqrt(triangles / (2 * 6 * kTiles * kTiles))));
  const samples: Sample[] = [];
  for (let face = 0; face < 6; ++face)
    for (let a = 0; a < kTiles; ++a)
      for (let b = 0; b < kTiles; ++b)
        samples.push(sample(Sample_Topic.NODE_MESH, samples.length + 1,
          nodeMesh(tile(face, a, b, kTiles, cells, [0, 0, 0], radius), revision, (a + b) % 7 === 0 ? 2 : 0), revision));
  return samples;
}

export function nerve(): Sample {
  const parts = [0, 1, 2, 3, 4, 5].map((face) => tile(face, 0, 0, 1, 12, [0.0026, -0.0052, 0.0039], () => 0.0025));
  const all: Surface = { points: [], normals: [], indices: [] };
  for (const part of parts) {
    all.indices.push(...part.indices.map((i) => i + all.points.length));
    all.points.push(...part.points);
    all.normals.push(...part.normals);
  }
  const surface = nodeMesh(all);
  return sample(Sample_Topic.STRUCTURE_MESH, 1, toBinary(wire.StructureMeshSchema, create(wire.StructureMeshSchema, {
    epoch: kEpoch, surface, warningDistanceM: 0.002,
  })));
}

function burr(): { verticesM: number[]; normals: number[]; indices: number[] } {
  const out = { verticesM: [] as number[], normals: [] as number[], indices: [] as number[] }, sides = 24;
  const profile: [number, number][] = [];  // radius and height along +y
  for (let i = 0; i <= 12; ++i) profile.push([Math.sin((i / 12) * 2.6) * 0.001, -Math.cos((i / 12) * 2.6) * 0.001]);
  profile.push([0.0005, 0.012]);
  for (const [r, y] of profile)
    for (let k = 0; k < sides; ++k) {
      const angle = (2 * Math.PI * k) / sides, n = unit([Math.cos(angle), y < 0.0009 ? y / 0.001 : 0, Math.sin(angle)]);
      out.verticesM.push(r * Math.cos(angle), y, r * Math.sin(angle));
      out.normals.push(...n);
    }
  for (let i = 0; i + 1 < profile.length; ++i)
    for (let k = 0; k < sides; ++k) {
      const a = i * sides + k, b = i * sides + ((k + 1) % sides);
      out.indices.push(a, a + sides, b, b, a + sides, b + sides);
    }
  return out;
}

export function sceneInfo(): Sample {
  return sample(Sample_Topic.SCENE_INFO, 0, toBinary(wire.SceneInfoSchema, create(wire.SceneInfoSchema, {
    epoch: kEpoch, name: 'a synthetic ball', pWVM: [0, 0, 0], qWV: [1, 0, 0, 0],
    boneMinM: [-kRadius, -kRadius, -kRadius], boneMaxM: [kRadius, kRadius, kRadius], burrRadiusM: 0.001, tool: burr(),
    camera: { distanceM: 0, azimuthRad: 0.61, elevationRad: 0.44 }, leafCount: 1000, revision: 1,
    toolNames: ['round burr', 'cone'], materials: [
      { name: 'facial nerve', isProtected: true }, { name: 'enamel', color: { red: 0.9, green: 0.9, blue: 0.95 } },
    ],
    viewerEffects: { millingSound: {} },
  })));
}

const kUpwards = [Math.SQRT1_2, Math.SQRT1_2, 0, 0];  // the shaft along +z

export function toolState(tick: number, expert?: { p: readonly number[]; q: readonly number[] }): Sample {
  const angle = tick / 700;
  return sample(Sample_Topic.TOOL_STATE, 0, toBinary(wire.ToolStateSchema, create(wire.ToolStateSchema, {
    epoch: kEpoch, tick: BigInt(tick), stampNs: 0n,
    pWTM: [0.004 * Math.sin(angle), -kRadius * 1.06, 0.004 * Math.cos(angle)], qWT: kUpwards,
    pWTDeviceM: [0.004 * Math.sin(angle), -kRadius * 1.03, 0.004 * Math.cos(angle)], qWTDevice: kUpwards,
    pWTExpertM: [...(expert?.p ?? [])], qWTExpert: [...(expert?.q ?? [])],
    forceN: [0, -2.5, 0.4], torqueNm: [0, 0, 0], buttons: 1, deviceState: 4,
    effects: { spinSpeed: 2000, burrForceN: 2.5, cuttingPowerW: 3, protectedDistanceM: 0.0031, protectedId: 1, damagedMm3: 0 },
  })));
}

// What the server says of the nodes that there are (common/dds/node_digest.h): a sum over what each of them shows.
export interface NodeSum {
  count: number;
  digest: bigint;
}

const word = (n: bigint) => BigInt.asUintN(64, n);

function contentOf(payload: Uint8Array): bigint {
  const node = fromBinary(wire.NodeMeshSchema, payload);
  const parts = [Uint32Array.of(node.revision), Float32Array.from(node.originM), Float32Array.from(node.stepM)].map((all) => new Uint8Array(all.buffer));
  let hash = 0xcbf29ce484222325n;
  for (const part of [...parts, node.vertices, node.indices, node.materials])
    for (const byte of part) hash = word((hash ^ BigInt(byte)) * 0x100000001b3n);
  return hash;
}

function finalised(n: bigint): bigint {
  n = word(n + 0x9e3779b97f4a7c15n);
  n = word((n ^ (n >> 30n)) * 0xbf58476d1ce4e5b9n);
  n = word((n ^ (n >> 27n)) * 0x94d049bb133111ebn);
  return n ^ (n >> 31n);
}

export function sumOf(nodes: Sample[]): NodeSum {
  const digest = nodes.reduce((sum, { key, payload }) => word(sum + finalised(word(finalised(key) + contentOf(payload)))), 0n);
  return { count: nodes.length, digest };
}

export interface StatusWish {
  nodes: NodeSum;
  sessionS?: number;
  answer?: { sender: bigint; sequence: number; result: string };
  isPaused?: boolean;
}

export function status({ nodes, sessionS = 12.5, answer, isPaused = false }: StatusWish): Sample {
  return sample(Sample_Topic.STATUS, 0, toBinary(wire.StatusSchema, create(wire.StatusSchema, {
    epoch: kEpoch, scene: 'ball', preset: 'balanced', ticks: BigInt(Math.round((sessionS || 0) * 1000)), rateHz: 1000, tickP50Us: 30, tickP99Us: 41,
    removedMm3: 3.25, nodeCount: nodes.count, nodeDigest: nodes.digest, sessionS, isMillingPaused: isPaused,
    checkpoints: [{ id: 1, sessionS: 4, removedMm3: 1 }], device: { name: 'simulated hand', kind: 5, state: 4, isSimulated: true },
    lastCommandSender: answer?.sender ?? 0n, lastCommandSequence: answer?.sequence ?? 0, lastCommandResult: answer?.result ?? '',
    lastCommandOutcome: answer ? wire.Outcome.DONE : wire.Outcome.UNSAID,
  })));
}

export function lesson(): Sample {
  return sample(Sample_Topic.LESSON, 0, toBinary(wire.LessonSchema, create(wire.LessonSchema, {
    epoch: kEpoch, sceneId: 'ball', trainee: 'Anna', scenes: [
      { id: 'ball', title: 'Ball', task: 'Mill the ball open without touching the nerve.', tools: ['round burr'], expectedS: 300 },
      { id: 'other', title: 'Other', task: 'Something else.', tools: ['cone'] },
    ],
    attempts: [{ number: 1, trainee: 'Ben', sceneId: 'ball', timeS: 61, removedMm3: 12, maxForceN: 3.4 }],
  })));
}

export function scenePicture(scene: number, sceneId: string, png: Uint8Array): Sample {
  return sample(Sample_Topic.SCENE_PICTURE, scene, toBinary(wire.ScenePictureSchema, create(wire.ScenePictureSchema, { epoch: kEpoch, sceneId, png })));
}

export function viewer(sender: number, name: string, role: wire.Viewer_Role, pointer: number[] = []): Sample {
  return sample(Sample_Topic.VIEWER, sender, toBinary(wire.ViewerSchema, create(wire.ViewerSchema, {
    sender: BigInt(sender), name, role, frameRateHz: 30, isComplete: true, pointerM: pointer, link: 'viewer',
    camera: { hasTarget: true, targetM: [0, 0, 0], distanceM: 0.05, azimuthRad: -0.5, elevationRad: 0.2 },
  })));
}

export function remark(key: number, note: string, points: number[]): Sample {
  return sample(Sample_Topic.REMARK, key, toBinary(wire.RemarkSchema, create(wire.RemarkSchema, {
    epoch: kEpoch, number: key + 1, author: 'Dr. Weber', role: 2, sessionS: 11, note, pointsM: points, color: 0xffd23f,
  })));
}

// An arc on the front of the ball.
export function arc(): number[] {
  return Array.from({ length: 24 }, (_, i) => unit([Math.sin(i / 12 - 1), -1.2, 0.9 + 0.2 * Math.cos(i / 3)]))
    .flatMap((n) => n.map((x) => x * bumpy(n)));
}
