// Draws a picture: the layer of all that rests (bone, structures), kept while neither view nor bone changes, then tool
// and signs over it. Where the processor draws, a moving view has no ambient occlusion; that comes when it rests.
import background_fragment from '#shaders/background_fragment.glsl';
import composite_fragment from '#shaders/composite_fragment.glsl';
import copy_fragment from '#shaders/copy_fragment.glsl';
import full_screen_vertex from '#shaders/full_screen_vertex.glsl';
import occlusion_fragment from '#shaders/occlusion_fragment.glsl';
import pick_fragment from '#shaders/pick_fragment.glsl';
import tool_shadow_fragment from '#shaders/tool_shadow_fragment.glsl';
import { add, joined, matrixOf, normalized, product, scale, transformed, type Box, type Vec3 } from '../math/linear';
import { BonePainter } from './bone_painter';
import { cameraFromWorld, rayThrough } from './camera';
import { bindTexture, Program, type Canvas, type Gl } from './gl';
import { Layers } from './layers';
import { MarkerPainter } from './marker_painter';
import { makeFrame, type Frame, type PictureView } from './picture_view';
import { clipOfPart, grown, isLarge, partOf, type Part } from './picture_part';
import { ToolPainter } from './tool_painter';

const kOcclusionRadius = 0.1;  // of the bone's radius
const kOcclusionPicture = 0.06;  // of the picture's height, at most
const kFilterReach = 8;  // pixels that the composite's filter looks beyond

// What the layer depends on.
function keyOf(view: PictureView, frame: Frame, is_fine: boolean): string {
  const in_layer = view.opacity === undefined ? 0 : [view.X_WT, view.work];
  const looks = view.structures.map((look) => [look.id, look.colour]);
  return JSON.stringify([[...frame.clipFromModel], view.cuts, view.opacity ?? null, view.structureMode, looks, is_fine, in_layer]);
}

export class Renderer {
  readonly bonePainter: BonePainter;
  readonly toolPainter: ToolPainter;
  private readonly gl: Gl;
  private readonly isSoftware: boolean;
  private readonly layers: Layers;
  private readonly markers: MarkerPainter;
  private readonly background: Program;
  private readonly occlusion: Program;
  private readonly composite: Program;
  private readonly copy: Program;
  private readonly toolShadow: Program;
  private readonly pickProgram: Program;
  private readonly nothing: WebGLVertexArrayObject;
  private layerKey = '';
  private allChanged = true;
  private readonly glows = new Map<number, number>();  // of structures, as they were drawn last
  private last?: { frame: Frame; view: PictureView; aspect: number };

  constructor(canvas: Canvas) {
    const gl = (this.gl = canvas.gl);
    this.isSoftware = canvas.isSoftware;
    this.layers = new Layers(gl, canvas.isSoftware ? 1 : 4, !canvas.isSoftware);
    this.bonePainter = new BonePainter(gl, this.layers);
    this.toolPainter = new ToolPainter(gl);
    this.markers = new MarkerPainter(gl);
    const full = (name: string, fragment: string) => new Program(gl, name, full_screen_vertex, fragment);
    this.background = full('background', background_fragment);
    this.occlusion = full('occlusion', occlusion_fragment);
    this.composite = full('composite', composite_fragment);
    this.copy = full('copy', copy_fragment);
    this.toolShadow = full('tool shadow', tool_shadow_fragment);
    this.pickProgram = full('pick', pick_fragment);
    this.nothing = gl.createVertexArray();
  }

  // Structures or materials are no longer what they were; of nodes the bone's store knows.
  noteChange(): void {
    this.allChanged = true;
  }

  // Around nodes that came or went, and structures that glow differently; V.
  private takeChanged(view: PictureView): Box | undefined {
    const { bone } = this.bonePainter;
    let changed = bone.changed;
    bone.changed = undefined;
    for (const { id, glow } of view.structures) {
      const box = this.bonePainter.structureBox(id);
      if (box && this.glows.get(id) !== glow) changed = joined(changed, box);
      this.glows.set(id, glow);
    }
    return changed;
  }

  // `is_fine`: with all that makes a picture good. `is_moving`: the layer will not be seen again.
  draw(view: PictureView, width: number, height: number, is_fine: boolean, is_moving: boolean): void {
    const { gl } = this, aspect = width / height;
    const frame = makeFrame(view, aspect), key = keyOf(view, frame, is_fine);
    this.bonePainter.level = is_moving && !is_fine ? 'coarse' : 'indices';
    const changed = this.takeChanged(view);
    const is_new = this.layers.resize(width, height) || this.allChanged || key + is_moving !== this.layerKey;
    if (is_new || changed) this.drawLayer(frame, view, is_fine, is_new ? undefined : changed);
    this.layerKey = key + is_moving;
    this.allChanged = false;
    this.last = { frame, view, aspect };
    if (this.isSoftware && is_new && is_moving && !is_fine && !view.isEndoscope) {
      // The tool comes into the layer itself, which saves a copy; the layer is spoiled by it.
      this.drawOver(frame, view);
      this.layers.blit();
      this.layerKey = '';
      return;
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
    this.copyLayer(frame, view, is_fine, aspect);
    this.drawOver(frame, view);
  }

  private copyLayer(frame: Frame, view: PictureView, is_fine: boolean, aspect: number): void {
    const { gl } = this;
    gl.disable(gl.BLEND);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.ALWAYS);
    this.copy.use().set({
      colour_map: bindTexture(gl, 0, is_fine ? this.layers.shaded : this.layers.colour),
      depth_map: bindTexture(gl, 3, this.layers.depth),
      field_radius: view.isEndoscope ? 0.48 * Math.min(aspect, 1) : 0,
    });
    this.fullScreen();
    this.castToolShadow(frame, view);
    gl.depthFunc(gl.LESS);
    for (const unit of [0, 3]) bindTexture(gl, unit, null);
  }

  private drawOver(frame: Frame, view: PictureView): void {
    if (view.opacity === undefined) this.toolPainter.drawTool(frame, view);
    this.toolPainter.drawGhosts(frame, view);
    this.markers.draw(frame, view);
  }

  // The point of the bone (W) that was seen there last; both from -1 to 1, right and up.
  pick(x: number, y: number): Vec3 | undefined {
    if (!this.last || this.layers.width === 0) return undefined;
    const { gl } = this, { frame, view, aspect } = this.last;
    const texel = [(x * 0.5 + 0.5) * this.layers.width, (y * 0.5 + 0.5) * this.layers.height].map(Math.floor);
    if (texel[0] < 0 || texel[1] < 0 || texel[0] >= this.layers.width || texel[1] >= this.layers.height) return undefined;
    this.layers.beginPick();
    gl.disable(gl.DEPTH_TEST);
    this.pickProgram.use().set({ depth_map: bindTexture(gl, 3, this.layers.depth), at: texel });
    this.fullScreen();
    const bytes = new Uint8Array(4);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    bindTexture(gl, 3, null);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    const depth = (bytes[0] + (bytes[1] + bytes[2] / 255) / 255) / 255;
    if (depth >= 0.99999) return undefined;
    const [near, far] = frame.nearFar;
    const away = (2 * near * far) / (far + near - (2 * depth - 1) * (far - near));
    return add(view.camera.eye, scale(rayThrough(view.camera, x, y, aspect), away));
  }

  // Where only the bone in `changed` (V) is another one, the processor draws no more than the part of the picture with it.
  private drawLayer(frame: Frame, view: PictureView, is_fine: boolean, changed?: Box): void {
    const { gl, layers } = this, { width, height } = layers;
    let part = changed && this.isSoftware ? partOf(changed, frame.clipFromModel, width, height) : undefined;
    if (part && isLarge(part, width, height)) part = undefined;
    if (part && part.width * part.height === 0) return;
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LESS);
    gl.depthMask(true);
    this.bonePainter.bone_V = view.bone_V;
    this.bonePainter.drawShadow(frame);
    layers.beginLayer();
    this.limitTo(part);
    this.bonePainter.part = part && clipOfPart(part, width, height);
    gl.clearStencil(0);
    gl.stencilMask(0xff);
    gl.clear(gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT | gl.COLOR_BUFFER_BIT);
    gl.disable(gl.DEPTH_TEST);
    this.background.use();
    this.fullScreen();
    gl.enable(gl.DEPTH_TEST);
    this.bonePainter.draw(frame, view, () => this.toolPainter.drawTool(frame, view));
    this.bonePainter.part = undefined;
    layers.endLayer();
    if (is_fine) this.shade(frame, part);
    this.limitTo(undefined);
  }

  private limitTo(part: Part | undefined, share = 1): void {
    const { gl } = this;
    if (!part) return gl.disable(gl.SCISSOR_TEST);
    const x = Math.floor(part.x * share), y = Math.floor(part.y * share);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(x, y, Math.ceil((part.x + part.width) * share) - x, Math.ceil((part.y + part.height) * share) - y);
  }

  private shade(frame: Frame, part?: Part): void {
    const { gl, layers } = this, { width, height } = layers;
    const reach = Math.ceil(kOcclusionPicture * height) + kFilterReach, near = part && grown(part, reach, width, height);
    gl.disable(gl.DEPTH_TEST);
    const eye = { near_far: frame.nearFar, tangents: frame.tangents, depth_map: bindTexture(gl, 3, layers.depth) };
    layers.beginOcclusion();
    this.limitTo(near, 0.5);
    this.occlusion.use().set({ ...eye, radius: kOcclusionRadius * frame.boneRadius, max_radius: kOcclusionPicture });
    this.fullScreen();
    layers.beginShaded();
    this.limitTo(near && grown(near, kFilterReach, width, height));
    this.composite.use().set({
      ...eye,
      colour_map: bindTexture(gl, 0, layers.colour),
      occlusion_map: bindTexture(gl, 4, layers.occlusion),
      depth_tolerance: 0.5 * kOcclusionRadius * frame.boneRadius,
    });
    this.fullScreen();
    for (const unit of [0, 3, 4]) bindTexture(gl, unit, null);
    gl.enable(gl.DEPTH_TEST);
  }

  private castToolShadow(frame: Frame, view: PictureView): void {
    if (!view.X_WT || this.toolPainter.isEmpty || view.burrRadius <= 0) return;
    const { gl } = this, radius = view.burrRadius;
    const X_CT = product(cameraFromWorld(view.camera), matrixOf(view.X_WT));
    const length = Math.min(Math.max(this.toolPainter.length, 0.1 * radius), 5 * radius);
    const burr = transformed(X_CT, [0, 0, 0]), shaft = transformed(X_CT, [0, length, 0]), reach = 4 * radius;
    if (!this.scissorAround(frame, [burr, shaft].flatMap((p) => [p, add(p, scale(frame.keyDirection, -reach))]), 1.1 * radius + 0.1 * reach)) return;
    gl.depthMask(false);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.DST_COLOR, gl.ZERO);
    this.toolShadow.use().set({
      near_far: frame.nearFar, tangents: frame.tangents, depth_map: bindTexture(gl, 3, this.layers.depth),
      key_direction: normalized(frame.keyDirection), burr, shaft, radii: [radius, 0.5 * radius], reach,
    });
    this.fullScreen();
    gl.disable(gl.BLEND);
    gl.disable(gl.SCISSOR_TEST);
    gl.depthMask(true);
  }

  // Only the part of the picture with these points (C) and so many metres around them is drawn to.
  private scissorAround(frame: Frame, points: Vec3[], room: number): boolean {
    const { gl } = this, width = gl.drawingBufferWidth, height = gl.drawingBufferHeight;
    let box = [1, 1, -1, -1];
    for (const p of points)
      for (const away of [-p[2] - room, -p[2] + room]) {
        const depth = Math.max(away, frame.nearFar[0]);
        const [x, rx] = [p[0], room].map((n) => n / depth / frame.tangents[0]);
        const [y, ry] = [p[1], room].map((n) => n / depth / frame.tangents[1]);
        box = [Math.min(box[0], x - rx), Math.min(box[1], y - ry), Math.max(box[2], x + rx), Math.max(box[3], y + ry)];
      }
    const [x0, y0, x1, y1] = box.map((n) => Math.min(Math.max(n, -1), 1) * 0.5 + 0.5);
    if (x1 <= x0 || y1 <= y0) return false;
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(Math.floor(x0 * width), Math.floor(y0 * height), Math.ceil((x1 - x0) * width) + 1, Math.ceil((y1 - y0) * height) + 1);
    return true;
  }

  private fullScreen(): void {
    this.gl.bindVertexArray(this.nothing);
    this.gl.drawArrays(this.gl.TRIANGLES, 0, 3);
    this.gl.bindVertexArray(null);
  }
}
