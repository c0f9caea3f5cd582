// The guest's orders, one after the other: each waits for its answer in the server's status.
import { rowOf } from '../shared/commands';
import type { CommandOrder, StatusView } from '../shared/messages';
import { trMark } from '../shared/language';

const kTimeoutMs = 5000;
const kLongTimeoutMs = 300_000;  // a scene that is read from a slow disk
const kRepeatAfterMs = 500;

interface Waiting {
  order: CommandOrder;
  sequence: number;
  started?: number;
  written?: number;
}

export interface Outcome {
  order: CommandOrder;
  isDone: boolean;
  result: string;
}

export class CommandOutbox {
  private readonly waiting: Waiting[] = [];
  // A guest that reloads the page is the same sender again, and the server ignores what is not beyond its last number:
  // so counting starts at the seconds of the clock.
  private last: number;

  constructor(now_ms = Date.now()) {
    this.last = Math.floor(now_ms / 1000) % 2 ** 31;
  }

  enqueue(order: CommandOrder): void {
    if (this.waiting.length < 64) this.waiting.push({ order, sequence: ++this.last });
  }

  answered(status: StatusView, sender: string): Outcome | undefined {
    const first = this.waiting[0];
    if (!first || status.lastCommandSender !== sender || status.lastCommandSequence !== first.sequence) return undefined;
    this.waiting.shift();
    return { order: first.order, isDone: status.isLastCommandDone, result: status.lastCommandResult || trMark('the server gave no result') };
  }

  // Writes the first one as often as it takes; returns one that nobody has answered in time.
  step(now: number, is_connected: boolean, write: (order: CommandOrder, sequence: number) => void): Outcome | undefined {
    const first = this.waiting[0];
    if (!first) return undefined;
    first.started ??= now;
    const is_long = first.written !== undefined && rowOf(first.order.action).isLong;
    if (now - first.started >= (is_long ? kLongTimeoutMs : kTimeoutMs)) {
      this.waiting.shift();
      return { order: first.order, isDone: false, result: first.written === undefined ? trMark('no server') : trMark('the server did not answer') };
    }
    if (!is_connected || (first.written !== undefined && now - first.written < kRepeatAfterMs)) return undefined;
    write(first.order, first.sequence);
    first.written = now;
    return undefined;
  }
}
