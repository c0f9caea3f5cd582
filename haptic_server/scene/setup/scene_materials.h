// Reads what a scene's materials, effects and tools ask of the tick's effects: what they are, and which voxel
// is of which material. It is for start-up only.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/config/scene_file.h"
#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/telemetry/effect_record.h"
#include "haptic_server/core/tool/burr.h"
#include "haptic_server/core/volume/bone_properties.h"
#include "haptic_server/core/volume/distance_field.h"
#include "haptic_server/core/volume/raw_volume.h"
#include "haptic_server/scans/densify/densify.h"

namespace bonemill {

Burr burrOf(const scene::Tool& tool);

// The configuration lacks what depends on the volume.
EffectConfigs effectConfigsOf(const scene::Scene& scene);

// This is what traces, reports and hashes hold of these effects.
RecordedEffects recordedEffectsOf(const scene::Effects& effects);

// Raw values of the scene become densities. Throws UserError for one that is none.
void mapRawValues(EffectConfigs& configs, const LoadedScene& loaded, const DensityMapping& mapping);

MaterialTable materialTableOf(const scene::Scene& scene);

std::vector<std::string> materialNamesOf(const scene::Scene& scene);

// Is a viewer to show some material in its colour?
bool wantsVertexMaterials(const scene::Scene& scene);

// Does anything in the scene ask what the scanned bone was made of?
bool wantsProperties(const scene::Scene& scene);

// One of each material; nothing where the label map has no colour for it.
using SegmentColors = std::vector<std::optional<Eigen::Vector3d>>;  // red, green, blue, 0 .. 1

// The protected structures as they were labelled, also beyond a region: what is drawn of them.
struct LabelledStructures {
    BoneProperties properties;  // without densities, on the labels' own voxels
    Eigen::Vector3d spacing;    // m, of those
    Pose X_VL;                  // the labels' frame in that of the bone that is milled
};

struct ScannedMaterials {
    std::vector<MaterialId> ids;  // of each raw voxel, x fastest; empty: the scene has no materials
    SegmentColors segment_colors;
    double label_edge = 0;  // m: the shortest of the label map's voxels; 0: there is none
    std::shared_ptr<const LabelledStructures> labelled;  // null: nothing is labelled beyond the bone
};

// Imports volume.label_path, and says it if its grid is another one. Throws UserError.
ScannedMaterials scannedMaterialsOf(const LoadedScene& loaded, const RawVolume& raw,
                                    std::vector<std::string>& remarks);

// As viewers show it: materials without a colour of their own have their segment's.
scene::Scene shownSceneOf(const scene::Scene& scene, const SegmentColors& colors);

// The field is null if no effect asks for it. Throws UserError if no voxel is of a protected material.
std::shared_ptr<const DistanceField> protectedFieldOf(const LoadedScene& loaded,
                                                      const BoneProperties& properties,
                                                      const Eigen::Vector3d& spacing);

}  // namespace bonemill
