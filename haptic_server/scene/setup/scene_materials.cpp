#include "haptic_server/scene/setup/scene_materials.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "common/base/assert.h"
#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/config/field_unit.h"
#include "common/config/scene_geometry.h"
#include "common/config/scene_tools.h"
#include "haptic_server/assessment/measures/meters.h"
#include "haptic_server/core/effects/effect_figures.h"
#include "haptic_server/scans/densify/distance_transform.h"
#include "haptic_server/scans/densify/voxel_materials.h"
#include "haptic_server/scans/find_bone/bone_pieces.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/scans/labels/labels.h"
#include "haptic_server/scene/setup/refuse_field.h"

namespace bonemill {
namespace {

// What the scene says of one effect, if it lists it.
template <class Config>
void read(const scene::Effects& effects, std::optional<Config>& config) {
    const auto* const place = effects.GetDescriptor()->FindFieldByName(Config::kName);
    if (!place || !effects.GetReflection()->HasField(effects, place)) return;
    const google::protobuf::Message& message = effects.GetReflection()->GetMessage(effects, place);
    config.emplace();
    if constexpr (requires { Config::parameters(); })
        for (const auto& [name, set] : Config::parameters()) {
            const auto* const field = message.GetDescriptor()->FindFieldByName(name);
            BONEMILL_ASSERT(field);
            set(*config, message.GetReflection()->GetDouble(message, field));
        }
}

EffectConfigs configsOf(const scene::Effects& effects) {
    EffectConfigs configs;
    forEachEffect(configs, [&](auto& config) { read(effects, config); });
    return configs;
}

constexpr double kBeyondWarning = kMillimetre;  // m: so much farther a structure is still seen, and named

MaterialRule ruleOf(const scene::Material& material) {
    MaterialRule rule;
    rule.has_range = material.has_from_value() || material.has_below_value();
    if (material.has_from_value()) rule.from = material.from_value();
    if (material.has_below_value()) rule.below = material.below_value();
    rule.labels.assign(material.label().begin(), material.label().end());
    return rule;
}

std::optional<Eigen::Vector3d> colorOfSegment(const Segments& segments, const scene::Material& material) {
    for (const std::string& name : material.segment())
        for (const Segment& segment : segments.list)
            if (segment.name == name && segment.color) return segment.color;
    return std::nullopt;
}

// Adds the labels of the segments that the materials name.
void findSegments(const LoadedScene& loaded, const Segments& segments, std::vector<MaterialRule>& rules) {
    const std::string& file = loaded.scene.volume().label_path();
    for (int n = 0; n < loaded.scene.material_size(); ++n) {
        const scene::Material& material = loaded.scene.material(n);
        const std::string path = "material[" + std::to_string(n) + "]";
        if (segments.are_layered && material.label_size() > 0)
            refuseField(loaded, path + ".label[0]",
                        ": the labels of " + file + " lie in several layers; name its segments instead");
        for (int s = 0; s < material.segment_size(); ++s) {
            try {
                const auto labels = labelsOfSegment(segments, material.segment(s), file);
                rules[size_t(n)].labels.insert(rules[size_t(n)].labels.end(), labels.begin(), labels.end());
            } catch (const UserError& error) {
                refuseField(loaded, path + ".segment[" + std::to_string(s) + "]",
                            std::string(": ") + error.what());
            }
        }
    }
}

// Throws UserError that names the field.
RawVolume importLabels(const LoadedScene& loaded) {
    try {
        return importVolume(resolvePath(loaded, loaded.scene.volume().label_path()));
    } catch (const UserError& error) {
        refuseField(loaded, "volume.label_path", std::string(": ") + error.what());
    }
}

// What is measured near structures (near.force) knows how near the burr was.
double protectedReachOf(const scene::Scene& scene) {
    const scene::Effects& effects = scene.effects();
    double reach = DistanceBins::kLimits.back() * kPerMillimetre;
    if (effects.has_protected_structures())
        reach = std::max(reach, effects.protected_structures().warning_distance_mm());
    if (effects.has_virtual_fixture()) reach = std::max(reach, effects.virtual_fixture().distance_mm());
    double burr = 0;
    for (const scene::Tool* tool : toolsOf(scene))
        burr = std::max({burr, tool->burr_radius_mm(), tool->burr_tip_radius_mm()});
    return (reach + burr) * kMillimetre + kBeyondWarning;
}

std::string textOf(const ResampledLabels& labels, const VolumeGeometry& file, const std::string& label_path) {
    std::ostringstream text;
    text.precision(3);
    text << label_path << ": labels of " << edgesText(file.dims.cast<double>()) << " voxels of "
         << edgesText(file.spacing * kPerMillimetre) << " mm, resampled; they cover " << 100 * labels.covered
         << " % of the volume";
    return text.str();
}

// Labels of a region's scan go on beyond it.
std::shared_ptr<const LabelledStructures> labelledStructures(const LoadedScene& loaded,
                                                             const RawVolume& labels,
                                                             const std::vector<MaterialRule>& rules,
                                                             const Pose& X_VW) {
    const auto is_protected = [&](MaterialId id) {
        return id != kNoMaterial && loaded.scene.material(id - 1).is_protected();
    };
    if (!loaded.scene.volume().has_region() ||
        std::ranges::none_of(loaded.scene.material(), [](const auto& m) { return m.is_protected(); }))
        return nullptr;
    const std::vector<MaterialId> ids =
        resampleLabels(labels, rules, labels.geometry, loaded.scene.volume().label_path()).ids;
    const VoxelVolume empty(labels.geometry, kMaxDensity);
    BoneProperties properties(empty, [&](const Eigen::Vector3i& v) {
        const MaterialId id = ids[placeIn(labels.geometry.dims, v)];
        return is_protected(id) ? id : kNoMaterial;
    });
    return std::make_shared<const LabelledStructures>(
        LabelledStructures{std::move(properties), labels.geometry.spacing, X_VW * labels.geometry.X_WV});
}

}  // namespace

Burr burrOf(const scene::Tool& tool) {
    Burr burr;
    burr.kind = BurrKind(tool.burr_kind());
    burr.grit = BurrGrit(tool.burr_grit());
    burr.radius = tool.burr_radius_mm() * kMillimetre;
    burr.length = tool.burr_length_mm() * kMillimetre;
    burr.tip_radius = tool.burr_tip_radius_mm() * kMillimetre;
    burr.friction = tool.burr_friction();
    burr.rubbing_friction = tool.burr_rubbing_friction();
    burr.speed = tool.speed_rpm() * kRpm;
    return burr;
}

EffectConfigs effectConfigsOf(const scene::Scene& scene) {
    EffectConfigs configs = configsOf(scene.effects());
    const scene::Irrigation& irrigation = scene.effects().irrigation();
    if (configs.thermal && irrigation.has_nozzle_mm())
        configs.thermal->p_TN = metresOf(irrigation.nozzle_mm());
    configs.materials = materialTableOf(scene);
    if (std::ranges::any_of(configs.materials, [](const auto& m) { return m.stiffness_factor != 1; }))
        configs.material_stiffness.emplace();
    return configs;
}

RecordedEffects recordedEffectsOf(const scene::Effects& effects) {
    return recordedBy(configsOf(effects));
}

void mapRawValues(EffectConfigs& configs, const LoadedScene& loaded, const DensityMapping& mapping) {
    const scene::EnergyRemoval& removal = loaded.scene.effects().energy_removal();
    if (!configs.energy_removal || !removal.has_reference_value()) return;
    const double share = (removal.reference_value() - mapping.low) / (mapping.high - mapping.low);
    const auto refuse = [&](const std::string& why) {
        const std::string path = "effects.energy_removal.reference_value";
        throw UserError(placeOf(loaded.file.string(), loaded.lines, path) + "field `" + path +
                        "` = " + numberText(removal.reference_value()) + why);
    };
    if (!(share > 0))
        refuse(" is not above the lower end of the window, " + numberText(mapping.low) +
               ", which is no bone at all");
    constexpr double kMaxTimes = 1e6;
    const double times = std::pow(share, -removal.density_exponent());
    if (!(times <= kMaxTimes && times >= 1 / kMaxTimes))
        refuse(" lets bone of the window's upper end, " + numberText(mapping.high) + ", take " +
               numberText(times) +
               " times its energy; give a value nearer to that, or a lower density_exponent");
    configs.energy_removal->reference_density = share * kMaxDensity;
}

MaterialTable materialTableOf(const scene::Scene& scene) {
    MaterialTable table;
    if (scene.material_size() > 0) table.emplace_back();
    for (const scene::Material& material : scene.material())
        table.push_back({.stiffness_factor = material.stiffness_factor(),
                         .specific_energy = material.specific_energy_j_per_mm3() * kPerCubicMillimetre,
                         .is_protected = material.is_protected()});
    return table;
}

std::vector<std::string> materialNamesOf(const scene::Scene& scene) {
    std::vector<std::string> names;
    for (const scene::Material& material : scene.material()) names.push_back(material.name());
    return names;
}

bool wantsVertexMaterials(const scene::Scene& scene) {
    return scene.effects().bleeding().material_size() > 0 ||
           std::ranges::any_of(scene.material(), [](const scene::Material& m) { return m.has_color(); });
}

bool wantsProperties(const scene::Scene& scene) {
    const scene::Effects& effects = scene.effects();
    return scene.material_size() > 0 ||
           (effects.has_energy_removal() && effects.energy_removal().density_exponent() > 0);
}

ScannedMaterials scannedMaterialsOf(const LoadedScene& loaded, const RawVolume& raw,
                                    std::vector<std::string>& remarks) {
    if (loaded.scene.material_size() == 0) return {};
    std::vector<MaterialRule> rules;
    for (const scene::Material& material : loaded.scene.material()) rules.push_back(ruleOf(material));
    const std::string& label_path = loaded.scene.volume().label_path();
    if (label_path.empty()) return {materialIds(raw, rules), {}, 0, nullptr};
    const RawVolume file = importLabels(loaded);
    remarks.push_back(label_path + ": " + file.description);
    findSegments(loaded, file.segments, rules);
    ScannedMaterials materials;
    for (const scene::Material& material : loaded.scene.material())
        materials.segment_colors.push_back(colorOfSegment(file.segments, material));
    try {
        ResampledLabels labels = resampleLabels(file, rules, raw.geometry, label_path);
        if (!labels.is_exact) remarks.push_back(textOf(labels, file.geometry, label_path));
        materials.label_edge = file.geometry.spacing.minCoeff();
        materials.labelled = labelledStructures(loaded, file, rules, raw.geometry.X_WV.inverse());
        materials.ids = materialIds(raw, rules, std::move(labels.ids));
        return materials;
    } catch (const UserError& error) {
        refuseField(loaded, "volume.label_path", std::string(": ") + error.what());
    }
}

scene::Scene shownSceneOf(const scene::Scene& scene, const SegmentColors& colors) {
    scene::Scene shown = scene;
    for (size_t n = 0; n < colors.size(); ++n) {
        scene::Material& material = *shown.mutable_material(int(n));
        if (material.has_color() || !colors[n]) continue;
        material.mutable_color()->set_red(colors[n]->x());
        material.mutable_color()->set_green(colors[n]->y());
        material.mutable_color()->set_blue(colors[n]->z());
    }
    return shown;
}

std::shared_ptr<const DistanceField> protectedFieldOf(const LoadedScene& loaded,
                                                      const BoneProperties& properties,
                                                      const Eigen::Vector3d& spacing) {
    const scene::Effects& effects = loaded.scene.effects();
    if (!effects.has_protected_structures() && !effects.has_virtual_fixture()) return nullptr;
    std::shared_ptr<const DistanceField> field =
        protectedDistance(properties, materialTableOf(loaded.scene), spacing, protectedReachOf(loaded.scene));
    if (!field)
        refuseField(
            loaded,
            effects.has_protected_structures() ? "effects.protected_structures" : "effects.virtual_fixture",
            " finds nothing to protect: no voxel is of a material with is_protected; check its range or "
            "labels");
    return field;
}

}  // namespace bonemill
