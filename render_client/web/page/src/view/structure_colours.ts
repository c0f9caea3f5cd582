// A structure's colour (sRGB): the scene's, or what its name asks for by the custom of anatomy books, or one of a row
// that people who see no red or no green can tell apart; as render_client/look/structures/structure_set.cpp.
import type { Vec3 } from '../math/linear';
import type { SceneView } from '../shared/messages';

const kNerve: Vec3 = [0.95, 0.85, 0.2], kVein: Vec3 = [0.1, 0.45, 0.85], kArtery: Vec3 = [0.84, 0.17, 0.12],
  kDura: Vec3 = [0.82, 0.64, 0.96];
const kCustom: [string, Vec3][] = [
  ['nerve', kNerve], ['chorda', kNerve], ['sinus', kVein], ['vein', kVein], ['jugular', kVein], ['arter', kArtery],
  ['carotid', kArtery], ['aorta', kArtery], ['vessel', kArtery], ['pulp', kArtery], ['dura', kDura], ['sac', kDura],
];
const kOthers: Vec3[] = [
  [0.9, 0.62, 0], [0.34, 0.71, 0.91], [0, 0.62, 0.45], [0.8, 0.47, 0.65], [0.84, 0.37, 0], [0, 0.45, 0.7],
];

export function structureColour(scene: SceneView, structure: number): Vec3 {
  const material = scene.materials[structure - 1];
  if (material?.colour) return material.colour;
  const name = material?.name.toLowerCase() ?? '';
  return kCustom.find(([word]) => name.includes(word))?.[1] ?? kOthers[structure % kOthers.length];
}

export const linearColour = (srgb: Vec3): Vec3 => [srgb[0] ** 2.2, srgb[1] ** 2.2, srgb[2] ** 2.2];
