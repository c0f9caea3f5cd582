// How a vertex looks by its material: as that does in the scene, or, where milling opened the bone, as fresh bone of it;
// as render_client/look/model/material_palette.cpp.
import type { Vec3 } from '../math/linear';
import { kMilledBit, type MaterialView } from '../shared/messages';
import { linearColour } from './structure_colours';

const kBoneDust: Vec3 = [0.84, 0.79, 0.7], kPaler = 0.5;
const kBloodshot: Vec3 = [0.42, 0.02, 0.02], kRedder = 0.92;

// Linear colour times alpha, alpha: four numbers for each of 256 vertex numbers.
export function vertexColours(materials: MaterialView[]): Float32Array {
  const texels = new Float32Array(4 * 256);
  materials.forEach(({ colour }, i) => {
    if (colour && i + 1 < kMilledBit) texels.set([...linearColour(colour), 1], 4 * (i + 1));
  });
  for (let n = 0; n < kMilledBit; ++n) {
    const is_cut = n > 0 && materials[n - 1]?.isProtected;
    const over = [...(is_cut ? kBloodshot : kBoneDust), 1], share = is_cut ? kRedder : kPaler;
    over.forEach((value, i) => (texels[4 * (n + kMilledBit) + i] = texels[4 * n + i] + share * (value - texels[4 * n + i])));
  }
  return texels;
}
