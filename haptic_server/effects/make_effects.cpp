#include "haptic_server/effects/make_effects.h"

#include "haptic_server/effects/add_material.h"
#include "haptic_server/effects/burr_vibration.h"
#include "haptic_server/effects/cutting_force.h"
#include "haptic_server/effects/energy_removal.h"
#include "haptic_server/effects/material_stiffness.h"
#include "haptic_server/effects/protected_structures.h"
#include "haptic_server/effects/spindle.h"
#include "haptic_server/effects/surface_friction.h"
#include "haptic_server/effects/thermal.h"
#include "haptic_server/effects/time_removal.h"
#include "haptic_server/effects/virtual_fixture.h"

namespace bonemill {

EffectList makeEffects(const EffectConfigs& configs, const BoneModel& bone, const EffectRoom& room) {
    EffectList effects;
    if (configs.spindle) effects.push_back(std::make_unique<Spindle>(*configs.spindle));
    if (configs.material_stiffness)
        effects.push_back(std::make_unique<MaterialStiffness>(configs.properties, configs.materials,
                                                              bone.volume.spacing()));
    if (configs.energy_removal)
        effects.push_back(std::make_unique<EnergyRemoval>(*configs.energy_removal, configs, bone, room));
    if (configs.cutting_force) effects.push_back(std::make_unique<CuttingForce>(*configs.cutting_force));
    if (configs.surface_friction)
        effects.push_back(std::make_unique<SurfaceFriction>(*configs.surface_friction));
    if (configs.burr_vibration) effects.push_back(std::make_unique<BurrVibration>(*configs.burr_vibration));
    if (configs.virtual_fixture)
        effects.push_back(
            std::make_unique<VirtualFixture>(*configs.virtual_fixture, configs.protected_field));
    if (configs.time_removal)
        effects.push_back(std::make_unique<TimeRemoval>(*configs.time_removal, bone, room.largest_burr_radius,
                                                        room.most_cells));
    if (configs.add_material)
        effects.push_back(std::make_unique<AddMaterial>(*configs.add_material, bone, room.largest_burr_radius,
                                                        room.most_cells));
    if (configs.thermal) effects.push_back(std::make_unique<Thermal>(*configs.thermal, bone, room.dt));
    if (configs.protected_structures)
        effects.push_back(
            std::make_unique<ProtectedStructures>(*configs.protected_structures, configs, bone));
    return effects;
}

}  // namespace bonemill
