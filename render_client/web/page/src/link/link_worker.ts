// The worker: takes the gateway's frames apart, checks and decodes what is in them, and hands it to the page; takes the
// page's orders and announcements to the gateway.
import { Sample_Topic, type Sample, type Samples } from '#proto/gateway_pb';
import type { CommandOrder, FromLink, PlacedNode, SceneView, ToLink } from '../shared/messages';
import { read } from './bounds';
import { demand, Malformed } from './checks';
import { CommandOutbox } from './command_outbox';
import { commandOf, announcementOf, HandSpeaker } from './speech';
import { decodeNode, decoderReady, type DecodedNode } from './node_codec';
import { NodeList } from './node_list';
import * as payloads from './payloads';
import { Placement } from './place_node';
import { SessionSocket } from './session_socket';
import { StructureMeshSchema } from '#proto/topics_scene_pb';
import { trMark } from '../shared/language';

const kMostStructureTriangles = 1 << 18;
const kMostKeys = 1024;  // viewers, remarks and pictures each

const scope = self as unknown as { postMessage(message: FromLink, transfer?: Transferable[]): void };
const post = (message: FromLink, transfer: Transferable[] = []) => scope.postMessage(message, transfer);

const book = new NodeList();
const outbox = new CommandOutbox();
const keys = new Map<string, Set<string>>();
let sender = '';
let placement: Placement | undefined;
let otherFirstLeaf = Infinity;
const early = new Map<number, DecodedNode>();  // by leaf, before the scene info
let malformed = 0;

const hand = new HandSpeaker((value) => socket.send({ case: 'hand', value }));
const socket = new SessionSocket({
  held: () => ({ epoch: book.epoch, leaves: book.leaves(), revisions: book.revisions() }),
  welcome: (message) => {
    sender = String(message.sender);
    post({ kind: 'welcome', ticket: message.ticket, name: message.name, role: Number(message.role), sender,
           expiresMs: Number(message.expiresNs / 1_000_000n) });
  },
  samples: takeAll,
  frame: (bytes, connection) => post({ kind: 'frame', bytes, connection }),
  away: (reason, sinceMs, nextTryMs) => post({ kind: 'away', reason, sinceMs, nextTryMs }),
  refused: (reason) => post({ kind: 'refused', reason }),
});

setInterval(() => {
  const outcome = outbox.step(Date.now(), socket.isWelcome, (order, sequence) => {
    socket.send({ case: 'command', value: commandOf(order, sequence) });
  });
  if (outcome) post({ kind: 'outcome', ...outcome });
}, 100);

// What came in one frame is shown together.
function takeAll(message: Samples): void {
  post({ kind: 'server', hasServer: message.hasServer, hasEnded: message.hasEnded });
  const placed: PlacedNode[] = [], gone: number[] = [];
  for (const sample of message.samples) {
    try {
      if (sample.topic === Sample_Topic.NODE_MESH) takeNode(sample, placed, gone);
      else take(sample);
    } catch (error) {
      if (++malformed <= 5) console.warn('a sample was dropped:', error instanceof Malformed ? error.message : error);
    }
  }
  if (placed.length + gone.length === 0) return;
  post({ kind: 'nodes', placed, gone }, placed.flatMap((node) => [node.vertices.buffer, node.indices.buffer, node.coarse.buffer]));
}

function beginIfNew(epoch: bigint): void {
  if (!book.begins(epoch)) return;
  placement = undefined;
  early.clear();
  keys.clear();
  post({ kind: 'epoch', epoch: String(epoch) });
}

function takeNode(sample: Sample, placed: PlacedNode[], gone: number[]): void {
  const leaf = Number(sample.key);
  demand(Number.isSafeInteger(leaf) && leaf <= 0xffffffff, 'leaf');
  if (sample.payload.length === 0) {
    if (book.drop(leaf)) gone.push(leaf);
    early.delete(leaf);
    return;
  }
  const node = decodeNode(sample.payload);
  beginIfNew(node.epoch);
  if (!book.isNews(leaf, node.epoch, node.revision)) return;
  book.hold(leaf, node.revision, node.indices.length / 3);
  if (placement && leaf < otherFirstLeaf) placed.push(placement.place(leaf, node));
  else if (!placement) early.set(leaf, node);
}

function takeScene(scene: SceneView): void {
  beginIfNew(BigInt(scene.epoch));
  if (BigInt(scene.epoch) !== book.epoch) return;
  placement = new Placement(scene.boneLow, scene.boneHigh);
  otherFirstLeaf = scene.otherFirstLeaf;
  post({ kind: 'scene', scene });
  if (early.size === 0) return;
  const shown = [...early].filter(([leaf]) => leaf < otherFirstLeaf);
  const placed = shown.map(([leaf, node]) => placement!.place(leaf, node));
  early.clear();
  post({ kind: 'nodes', placed, gone: [] });
}

function takeStructure(id: number, payload: Uint8Array): void {
  demand(id >= 1 && id <= 255, 'structure');
  if (payload.length === 0) return post({ kind: 'structure', id });
  const message = read(StructureMeshSchema, payload);
  const node = decodeNode(message.surface);
  demand(node.epoch === message.epoch && node.indices.length <= 3 * kMostStructureTriangles, 'structure');
  beginIfNew(node.epoch);
  if (node.epoch !== book.epoch) return;
  // A structure is a chunk of its own, whatever its size: its steps are those of its own box.
  const reach = node.step.map((s, i) => node.origin[i] + s * 65535) as unknown as [number, number, number];
  const surface = new Placement(node.origin, reach, 1).place(id, node);
  post({ kind: 'structure', id, surface: { id, warningDistance: message.warningDistanceM, node: surface } });
}

// Of a topic there are so many keys at most.
function isKnownKey(topic: string, key: string, is_gone: boolean): boolean {
  const known = keys.get(topic) ?? new Set<string>();
  keys.set(topic, known);
  if (is_gone) known.delete(key);
  else if (known.size < kMostKeys) known.add(key);
  return is_gone || known.has(key);
}

function take(sample: Sample): void {
  const { payload } = sample, key = String(sample.key), is_gone = payload.length === 0;
  switch (sample.topic) {
    case Sample_Topic.SCENE_INFO:
      return is_gone ? undefined : takeScene(payloads.sceneOf(payload));
    case Sample_Topic.STRUCTURE_MESH:
      return takeStructure(Number(sample.key), payload);
    case Sample_Topic.TOOL_STATE:
      return is_gone ? undefined : post({ kind: 'tool', tool: payloads.toolOf(payload) });
    case Sample_Topic.LESSON:
      return is_gone ? undefined : post({ kind: 'lesson', lesson: payloads.lessonOf(payload) });
    case Sample_Topic.SCENE_PICTURE:
      if (isKnownKey('picture', key, is_gone) && !is_gone)
        post({ kind: 'picture', scene: Number(sample.key), picture: payloads.pictureOf(payload) });
      return;
    case Sample_Topic.STATUS:
      return is_gone ? undefined : takeStatus(payload);
    case Sample_Topic.VIEWER:
      if (isKnownKey('viewer', key, is_gone))
        post({ kind: 'viewer', sender: key, viewer: is_gone ? undefined : payloads.viewerOf(payload) });
      return;
    case Sample_Topic.REMARK:
      if (isKnownKey('remark', key, is_gone))
        post({ kind: 'remark', key, remark: is_gone ? undefined : payloads.remarkOf(payload) });
      return;
  }
}

function takeStatus(payload: Uint8Array): void {
  const status = payloads.statusOf(payload);
  beginIfNew(BigInt(status.epoch));
  if (BigInt(status.epoch) !== book.epoch) return;
  post({ kind: 'status', status });
  const outcome = outbox.answered(status, sender);
  if (outcome) post({ kind: 'outcome', ...outcome });
}

function onPage(message: ToLink): void {
  switch (message.kind) {
    case 'open':
      return socket.open(message.url, message.token);
    case 'retry':
      return socket.retryNow();
    case 'command':
      return outbox.enqueue(message.order as CommandOrder);
    case 'announce':
      return socket.send({ case: 'announce', value: announcementOf(message) });
    case 'hand':
      return hand.say(message, book.epoch);
    case 'taken':
      return socket.taken(message.bytes, message.connection);
  }
}

// Nothing is done before nodes can be decoded; what the page says until then waits, in its order.
const isReady = decoderReady.then(() => true, () => {
  post({ kind: 'refused', reason: trMark('This browser runs no WebAssembly, which the page needs.') });
  return false;
});
self.onmessage = (event: MessageEvent<ToLink>) => void isReady.then((is_ready) => is_ready && onPage(event.data));
