#include "tests/stability/variant.h"

#include <gtest/gtest.h>

#include <set>

namespace bonemill::test {
namespace {

// What is not felt, or is the milling that every variant does in place of energy_removal.
const std::set<std::string> kWithoutVariant = {"protected_structures", "time_removal", "add_material"};

TEST(Variants, EveryEffectOfTheTickIsOne) {
    std::set<std::string> expected = kWithoutVariant, found = kWithoutVariant;
    EffectConfigs configs;
    forEachEffect(configs,
                  [&]<class Config>(const std::optional<Config>&) { expected.insert(Config::kName); });
    for (const Variant& variant : effectVariants())
        if (!variant.name.starts_with("all_")) found.insert(variant.name);
    EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace bonemill::test
