#include "haptic_server/scans/labels/material_ids.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bonemill {
namespace {

bool isInRange(const MaterialRule& rule, double value) {
    return rule.has_range && std::isfinite(value) && (!rule.from || value >= *rule.from) &&
           (!rule.below || value < *rule.below);
}

}  // namespace

std::vector<MaterialId> materialIds(const RawVolume& raw, std::span<const MaterialRule> rules,
                                    std::vector<MaterialId> of_labels) {
    std::vector<MaterialId> ids = std::move(of_labels);
    ids.resize(raw.values.size(), kNoMaterial);
    if (std::ranges::none_of(rules, &MaterialRule::has_range)) return ids;
    raw.values.visit([&](auto samples) {
        for (size_t n = 0; n < samples.size(); ++n)
            for (size_t rule = rules.size(); rule > ids[n]; --rule)  // the later one wins
                if (isInRange(rules[rule - 1], double(samples[n]))) ids[n] = MaterialId(rule);
    });
    return ids;
}

}  // namespace bonemill
