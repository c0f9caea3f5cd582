// node foxglove.mjs FOLDER: holds what `session export --foxglove` wrote there (export.mcap, beside it export.csv and
// export.layout.json) against the schemas that Foxglove publishes, read with a stock MCAP reader: every field and number
// of every type, every value of every message, how many there are, and that each pose and wrench is the table's.
import { createFileRegistry, fromBinary, type DescField, type DescMessage, type FileRegistry } from '@bufbuild/protobuf';
import { FileDescriptorSetSchema } from '@bufbuild/protobuf/wkt';
import { generateProto } from '@foxglove/schemas/dist/internal/generateProto';
import { foxgloveEnumSchemas, foxgloveMessageSchemas } from '@foxglove/schemas/dist/internal/schemas';
import * as published from '@foxglove/schemas/jsonschema';
import { McapIndexedReader, McapStreamReader } from '@mcap/core';
import { decompress } from 'fzstd';
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';

type Value = Record<string, unknown>;
const folder = process.argv[2]!;
const file = new Uint8Array(readFileSync(join(folder, 'export.mcap')));
const readable = {
  size: () => Promise.resolve(BigInt(file.length)),
  read: (from: bigint, count: bigint) => Promise.resolve(file.subarray(Number(from), Number(from + count))),
};
const decompressHandlers = { zstd: (bytes: Uint8Array, size: bigint) => decompress(bytes, new Uint8Array(Number(size))) };

// "repeated foxglove.Point3 points = 2" of each field, as it is published, and as the file's own schema has it.
function publishedFields(name: string): string[] {
  const message = foxgloveMessageSchemas[name as keyof typeof foxgloveMessageSchemas];
  assert(message, `${name} is no published message`);
  const text = generateProto(message, Object.values(foxgloveEnumSchemas).filter((each) => each.parentSchemaName === name));
  const body = text.replace(/\/\/.*$/gm, '').replace(/enum \w+ \{[^}]*\}/g, '');
  return [...body.matchAll(/^\s*((?:repeated )?[\w.]+ \w+ = \d+);/gm)].map((found) => found[1]!).sort();
}
const kScalars = ['', 'double', 'float', 'int64', 'uint64', 'int32', 'fixed64', 'fixed32', 'bool', 'string', '', '', 'bytes', 'uint32'];
function typeOf(field: DescField): string {
  if (field.message) return field.message.typeName;
  if (field.enum) return field.enum.name;
  assert(field.scalar);
  return kScalars[field.scalar]!;
}
const checkedTypes = new Set<string>();
function checkType(type: DescMessage): void {
  if (checkedTypes.has(type.typeName) || !type.typeName.startsWith('foxglove.')) return;
  checkedTypes.add(type.typeName);
  const fields = type.fields.map((field) => `${field.fieldKind === 'list' ? 'repeated ' : ''}${typeOf(field)} ${field.name} = ${field.number}`);
  assert.deepEqual(fields.sort(), publishedFields(type.name), type.typeName);
  for (const each of type.nestedEnums) {
    const own = Object.values(foxgloveEnumSchemas).find((known) => known.parentSchemaName === type.name && known.protobufEnumName === each.name)!;
    assert.deepEqual(each.values.map(({ name, number }) => [name, number]), own.values.map(({ name, value }) => [name, value]));
  }
  for (const field of type.fields) if (field.message) checkType(field.message);
}

// A message as Foxglove hands it to panels: by its fields' names, times as sec and nsec.
function plain(type: DescMessage, message: Value): Value {
  if (/^google\.protobuf\.(Timestamp|Duration)$/.test(type.typeName)) return { sec: Number(message.seconds), nsec: message.nanos };
  const of = (field: DescField, value: unknown): unknown => (field.message ? plain(field.message, value as Value) : value);
  const entries = type.fields.map((field): [string, unknown] => {
    const value = message[field.localName];
    return [field.name, field.fieldKind === 'list' ? (value as unknown[]).map((each) => of(field, each)) : value === undefined ? value : of(field, value)];
  });
  return Object.fromEntries(entries.filter(([, value]) => value !== undefined));
}

// What the published JSON schemas use of that language.
type Schema = { type?: string; properties?: Record<string, Schema>; required?: string[]; items?: Schema; oneOf?: { const: unknown }[]; minimum?: number; maximum?: number };
const kKnownWords = ['title', 'description', '$comment', 'type', 'properties', 'required', 'items', 'minimum', 'maximum', 'oneOf', 'const', 'contentEncoding'];
let values = 0;
function validate(schema: Schema, value: unknown, where: string): void {
  ++values;
  for (const word of Object.keys(schema)) assert(kKnownWords.includes(word), `${where}: schema says ${word}`);
  if (schema.oneOf) return assert(schema.oneOf.some((each) => each.const === value), where);
  if (schema.type === 'array') {
    assert(Array.isArray(value), where);
    return value.forEach((each, i) => validate(schema.items!, each, `${where}[${i}]`));
  }
  if (schema.type === 'object') {
    const parts = value as Value;
    for (const name of schema.required ?? []) assert(name in parts, `${where}.${name} is missing`);
    for (const [name, part] of Object.entries(parts)) {
      assert(schema.properties![name], `${where}.${name} is not published`);
      validate(schema.properties![name]!, part, `${where}.${name}`);
    }
    return;
  }
  if (schema.type === 'integer' || schema.type === 'number') {
    assert(typeof value === 'number' && Number.isFinite(value), where);
    assert(schema.type === 'number' || Number.isInteger(value), where);
    assert(value >= (schema.minimum ?? -Infinity) && value <= (schema.maximum ?? Infinity), where);
  } else assert.equal(typeof value, schema.type, where);
}
// One that would take anything proves nothing.
assert.throws(() => validate(published.PoseInFrame as Schema, { timestamp: { sec: 1, nsec: 0 }, frame_id: 'W' }, 'pose'), /pose is missing/);
assert.throws(() => validate(published.Log as Schema, { level: 9 }, 'log'));

const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
const registries = new Map<number, FileRegistry>();
const messages = new Map<string, Value[]>();
for await (const { channelId, data, logTime } of reader.readMessages()) {
  const channel = reader.channelsById.get(channelId)!;
  const schema = reader.schemasById.get(channel.schemaId)!;
  assert.equal(schema.encoding, 'protobuf');
  assert.equal(channel.messageEncoding, 'protobuf');
  if (!registries.has(schema.id)) registries.set(schema.id, createFileRegistry(fromBinary(FileDescriptorSetSchema, schema.data)));
  const type = registries.get(schema.id)!.getMessage(schema.name)!;
  const decoded = fromBinary(type, data);
  assert.equal(decoded.$unknown, undefined, `${schema.name} is not all in its schema`);
  checkType(type);
  const message = plain(type, decoded as unknown as Value);
  if (schema.name.startsWith('foxglove.')) validate(published[type.name as keyof typeof published] as Schema, message, channel.topic);
  const { sec, nsec } = (message.timestamp ?? { sec: 0, nsec: 0 }) as { sec: number; nsec: number };
  if (sec > 0) assert(BigInt(sec) * 1_000_000_000n + BigInt(nsec) <= logTime, `${channel.topic} tells of what is to come`);
  messages.set(channel.topic, [...(messages.get(channel.topic) ?? []), message]);
}
for (const type of ['FrameTransforms', 'SceneUpdate', 'PoseInFrame', 'Log', 'ArrowPrimitive', 'TriangleListPrimitive']) assert(checkedTypes.has(`foxglove.${type}`), type);

// The index counts what is there, and a reader that goes from the first byte to the last finds the same.
const statistics = reader.statistics!;
for (const [id, channel] of reader.channelsById) assert.equal(statistics.channelMessageCounts.get(id) ?? 0n, BigInt(messages.get(channel.topic)?.length ?? 0), channel.topic);
assert.equal(statistics.chunkCount, reader.chunkIndexes.length);
for (const { uncompressedSize } of reader.chunkIndexes) assert(uncompressedSize < 8n << 20n, 'a chunk is quick to fetch');
const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
stream.append(file);
let streamed = 0n;
for (let record = stream.nextRecord(); record; record = stream.nextRecord()) streamed += record.type === 'Message' ? 1n : 0n;
assert(stream.done());
assert.equal(streamed, statistics.messageCount);

// Every number of pose and wrench is the table's.
const lines = readFileSync(join(folder, 'export.csv'), 'utf8').trim().split('\n').map((line) => line.split(','));
const names = lines.shift()!;
const number = (row: string[], name: string): number => Number(row[names.indexOf(name)]);
type Pose = { pose: { position: Record<string, number>; orientation: Record<string, number> } };
const [ticks, tools, hands] = ['/tick', '/tool/pose', '/hand/pose'].map((topic) => messages.get(topic)!);
for (const list of [ticks, tools, hands]) assert.equal(list!.length, lines.length);
lines.forEach((row, n) => {
  for (const axis of ['x', 'y', 'z']) {
    assert.equal(ticks![n]![`force_${axis}_n`], number(row, `f${axis}_n`));
    assert.equal(ticks![n]![`torque_${axis}_nm`], number(row, `t${axis}_nm`));
    for (const [list, of] of [[tools, 'spo'], [hands, 'dev']] as const) assert.equal((list![n] as Pose).pose.position[axis], number(row, `${of}_p${axis}_m`));
  }
  for (const part of ['w', 'x', 'y', 'z'])
    for (const [list, of] of [[tools, 'spo'], [hands, 'dev']] as const) assert.equal((list![n] as Pose).pose.orientation[part], number(row, `${of}_q${part}`));
});

// The layout shows topics that there are.
const layout = JSON.parse(readFileSync(join(folder, 'export.layout.json'), 'utf8')) as { configById: Record<string, { topics?: Value }>; layout: unknown };
const topics = [...reader.channelsById.values()].map(({ topic }) => topic);
for (const topic of Object.keys(layout.configById['3D!bone']!.topics!)) assert(topics.includes(topic), topic);
const panels = JSON.stringify(layout.layout);
for (const panel of Object.keys(layout.configById)) assert(panels.includes(`"${panel}"`), panel);
console.log(`${streamed} messages of ${messages.size} topics, ${checkedTypes.size} published types, ${values} values`);
