// Tells the others who is watching: about once per second, sooner when the view or the pointer moves.
import type { Session } from './session';
import type { Stage } from './stage';
import type { ToLink } from './shared/messages';
import type { ToolHold } from './tool_hold';

const kEveryMs = 1000, kViewMs = 200, kPointerMs = 33;

export class Announcer {
  private said = -1e9;
  private pointer = '';
  private camera = '';

  constructor(
    private readonly session: Session, private readonly stage: Stage, private readonly hold: ToolHold,
    private readonly tell: (message: ToLink) => void,
  ) {}

  step(now: number): void {
    if (this.session.connection.state !== 'open') return;
    const pointer = JSON.stringify(this.stage.ownPointer ?? null), camera = JSON.stringify(this.stage.orbit.wish());
    const wait = pointer !== this.pointer ? kPointerMs : camera !== this.camera ? kViewMs : kEveryMs;
    if (now - this.said < wait) return;
    this.said = now;
    this.pointer = pointer;
    this.camera = camera;
    this.tell({
      kind: 'announce', frameRateHz: this.stage.pace.rate(now), isComplete: this.session.isComplete,
      pointer: this.stage.ownPointer, isHolding: this.hold.isHolding,
      camera: this.session.scene ? this.stage.orbit.wish() : undefined,
    });
  }
}
