#include "tests/stability/variant.h"

#include <algorithm>

#include "haptic_server/laws/all_laws.h"
#include "tests/support/typical_effects.h"

namespace bonemill::test {
namespace {

constexpr uint32_t kPedal = kButtonRemove;
constexpr const char* kAllFelt = "all_felt";

struct NamedEffect {
    const char* name;
    bool mills, turns;  // turns: it is one of a burr that does
    void (*add)(EffectConfigs&);
};

// There is one line per effect.
constexpr NamedEffect kEffects[] = {
    {"spindle", false, true, [](EffectConfigs& e) { e.spindle = test::kSpindle; }},
    {"cutting_force", false, true, [](EffectConfigs& e) { e.cutting_force = test::kCuttingForce; }},
    {"surface_friction", false, false, [](EffectConfigs& e) { e.surface_friction = test::kSurfaceFriction; }},
    {"burr_vibration", false, true, [](EffectConfigs& e) { e.burr_vibration = test::kBurrVibration; }},
    {"thermal", false, true, [](EffectConfigs& e) { e.thermal = test::kThermal; }},
    {"material_stiffness", false, false, [](EffectConfigs& e) { e.material_stiffness.emplace(); }},
    // The fixture is so weak that the bone has the last word.
    {"virtual_fixture", false, false,
     [](EffectConfigs& e) {
         e.virtual_fixture = {.distance = 0.3e-3, .stiffness = 1000, .max_force = 0.1, .hand_force_scale = 1};
     }},
    {"energy_removal", true, true, [](EffectConfigs& e) { e.energy_removal = test::kEnergyRemoval; }},
};

void addFelt(EffectConfigs& configs) {
    for (const NamedEffect& effect : kEffects)
        if (!effect.mills) effect.add(configs);
}
void addAll(EffectConfigs& configs) {
    for (const NamedEffect& effect : kEffects) effect.add(configs);
}

bool isThesis(const FixedTickConfig& config) {
    return config.accuracy.law == ContactLaw::kThesis2012;
}

}  // namespace

const std::vector<Variant>& allVariants() {
    static const std::vector<Variant> kVariants = [] {
        std::vector<Variant> list;
        for (const Preset preset : kPresets) list.push_back({std::string(presetName(preset)), preset});
        return list;
    }();
    return kVariants;
}

bool Variant::isOtherLaw() const {
    return std::find(std::begin(kComparedLaws), std::end(kComparedLaws), preset) != std::end(kComparedLaws);
}

const std::vector<Variant>& lawVariants() {
    static const std::vector<Variant> kVariants = [] {
        std::vector<Variant> list;
        for (const Preset preset : kComparedLaws) list.push_back({std::string(presetName(preset)), preset});
        return list;
    }();
    return kVariants;
}

Names everyLaw() {
    Names names;
    for (const Variant& variant : lawVariants()) names.push_back(variant.name);
    return names;
}

const Variant& baselineVariant() {
    for (const Variant& variant : allVariants())
        if (variant.isBaseline()) return variant;
    return allVariants().front();
}

const std::vector<Variant>& effectVariants() {
    static const std::vector<Variant> kVariants = [] {
        std::vector<Variant> list;
        for (const NamedEffect& effect : kEffects)
            list.push_back({effect.name, Preset::kBalanced, effect.add, effect.turns ? kPedal : 0});
        list.push_back({kAllFelt, Preset::kBalanced, addFelt, kPedal});
        list.push_back({"all_effects", Preset::kBalanced, addAll, kPedal});
        return list;
    }();
    return kVariants;
}

const DeviceCapabilities kArm{.name = "arm of three degrees",
                              .kind = uint32_t(DeviceKind::kUnknown),
                              .abilities = kAbilityForce | kAbilityOrientation,
                              .max_force = 3,
                              .max_torque = 0,
                              .max_stiffness = 0,
                              .max_rotation_stiffness = 0,
                              .workspace_radius = 0.08};

const std::vector<Variant>& deviceVariants() {
    static const std::vector<Variant> kVariants{
        {.name = "arm", .preset = Preset::kBalanced, .device = &kArm},
        {.name = "scale_0_3", .preset = Preset::kBalanced, .workspace_scale = 0.3},
        {.name = "scale_3", .preset = Preset::kBalanced, .workspace_scale = 3}};
    return kVariants;
}

Names scaledWorkspaces() {
    return {"scale_0_3", "scale_3"};
}
Names everyDevice() {
    return Names{"arm"} + scaledWorkspaces();
}
Names operator+(Names a, const Names& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

Names feltEffects() {
    Names names;
    for (const NamedEffect& effect : kEffects)
        if (!effect.mills) names.push_back(effect.name);
    names.push_back(kAllFelt);
    return names;
}

Names feltEffectsBut(const Names& left_out) {
    Names names = feltEffects();
    std::erase(names, kAllFelt);
    std::erase_if(names, [&](const std::string& name) {
        return std::find(left_out.begin(), left_out.end(), name) != left_out.end();
    });
    return names;
}

void applyVariant(const Variant& variant, FixedTickConfig& config) {
    config.laws = allLaws();
    config.accuracy = presetSettings(variant.preset);
    setHandSpace(config, HandSpace(variant.workspace_scale));
    if (!variant.add_effects) return;
    config.tool.burr.speed = kSpinSpeed;
    config.tool.burr.friction = kCuttingFriction;
    config.effects = {};
    variant.add_effects(config.effects);
}

CouplingFigures couplingFigures(const FixedTickConfig& config) {
    if (isThesis(config)) {
        const CouplingConfig& c = config.coupling;
        return {c.translation_stiffness, c.translation_stiffness, c.rotation_stiffness / 2, c.max_speed,
                c.max_angular_speed};
    }
    const GradientConfig& g = config.gradient;
    if (config.accuracy.law != ContactLaw::kGradient) {
        const double k = g.coupling.translation_stiffness;
        return {k, k, g.coupling.rotation_stiffness, g.max_speed, g.max_angular_speed};
    }
    return {g.coupling.translation_stiffness,
            g.coupling.translation_stiffness * (1 + g.coupling.relaxing_share), g.coupling.rotation_stiffness,
            g.max_speed, g.max_angular_speed};
}

double& couplingStiffness(FixedTickConfig& config) {
    return isThesis(config) ? config.coupling.translation_stiffness
                            : config.gradient.coupling.translation_stiffness;
}

double& contactStiffness(FixedTickConfig& config) {
    const ContactLaw law = config.accuracy.law;
    const bool is_per_point = isThesis(config) || law == ContactLaw::kVps || law == ContactLaw::kPenaltySdf;
    return is_per_point ? config.contact.point_stiffness : config.gradient.contact.stiffness_per_area;
}

void setDragInAir(FixedTickConfig& config, double drag) {
    const double stiffness = couplingStiffness(config);
    config.gradient.coupling.damping_time = drag / stiffness;
    config.coupling.static_damping = drag / (drag + stiffness * config.dt);
}

}  // namespace bonemill::test
