// What comes over the network is believed after this only: every number, list and text of a message, however deep, is
// within the bounds of its field's options (proto/bounds.proto), as in the native viewer (common/bounds).
import { fromBinary, getOption, hasOption, isFieldSet, type DescField, type DescMessage, type Message, type MessageShape, ScalarType } from '@bufbuild/protobuf';
import { bytes, items, payload as payloadBytes, shape, Shape } from '#proto/bounds_pb';
import { range } from '#proto/scene_values_pb';
import { demand, kLargestNumber, kUnitTolerance, shownText } from './checks';

interface Rule {
  field: DescField;
  isAlwaysThere: boolean;
  low: number;
  high: number;
  items: number;
  bytes: number;
  areBytesBounded: boolean;
  shape: Shape;
}

const kImplicit = 2;  // FeatureSet_FieldPresence.IMPLICIT of the runtime's descriptors
const rules = new Map<DescMessage, Rule[]>();

function ruleOf(field: DescField): Rule {
  const has_range = hasOption(field, range), given = getOption(field, range);
  const free = field.scalar === ScalarType.DOUBLE || field.scalar === ScalarType.FLOAT ? kLargestNumber : Infinity;
  return {
    field,
    isAlwaysThere: field.presence === kImplicit,
    low: has_range ? given.min : -free,
    high: has_range ? given.max : free,
    items: field.parent.file.proto.package === 'bonemill.scene' ? Infinity : getOption(field, items),
    bytes: getOption(field, bytes),
    areBytesBounded: hasOption(field, bytes),
    shape: getOption(field, shape),
  };
}

function rulesOf(type: DescMessage): Rule[] {
  const known = rules.get(type) ?? type.fields.map(ruleOf);
  rules.set(type, known);
  return known;
}

// Returns it with a text that stands on a screen.
function checkedValue(rule: Rule, value: unknown): unknown {
  const { field } = rule, name = `${field.parent.name}.${field.name}`;
  if (field.message) check(field.message, value as Message);
  if (field.enum && rule.shape === Shape.DECLARED) demand(field.enum.value[value as number] !== undefined, name);
  if (typeof value === 'number' || typeof value === 'bigint') demand(Number(value) >= rule.low && Number(value) <= rule.high, name);
  if (value instanceof Uint8Array) demand(!rule.areBytesBounded || value.length <= rule.bytes, name);
  if (typeof value !== 'string') return value;
  if (rule.shape === Shape.ID) demand(value !== '' && value.length <= rule.bytes, name);
  return shownText(value, rule.bytes);
}

function demandShape({ field, shape: wanted }: Rule, list: unknown[]): void {
  const is_none = list.length === 0 && (wanted === Shape.VECTOR_OR_NONE || wanted === Shape.QUATERNION_OR_NONE);
  if (is_none || wanted === Shape.ANY) return;
  const is_vector = wanted === Shape.VECTOR || wanted === Shape.VECTOR_OR_NONE;
  demand(list.length === (is_vector ? 3 : 4), `${field.parent.name}.${field.name}`);
  if (!is_vector) demand(Math.abs(Math.hypot(...(list as number[])) - 1) < kUnitTolerance, `${field.name} of length 1`);
}

function check(type: DescMessage, message: Message): void {
  const values = message as unknown as Record<string, never>;
  for (const rule of rulesOf(type)) {
    const { field } = rule;
    if (!rule.isAlwaysThere && !isFieldSet(message, field)) continue;
    const [holder, name] = field.oneof ? [values[field.oneof.localName], 'value'] : [values, field.localName];
    if (field.fieldKind !== 'list') {
      holder[name] = checkedValue(rule, holder[name]) as never;
      continue;
    }
    const list = holder[name] as unknown[];
    demand(list.length <= rule.items, `${field.parent.name}.${field.name}`);
    demandShape(rule, list);
    for (let i = 0; i < list.length; ++i) list[i] = checkedValue(rule, list[i]);
  }
}

// Throws Malformed, or what the decoder throws.
export function read<Type extends DescMessage>(type: Type, payload: Uint8Array): MessageShape<Type> {
  demand(payload.length <= getOption(type, payloadBytes), `${type.name} is too long`);
  const message = fromBinary(type, payload);
  check(type, message);
  return message;
}
