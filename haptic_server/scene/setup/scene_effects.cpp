#include "haptic_server/scene/setup/scene_effects.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/config/field_unit.h"
#include "haptic_server/scene/setup/scene_materials.h"

namespace bonemill {
namespace {

// Each reads what the scene says of one effect, if it lists it.

void read(const scene::Effects& effects, std::optional<SpindleConfig>& config) {
    constexpr double kTorquePerKrpm = kMillimetre / (1000 * kRpm);  // N·m·s/rad
    if (!effects.has_spindle()) return;
    const scene::Spindle& spindle = effects.spindle();
    config = {.inertia = spindle.inertia_kg_mm2() * kMillimetre * kMillimetre,
              .max_torque = spindle.max_torque_nmm() * kMillimetre,
              .droop = spindle.droop_nmm_per_krpm() * kTorquePerKrpm,
              .drag = spindle.drag_nmm_per_krpm() * kTorquePerKrpm};
}

void read(const scene::Effects&, std::optional<MaterialStiffnessConfig>&) {}  // The materials say it.

void read(const scene::Effects& effects, std::optional<EnergyRemovalConfig>& config) {
    if (!effects.has_energy_removal()) return;
    const scene::EnergyRemoval& removal = effects.energy_removal();
    config = {.specific_energy = removal.specific_energy_j_per_mm3() * kPerCubicMillimetre,
              .reference_density = kMaxDensity,
              .density_exponent = removal.density_exponent(),
              .threshold_pressure = removal.threshold_pressure_mpa() * kMega,
              .diamond_energy_factor = removal.diamond_energy_factor()};
}

void read(const scene::Effects& effects, std::optional<CuttingForceConfig>& config) {
    if (!effects.has_cutting_force()) return;
    config = {.slow_speed = effects.cutting_force().slow_speed_mm_per_s() * kMillimetre,
              .smoothing_time = effects.cutting_force().smoothing_time_ms() * kMillisecond};
}

void read(const scene::Effects& effects, std::optional<SurfaceFrictionConfig>& config) {
    if (!effects.has_surface_friction()) return;
    const scene::SurfaceFriction& friction = effects.surface_friction();
    config = {.coefficient = friction.coefficient(),
              .presliding_stiffness = friction.presliding_stiffness_n_per_mm() / kMillimetre};
}

void read(const scene::Effects& effects, std::optional<BurrVibrationConfig>& config) {
    if (!effects.has_burr_vibration()) return;
    config = {.amplitude_per_force = effects.burr_vibration().amplitude_per_force(),
              .max_amplitude = effects.burr_vibration().max_amplitude_n(),
              .diamond_factor = effects.burr_vibration().diamond_factor()};
}

void read(const scene::Effects& effects, std::optional<VirtualFixtureConfig>& config) {
    if (!effects.has_virtual_fixture()) return;
    const scene::VirtualFixture& fixture = effects.virtual_fixture();
    config = {.distance = fixture.distance_mm() * kMillimetre,
              .stiffness = fixture.stiffness_n_per_mm() / kMillimetre,
              .max_force = fixture.max_force_n(),
              .hand_force_scale = fixture.hand_force_scale()};
}

void read(const scene::Effects& effects, std::optional<TimeRemovalConfig>& config) {
    if (effects.has_time_removal())
        config = {.rate = effects.time_removal().rate_density_per_s() * kDensityCountsPerUnit};
}

void read(const scene::Effects& effects, std::optional<AddMaterialConfig>& config) {
    if (effects.has_add_material())
        config = {.rate = effects.add_material().rate_density_per_s() * kDensityCountsPerUnit};
}

void read(const scene::Effects& effects, std::optional<ThermalConfig>& config) {
    if (!effects.has_thermal()) return;
    const scene::Thermal& thermal = effects.thermal();
    config = {.heat_share = thermal.heat_share(),
              .irrigation_radius = thermal.irrigation_radius_mm() * kMillimetre,
              .heat = {.cell = thermal.cell_mm() * kMillimetre,
                       .conductivity = thermal.conductivity_w_per_m_k(),
                       .heat_capacity = thermal.heat_capacity_j_per_cm3_k() * kPerCubicCentimetre,
                       .perfusion = thermal.perfusion_per_s(),
                       .body_temperature = thermal.body_temperature_c(),
                       .wet_transfer = thermal.irrigation_w_per_m2_k(),
                       .irrigation_temperature = thermal.irrigation_temperature_c(),
                       .dry_transfer = thermal.dry_w_per_m2_k(),
                       .necrosis_temperature = thermal.necrosis_temperature_c(),
                       .necrosis_time = thermal.necrosis_time_s()}};
}

void read(const scene::Effects& effects, std::optional<ProtectedStructuresConfig>& config) {
    if (effects.has_protected_structures())
        config = {.warning_distance = effects.protected_structures().warning_distance_mm() * kMillimetre};
}

EffectConfigs configsOf(const scene::Effects& effects) {
    EffectConfigs configs;
    forEachEffect(configs, [&](auto& config) { read(effects, config); });
    return configs;
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
    burr.speed = tool.speed_rpm() * kRpm;
    return burr;
}

EffectConfigs effectConfigsOf(const scene::Scene& scene) {
    EffectConfigs configs = configsOf(scene.effects());
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
    constexpr double kMostTimes = 1e6;
    const double times = std::pow(share, -removal.density_exponent());
    if (!(times <= kMostTimes && times >= 1 / kMostTimes))
        refuse(" lets bone of the window's upper end, " + numberText(mapping.high) + ", take " +
               numberText(times) +
               " times its energy; give a value nearer to that, or a lower density_exponent");
    configs.energy_removal->reference_density = share * kMaxDensity;
}

}  // namespace bonemill
