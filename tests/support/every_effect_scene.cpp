#include "tests/support/every_effect_scene.h"

#include <fstream>

#include "common/base/units.h"
#include "common/config/viewer_effects.h"
#include "haptic_server/scans/nrrd/nrrd_writer.h"

namespace bonemill::test {
namespace {

constexpr double kFullValue = 2000, kAirValue = -1000;  // HU
constexpr double kFaceOffset = 0.3;                     // voxels: not in step with the grid

VolumeGeometry geometryOf(const EveryEffectBlock& block) {
    VolumeGeometry geometry;
    geometry.dims.setConstant(block.edge);
    geometry.spacing.setConstant(block.voxel_mm * kMillimetre);
    return geometry;
}

double heightOf(int k, const EveryEffectBlock& block) {
    return k - (block.edge / 2 + kFaceOffset);  // voxels above the face
}

template <class T, class ValueAt>
void write(const std::string& file, const EveryEffectBlock& block, ValueAt&& valueAt) {
    NrrdStream<T> stream(file, geometryOf(block));
    for (int k = 0; k < block.edge; ++k)
        stream.append(
            std::vector<T>(size_t(block.edge) * size_t(block.edge), T(valueAt(heightOf(k, block)))));
    stream.close();
}

}  // namespace

void writeBlock(const std::string& folder, const EveryEffectBlock& block) {
    write<int16_t>(folder + "/block.nrrd", block, [](double height) {
        return std::clamp(0.5 - height, 0.0, 1.0) * (kFullValue - kAirValue) + kAirValue;
    });
    write<uint8_t>(folder + "/labels.nrrd", block, [&](double height) {
        if (height > 0) return 0;
        return height * block.voxel_mm < -block.protected_depth_mm ? 2 : 1;
    });
}

scene::Scene everyEffectScene(const EveryEffectBlock& block, const std::string& law) {
    scene::Scene scene;
    scene.set_name("every effect");
    scene::Volume& volume = *scene.mutable_volume();
    volume.set_path("block.nrrd");
    volume.set_label_path("labels.nrrd");
    volume.set_window_low(kAirValue);
    volume.set_window_high(kFullValue);
    volume.set_iso_value((kAirValue + kFullValue) / 2);
    scene::Tool& tool = *scene.add_tool();
    tool.set_burr_radius_mm(block.burr_radius_mm);
    tool.set_speed_rpm(30000);
    scene::Material& bone = *scene.add_material();
    bone.set_name("bone");
    bone.add_label(1);
    scene::Material& nerve = *scene.add_material();
    nerve.set_name("nerve");
    nerve.add_label(2);
    nerve.set_is_protected(true);
    nerve.set_stiffness_factor(0.5);
    scene::Effects& effects = *scene.mutable_effects();
    for (const std::string& name : tickEffectNames())
        if (name == law || (name != kByTime && name != kByEnergy))
            effects.GetReflection()->MutableMessage(&effects, effects.GetDescriptor()->FindFieldByName(name));
    return scene;
}

void writeScene(const std::string& file, const scene::Scene& scene) {
    std::ofstream(file) << scene.DebugString();
}

std::vector<std::string> tickEffectNames() {
    std::vector<std::string> names;
    const auto& type = *scene::Effects::descriptor();
    for (int n = 0; n < type.field_count(); ++n)
        if (!isViewerEffect(*type.field(n))) names.push_back(type.field(n)->name());
    return names;
}

scene::Scene withoutEffect(scene::Scene scene, const std::string& name) {
    if (name == kMaterialStiffness) {
        for (scene::Material& material : *scene.mutable_material()) material.clear_stiffness_factor();
        return scene;
    }
    scene::Effects& effects = *scene.mutable_effects();
    effects.GetReflection()->ClearField(&effects, effects.GetDescriptor()->FindFieldByName(name));
    return scene;
}

}  // namespace bonemill::test
