// The mouse holds the tool: cursor, wheel and keys say where the user wants it, and what the burr shall do; as
// render_client/hand/controls/tool_hold.cpp. The cursor moves the tool across the plane of the picture that goes through
// it, the wheel along the line of sight.
import {
  add, dot, multiplied, normalized, rotated, rotationBetween, rotationOf, scale, sub, unit, type Pose, type Vec3,
} from './math/linear';
import { rayThrough, type Camera } from './view/camera';

const kLeastDepth = 1e-3;  // m in front of the eye
const kBeginInFront = 3;  // burr radii from the surface to the burr's centre
const kLeastTowardsEye = 0.15;  // of the shaft's direction
const kHandAboveSight = 0.7;  // rad
const kDepthPerStep = 0.5;  // burr radii for one notch of the wheel
const kTurnPerHeight = 3.5;  // rad for a drag over the picture's height

export interface Look {
  camera: Camera;
  width: number;  // px
  height: number;
}

export interface Place {
  x: number;  // px
  y: number;
}

export class ToolHold {
  readonly keys = { mill: false, add: false, turn: false, clutch: false };
  readonly buttonsDown = { mill: false, add: false, turn: false };
  isHolding = false;
  wish: Pose = { p: [0, 0, 0], q: [1, 0, 0, 0] };
  private burrRadius = 1e-3;
  private comesToCursor = false;

  begin(X_WT: Pose, burr_radius: number, comes_to_cursor: boolean): void {
    this.wish = X_WT;
    this.burrRadius = burr_radius;
    this.comesToCursor = comes_to_cursor;
    this.releaseAll();
    this.isHolding = true;
  }

  letGo(): void {
    this.isHolding = false;
    this.releaseAll();
  }

  releaseAll(): void {
    for (const held of [this.keys, this.buttonsDown] as Record<string, boolean>[]) for (const key in held) held[key] = false;
  }

  get buttons(): number {
    if (this.buttonsDown.mill || this.keys.mill) return 1;
    return this.buttonsDown.add || this.keys.add ? 2 : 0;
  }

  get isTurning(): boolean {
    return this.buttonsDown.turn || this.keys.turn;
  }

  move(look: Look, from: Place, to: Place): void {
    if (!this.isHolding || this.keys.clutch) return;
    if (this.isTurning) this.turn(look, from, to);
    else this.follow(look, from, to);
  }

  moveAlongSight(look: Look, steps: number): void {
    const sight = normalized(sub(this.wish.p, look.camera.eye));
    const p = add(this.wish.p, scale(sight, steps * kDepthPerStep * this.burrRadius));
    if (depthOf(look.camera, p) > kLeastDepth) this.wish = { ...this.wish, p };
  }

  private follow(look: Look, from: Place, to: Place): void {
    const depth = Math.max(depthOf(look.camera, this.wish.p), kLeastDepth);
    const at = (place: Place) => pointAt(look, place, depth);
    const p = this.comesToCursor ? at(to) : add(this.wish.p, sub(at(to), at(from)));
    this.comesToCursor = false;
    this.wish = { ...this.wish, p };
  }

  // What the user sees of the tool's near side goes with the mouse.
  private turn(look: Look, from: Place, to: Place): void {
    const turn = add(scale(look.camera.right, to.y - from.y), scale(look.camera.up, to.x - from.x));
    this.wish = { ...this.wish, q: unit(multiplied(rotationOf(scale(turn, kTurnPerHeight / look.height)), this.wish.q)) };
  }
}

const depthOf = (camera: Camera, p: Vec3) => -dot(sub(p, camera.eye), camera.back);

export function pointAt(look: Look, place: Place, depth: number): Vec3 {
  const x = (2 * place.x) / look.width - 1, y = 1 - (2 * place.y) / look.height;
  return add(look.camera.eye, scale(rayThrough(look.camera, x, y, look.width / look.height), depth));
}

// Where a tool begins: on the line of sight of a point of the bone's surface, some burr radii in front of it. It stays
// turned as it is unless its shaft would then point into the picture, through the bone.
export function beginInFrontOf(surface: Vec3, camera: Camera, burr_radius: number, X_WT?: Pose): Pose {
  const to_eye = normalized(sub(camera.eye, surface));
  const p = add(surface, scale(to_eye, kBeginInFront * burr_radius));
  if (X_WT && dot(rotated(X_WT.q, [0, 1, 0]), to_eye) > kLeastTowardsEye) return { p, q: X_WT.q };
  const shaft = add(scale(to_eye, Math.cos(kHandAboveSight)), scale(camera.up, Math.sin(kHandAboveSight)));
  return { p, q: rotationBetween([0, 1, 0], shaft) };
}
