#include <algorithm>

#include "common/base/units.h"
#include "common/config/field_unit.h"
#include "common/config/scene_check.h"

namespace bonemill {
namespace {

// An effect of the tick needs this beside being listed, and others need this of it.
struct EffectRule {
    const char* name;
    bool needs_gradient_law = false;
    bool needs_speed = false;
    bool needs_ball = false;         // knows no other burr
    bool says_burrs_effort = false;  // how hard the burr works, which milling_sound makes heard
};
constexpr EffectRule kRules[] = {
    {.name = "energy_removal", .needs_gradient_law = true, .needs_speed = true, .says_burrs_effort = true},
    {.name = "cutting_force", .needs_gradient_law = true, .needs_speed = true, .says_burrs_effort = true},
    {.name = "spindle", .needs_gradient_law = true, .needs_speed = true, .says_burrs_effort = true},
    {.name = "burr_vibration", .needs_gradient_law = true, .needs_speed = true, .says_burrs_effort = true},
    {.name = "surface_friction", .needs_gradient_law = true},
    {.name = "thermal", .needs_gradient_law = true, .needs_speed = true, .says_burrs_effort = true},
    {.name = "virtual_fixture", .needs_gradient_law = true},
    {.name = "protected_structures", .needs_gradient_law = true},
    {.name = "time_removal", .needs_ball = true},
    {.name = "add_material", .needs_ball = true}};

bool isListed(const scene::Effects& effects, const std::string& name) {
    const auto* field = effects.GetDescriptor()->FindFieldByName(name);
    return field != nullptr && effects.GetReflection()->HasField(effects, field);
}

std::string pathOf(const std::string& effect) {
    return "effects." + effect;
}

bool isGradientLaw(const scene::Accuracy& accuracy) {
    if (accuracy.has_contact_law()) return accuracy.contact_law() == scene::Accuracy::GRADIENT;
    const auto preset = accuracy.preset();
    return preset == scene::Accuracy::FAST || preset == scene::Accuracy::BALANCED ||
           preset == scene::Accuracy::EXACT;
}

void checkLaw(const scene::Scene& scene, const RefuseField& refuse) {
    const char* effect = effectOfGradientLaw(scene.effects());
    if (effect == nullptr || isGradientLaw(scene.accuracy())) return;
    refuse(
        pathOf(effect),
        "needs the gradient contact law, and accuracy asks for another one: take the preset FAST, BALANCED "
        "or EXACT, or leave the effect out");
}

void checkSpeed(const scene::Scene& scene, const RefuseField& refuse) {
    for (const EffectRule& rule : kRules) {
        if (!rule.needs_speed || !isListed(scene.effects(), rule.name)) continue;
        if (scene.tool_size() == 0)
            refuse(pathOf(rule.name), "needs a tool that turns: list one in tool, with speed_rpm");
        for (int i = 0; i < scene.tool_size(); ++i)
            if (!scene.tool(i).has_speed_rpm())
                refuse("tool[" + std::to_string(i) + "].speed_rpm",
                       "is missing: " + pathOf(rule.name) + " needs it");
    }
}

void checkBallOnly(const scene::Scene& scene, const RefuseField& refuse) {
    for (const EffectRule& rule : kRules) {
        if (!rule.needs_ball || !isListed(scene.effects(), rule.name)) continue;
        for (int i = 0; i < scene.tool_size(); ++i)
            if (scene.tool(i).burr_kind() != scene::Tool::BALL)
                refuse("tool[" + std::to_string(i) + "].burr_kind",
                       "= " + scene::Tool::BurrKind_Name(scene.tool(i).burr_kind()) + " does not go with " +
                           pathOf(rule.name) + ", which knows only a BALL");
    }
}

void checkThermal(const scene::Scene& scene, const RefuseField& refuse) {
    if (!scene.effects().has_thermal()) return;
    const scene::Thermal& thermal = scene.effects().thermal();
    if (thermal.necrosis_temperature_c() <= thermal.body_temperature_c())
        refuse(pathOf("thermal") + ".necrosis_temperature_c",
               "= " + numberText(thermal.necrosis_temperature_c()) +
                   " is not above body_temperature_c = " + numberText(thermal.body_temperature_c()));
    // Explicit steps are stable up to a sixth of the time that heat takes through a cube.
    constexpr double kStable = 0.15;
    const double cell = thermal.cell_mm() * kMillimetre;
    const double longest = kStable * thermal.heat_capacity_j_per_cm3_k() * kPerCubicCentimetre * cell * cell /
                           thermal.conductivity_w_per_m_k();
    if (longest * scene.loop().rate_hz() < 1)
        refuse(pathOf("thermal") + ".cell_mm",
               "= " + numberText(thermal.cell_mm()) + " is too small: heat goes through such cubes within " +
                   "a tick of " + numberText(scene.loop().rate_hz()) + " Hz; take larger ones");
}

void checkSound(const scene::Scene& scene, const RefuseField& refuse) {
    if (!scene.effects().has_milling_sound()) return;
    for (const EffectRule& rule : kRules)
        if (rule.says_burrs_effort && isListed(scene.effects(), rule.name)) return;
    refuse(pathOf("milling_sound"),
           "would never hear the burr in bone: list spindle, cutting_force or energy_removal as well");
}

template <class Effect>
void checkMaterials(const std::string& name, const Effect& effect, const scene::Scene& scene,
                    const RefuseField& refuse) {
    for (int n = 0; n < effect.material_size(); ++n)
        if (std::ranges::none_of(scene.material(),
                                 [&](const auto& m) { return m.name() == effect.material(n); }))
            refuse(pathOf(name) + ".material[" + std::to_string(n) + "]",
                   "= \"" + effect.material(n) + "\" is no material of this scene");
}

void checkPulse(const scene::Scene& scene, const RefuseField& refuse) {
    if (!scene.effects().has_pulse()) return;
    const scene::Pulse& pulse = scene.effects().pulse();
    if (pulse.material_size() == 0)
        refuse(pathOf("pulse") + ".material", "is missing: name the protected materials that pulsate");
    checkMaterials("pulse", pulse, scene, refuse);
    for (int n = 0; n < pulse.material_size(); ++n)
        if (std::ranges::any_of(scene.material(), [&](const auto& m) {
                return m.name() == pulse.material(n) && !m.is_protected();
            }))
            refuse(pathOf("pulse") + ".material[" + std::to_string(n) + "]",
                   "= \"" + pulse.material(n) + "\" is not protected: only structures pulsate");
}

void checkTraces(const scene::Scene& scene, const RefuseField& refuse) {
    const scene::Effects& effects = scene.effects();
    if (effects.has_browning() && !effects.has_thermal())
        refuse(pathOf("browning"), "would never see hot bone: list thermal as well");
    const scene::Browning& browning = effects.browning();
    if (browning.brown_from_c() >= browning.charred_from_c())
        refuse(pathOf("browning") + ".brown_from_c",
               "= " + numberText(browning.brown_from_c()) +
                   " is not below charred_from_c = " + numberText(browning.charred_from_c()));
    if (effects.has_bruising() && !effects.has_protected_structures())
        refuse(pathOf("bruising"), "would never see a touch: list protected_structures as well");
}

}  // namespace

const char* effectOfGradientLaw(const scene::Effects& effects) {
    for (const EffectRule& rule : kRules)
        if (rule.needs_gradient_law && isListed(effects, rule.name)) return rule.name;
    return nullptr;
}

void checkEffects(const scene::Scene& scene, const RefuseField& refuse) {
    checkLaw(scene, refuse);
    checkSpeed(scene, refuse);
    checkBallOnly(scene, refuse);
    checkMaterials("bleeding", scene.effects().bleeding(), scene, refuse);
    checkPulse(scene, refuse);
    checkThermal(scene, refuse);
    checkSound(scene, refuse);
    checkTraces(scene, refuse);
    if (scene.effects().has_time_removal() && scene.effects().has_energy_removal())
        refuse("effects.time_removal",
               "stands beside effects.energy_removal: bone goes by time or by energy, list one");
}

}  // namespace bonemill
