// WebGL 2: the context, programs, and owners of what lies on the graphics card.

export type Gl = WebGL2RenderingContext;

export interface Canvas {
  gl: Gl;
  // The processor draws: every pixel is dear.
  isSoftware: boolean;
}

// The first look says who draws; the context that stays is made to suit it.
export function openCanvas(canvas: HTMLCanvasElement): Canvas | undefined {
  const probe = document.createElement('canvas').getContext('webgl2');
  if (!probe) return undefined;
  const info = probe.getExtension('WEBGL_debug_renderer_info');
  const name = String(probe.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : probe.RENDERER));
  probe.getExtension('WEBGL_lose_context')?.loseContext();
  const isSoftware = /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
  const gl = canvas.getContext('webgl2', {
    antialias: !isSoftware, alpha: false, depth: true, stencil: false, powerPreference: 'high-performance',
  });
  return gl ? { gl, isSoftware } : undefined;
}

export type UniformValue = number | readonly number[] | Float32Array;

export class Program {
  private readonly program: WebGLProgram;
  private readonly places = new Map<string, { place: WebGLUniformLocation; type: number }>();

  constructor(private readonly gl: Gl, name: string, vertex: string, fragment: string, defines: string[] = []) {
    const precise = ['float', 'int', 'sampler2D', 'sampler2DShadow', 'sampler3D'].map((type) => `precision highp ${type};\n`);
    const head = ['#version 300 es\n', ...precise, ...defines.map((word) => `#define ${word}\n`)].join('');
    this.program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]] as const) {
      const shader = gl.createShader(kind)!;
      gl.shaderSource(shader, head + source);
      gl.compileShader(shader);
      gl.attachShader(this.program, shader);
    }
    gl.linkProgram(this.program);
    if (!gl.getProgramParameter(this.program, gl.LINK_STATUS) && !gl.isContextLost()) {
      const logs = (gl.getAttachedShaders(this.program) ?? []).map((shader) => gl.getShaderInfoLog(shader));
      throw new Error(`${name}: ${gl.getProgramInfoLog(this.program)} ${logs.join(' ')}`);
    }
    const count = Number(gl.getProgramParameter(this.program, gl.ACTIVE_UNIFORMS));
    for (let i = 0; i < count; ++i) {
      const uniform = gl.getActiveUniform(this.program, i)!;
      const place = gl.getUniformLocation(this.program, uniform.name);
      if (place) this.places.set(uniform.name.replace('[0]', ''), { place, type: uniform.type });
    }
  }

  use(): this {
    this.gl.useProgram(this.program);
    return this;
  }

  // Uniforms that the program does not have are left out.
  set(values: Record<string, UniformValue>): this {
    const { gl } = this;
    for (const [name, value] of Object.entries(values)) {
      const uniform = this.places.get(name);
      if (!uniform) continue;
      const numbers = typeof value === 'number' ? [value] : value;
      switch (uniform.type) {
        case gl.FLOAT: gl.uniform1fv(uniform.place, numbers); break;
        case gl.FLOAT_VEC2: gl.uniform2fv(uniform.place, numbers); break;
        case gl.FLOAT_VEC3: gl.uniform3fv(uniform.place, numbers); break;
        case gl.FLOAT_VEC4: gl.uniform4fv(uniform.place, numbers); break;
        case gl.FLOAT_MAT4: gl.uniformMatrix4fv(uniform.place, false, numbers); break;
        default: gl.uniform1i(uniform.place, numbers[0]);
      }
    }
    return this;
  }
}

export function bindTexture(gl: Gl, unit: number, texture: WebGLTexture | null, kind: number = gl.TEXTURE_2D): number {
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(kind, texture);
  gl.activeTexture(gl.TEXTURE0);
  return unit;
}

// Of four bytes, x fastest, and smooth between its samples.
export function makeVolumeTexture(gl: Gl, size: readonly [number, number, number], bytes: Uint8Array): WebGLTexture {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_3D, texture);
  gl.texImage3D(gl.TEXTURE_3D, 0, gl.RGBA8, ...size, 0, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
  for (const kind of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_3D, kind, gl.LINEAR);
  for (const kind of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R])
    gl.texParameteri(gl.TEXTURE_3D, kind, gl.CLAMP_TO_EDGE);
  gl.bindTexture(gl.TEXTURE_3D, null);
  return texture;
}

export function makeTexture(gl: Gl, format: number, width: number, height: number): WebGLTexture {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
  for (const kind of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, kind, gl.NEAREST);
  for (const kind of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, kind, gl.CLAMP_TO_EDGE);
  gl.bindTexture(gl.TEXTURE_2D, null);
  return texture;
}
