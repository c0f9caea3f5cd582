// What is drawn into before it comes onto the canvas: bone and all that rests, with its depth; the same with ambient
// occlusion; the shadow map. All of one size at a time.
import { makeTexture, type Gl } from './gl';
import { kShadowSize } from './picture_view';

export class Layers {
  width = 0;
  height = 0;
  colour!: WebGLTexture;
  depth!: WebGLTexture;
  shaded!: WebGLTexture;
  occlusion!: WebGLTexture;
  readonly shadow: WebGLTexture | null = null;
  private readonly drawn: WebGLFramebuffer;  // colour and depth textures
  private readonly sampled: WebGLFramebuffer;  // several samples per pixel
  private readonly shadedTarget: WebGLFramebuffer;
  private readonly occlusionTarget: WebGLFramebuffer;
  private readonly shadowTarget: WebGLFramebuffer | null = null;
  private readonly pickTarget: WebGLFramebuffer;
  private buffers: WebGLRenderbuffer[] = [];

  constructor(private readonly gl: Gl, private readonly samples: number, has_shadow: boolean) {
    this.drawn = gl.createFramebuffer();
    this.sampled = gl.createFramebuffer();
    this.shadedTarget = gl.createFramebuffer();
    this.occlusionTarget = gl.createFramebuffer();
    this.pickTarget = gl.createFramebuffer();
    this.attach(this.pickTarget, makeTexture(gl, gl.RGBA8, 1, 1));
    if (!has_shadow) return;
    this.shadow = makeTexture(gl, gl.DEPTH_COMPONENT24, kShadowSize, kShadowSize);
    gl.bindTexture(gl.TEXTURE_2D, this.shadow);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_FUNC, gl.LEQUAL);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    this.shadowTarget = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowTarget);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.shadow, 0);
  }

  // True when the size is another one, and nothing is drawn in it.
  resize(width: number, height: number): boolean {
    if (width === this.width && height === this.height) return false;
    const { gl } = this;
    for (const old of [this.colour, this.depth, this.shaded, this.occlusion]) if (old) gl.deleteTexture(old);
    for (const old of this.buffers) gl.deleteRenderbuffer(old);
    this.buffers = [];
    this.width = width;
    this.height = height;
    this.colour = makeTexture(gl, gl.RGBA8, width, height);
    this.depth = makeTexture(gl, gl.DEPTH24_STENCIL8, width, height);
    this.shaded = makeTexture(gl, gl.RGBA8, width, height);
    this.occlusion = makeTexture(gl, gl.RGBA8, Math.ceil(width / 2), Math.ceil(height / 2));
    for (const texture of [this.colour, this.shaded]) {
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    }
    this.attach(this.drawn, this.colour);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_STENCIL_ATTACHMENT, gl.TEXTURE_2D, this.depth, 0);
    this.attach(this.shadedTarget, this.shaded);
    this.attach(this.occlusionTarget, this.occlusion);
    if (this.samples > 1) {
      gl.bindFramebuffer(gl.FRAMEBUFFER, this.sampled);
      for (const [format, place] of [[gl.RGBA8, gl.COLOR_ATTACHMENT0], [gl.DEPTH24_STENCIL8, gl.DEPTH_STENCIL_ATTACHMENT]]) {
        const buffer = gl.createRenderbuffer();
        gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
        gl.renderbufferStorageMultisample(gl.RENDERBUFFER, this.samples, format, width, height);
        gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
        this.buffers.push(buffer);
      }
    }
    return true;
  }

  beginLayer(): void {
    this.bind(this.samples > 1 ? this.sampled : this.drawn, this.width, this.height);
  }

  // From here on colour and depth can be read.
  endLayer(): void {
    if (this.samples <= 1) return;
    const { gl, width, height } = this;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.sampled);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, this.drawn);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT, gl.NEAREST);
  }

  // The layer becomes the canvas' picture, where both have one sample per pixel.
  blit(): void {
    const { gl, width, height } = this;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.drawn);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  beginShadow(): void {
    this.bind(this.shadowTarget, kShadowSize, kShadowSize);
  }
  beginOcclusion(): void {
    this.bind(this.occlusionTarget, Math.ceil(this.width / 2), Math.ceil(this.height / 2));
  }
  beginShaded(): void {
    this.bind(this.shadedTarget, this.width, this.height);
  }
  beginPick(): void {
    this.bind(this.pickTarget, 1, 1);
  }

  private bind(target: WebGLFramebuffer | null, width: number, height: number): void {
    this.gl.bindFramebuffer(this.gl.FRAMEBUFFER, target);
    this.gl.viewport(0, 0, width, height);
  }

  private attach(target: WebGLFramebuffer, texture: WebGLTexture): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
  }
}
