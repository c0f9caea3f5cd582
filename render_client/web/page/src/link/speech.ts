// What the page says, as the gateway's messages.
import { create, type MessageInitShape } from '@bufbuild/protobuf';
import { CommandSchema, type Command } from '#proto/topics_commands_pb';
import { HandPointerSchema, ViewerSchema } from '#proto/topics_people_pb';
import type { CameraWish, CommandOrder, ToLink } from '../shared/messages';

type Action = MessageInitShape<typeof CommandSchema>['action'];

function actionOf(order: CommandOrder): Action {
  if (order.action === 'addRemark')
    return { case: 'addRemark', value: { note: order.note, pointsM: order.points.flat(), color: order.colour } };
  return { case: order.action, value: order.value ?? true } as Action;
}

export function commandOf(order: CommandOrder, sequence: number): Command {
  return create(CommandSchema, { sequence, action: actionOf(order) });
}

function cameraOf(camera: CameraWish) {
  return {
    hasTarget: camera.target !== undefined,
    targetM: camera.target ? [...camera.target] : [],
    distanceM: camera.distance,
    azimuthRad: camera.azimuth,
    elevationRad: camera.elevation,
    up: camera.up ? [...camera.up] : [],
  };
}

export function announcementOf(message: ToLink & { kind: 'announce' }) {
  return create(ViewerSchema, {
    frameRateHz: message.frameRateHz,
    isComplete: message.isComplete,
    pointerM: message.pointer ? [...message.pointer] : [],
    isHolding: message.isHolding,
    link: 'browser',
    camera: message.camera && cameraOf(message.camera),
  });
}

// Where the mouse wants the tool: with every picture, and again while pictures are slow; that it has let go, for half a
// second (render_client/link/subscribe/viewer_voice.h).
const kRepeatMs = 50, kLongestPictureMs = 1000, kFarewellMs = 500;

export class HandSpeaker {
  private message?: MessageInitShape<typeof HandPointerSchema>;
  private said = 0;
  private sequence = 0;
  private timer?: ReturnType<typeof setInterval>;

  constructor(private readonly write: (value: MessageInitShape<typeof HandPointerSchema>) => void) {}

  say(hand: ToLink & { kind: 'hand' }, epoch: bigint): void {
    this.message = hand.isHolding
      ? { epoch, pWTM: [...hand.p], qWT: [...hand.q], buttons: hand.buttons, isHolding: true }
      : { epoch, isHolding: false };
    this.said = Date.now();
    this.speak();
    this.timer ??= setInterval(() => this.speak(), kRepeatMs);
  }

  private speak(): void {
    if (!this.message) return;
    if (Date.now() - this.said > (this.message.isHolding ? kLongestPictureMs : kFarewellMs)) return;
    this.write({ ...this.message, sequence: ++this.sequence, stampNs: BigInt(Date.now()) * 1_000_000n });
  }
}
