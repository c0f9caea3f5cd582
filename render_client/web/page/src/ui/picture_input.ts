// Mouse, pen and fingers on the picture. One finger or the left button does what the mode says, mostly orbit; two
// fingers zoom and pan; right, middle and shift + left drag pan; the wheel zooms; a double click or tap asks for another
// target. While the mouse holds the tool, moving, left, right and wheel are the tool's.
import type { Place } from '../tool_hold';
import type { DragMode } from '../view_settings';

export interface PictureActs {
  mode(): DragMode;
  isHolding(): boolean;
  orbit(right: number, down: number): void;  // px
  pan(right: number, down: number): void;  // px
  zoom(factor: number): void;
  target(at: Place): void;
  point(at: Place | undefined): void;
  stroke(at: Place, phase: 'begin' | 'move' | 'end'): void;
  note(at: Place): void;
  toolMove(from: Place, to: Place): void;
  toolButton(button: 'mill' | 'add' | 'turn', is_down: boolean): void;
  toolWheel(steps: number): void;
}

type Drag = 'orbit' | 'pan' | 'point' | 'stroke' | 'tool' | 'none';
const kTapPx = 9, kTapMs = 350, kDoubleMs = 400;

export class PictureInput {
  cursor: Place = { x: 0, y: 0 };
  pointsByKey = false;
  private readonly fingers = new Map<number, Place>();
  private drag: Drag = 'none';
  private begun: Place & { at: number } = { x: 0, y: 0, at: 0 };
  private lastTap: Place & { at: number } = { x: 0, y: 0, at: -1e9 };

  constructor(private readonly canvas: HTMLCanvasElement, private readonly acts: PictureActs) {
    canvas.addEventListener('pointerdown', (event) => this.onDown(event));
    canvas.addEventListener('pointermove', (event) => this.onMove(event));
    for (const end of ['pointerup', 'pointercancel'] as const) canvas.addEventListener(end, (event) => this.onUp(event));
    canvas.addEventListener('wheel', (event) => this.onWheel(event), { passive: false });
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  // Where on the canvas, in CSS pixels.
  private placeOf(event: MouseEvent): Place {
    const box = this.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  private onDown(event: PointerEvent): void {
    this.canvas.focus();
    const at = this.placeOf(event);
    try {
      this.canvas.setPointerCapture(event.pointerId);
    } catch {
      return;  // it is gone already
    }
    this.fingers.set(event.pointerId, at);
    if (this.fingers.size === 2) {
      this.endDrag(at, true);
      this.drag = 'none';  // two fingers pinch
      return;
    }
    if (this.fingers.size > 2) return;
    this.begun = { ...at, at: event.timeStamp };
    this.beginDrag(event, at);
  }

  private beginDrag(event: PointerEvent, at: Place): void {
    const is_left = event.button === 0, mode = this.acts.mode();
    if (this.acts.isHolding() && event.pointerType === 'mouse' && event.button !== 1 && !event.ctrlKey) {
      this.drag = 'tool';
      if (is_left) this.acts.toolButton(event.shiftKey ? 'add' : 'mill', true);
      else if (event.button === 2) this.acts.toolButton('turn', true);
    } else if (is_left && (event.ctrlKey || mode === 'point')) {
      this.drag = 'point';
      this.acts.point(at);
    } else if (is_left && mode === 'draw') {
      this.drag = 'stroke';
      this.acts.stroke(at, 'begin');
    } else {
      this.drag = is_left && !event.shiftKey ? 'orbit' : 'pan';
      if (event.button === 1 && !event.shiftKey && this.acts.isHolding()) this.drag = 'orbit';
    }
  }

  private onMove(event: PointerEvent): void {
    const at = this.placeOf(event), old = this.fingers.get(event.pointerId);
    const from = old ?? this.cursor;
    if (event.pointerType === 'mouse') this.cursor = at;
    if (this.fingers.size === 2 && old) return this.pinch(event.pointerId, old, at);
    if (old) this.fingers.set(event.pointerId, at);
    if (this.acts.isHolding() && (this.drag === 'tool' || !old)) this.acts.toolMove(from, at);
    if (this.pointsByKey) this.acts.point(at);
    if (!old) return;
    if (this.drag === 'orbit') this.acts.orbit(at.x - from.x, at.y - from.y);
    else if (this.drag === 'pan') this.acts.pan(at.x - from.x, at.y - from.y);
    else if (this.drag === 'point') this.acts.point(at);
    else if (this.drag === 'stroke') this.acts.stroke(at, 'move');
  }

  private pinch(id: number, old: Place, at: Place): void {
    const other = [...this.fingers].find(([finger]) => finger !== id)![1];
    const apart = (p: Place) => Math.hypot(p.x - other.x, p.y - other.y);
    if (apart(at) > 1 && apart(old) > 1) this.acts.zoom(apart(old) / apart(at));
    this.acts.pan((at.x - old.x) / 2, (at.y - old.y) / 2);
    this.fingers.set(id, at);
  }

  private onUp(event: PointerEvent): void {
    const at = this.placeOf(event);
    if (!this.fingers.delete(event.pointerId)) return;
    if (this.drag === 'tool') {
      if (event.button === 0) for (const one of ['mill', 'add'] as const) this.acts.toolButton(one, false);
      if (event.button === 2) this.acts.toolButton('turn', false);
      if (event.buttons !== 0 && event.type === 'pointerup') return;
    }
    const is_tap = Math.hypot(at.x - this.begun.x, at.y - this.begun.y) < kTapPx && event.timeStamp - this.begun.at < kTapMs;
    const drag = this.drag;
    this.endDrag(at, event.type === 'pointercancel');
    if (is_tap && this.fingers.size === 0 && (drag === 'orbit' || drag === 'pan')) this.tap(at, event.timeStamp);
  }

  private endDrag(at: Place, is_cancelled: boolean): void {
    if (this.drag === 'point') this.acts.point(undefined);
    if (this.drag === 'stroke' && !is_cancelled) this.acts.stroke(at, 'end');
    if (this.drag === 'tool') for (const one of ['mill', 'add', 'turn'] as const) this.acts.toolButton(one, false);
    this.drag = 'none';
  }

  private tap(at: Place, now: number): void {
    if (this.acts.mode() === 'note') return this.acts.note(at);
    const is_double = now - this.lastTap.at < kDoubleMs && Math.hypot(at.x - this.lastTap.x, at.y - this.lastTap.y) < 25;
    this.lastTap = { ...at, at: is_double ? -1e9 : now };
    if (is_double) this.acts.target(at);
  }

  private onWheel(event: WheelEvent): void {
    event.preventDefault();
    const notches = event.deltaMode === 0 ? event.deltaY / 100 : event.deltaMode === 1 ? event.deltaY / 3 : event.deltaY;
    const steps = Math.min(Math.max(notches, -3), 3);
    if (this.acts.isHolding()) this.acts.toolWheel(-steps);
    else this.acts.zoom(1.1 ** steps);
  }
}
