// How fast pictures come, and how coarse they have to be while the view moves so that they come fast enough.

const kRestMs = 220;  // a view that has not moved for so long rests
const kTooSlowMs = 32, kFastMs = 22;  // from picture to picture
const kPauseMs = 1000;  // between two moves
const kPerSecondMs = 1000;
// Of the pixels' rows and columns; few steps, for each of them is another canvas.
const kShares = [1, 0.8, 0.65, 0.5];

export class Pace {
  private times: number[] = [];
  private movedAt = -1e9;
  private changedAt = -1e9;
  private drawnAt = -1e9;  // what has come until then was seen
  private wasMoving = false;
  private level = 0;  // of kShares
  private isSlow: boolean;
  private balance = 0;

  constructor(is_software: boolean) {
    this.isSlow = is_software;
    this.level = is_software ? 2 : 0;
  }

  noteMove(now: number): void {
    this.movedAt = now;
  }
  noteChange(now: number): void {
    this.changedAt = now;
  }

  // A picture is drawn now: with all that makes it good, or with so much of the pixels' rows and columns.
  next(now: number): { isFine: boolean; isMoving: boolean; share: number } {
    // What is new since the picture before goes on, however long that picture took.
    const isNew = (at: number) => now - at < kRestMs || at > this.drawnAt;
    const step = now - (this.times.at(-1) ?? -1e9), isMoving = isNew(this.movedAt);
    if (isMoving && this.wasMoving && step < kPauseMs) this.adapt(step);
    const isFine = !this.isSlow || (!isMoving && !isNew(this.changedAt));
    this.times = [...this.times.filter((time) => now - time < kPerSecondMs), now];
    this.wasMoving = isMoving;
    this.drawnAt = Math.max(now, this.movedAt, this.changedAt);
    return { isFine, isMoving, share: isMoving && this.isSlow ? kShares[this.level] : 1 };
  }

  // When a coarse picture has to be drawn again, fine; 0: it is fine.
  restsIn(now: number): number {
    if (!this.isSlow) return 0;
    return Math.max(0, Math.max(this.movedAt, this.changedAt) + kRestMs + 10 - now);
  }

  rate(now: number): number {
    return this.times.filter((time) => now - time < kPerSecondMs).length;
  }

  private adapt(step: number): void {
    this.balance = Math.min(Math.max(this.balance + (step > kTooSlowMs ? 1 : step < kFastMs ? -0.5 : 0), -15), 10);
    if (this.balance >= 10) {
      this.isSlow = true;  // a hiccup is no slow machine
      this.level = Math.min(this.level + 1, kShares.length - 1);
      this.balance = 0;
    } else if (this.balance <= -15) {
      this.level = Math.max(this.level - 1, 0);
      this.balance = 0;
    }
  }
}
