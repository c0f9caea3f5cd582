// The faint mottling of bone, of the native viewer's bone shader: there the graphics card makes it per pixel; here it
// is made once per vertex, which are finer than its grain, so that it costs nothing when a picture is drawn.

function hash(x: number, y: number, z: number): number {
  let h = Math.imul(x, 0x8da6b343) ^ Math.imul(y, 0xd8163841) ^ Math.imul(z, 0xcb1ab31f);
  h = Math.imul(h ^ (h >>> 15), 0x2c1b3c6d);
  h = Math.imul(h ^ (h >>> 12), 0x297a2d39);
  return ((h ^ (h >>> 15)) >>> 0) / 0x100000000;
}

function valueNoise(x: number, y: number, z: number): number {
  const i = Math.floor(x), j = Math.floor(y), k = Math.floor(z);
  const soft = (t: number) => t * t * (3 - 2 * t);
  const fx = soft(x - i), fy = soft(y - j), fz = soft(z - k);
  const along = (b: number, c: number) => {
    const low = hash(i, b, c);
    return low + (hash(i + 1, b, c) - low) * fx;
  };
  const sheet = (c: number) => {
    const low = along(j, c);
    return low + (along(j + 1, c) - low) * fy;
  };
  const low = sheet(k);
  return low + (sheet(k + 1) - low) * fz;
}

// 0 to 1; in metres.
export function mottlingAt(x: number, y: number, z: number, grain: number): number {
  const s = 1 / grain, fine = 2.7 / grain;
  return 0.65 * valueNoise(x * s, y * s, z * s) + 0.35 * valueNoise(x * fine + 11, y * fine + 11, z * fine + 11);
}
