// Signs in the picture: force arrow, pointers, the line to where a mouse wants the tool, strokes on the bone. After
// render_client/look/paint/marker_painter.cpp.
import marker_fragment from '#shaders/marker_fragment.glsl';
import marker_vertex from '#shaders/marker_vertex.glsl';
import { add, cross, norm, normalized, orthogonal, scale, sub, dot, type Vec3 } from '../math/linear';
import { Program, type Gl } from './gl';
import type { Frame, PictureView } from './picture_view';

const kSmallestForce = 0.05, kGreenForce = 0.2, kLargestForce = 20;  // N
const kShortest = 0.05, kLongest = 0.3;  // of the picture's height, as all sizes below
const kShaft = 0.006, kHead = 0.0155, kHeadLength = 0.04;
const kDot = 0.008, kRing = 0.022, kRingWidth = 0.0045, kGlow = 0.036;
const kPullLine = 0.0038, kPullRing = 0.014, kShortestPull = 0.006;
const kStroke = 0.003;
const kSides = 32;
const kHiddenStrength = 0.35;
const kPointerColour: Vec3 = [1, 0.16, 0.72], kIdlePullColour: Vec3 = [0.7, 0.75, 0.8];

type Colour = readonly [number, number, number, number];

const clamped = (x: number) => Math.min(Math.max(x, 0), 1);
const logarithmic = (value: number, low: number, high: number) => clamped(Math.log(value / low) / Math.log(high / low));

export interface ForceLook {
  length: number;  // in picture heights; 0: none
  colour: Vec3;
}

export function forceLook(newtons: number): ForceLook {
  if (!(newtons >= kSmallestForce) || !Number.isFinite(newtons)) return { length: 0, colour: [0, 0, 0] };
  const heat = logarithmic(newtons, kGreenForce, kLargestForce);
  return {
    length: kShortest + (kLongest - kShortest) * logarithmic(newtons, kSmallestForce, kLargestForce),
    colour: [Math.min(2 * heat + 0.12, 1), Math.min(2 - 2 * heat, 1) * 0.85, 0.1],
  };
}

const withAlpha = (colour: Vec3, alpha: number): Colour => [colour[0], colour[1], colour[2], alpha];

export class MarkerPainter {
  private readonly program: Program;
  private readonly layout: WebGLVertexArrayObject;
  private readonly buffer: WebGLBuffer;
  private numbers: number[] = [];

  constructor(private readonly gl: Gl) {
    this.program = new Program(gl, 'marker', marker_vertex, marker_fragment);
    this.layout = gl.createVertexArray();
    this.buffer = gl.createBuffer();
    gl.bindVertexArray(this.layout);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    [[3, 0], [3, 12], [4, 24]].forEach(([size, at], i) => {
      gl.enableVertexAttribArray(i);
      gl.vertexAttribPointer(i, size, gl.FLOAT, false, 40, at);
    });
    gl.bindVertexArray(null);
  }

  draw(frame: Frame, view: PictureView): void {
    const inCamera = (p_W: Vec3): Vec3 => {
      const d = sub(p_W, view.camera.eye);
      return [dot(d, view.camera.right), dot(d, view.camera.up), dot(d, view.camera.back)];
    };
    // The metres that the picture's height spans there.
    const heightAt = (p_C: Vec3) => 2 * frame.tangents[1] * -p_C[2];
    const isBefore = (p_C: Vec3) => -p_C[2] > frame.nearFar[0];
    for (const stroke of view.strokes) this.addStroke(stroke.points.map(inCamera), withAlpha(stroke.colour, 1), heightAt, isBefore);
    this.flush(frame, 0);
    const tool = view.X_WT && inCamera(view.X_WT.p), wish = view.wish && inCamera(view.wish);
    const pull = tool && wish && isBefore(tool) && isBefore(wish) && norm(sub(wish, tool)) > kShortestPull * heightAt(tool);
    const newtons = view.forceN ? norm(view.forceN) : 0, look = forceLook(newtons);
    const pullColour = look.length > 0 ? look.colour : kIdlePullColour;
    if (pull) {
      const radius = kPullLine * heightAt(wish);
      this.addCone(tool, sub(wish, tool), radius, radius, pullColour);
      this.flush(frame, this.gl.BACK);
    }
    if (tool && view.forceN && look.length > 0 && isBefore(tool)) {
      const axis = normalized(sub(inCamera(add(view.camera.eye, view.forceN)), inCamera(view.camera.eye)));
      this.addArrow(tool, axis, view.burrRadius, look, heightAt(tool));
      this.flush(frame, this.gl.BACK);
    }
    if (pull) this.addRing(wish, 0.6 * kPullRing * heightAt(wish), kPullRing * heightAt(wish), withAlpha(pullColour, 1), withAlpha(pullColour, 1));
    for (const p of view.pointers.map(inCamera)) if (isBefore(p)) this.addPointer(p, heightAt(p));
    this.flush(frame, 0);
  }

  private add(p: Vec3, n: Vec3, colour: Colour): void {
    this.numbers.push(...p, ...n, ...colour);
  }

  // The arrow starts at the burr's surface and points the way in which the force pushes the hand. Both parts are
  // convex: with the farther one drawn first, no depth has to be written.
  private addArrow(burr: Vec3, axis: Vec3, burr_radius: number, look: ForceLook, height: number): void {
    const head = Math.min(kHeadLength, 0.7 * look.length) * height, shaft = look.length * height - head;
    const base = add(burr, scale(axis, burr_radius)), neck = add(base, scale(axis, shaft));
    const parts = [
      () => {
        this.addDisc(base, scale(axis, -1), kShaft * height, look.colour);
        this.addCone(base, scale(axis, shaft), kShaft * height, kShaft * height, look.colour);
      },
      () => {
        this.addDisc(neck, scale(axis, -1), kHead * height, look.colour);
        this.addCone(neck, scale(axis, head), kHead * height, 0, look.colour);
      },
    ];
    if (dot(axis, neck) >= 0) parts.reverse();
    for (const part of parts) part();
  }

  private addCone(base: Vec3, axis: Vec3, low: number, high: number, colour: Vec3): void {
    const along = normalized(axis), right = orthogonal(along), up = cross(along, right);
    const slope = (low - high) / norm(axis);
    const at = (i: number, is_high: boolean) => {
      const angle = (2 * Math.PI * i) / kSides;
      const out = add(scale(right, Math.cos(angle)), scale(up, Math.sin(angle)));
      const p = add(is_high ? add(base, axis) : base, scale(out, is_high ? high : low));
      this.add(p, normalized(add(out, scale(along, slope))), withAlpha(colour, 1));
    };
    for (let i = 0; i < kSides; ++i)
      for (const [k, is_high] of [[i, false], [i + 1, false], [i + 1, true], [i, false], [i + 1, true], [i, true]] as const)
        at(k, is_high);
  }

  private addDisc(base: Vec3, axis: Vec3, radius: number, colour: Vec3): void {
    const right = orthogonal(axis), up = cross(axis, right);
    const at = (i: number) => {
      const angle = (2 * Math.PI * i) / kSides;
      return add(base, scale(add(scale(right, Math.cos(angle)), scale(up, Math.sin(angle))), radius));
    };
    for (let i = 0; i < kSides; ++i) for (const p of [base, at(i), at(i + 1)]) this.add(p, axis, withAlpha(colour, 1));
  }

  // The sign stands a little nearer than the surface that it marks, so that the surface's bends do not swallow it.
  private addPointer(p_C: Vec3, m: number): void {
    const p = scale(p_C, 1 - (kRing * m) / norm(p_C));
    const full = withAlpha(kPointerColour, 1);
    this.addRing(p, 0, kGlow * m, withAlpha(kPointerColour, 0.55), withAlpha(kPointerColour, 0));
    this.addRing(p, (kRing - kRingWidth) * m, kRing * m, full, full);
    this.addRing(p, 0, kDot * m, [1, 0.85, 0.97, 1], full);
  }

  private addRing(p: Vec3, inner: number, outer: number, inner_colour: Colour, outer_colour: Colour): void {
    const at = (i: number, is_outer: boolean) => {
      const angle = (2 * Math.PI * i) / kSides, r = is_outer ? outer : inner;
      this.add(add(p, [r * Math.cos(angle), r * Math.sin(angle), 0]), [0, 0, 0], is_outer ? outer_colour : inner_colour);
    };
    for (let i = 0; i < kSides; ++i)
      for (const [k, is_outer] of [[i, false], [i, true], [i + 1, true], [i, false], [i + 1, true], [i + 1, false]] as const)
        at(k, is_outer);
  }

  // A band that faces the eye, a little nearer than the bone on which it was drawn.
  private addStroke(points: Vec3[], colour: Colour, heightAt: (p: Vec3) => number, isBefore: (p: Vec3) => boolean): void {
    for (let i = 0; i + 1 < points.length; ++i) {
      if (!isBefore(points[i]) || !isBefore(points[i + 1])) continue;
      const [a, b] = [points[i], points[i + 1]].map((p) => scale(p, 1 - (3 * kStroke * heightAt(p)) / norm(p)));
      const side = normalized(cross(sub(b, a), a)), along = normalized(sub(b, a));
      const w = kStroke * heightAt(a), v = kStroke * heightAt(b);
      const low = add(a, scale(along, -0.5 * w)), high = add(b, scale(along, 0.5 * v));
      const corners = [add(low, scale(side, w)), add(low, scale(side, -w)), add(high, scale(side, -v)), add(high, scale(side, v))];
      for (const k of [0, 1, 2, 0, 2, 3]) this.add(corners[k], [0, 0, 0], colour);
    }
  }

  private flush(frame: Frame, culling: number): void {
    if (this.numbers.length === 0) return;
    const { gl } = this;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    if (culling) {
      gl.enable(gl.CULL_FACE);
      gl.cullFace(culling);
    }
    this.program.use().set({ clip_from_camera: frame.clipFromCamera });
    gl.bindVertexArray(this.layout);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(this.numbers), gl.STREAM_DRAW);
    for (const [test, strength] of [[gl.GREATER, kHiddenStrength], [gl.LEQUAL, 1]] as const) {
      gl.depthFunc(test);
      this.program.set({ strength });
      gl.drawArrays(gl.TRIANGLES, 0, this.numbers.length / 10);
    }
    gl.bindVertexArray(null);
    gl.depthFunc(gl.LESS);
    gl.depthMask(true);
    gl.disable(gl.CULL_FACE);
    gl.disable(gl.BLEND);
    this.numbers = [];
  }
}
