// Draws on the bone: places under mouse or finger become a stroke, which is sent to everyone when it ends.
import { norm, sub, type Vec3 } from './math/linear';
import type { CommandOrder } from './shared/messages';
import type { Stage } from './stage';
import type { Place } from './tool_hold';

const kMostPoints = 300;
const kApartPx = 4;
const kColour = 0xffd23f;

// Every second point of a stroke that is too long.
export function thinned(points: Vec3[], most = kMostPoints): Vec3[] {
  let thin = points;
  while (thin.length > most) thin = thin.filter((_, i) => i % 2 === 0 || i === thin.length - 1);
  return thin;
}

export class StrokePen {
  private points: Vec3[] = [];
  private last: Place = { x: 0, y: 0 };

  constructor(private readonly stage: Stage, private readonly send: (order: CommandOrder) => void) {}

  move(at: Place, phase: 'begin' | 'move' | 'end'): void {
    if (phase === 'begin') this.points = [];
    const is_far = Math.hypot(at.x - this.last.x, at.y - this.last.y) >= kApartPx;
    if (phase === 'begin' || is_far) this.add(at);
    const points = thinned(this.points);
    this.stage.preview = phase === 'end' ? undefined : { points, colour: [1, 0.82, 0.25] };
    this.stage.invalidate();
    if (phase === 'end' && points.length > 1) this.send({ action: 'addRemark', note: '', points, colour: kColour });
  }

  private add(at: Place): void {
    this.last = at;
    const p = this.stage.pick(at);
    const before = this.points.at(-1);
    if (p && (!before || norm(sub(p, before)) > 0) && this.points.length < 8 * kMostPoints) this.points.push(p);
  }
}
