// node journal.mjs FILE: reads a session's journal with a stock MCAP reader and its own schemas, from its index and
// as a stream, as any tool for such files does.
import { createFileRegistry, fromBinary } from '@bufbuild/protobuf';
import { FileDescriptorSetSchema } from '@bufbuild/protobuf/wkt';
import { McapIndexedReader, McapStreamReader } from '@mcap/core';
import { decompress } from 'fzstd';
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';

const file = new Uint8Array(readFileSync(process.argv[2]!));
const readable = {
  size: () => Promise.resolve(BigInt(file.length)),
  read: (from: bigint, count: bigint) => Promise.resolve(file.subarray(Number(from), Number(from + count))),
};
const decompressHandlers = { zstd: (bytes: Uint8Array, size: bigint) => decompress(bytes, new Uint8Array(Number(size))) };

// By topic, each message as the schema in the file says that it is.
const messages = new Map<string, Record<string, unknown>[]>();
const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
assert.equal(reader.header.profile, 'bonemill.journal');
for await (const message of reader.readMessages()) {
  const channel = reader.channelsById.get(message.channelId)!;
  const schema = reader.schemasById.get(channel.schemaId)!;
  assert.equal(schema.encoding, 'protobuf');
  const type = createFileRegistry(fromBinary(FileDescriptorSetSchema, schema.data)).getMessage(schema.name);
  assert(type, schema.name);
  const decoded = fromBinary(type, message.data);
  assert.equal(decoded.$unknown, undefined, `${schema.name} is not all in its schema`);
  messages.set(channel.topic, [...(messages.get(channel.topic) ?? []), decoded as unknown as Record<string, unknown>]);
}

const all = (topic: string) => messages.get(topic) ?? [];
assert.equal(all('/manifest').length, 1);
const counts = all('/inputs').map(({ count }) => count as number);
assert.equal(counts.reduce((sum, count) => sum + count, 0), 2500);
assert.equal(all('/state_hash').length, 2);
assert(all('/bone').length > 5);
assert.equal(all('/tool').length, 63);
type Pose = { frameId: string; timestamp: { seconds: bigint }; pose: { position: { x: number }; orientation: { w: number } } };
const tool = all('/tool').at(-1) as unknown as Pose;
assert.equal(tool.frameId, 'W');
assert(tool.timestamp.seconds > 1_700_000_000n);
assert(Math.abs(tool.pose.position.x) < 0.02);
const wrench = all('/wrench').at(-1) as unknown as { forceN: { z: number } };
assert(Math.abs(wrench.forceN.z) <= 1 && wrench.forceN.z !== 0);

const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
stream.append(file);
let streamed = 0;
for (let record = stream.nextRecord(); record; record = stream.nextRecord()) streamed += record.type === 'Message' ? 1 : 0;
assert(stream.done());
assert.equal(streamed, [...messages.values()].reduce((sum, list) => sum + list.length, 0));
console.log(`${streamed} messages of ${messages.size} topics`);
