// What is to be known of each command, from the rows of proto/topics_commands.proto (as common/commands): build.mjs writes them.
import { kCommandRows } from '#proto/command_rows';
import { Role, type CommandOrder } from './messages';

export type CommandAction = CommandOrder['action'];

interface Form {
  kind?: string;
  value?: number;
  order: string;
}

export interface CommandRow {
  mayOperator?: boolean;
  mayExaminer?: boolean;
  isLong?: boolean;
  forms: Form[];
}

export const rowOf = (action: CommandAction): CommandRow => kCommandRows[action];

export function mayOrder(role: Role, action: CommandAction): boolean {
  const row = rowOf(action);
  return role === Role.Instructor || (role === Role.Operator && !!row.mayOperator) || (role === Role.Examiner && !!row.mayExaminer);
}
export const mayHoldTool = (role: Role) => mayOrder(role, 'selectTool');
export const mayPoint = (role: Role) => role === Role.Instructor;

// The number by which a form is found; of a text, whether there is any.
function numberOf(order: CommandOrder): number {
  if (order.action === 'addRemark') return order.note ? 1 : 0;
  const value = order.value ?? true;
  return typeof value === 'string' ? Number(value !== '') : Number(value);
}

export function orderText(order: CommandOrder): string {
  const number = numberOf(order), form = rowOf(order.action).forms.find((one) => (one.value ?? number) === number);
  const value = 'value' in order && typeof order.value === 'string' ? order.value : String(number + (form?.kind === 'TOOL' ? 1 : 0));
  return form?.order.replace('{}', value) ?? order.action;
}
