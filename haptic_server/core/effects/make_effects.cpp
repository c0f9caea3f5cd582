#include "haptic_server/core/effects/make_effects.h"

#include "haptic_server/core/effects/add_material.h"
#include "haptic_server/core/effects/burr_vibration.h"
#include "haptic_server/core/effects/cutting_force.h"
#include "haptic_server/core/effects/energy_removal.h"
#include "haptic_server/core/effects/material_stiffness.h"
#include "haptic_server/core/effects/protected_structures.h"
#include "haptic_server/core/effects/spindle.h"
#include "haptic_server/core/effects/surface_friction.h"
#include "haptic_server/core/effects/thermal.h"
#include "haptic_server/core/effects/time_removal.h"
#include "haptic_server/core/effects/virtual_fixture.h"

namespace bonemill {

namespace {

using Made = std::unique_ptr<HapticEffect>;

// An effect may need this beside its own config.
struct Needs {
    const EffectConfigs& all;
    const BoneModel& bone;
    const EffectRoom& room;
};

Made make(const SpindleConfig& config, const Needs&) {
    return std::make_unique<Spindle>(config);
}
Made make(const MaterialStiffnessConfig&, const Needs& needs) {
    return std::make_unique<MaterialStiffness>(needs.all.properties, needs.all.materials,
                                               needs.bone.volume.spacing());
}
Made make(const EnergyRemovalConfig& config, const Needs& needs) {
    return std::make_unique<EnergyRemoval>(config, needs.all, needs.bone, needs.room);
}
Made make(const CuttingForceConfig& config, const Needs&) {
    return std::make_unique<CuttingForce>(config);
}
Made make(const SurfaceFrictionConfig& config, const Needs&) {
    return std::make_unique<SurfaceFriction>(config);
}
Made make(const BurrVibrationConfig& config, const Needs&) {
    return std::make_unique<BurrVibration>(config);
}
Made make(const VirtualFixtureConfig& config, const Needs& needs) {
    return std::make_unique<VirtualFixture>(config, needs.all.protected_field);
}
Made make(const TimeRemovalConfig& config, const Needs& needs) {
    return std::make_unique<TimeRemoval>(config, needs.bone, needs.room);
}
Made make(const AddMaterialConfig& config, const Needs& needs) {
    return std::make_unique<AddMaterial>(config, needs.bone, needs.room);
}
Made make(const ThermalConfig& config, const Needs& needs) {
    return std::make_unique<Thermal>(config, needs.bone, needs.room.dt);
}
Made make(const ProtectedStructuresConfig& config, const Needs& needs) {
    return std::make_unique<ProtectedStructures>(config, needs.all, needs.bone);
}

}  // namespace

EffectList makeEffects(const EffectConfigs& configs, const BoneModel& bone, const EffectRoom& room) {
    EffectList effects;
    forEachEffect(configs, [&](const auto& config) {
        if (config) effects.push_back(make(*config, {configs, bone, room}));
    });
    return effects;
}

}  // namespace bonemill
