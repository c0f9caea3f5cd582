#include "tests/stability/variant.h"

namespace bonemill::test {
namespace {

bool isThesis(const TickConfig& config) {
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

const Variant& baselineVariant() {
    for (const Variant& variant : allVariants())
        if (variant.isBaseline()) return variant;
    return allVariants().front();
}

void applyVariant(const Variant& variant, TickConfig& config) {
    config.accuracy = presetSettings(variant.preset);
}

CouplingFigures couplingFigures(const TickConfig& config) {
    if (isThesis(config)) {
        const CouplingConfig& c = config.coupling;
        return {c.translation_stiffness, c.translation_stiffness, c.rotation_stiffness / 2, c.max_speed,
                c.max_angular_speed};
    }
    const GradientConfig& g = config.gradient;
    return {g.coupling.translation_stiffness,
            g.coupling.translation_stiffness * (1 + g.coupling.relaxing_share), g.coupling.rotation_stiffness,
            g.max_speed, g.max_angular_speed};
}

double& couplingStiffness(TickConfig& config) {
    return isThesis(config) ? config.coupling.translation_stiffness
                            : config.gradient.coupling.translation_stiffness;
}

double& contactStiffness(TickConfig& config) {
    return isThesis(config) ? config.contact.point_stiffness : config.gradient.contact.stiffness_per_area;
}

void setDragInAir(TickConfig& config, double drag) {
    const double stiffness = couplingStiffness(config);
    config.gradient.coupling.damping_time = drag / stiffness;
    config.coupling.static_damping = drag / (drag + stiffness * config.dt);
}

}  // namespace bonemill::test
