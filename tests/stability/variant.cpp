#include "tests/stability/variant.h"

namespace bonemill::test {

const std::vector<Variant>& allVariants() {
    static const std::vector<Variant> variants{
        {"thesis_2012", 1, nullptr, [](TickConfig& config, double k) { config.contact.point_stiffness = k; },
         PenaltyContactConfig{}.point_stiffness},
    };
    return variants;
}

const Variant& baselineVariant() {
    return allVariants().front();
}

}  // namespace bonemill::test
