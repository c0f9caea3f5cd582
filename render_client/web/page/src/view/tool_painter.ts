// The tool, and its outline where the hand is and where an expert was.
import ghost_fragment from '#shaders/ghost_fragment.glsl';
import tool_fragment from '#shaders/tool_fragment.glsl';
import tool_vertex from '#shaders/tool_vertex.glsl';
import { matrixOf, norm, product, scale, type Mat4, type Pose, type Vec3 } from '../math/linear';
import type { ToolMesh } from '../shared/messages';
import { cameraFromWorld } from './camera';
import { Program, type Gl } from './gl';
import type { Frame, PictureView } from './picture_view';

// The burr has a light of its own while it works: orange where it removes, the brighter the harder it presses, blue
// where it adds.
const kFaintest = 0.35;
const kGlow: Record<PictureView['work'], Vec3> = { idle: [0, 0, 0], turning: [0, 0, 0], removing: [1.9, 0.3, 0.02], adding: [0.05, 0.75, 1.1] };

function glowOf({ work, load }: PictureView): Vec3 {
  return work === 'removing' ? scale(kGlow.removing, kFaintest + (1 - kFaintest) * load) : kGlow[work];
}

export class ToolPainter {
  reach = 0;  // m, of the farthest point from T's origin
  length = 0;  // m, along +y of T
  private count = 0;
  private readonly tool: Program;
  private readonly ghost: Program;
  private readonly layout: WebGLVertexArrayObject;
  private readonly buffers: WebGLBuffer[];

  constructor(private readonly gl: Gl) {
    this.tool = new Program(gl, 'tool', tool_vertex, tool_fragment);
    this.ghost = new Program(gl, 'ghost', tool_vertex, ghost_fragment);
    this.layout = gl.createVertexArray();
    this.buffers = [gl.createBuffer(), gl.createBuffer(), gl.createBuffer()];
    gl.bindVertexArray(this.layout);
    for (const i of [0, 1]) {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[i]);
      gl.enableVertexAttribArray(i);
      gl.vertexAttribPointer(i, 3, gl.FLOAT, false, 0, 0);
    }
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.buffers[2]);
    gl.bindVertexArray(null);
  }

  set(mesh: ToolMesh): void {
    const { gl } = this;
    gl.bindVertexArray(this.layout);
    for (const [i, data] of [mesh.vertices, mesh.normals].entries()) {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[i]);
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    }
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, mesh.indices, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    this.count = mesh.indices.length;
    this.reach = this.length = 0;
    for (let i = 0; i < mesh.vertices.length; i += 3) {
      this.reach = Math.max(this.reach, norm([mesh.vertices[i], mesh.vertices[i + 1], mesh.vertices[i + 2]]));
      this.length = Math.max(this.length, mesh.vertices[i + 1]);
    }
  }

  get isEmpty(): boolean {
    return this.count === 0;
  }

  drawTool(frame: Frame, view: PictureView): void {
    if (!view.X_WT || this.isEmpty) return;
    this.tool.use().set({
      camera_from_model: this.inCamera(view, view.X_WT),
      clip_from_camera: frame.clipFromCamera,
      key_direction: frame.keyDirection,
      light_reach: frame.lightReach,
      burr_radius: view.burrRadius,
      milling_glow: glowOf(view),
    });
    this.draw();
  }

  // They are seen through the bone too, but fainter there: the hand usually is inside when the tool is stopped at the
  // surface.
  drawGhosts(frame: Frame, view: PictureView): void {
    if (view.ghosts.length === 0 || this.isEmpty) return;
    const { gl } = this;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.enable(gl.CULL_FACE);
    gl.depthMask(false);
    this.ghost.use().set({ clip_from_camera: frame.clipFromCamera });
    for (const { X_WT, colour } of view.ghosts) {
      this.ghost.set({ camera_from_model: this.inCamera(view, X_WT), tint: colour });
      for (const [test, strength] of [[gl.GREATER, 0.6], [gl.LEQUAL, 0.8]] as const) {
        gl.depthFunc(test);
        this.ghost.set({ strength });
        this.draw();
      }
    }
    gl.depthFunc(gl.LESS);
    gl.depthMask(true);
    gl.disable(gl.CULL_FACE);
    gl.disable(gl.BLEND);
  }

  private inCamera(view: PictureView, X_WT: Pose): Mat4 {
    return product(cameraFromWorld(view.camera), matrixOf(X_WT));
  }

  private draw(): void {
    this.gl.bindVertexArray(this.layout);
    this.gl.drawElements(this.gl.TRIANGLES, this.count, this.gl.UNSIGNED_INT, 0);
    this.gl.bindVertexArray(null);
  }
}
