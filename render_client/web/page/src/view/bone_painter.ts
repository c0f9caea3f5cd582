// Draws what rests while the camera does: bone with its cut faces, and protected structures. The order of passes is
// that of render_client/look/paint/bone_painter.cpp and structure_painter.cpp.
import bone_fragment from '#shaders/bone_fragment.glsl';
import cap_fragment from '#shaders/cap_fragment.glsl';
import depth_fragment from '#shaders/depth_fragment.glsl';
import full_screen_vertex from '#shaders/full_screen_vertex.glsl';
import mesh_vertex from '#shaders/mesh_vertex.glsl';
import structure_fragment from '#shaders/structure_fragment.glsl';
import type { MaterialView, StructureSurface } from '../shared/messages';
import { BoneStore, Chunk, type Level } from './bone_store';
import { frustumPlanes } from './camera';
import { bindTexture, makeTexture, makeVolumeTexture, Program, type Gl, type UniformValue } from './gl';
import type { Layers } from './layers';
import { shineUniforms, type NearStructures } from './near_structures';
import type { Frame, PictureView } from './picture_view';
import { vertexColours } from './vertex_colours';
import { product, type Box, type Mat4, type Vec3 } from '../math/linear';

const kGrain = 0.045;  // size of the mottling over the bone's radius
const kOpened = 0x80;  // stencil: the nearest surface is seen from within
const kLayers = 0x7f;  // stencil: how many front faces there are
const kFarWallOpacity = 0.28, kLastWallOpacity = 0.12, kWallOpacity = 0.45, kOutline = 0.8, kCapOpacity = 0.15, kBoxMargin = 0.01;
const kInsideSolid: Vec3 = [0.42, 0.16, 0.12], kInsideGlass: Vec3 = [0.85, 0.22, 0.1];
const kIdentity = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);

interface Programs {
  surface: Program;
  depth: Program;
  structure: Program;
}

export class BonePainter {
  readonly bone: BoneStore;
  trianglesDrawn = 0;
  level: Level = 'indices';
  // Only bone in this part of clip space has to be drawn; none: all that is seen.
  part?: Mat4;
  bone_V: Box = { low: [0, 0, 0], high: [0, 0, 0] };
  private readonly structures = new Map<number, Chunk>();
  private programs!: Record<'whole' | 'cut', Programs>;
  private hasColours = false;
  private hasMilled = false;
  // What shines through thin bone.
  private near?: { structures: NearStructures; texture: WebGLTexture };
  private shines = true;
  private readonly light: string[];
  private readonly cap: Program;
  private readonly palette: WebGLTexture;
  private readonly nothing: WebGLVertexArrayObject;

  private readonly made = new Map<string, Program>();

  constructor(private readonly gl: Gl, private readonly layers: Layers) {
    this.bone = new BoneStore(gl);
    this.light = layers.shadow ? ['SHADOW'] : [];
    this.makePrograms();
    this.cap = new Program(gl, 'cap', full_screen_vertex, cap_fragment, this.light);
    this.palette = makeTexture(gl, gl.RGBA32F, 256, 1);
    this.setMaterials([]);
    this.nothing = gl.createVertexArray();
  }

  // A way of looking that comes again is not compiled again.
  private programOf(name: string, vertex: string, fragment: string, words: string[]): Program {
    const key = [name, ...words].join(' ');
    const made = this.made.get(key) ?? new Program(this.gl, name, vertex, fragment, words);
    this.made.set(key, made);
    return made;
  }

  // One per way of looking, so that none does what is not asked for.
  private makePrograms(): void {
    const { light } = this;
    const looks = [
      ...(this.hasColours || this.hasMilled ? ['MATERIALS'] : []), ...(this.hasMilled ? ['MILLED'] : []),
      ...(this.near ? ['NEAR_STRUCTURES'] : []),
    ];
    const of = (words: string[]): Programs => ({
      surface: this.programOf('bone', mesh_vertex, bone_fragment, [...words, ...light, ...looks]),
      depth: this.programOf('bone depth', mesh_vertex, depth_fragment, words),
      structure: this.programOf('structure', mesh_vertex, structure_fragment, [...words, ...light]),
    });
    this.programs = { whole: of([]), cut: of(['CUT']) };
  }

  setMaterials(materials: MaterialView[]): void {
    const texels = vertexColours(materials), has_colours = materials.some(({ colour }) => colour);
    const has_changed = has_colours !== this.hasColours;
    this.hasColours = has_colours;
    if (has_changed) this.makePrograms();
    const { gl } = this;
    gl.bindTexture(gl.TEXTURE_2D, this.palette);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, 256, 1, gl.RGBA, gl.FLOAT, texels);
    gl.bindTexture(gl.TEXTURE_2D, null);
  }

  setStructure(id: number, surface?: StructureSurface): void {
    this.structures.get(id)?.free();
    this.structures.delete(id);
    if (!surface) return;
    const chunk = new Chunk(this.gl, surface.node.origin, surface.node.step);
    chunk.set(surface.node);
    this.structures.set(id, chunk);
  }

  // They shine through thin bone from now on; none: nothing does.
  setNear(structures: NearStructures | undefined): void {
    const { gl } = this, had = this.near;
    if (had) gl.deleteTexture(had.texture);
    this.near = structures && { structures, texture: makeVolumeTexture(gl, structures.size, structures.samples) };
    if (!had !== !this.near) this.makePrograms();
  }

  // V; none: there is no such structure.
  structureBox(id: number): Box | undefined {
    return this.structures.get(id);
  }

  clear(): void {
    this.bone.clear();
    for (const id of [...this.structures.keys()]) this.setStructure(id);
  }

  drawShadow(frame: Frame): void {
    if (!this.layers.shadow) return;
    const { gl } = this;
    this.layers.beginShadow();
    gl.clear(gl.DEPTH_BUFFER_BIT);
    const from_model = product(frame.shadowFromCamera, frame.X_CV);
    const program = this.begin(frame, 'depth', { camera_from_model: from_model, clip_from_camera: kIdentity });
    this.drawBone(frame, program, frustumPlanes(from_model));
  }

  // The framebuffer of the layer is bound, with background and clear depth and stencil. `draw_tool` draws what is to be
  // seen through transparent bone.
  draw(frame: Frame, view: PictureView, draw_tool: () => void): void {
    this.trianglesDrawn = 0;
    const has_milled = this.bone.hasMilled, has_changed = has_milled !== this.hasMilled;
    this.hasMilled = has_milled;
    if (has_changed) this.makePrograms();
    this.shines = view.structureMode !== 'off';
    if (view.opacity === undefined) this.drawOpaque(frame, view);
    else this.drawTransparent(frame, view, view.opacity, draw_tool);
  }

  private drawOpaque(frame: Frame, view: PictureView): void {
    const { gl } = this;
    if (frame.isCut) {
      this.beginMarking();
      this.drawSurface(frame, 1, 0, kInsideSolid);
      gl.depthFunc(gl.ALWAYS);  // at its rim the cap is as deep as the surface
      this.drawCap(frame, 1);
      gl.depthFunc(gl.LESS);
      gl.disable(gl.STENCIL_TEST);
    } else {
      // Bone that is whole and coarse shows no inside, and what faces away costs as much as what is seen.
      if (this.level === 'coarse') gl.enable(gl.CULL_FACE);
      this.drawSurface(frame, 1, 0, kInsideSolid);
      gl.disable(gl.CULL_FACE);
    }
    if (view.structureMode === 'behind') this.drawStructures(frame, view, true);
    if (view.structureMode !== 'off') this.drawStructures(frame, view, false);
  }

  private drawTransparent(frame: Frame, view: PictureView, opacity: number, draw_tool: () => void): void {
    const { gl } = this;
    this.drawFarWall(frame);
    if (frame.isCut) this.markOpened(frame);
    draw_tool();
    if (view.structureMode !== 'off') this.drawStructures(frame, view, false);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    this.drawInnerWall(frame);
    this.findNearestLayer(frame, gl.BACK);
    this.drawFoundLayer(frame, gl.BACK, opacity, kOutline);
    if (frame.isCut) {
      gl.enable(gl.STENCIL_TEST);
      gl.depthFunc(gl.LEQUAL);
      this.drawCap(frame, Math.min(opacity + kCapOpacity, 1));
      gl.depthFunc(gl.LESS);
      gl.disable(gl.STENCIL_TEST);
    }
    gl.disable(gl.BLEND);
  }

  // Draws the farthest front face where there is another one before it: the far wall of a cavity, or of the skull.
  // Leaves the depth clear, and in the stencil how many layers there are.
  private drawFarWall(frame: Frame): void {
    const { gl } = this;
    gl.clearDepth(0);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.clearDepth(1);
    gl.enable(gl.STENCIL_TEST);
    gl.stencilMask(kLayers);
    gl.stencilFunc(gl.ALWAYS, 0, 0xff);
    gl.stencilOp(gl.KEEP, gl.INCR, gl.INCR);
    gl.depthFunc(gl.GREATER);
    this.findNearestLayer(frame, gl.BACK);
    gl.stencilOp(gl.KEEP, gl.KEEP, gl.KEEP);
    gl.stencilMask(0xff);
    gl.stencilFunc(gl.LEQUAL, 2, kLayers);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    this.drawFoundLayer(frame, gl.BACK, kFarWallOpacity, 0);
    gl.disable(gl.BLEND);
    gl.disable(gl.STENCIL_TEST);
    gl.clear(gl.DEPTH_BUFFER_BIT);
  }

  // The wall is strong where it belongs to a cavity or something else is behind it: that is what one wants to see.
  private drawInnerWall(frame: Frame): void {
    const { gl } = this;
    this.findNearestLayer(frame, gl.FRONT);
    gl.enable(gl.STENCIL_TEST);
    gl.stencilFunc(gl.LEQUAL, 2, kLayers);
    this.drawFoundLayer(frame, gl.FRONT, kWallOpacity, kOutline);
    gl.stencilFunc(gl.GREATER, 2, kLayers);
    this.drawFoundLayer(frame, gl.FRONT, kLastWallOpacity, 0);
    gl.disable(gl.STENCIL_TEST);
  }

  private findNearestLayer(frame: Frame, culled: number): void {
    const { gl } = this;
    gl.enable(gl.CULL_FACE);
    gl.cullFace(culled);
    this.drawDepth(frame);
    gl.disable(gl.CULL_FACE);
  }

  private drawFoundLayer(frame: Frame, culled: number, opacity: number, outline: number): void {
    const { gl } = this;
    gl.enable(gl.CULL_FACE);
    gl.cullFace(culled);
    gl.depthFunc(gl.EQUAL);
    this.drawSurface(frame, opacity, outline, kInsideGlass);
    gl.depthFunc(gl.LESS);
    gl.cullFace(gl.BACK);
    gl.disable(gl.CULL_FACE);
  }

  private markOpened(frame: Frame): void {
    const { gl } = this;
    this.beginMarking();
    this.drawDepth(frame);
    gl.stencilOp(gl.KEEP, gl.KEEP, gl.KEEP);
    gl.stencilMask(0xff);
    gl.disable(gl.STENCIL_TEST);
    gl.clear(gl.DEPTH_BUFFER_BIT);
  }

  // From here on the stencil says which side of the nearest surface is seen.
  private beginMarking(): void {
    const { gl } = this;
    gl.enable(gl.STENCIL_TEST);
    gl.stencilMask(kOpened);
    gl.stencilFunc(gl.ALWAYS, kOpened, 0xff);
    gl.stencilOpSeparate(gl.FRONT, gl.KEEP, gl.KEEP, gl.ZERO);
    gl.stencilOpSeparate(gl.BACK, gl.KEEP, gl.KEEP, gl.REPLACE);
  }

  private drawCap(frame: Frame, opacity: number): void {
    const { gl } = this, margin = kBoxMargin * frame.boneRadius;
    gl.stencilFunc(gl.EQUAL, kOpened, kOpened);
    gl.stencilOp(gl.KEEP, gl.KEEP, gl.KEEP);
    gl.stencilMask(0xff);
    this.cap.use().set({
      ...this.lightOf(frame),
      cut_planes: frame.cuts_C,
      near_far: frame.nearFar,
      tangents: frame.tangents,
      model_from_camera: frame.X_VC,
      bone_low: this.bone_V.low.map((n) => n - margin),
      bone_high: this.bone_V.high.map((n) => n + margin),
      grain_size: kGrain * frame.boneRadius,
      opacity,
    });
    gl.bindVertexArray(this.nothing);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  private drawSurface(frame: Frame, opacity: number, outline: number, inside: Vec3): void {
    const { near, gl } = this;
    const program = this.begin(frame, 'surface', {
      ...this.lightOf(frame), opacity: [opacity, outline], inside_colour: inside,
      ...(near && shineUniforms(near.structures, this.shines)),
      ...(near && { near_structures: bindTexture(gl, 3, near.texture, gl.TEXTURE_3D) }),
    });
    this.drawBone(frame, program, this.planesOf(frame));
  }

  private planesOf(frame: Frame): number[][] {
    return frustumPlanes(this.part ? product(this.part, frame.clipFromModel) : frame.clipFromModel);
  }

  private drawDepth(frame: Frame): void {
    const { gl } = this;
    gl.colorMask(false, false, false, false);
    this.drawBone(frame, this.begin(frame, 'depth', {}), this.planesOf(frame));
    gl.colorMask(true, true, true, true);
  }

  private drawStructures(frame: Frame, view: PictureView, is_behind: boolean): void {
    const { gl } = this;
    if (this.structures.size === 0) return;
    const program = this.begin(frame, 'structure', { ...this.lightOf(frame), is_behind: is_behind ? 1 : 0 });
    if (is_behind) {
      gl.enable(gl.BLEND);
      gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
      gl.enable(gl.CULL_FACE);
      gl.depthMask(false);
      gl.depthFunc(gl.GREATER);
    }
    for (const look of view.structures) {
      const chunk = this.structures.get(look.id);
      if (!chunk) continue;
      program.set({ structure_colour: look.colour, glow: look.glow, origin: chunk.origin, step: chunk.step });
      this.trianglesDrawn += chunk.draw();
    }
    gl.depthFunc(gl.LESS);
    gl.depthMask(true);
    gl.disable(gl.CULL_FACE);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(null);
  }

  private begin(frame: Frame, what: keyof Programs, more: Record<string, UniformValue>): Program {
    const program = this.programs[frame.isCut ? 'cut' : 'whole'][what];
    return program.use().set({
      camera_from_model: frame.X_CV,
      clip_from_camera: frame.clipFromCamera,
      cut_planes: frame.cuts_V,
      palette: bindTexture(this.gl, 1, this.palette),
      ...more,
    });
  }

  private lightOf(frame: Frame): Record<string, UniformValue> {
    return {
      key_direction: frame.keyDirection,
      light_reach: frame.lightReach,
      clip_from_camera: frame.clipFromCamera,
      has_shadow: this.layers.shadow ? 1 : 0,
      shadow_map: this.layers.shadow ? bindTexture(this.gl, 2, this.layers.shadow) : 2,
      shadow_texel: frame.shadowTexel,
      shadow_from_camera: frame.shadowFromCamera,
    };
  }

  private drawBone(frame: Frame, program: Program, planes: number[][]): void {
    const eye_V: Vec3 = [frame.X_VC[12], frame.X_VC[13], frame.X_VC[14]];
    this.trianglesDrawn += this.bone.draw(program, planes, eye_V, this.level);
  }
}
