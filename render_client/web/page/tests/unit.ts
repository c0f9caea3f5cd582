// The pure parts of the page, with node's own test runner.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { create, fromBinary, getOption, ScalarType, toBinary, type DescMessage } from '@bufbuild/protobuf';
import { items, shape, Shape } from '#proto/bounds_pb';
import * as wire from '../src/link/wire';
import * as linear from '../src/math/linear';
import { read } from '../src/link/bounds';
import { shownText, Malformed } from '../src/link/checks';
import { CommandOutbox } from '../src/link/command_outbox';
import { decodeMaterials, decodeNode, decoderReady } from '../src/link/node_codec';
import { NodeList } from '../src/link/node_list';
import * as payloads from '../src/link/payloads';
import { Placement } from '../src/link/place_node';
import { kMilledBit, kVertexBytes, Role, type CommandOrder, type StatusView, type ToolView } from '../src/shared/messages';
import { clockText, readableText } from '../src/shared/format';
import { hasTakenOver, kPointerDevice, OrderDesk, questionBefore, whyNot, whyNotHold, whyNotTakeOver } from '../src/orders';
import { orderText } from '../src/shared/commands';
import { Pace } from '../src/pace';
import { Session } from '../src/session';
import { MillingSynth } from '../src/sound/milling_synth';
import { thinned } from '../src/stroke_pen';
import { ToolHold } from '../src/tool_hold';
import { actionOf } from '../src/ui/key_table';
import { conditions, loadOf, workOf } from '../src/ui/words';
import { vertexColours } from '../src/view/vertex_colours';
import { Orbit, frustumPlanes, isBoxSeen, pixelOf } from '../src/view/camera';
import { makeFrame, type PictureView } from '../src/view/picture_view';
import { nearStructures } from '../src/view/near_structures';
import * as synthetic from './synthetic';

await decoderReady;

const near = (a: number, b: number, tolerance: number) => assert.ok(Math.abs(a - b) <= tolerance, `${a} is not ${b}`);

test('poses go there and back', () => {
  const X: linear.Pose = { p: [1, 2, 3], q: linear.unit([0.5, 0.1, -0.7, 0.3]) };
  const v: linear.Vec3 = [0.3, -0.2, 0.9];
  const back = linear.placed(linear.inversePose(X), linear.placed(X, v));
  const by_matrix = linear.transformed(linear.inverseRigid(linear.matrixOf(X)), linear.transformed(linear.matrixOf(X), v));
  for (let i = 0; i < 3; ++i) {
    near(back[i], v[i], 1e-12);
    near(by_matrix[i], v[i], 1e-6);
  }
});

test('numbers are worded as in the native viewer', () => {
  assert.equal(readableText(2.5311, ' N'), '2.53 N');
  assert.equal(readableText(-0.001, ' N'), '0.00 N');
  assert.equal(readableText(1234, ' mm³'), '1234 mm³');
  assert.equal(readableText(NaN, ' N'), '--');
  assert.equal(clockText(3723.9), '1:02:03');
});

test('texts of others lose what is no sign', () => {
  assert.equal(shownText('a\u0000b\u202ec\nd\u061ce\u2067f\u{e0041}g\u200d'), 'abcdefg\u200d');
  assert.equal(shownText('x'.repeat(600)).length, 512);
});

test('a node keeps its place to some micrometres', () => {
  const nodes = synthetic.boneNodes(4000), low: linear.Vec3 = [-0.01, -0.01, -0.01], high: linear.Vec3 = [0.01, 0.01, 0.01];
  const placement = new Placement(low, high);
  for (const sample of nodes.slice(0, 20)) {
    const node = decodeNode(sample.payload), placed = placement.place(Number(sample.key), node);
    const from = new DataView(node.packed.buffer), to = new DataView(placed.vertices.buffer);
    for (let v = 0; v < node.vertexCount; ++v)
      for (let i = 0; i < 3; ++i) {
        const there = node.origin[i] + node.step[i] * from.getUint16(8 * v + 2 * i, true);
        near(placed.origin[i] + placed.step * to.getUint16(kVertexBytes * v + 2 * i, true), there, 1e-6);
      }
  }
});

test('what was damaged on its way is refused, whatever it is', () => {
  const good = synthetic.boneNodes(4000)[0].payload;
  let seed = 12345, refused = 0;
  const random = (n: number) => (seed = (Math.imul(seed, 1103515245) + 12345) >>> 0) % n;
  for (let round = 0; round < 2000; ++round) {
    const bad = good.slice();
    for (let k = 0; k <= random(3); ++k) bad[random(bad.length)] = random(256);
    try {
      const node = decodeNode(bad.slice(0, random(8) === 0 ? random(bad.length) : bad.length));
      assert.ok(node.indices.every((i) => i < node.vertexCount));
    } catch (error) {
      ++refused;
      assert.ok(error instanceof Error && !(error instanceof assert.AssertionError), String(error));
    }
  }
  assert.ok(refused > 200);
});

test('runs of materials must cover the vertices', () => {
  assert.deepEqual([...decodeMaterials(Uint8Array.from([3, 2, 0, 1]), 3)], [3, 3, 0]);
  for (const bad of [[3, 2], [3, 4], [3, 0], [3, 0x80], [3, 0xff, 0xff, 0xff, 0xff, 0xff, 1]])
    assert.throws(() => decodeMaterials(Uint8Array.from(bad), 3), Malformed);
});

test('numbers that cannot be are refused', () => {
  assert.equal(payloads.sceneOf(synthetic.sceneInfo().payload).toolNames.length, 2);
  assert.equal(payloads.statusOf(synthetic.status({ nodes: { count: 3, digest: 0n } }).payload).nodeCount, 3);
  assert.throws(() => payloads.statusOf(synthetic.status({ nodes: { count: 3, digest: 0n }, sessionS: NaN }).payload), Malformed);
  assert.throws(() => payloads.remarkOf(synthetic.remark(0, '', [1, 2]).payload), Malformed);
  assert.throws(() => payloads.remarkOf(synthetic.remark(0, '', Array.from({ length: 903 }, () => 0)).payload), Malformed);
  assert.throws(() => payloads.viewerOf(synthetic.viewer(4, 'x', 2, [1e9, 0, 0]).payload), Malformed);
  assert.throws(() => payloads.viewerOf(synthetic.viewer(4, 'x', 17 as never).payload), Malformed);
  assert.equal(payloads.viewerOf(synthetic.viewer(4, 'x', 1, [0, 0, 0]).payload).pointer, undefined, 'an operator does not point');
});

test('nothing in a payload passes unchecked', () => {
  const payloadsOf: [DescMessage, Uint8Array][] = [
    [wire.SceneInfoSchema, synthetic.sceneInfo().payload], [wire.ToolStateSchema, synthetic.toolState(1).payload],
    [wire.StatusSchema, synthetic.status({ nodes: { count: 3, digest: 0n } }).payload], [wire.LessonSchema, synthetic.lesson().payload],
    [wire.ViewerSchema, synthetic.viewer(4, 'x', 1).payload], [wire.RemarkSchema, synthetic.remark(0, 'x', []).payload],
  ];
  let spoilt = 0;
  for (const [type, payload] of payloadsOf) {
    read(type, payload);
    for (const field of type.fields) {
      const message = fromBinary(type, payload), values = message as unknown as Record<string, unknown>;
      const is_floating = field.scalar === ScalarType.DOUBLE || field.scalar === ScalarType.FLOAT, is_text = field.scalar === ScalarType.STRING;
      const length = 1 + (getOption(field, shape) === Shape.ANY ? getOption(field, items) : 4);
      if (field.fieldKind === 'list') values[field.localName] = Array.from({ length }, () => field.message ? create(field.message) : is_text ? 'x' : 0);
      else if (is_floating) values[field.localName] = NaN;
      else if (is_text) values[field.localName] = 'x\u0007'.repeat(2000);
      else continue;
      ++spoilt;
      if (is_text && field.fieldKind !== 'list') assert.ok(String((read(type, toBinary(type, message)) as unknown as Record<string, unknown>)[field.localName]).match(/^x{1,1200}$/), field.name);
      else assert.throws(() => read(type, toBinary(type, message)), Malformed, `${type.name}.${field.name}`);
    }
  }
  assert.ok(spoilt > 40, `${spoilt}`);
});

test('the newer epoch wins, then the newer revision, and there is an end to it', () => {
  const book = new NodeList();
  assert.ok(book.begins(5n) && !book.begins(5n) && !book.begins(4n));
  book.hold(7, 2, 100);
  assert.ok(book.isNews(7, 5n, 3) && !book.isNews(7, 5n, 2) && !book.isNews(8, 4n, 9));
  assert.throws(() => book.hold(8, 1, 20_000_000), Malformed);
  assert.ok(book.begins(6n));
  assert.equal(book.size, 0);
});

test('coarse triangles are fewer, of the same vertices, and leave a border that lies in no plane', () => {
  const node = decodeNode(synthetic.boneNodes(200_000)[10].payload);
  const placed = new Placement([-0.01, -0.01, -0.01], [0.01, 0.01, 0.01]).place(1, node);
  const coarse = placed.coarse, used = new Set(coarse);
  assert.ok(coarse.length < placed.indices.length / 2 && coarse.length > placed.indices.length / 20);
  const edges = (indices: Uint32Array) => {
    const all = new Set<string>();
    for (let i = 0; i < indices.length; i += 3)
      for (let k = 0; k < 3; ++k) all.add(`${indices[i + k]} ${indices[i + ((k + 1) % 3)]}`);
    return [...all].filter((edge) => !all.has(edge.split(' ').reverse().join(' '))).sort();
  };
  assert.deepEqual(edges(coarse), edges(placed.indices));
  assert.ok([...used].every((v) => v < node.vertexCount));
});

// A wavy sheet that the plane x = 0 cuts into two nodes of two chunks, with vertices where a lattice has them.
test('a moving view stays coarse, and becomes coarser, however long its pictures take', () => {
  const pace = new Pace(true), shares: number[] = [];
  let now = 10_000;
  for (let i = 0; i < 20; ++i) {
    pace.noteMove(now + 1);  // while the picture before was drawn
    now += 400;
    const { isFine, isMoving, share } = pace.next(now);
    assert.ok(isMoving && !isFine, `picture ${i}`);
    shares.push(share);
  }
  assert.ok(shares.at(-1)! < shares[0]);
  now += pace.restsIn(now) + 5;
  assert.ok(pace.next(now).isFine, 'a view at rest');
  pace.noteChange(now + 1);
  assert.ok(!pace.next(now + 400).isFine, 'milled since the picture before');
  assert.ok(pace.next(now + 700).isFine);
});

test('two nodes have the same coarse border in the plane between them', () => {
  const kVoxel = 1e-4, kSide = 40;
  const half = (sign: number) => {
    const points: [number, number, number][] = [], indices: number[] = [];
    for (let i = 0; i <= kSide; ++i)
      for (let j = 0; j <= kSide; ++j) {
        const x = (sign * i * kVoxel) / 2, y = (j * kVoxel) / 2;
        points.push([x, y, kVoxel * Math.round(64 * (20 + 3 * Math.sin(9000 * x + 4000 * y) + y / kVoxel / 3)) / 64]);
      }
    for (let i = 0; i < kSide; ++i)
      for (let j = 0; j < kSide; ++j) {
        const a = i * (kSide + 1) + j, b = a + kSide + 1;
        indices.push(a, b, a + 1, a + 1, b, b + 1);
      }
    const node = decodeNode(synthetic.nodeMesh({ points, normals: points.map((): [number, number, number] => [0, 0, 1]), indices }, 1, 0, kVoxel / 256));
    return new Placement([-2e-3, 0, 0], [2e-3, 2e-3, 4e-3]).place(sign + 1, node);
  };
  const borderOf = (sign: number, level: 'indices' | 'coarse') => {
    const placed = half(sign), view = new DataView(placed.vertices.buffer);
    const at = (v: number) => [0, 1, 2].map((i) => placed.origin[i] + placed.step * view.getUint16(v * kVertexBytes + 2 * i, true));
    return { share: placed.coarse.length / placed.indices.length, chunk: placed.chunk,
      points: [...new Set([...placed[level]].map(at).filter((p) => Math.abs(p[0]) < placed.step).map((p) => p.slice(1).map((x) => x.toFixed(7)).join(' ')))].sort() };
  };
  const left = borderOf(-1, 'coarse'), right = borderOf(1, 'coarse');
  assert.notEqual(left.chunk, right.chunk);
  assert.deepEqual(left.points, right.points);
  assert.ok(left.points.length > 4 && left.points.length < borderOf(1, 'indices').points.length / 2);
  assert.ok(left.share < 0.2, `${left.share} of the triangles are left`);
});

test('an order waits for its own answer, is repeated, and given up', () => {
  const outbox = new CommandOutbox(5000), written: number[] = [];
  const write = (_: CommandOrder, sequence: number) => written.push(sequence);
  outbox.enqueue({ action: 'saveCheckpoint' });
  outbox.enqueue({ action: 'resetDevice' });
  outbox.step(0, true, write);
  outbox.step(100, true, write);
  outbox.step(600, true, write);
  assert.deepEqual(written, [6, 6]);
  const status = { lastCommandSender: '9', lastCommandSequence: 6, lastCommandResult: 'done', isLastCommandDone: true } as StatusView;
  assert.equal(outbox.answered(status, '8'), undefined);
  assert.equal(outbox.answered(status, '9')?.isDone, true);
  outbox.step(700, true, write);
  assert.equal(outbox.step(5700, true, write)?.result, 'the server did not answer');
});

function live(role: Role): Session {
  const session = new Session();
  session.take({ kind: 'welcome', ticket: 't', name: 'A', role, sender: '7', expiresMs: 0 }, 0);
  session.take({ kind: 'server', hasServer: true, hasEnded: false }, 0);
  session.take({ kind: 'status', status: payloads.statusOf(synthetic.status({ nodes: { count: 1, digest: 0n } }).payload) }, 0);
  return session;
}

test('what a role may do', () => {
  assert.notEqual(whyNot('pauseMilling', live(Role.Viewer)), '');
  assert.equal(whyNot('pauseMilling', live(Role.Operator)), '');
  assert.notEqual(whyNot('shutDown', live(Role.Operator)), '');
  assert.equal(whyNot('shutDown', live(Role.Instructor)), '');
  assert.notEqual(whyNot('resetVolume', live(Role.Examiner)), '');
  assert.equal(whyNot('startAttempt', live(Role.Examiner)), '');
  assert.equal(whyNot('pauseMilling', live(Role.Examiner)), '');
  assert.match(whyNotHold(live(Role.Examiner), 0), /examiner/);
});

test('what is ordered is said as in the native viewer', () => {
  assert.equal(orderText({ action: 'resetVolume' }), 'put the bone back');
  assert.equal(orderText({ action: 'pauseMilling', value: false }), 'go on milling');
  assert.equal(orderText({ action: 'selectTool', value: 1 }), 'tool 2');
  assert.equal(orderText({ action: 'restoreCheckpoint', value: 0 }), 'put the bone back');
  assert.equal(orderText({ action: 'restoreCheckpoint', value: 7 }), 'back to checkpoint 7');
  assert.equal(orderText({ action: 'startAttempt', value: 'Ben' }), 'attempt of Ben');
  assert.equal(orderText({ action: 'addRemark', note: '', points: [], colour: 0 }), 'draw a stroke');
});

test('what loses something is asked for twice', () => {
  const session = live(Role.Operator), sent: CommandOrder[] = [], said: string[] = [];
  const desk = new OrderDesk(session, (order) => sent.push(order), (text) => said.push(text));
  desk.give({ action: 'resetVolume' });
  assert.deepEqual(sent, []);
  assert.match(said[0], /once more does it/);
  desk.give({ action: 'resetVolume' });
  assert.equal(sent.length, 1);
  session.status!.checkpoints.push({ id: 2, sessionS: 5, removedMm3: session.status!.removedMm3 });
  assert.equal(questionBefore({ action: 'resetVolume' }, session), '');
});

test('after a script it begins again, or is taken over', () => {
  const session = live(Role.Operator), device = session.status!.device!;
  assert.notEqual(whyNotTakeOver(session), '');
  device.script = { hasEnded: true, takenOverBy: '0' };
  assert.equal(whyNotTakeOver(session), '');
  assert.match(conditions(session)[0].text, /automatic demonstration has ended/);
  assert.equal(questionBefore({ action: 'beginAgain' }, session), '', 'a script does its own work again');
  assert.notEqual(whyNotTakeOver({ ...session, role: Role.Examiner, isLive: true } as Session), '');
  device.script = { hasEnded: false, takenOverBy: '7' };
  assert.ok(!hasTakenOver(session), 'the mouse is not there yet');
  device.kind = kPointerDevice;
  assert.ok(hasTakenOver(session));
  assert.match(questionBefore({ action: 'beginAgain' }, session), /once more does it/);
  device.script.takenOverBy = '8';
  assert.ok(!hasTakenOver(session), 'somebody else has');
});

test('a viewer that falls silent is gone', () => {
  const session = live(Role.Viewer), sample = synthetic.viewer(5, 'B', 1);
  session.take({ kind: 'viewer', sender: '5', viewer: payloads.viewerOf(sample.payload) }, 1000);
  assert.equal(session.others(2000).length, 1);
  assert.equal(session.others(9000).length, 0);
});

test('pictures of scenes come by themselves, and stay over a change of the lesson', () => {
  const session = new Session(), png = new Uint8Array([1, 2, 3]);
  const lesson = () => session.take({ kind: 'lesson', lesson: payloads.lessonOf(synthetic.lesson().payload) }, 0);
  const picture = (scene: number, id: string) =>
    session.take({ kind: 'picture', scene, picture: payloads.pictureOf(synthetic.scenePicture(scene, id, png).payload) }, 0);
  picture(1, 'other');
  lesson();
  assert.deepEqual(session.lesson?.scenes.map((scene) => scene.picture?.length), [undefined, 3]);
  picture(0, 'another');
  assert.equal(session.lesson?.scenes[0].picture, undefined);
  picture(0, 'ball');
  lesson();
  assert.deepEqual(session.lesson?.scenes.map((scene) => scene.picture?.length), [3, 3]);
});

test('who holds the pedal while bone is put back is told to release it', () => {
  const session = new Session();
  session.take({ kind: 'welcome', role: Role.Operator, name: 'Anna', sender: '1', expiresMs: 0 } as never, 0);
  session.hasServer = true;
  const tool = payloads.toolOf(synthetic.toolState(1).payload);
  session.take({ kind: 'tool', tool: { ...tool, waitsForRelease: true } }, 0);
  assert.match(conditions(session)[0].text, /Release the pedal/);
  session.take({ kind: 'tool', tool: { ...tool, buttons: 0, waitsForRelease: true } }, 0);
  assert.deepEqual(conditions(session), []);
});

test('an expert is there or not', () => {
  assert.equal(payloads.toolOf(synthetic.toolState(1).payload).X_WT_expert, undefined);
  const X_WT = { p: [0.01, 0, 0] as const, q: [1, 0, 0, 0] as const };
  assert.deepEqual(payloads.toolOf(synthetic.toolState(1, X_WT).payload).X_WT_expert, X_WT);
});

test('keys mean what they mean in the native viewer', () => {
  const press = (key: string, shiftKey = false) => actionOf({ key, shiftKey, ctrlKey: false, metaKey: false, altKey: false, repeat: false });
  assert.equal(press('x'), 'cutX');
  assert.equal(press('X', true), 'flipX');
  assert.equal(press('+', true), 'zoomIn');
  assert.equal(press('ArrowLeft'), 'orbitLeft');
  assert.equal(press('q'), undefined);
});

test('the first view shows all of the bone', () => {
  const corners = linear.cornersOf({ low: [-0.01, -0.02, -0.03], high: [0.01, 0.02, 0.03] });
  for (const aspect of [16 / 9, 0.46]) {
    const orbit = Orbit.of({ distance: 0, azimuth: 0.6, elevation: 0.4 }, corners, aspect), height = 720;
    for (const corner of corners) {
      const at = pixelOf(orbit.view(), corner, height * aspect, height)!;
      assert.ok(at.x > 0 && at.x < height * aspect && at.y > 0 && at.y < height);
    }
  }
});

// A square of 2 mm, of two large triangles.
test('what is near bone is told with its distance', () => {
  const vertices = new Uint8Array(4 * kVertexBytes), bytes = new DataView(vertices.buffer);
  [[0, 0], [2000, 0], [0, 2000], [2000, 2000]].forEach(([x, y], i) => {
    bytes.setUint16(kVertexBytes * i, x, true);
    bytes.setUint16(kVertexBytes * i + 2, y, true);
  });
  const origin: linear.Vec3 = [0.01, 0.02, 0.03];
  const node = { leaf: 0, chunk: '', origin, step: 1e-6, low: origin, high: origin, vertices, indices: Uint32Array.from([0, 1, 2, 1, 3, 2]), coarse: new Uint32Array(), isMilled: false };
  const near = nearStructures([{ surface: { id: 1, warningDistance: 0.002, node }, colour: [1, 0.5, 0] }])!;
  let seen = 0;
  for (let n = 0; n < near.samples.length / 4; ++n) {
    const at = [n % near.size[0], Math.floor(n / near.size[0]) % near.size[1], Math.floor(n / near.size[0] / near.size[1])];
    const p = at.map((steps, axis) => near.first[axis] + steps * near.step - origin[axis]);
    const distance = Math.hypot(...p.map((x, axis) => Math.max(-x, axis < 2 ? x - 0.002 : x, 0)));
    const told = (near.samples[4 * n + 3] / 255) * 0.002;
    assert.ok(Math.abs(told - Math.min(distance, 0.002)) < 5e-5, `${at}: ${told} for ${distance}`);
    if (distance > 0.0019) continue;
    assert.deepEqual([...near.samples.subarray(4 * n, 4 * n + 3)], [255, 128, 0]);
    ++seen;
  }
  assert.ok(seen > 200);
  assert.equal(nearStructures([]), undefined);
});

function pictureView(): PictureView {
  const bone_V = { low: [-0.01, -0.01, -0.01] as linear.Vec3, high: [0.01, 0.01, 0.01] as linear.Vec3 };
  const cut = () => ({ isOn: false, position: 0.5, isFlipped: false });
  return {
    camera: Orbit.of({ distance: 0, azimuth: 0.6, elevation: 0.4 }, linear.cornersOf(bone_V), 1.5).view(), isEndoscope: false,
    X_WV: { p: [0.1, 0, 0], q: linear.unit([1, 0.2, 0, 0]) }, bone_V, burrRadius: 0.001, toolReach: 0, work: 'idle', load: 0, ghosts: [],
    cuts: [cut(), cut(), cut()], structures: [], structureMode: 'behind', pointers: [], strokes: [],
  };
}

test('a cut-plane leaves the side that it says', () => {
  const view = pictureView();
  view.cuts[0] = { isOn: true, position: 0.25, isFlipped: false };
  const frame = makeFrame(view, 1.5), plane = frame.cuts_V.slice(0, 4), bone = frame.bone_W;
  const inside: linear.Vec3 = [bone.low[0] + 0.2 * (bone.high[0] - bone.low[0]), 0, 0];
  const at = (p_W: linear.Vec3) => {
    const p = linear.placed(linear.inversePose(view.X_WV), p_W);
    return plane[0] * p[0] + plane[1] * p[1] + plane[2] * p[2] + plane[3];
  };
  assert.ok(at(inside) > 0 && at([bone.high[0], 0, 0]) < 0);
});

test('what is out of the picture is not drawn', () => {
  const view = { ...pictureView(), X_WV: { p: [0, 0, 0] as const, q: [1, 0, 0, 0] as const } };
  const planes = frustumPlanes(makeFrame(view, 1.5).clipFromModel);
  assert.ok(isBoxSeen(planes, [-0.001, -0.001, -0.001], [0.001, 0.001, 0.001]));
  assert.ok(!isBoxSeen(planes, [0.5, -0.001, -0.001], [0.6, 0.001, 0.001]));
});

test('the tool in the mouse stays under the cursor', () => {
  const hold = new ToolHold(), camera = pictureView().camera, look = { camera, width: 1200, height: 800 };
  hold.begin({ p: [0, 0, 0], q: [1, 0, 0, 0] }, 0.001, true);
  hold.move(look, { x: 0, y: 0 }, { x: 300, y: 200 });
  for (const to of [{ x: 700, y: 500 }, { x: 640, y: 90 }]) {
    hold.move(look, pixelOf(camera, hold.wish.p, 1200, 800)!, to);
    const at = pixelOf(camera, hold.wish.p, 1200, 800)!;
    near(at.x, to.x, 0.01);
    near(at.y, to.y, 0.01);
  }
});

test('a long stroke loses points, not its ends', () => {
  const points = Array.from({ length: 1000 }, (_, i): linear.Vec3 => [i, 0, 0]);
  const thin = thinned(points);
  assert.ok(thin.length <= 300 && thin[0][0] === 0 && thin.at(-1)![0] === 999);
});

test('milled bone is paler, and a cut structure dark red', () => {
  const texels = vertexColours([
    { name: 'bone', colour: [0.5, 0.5, 0.5], isProtected: false }, { name: 'nerve', colour: [1, 1, 0], isProtected: true }]);
  const at = (n: number) => [...texels.slice(4 * n, 4 * n + 4)];
  for (const i of [0, 1, 2]) assert.ok(at(1 + kMilledBit)[i] > at(1)[i]);
  assert.ok(at(2 + kMilledBit)[0] < 0.5 && at(2 + kMilledBit)[1] < 0.1);
  assert.deepEqual(at(0), [0, 0, 0, 0]);
  assert.ok(at(kMilledBit)[3] > 0, 'bone without a material, too');
});

test('in the air the burr only turns', () => {
  const at = (buttons: number, contacts: number, removedMm3: number) =>
    workOf({ buttons, contacts, waitsForRelease: false, effects: { removedMm3 } } as unknown as ToolView);
  assert.deepEqual([at(1, 0, 0), at(1, 3, 0), at(1, 0, 0.1), at(0, 3, 0), at(2, 0, 0)],
    ['turning', 'removing', 'removing', 'idle', 'adding']);
  assert.equal(workOf({ buttons: 1, contacts: 0, waitsForRelease: false } as unknown as ToolView), 'removing');
  near(loadOf({ forceN: [0.6, 0, 0.8] } as unknown as ToolView), 0.5, 1e-9);
});

test('a thin wall sounds higher', () => {
  const middle = (wallM: number) => {
    const synth = new MillingSynth({ volume: 0.5, flutes: 8, idleLevel: 0, fullSpeedRpm: 30000, fullPowerW: 10 }, 48000);
    const samples = new Float32Array(96000);
    synth.setLoad({ spinSpeed: 6283, burrForceN: 1, cuttingPowerW: 1, wallM }, true);
    synth.render(samples);
    let changes = 0;
    for (let i = 48001; i < samples.length; ++i) changes += Number(samples[i - 1] < 0 !== samples[i] < 0);
    return changes / 2;
  };
  assert.ok(middle(0) > 1.2 * middle(1), `${middle(0)} ${middle(1)}`);
});

test('the sound is heard under load and fades without', () => {
  const synth = new MillingSynth({ volume: 0.5, flutes: 8, idleLevel: 0.3, fullSpeedRpm: 30000, fullPowerW: 10 }, 48000);
  const loudness = () => {
    const samples = new Float32Array(24000);
    synth.render(samples);
    return Math.sqrt(samples.reduce((sum, x) => sum + x * x, 0) / samples.length);
  };
  synth.setLoad({ spinSpeed: 3000, burrForceN: 3, cuttingPowerW: 5 }, true);
  const loud = loudness();
  synth.setLoad({ spinSpeed: 3000, burrForceN: 0, cuttingPowerW: 0 }, true);
  loudness();
  const idle = loudness();
  synth.setLoad({ spinSpeed: 3000, burrForceN: 3, cuttingPowerW: 5 }, false);
  loudness();
  assert.ok(loud > 2 * idle && idle > 0.001 && loudness() < 1e-4);
  near(synth.frequency, 3000 / (2 * Math.PI), 1);
});
