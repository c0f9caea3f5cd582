// Why an order cannot be given, what is lost by it, and how a key makes one; as render_client/hand/controls/session_view.cpp.
import { readableText } from './shared/format';
import { tr } from './shared/language';
import { mayOrder, mayPoint, rowOf, type CommandAction } from './shared/commands';
import { Role, type CommandOrder } from './shared/messages';
import type { Session } from './session';

// Empty if it may. The server and the gateway ask for themselves.
export function whyNot(action: CommandAction, session: Session): string {
  if (!mayOrder(session.role, action)) {
    if (session.role === Role.Viewer) return tr('An observer only looks');
    if (rowOf(action).mayOperator) return tr('An examiner leaves bone and tool to others');
    return tr('Only an instructor may do this: {1}', rowOf(action).forms[0].order);
  }
  return session.isLive ? '' : tr('There is no server');
}

export function whyNotPoint(session: Session): string {
  return mayPoint(session.role) ? '' : tr('Only an instructor points');
}

export function whyNotHold(session: Session, now: number): string {
  const why = whyNot('selectTool', session);
  if (why) return why;
  const other = session.others(now).find((viewer) => viewer.isHolding);
  if (other) return other.name ? tr('{1} holds the tool', other.name) : tr('Another viewer holds the tool');
  const device = session.status?.device;
  if (device && device.kind !== kPointerDevice) return tr('{1} holds the tool', device.name || tr('The device'));
  return '';
}

// A scripted hand has done all of its script, and this viewer may take the tool over from it; empty if so.
export function whyNotTakeOver(session: Session): string {
  return whyNot('takeOver', session) || (session.status?.device?.script?.hasEnded ? '' : tr('no scripted hand has done all of its script'));
}
// The mouse that came in the place of a scripted hand is ours.
export function hasTakenOver(session: Session): boolean {
  const device = session.status?.device;
  return device?.kind === kPointerDevice && device.script?.takenOverBy === session.sender;
}
export const kPointerDevice = 6;  // DeviceKind::kPointer of common/device_messages

// A checkpoint has the bone as it is when just as much was removed until then.
export function unsavedWork(session: Session): string {
  const status = session.status;
  if (!status || status.removedMm3 === 0) return '';
  if (status.checkpoints.some((checkpoint) => checkpoint.removedMm3 === status.removedMm3)) return '';
  return tr('{1} are milled and in no checkpoint', readableText(status.removedMm3, ' mm³'));
}

// What is asked before something is lost; empty if nothing is.
export function questionBefore(order: CommandOrder, session: Session): string {
  if (order.action === 'shutDown') return tr('End the session for everyone? Checkpoints go with it: once more does it');
  if (order.action === 'eraseRemark') return order.value === 0 ? tr('Erase all notes and strokes? Once more does it') : '';
  const removed = session.status?.removedMm3 ?? 0;
  if (order.action === 'chooseScene')
    return removed > 0 ? tr('Change the scene? {1} are milled and go with this one: once more does it', readableText(removed, ' mm³')) : '';
  // A script does its own work again; that of who has taken over is lost.
  if (order.action === 'beginAgain' && (session.status?.device?.script?.takenOverBy ?? '0') === '0') return '';
  if (!['startAttempt', 'resetVolume', 'restoreCheckpoint', 'beginAgain'].includes(order.action)) return '';
  const lost = unsavedWork(session);
  if (!lost) return '';
  const what = order.action === 'startAttempt' ? tr('Start on whole bone?')
    : order.action === 'restoreCheckpoint' ? tr('Back to checkpoint {1}?', order.value) : tr('Put the bone back?');
  return tr('{1} {2}: once more does it, K saves them first', what, lost);
}

const kAskedMs = 6000;

// An order that loses something is given when it is asked for twice.
export class OrderDesk {
  private asked = '';
  private askedUntil = 0;

  constructor(
    private readonly session: Session,
    private readonly send: (order: CommandOrder) => void,
    private readonly say: (text: string, tone?: 'warning' | 'alarm') => void,
  ) {}

  give(order: CommandOrder): void {
    const why_not = whyNot(order.action, this.session);
    if (why_not) return this.say(why_not, 'warning');
    const question = questionBefore(order, this.session), key = JSON.stringify(order);
    const is_asked = key === this.asked && Date.now() < this.askedUntil;
    this.asked = '';
    if (!question || is_asked) return this.send(order);
    this.asked = key;
    this.askedUntil = Date.now() + kAskedMs;
    this.say(question, 'warning');
  }

  pauseOrGoOn(): void {
    this.give({ action: 'pauseMilling', value: !this.session.status?.isMillingPaused });
  }

  backToLastCheckpoint(): void {
    const last = this.session.status?.checkpoints.at(-1);
    if (last) this.give({ action: 'restoreCheckpoint', value: last.id });
    else this.say(tr('there is no checkpoint yet: {1} saves one', 'K'));
  }

  nextTool(): void {
    const count = this.session.scene?.toolNames.length ?? 0;
    if (count < 2) return this.say(tr('the scene has one tool only'));
    this.give({ action: 'selectTool', value: ((this.session.scene?.toolIndex ?? 0) + 1) % count });
  }

  // The one after the scene in force, of those that can be chosen.
  nextScene(): void {
    const { scenes = [], sceneId = '' } = this.session.lesson ?? {};
    const now = scenes.findIndex((scene) => scene.id === sceneId);
    const turned = [...scenes.slice(now + 1), ...scenes.slice(0, Math.max(now, 0))];
    const next = turned.find((scene) => !scene.problem);
    if (next) this.give({ action: 'chooseScene', value: next.id });
    else this.say(tr('there is no other scene to choose'));
  }

  stopAttempt(): void {
    if (this.session.lesson?.isRunning) this.give({ action: 'stopAttempt' });
    else this.say(tr('no attempt is under way'));
  }
}
