#include "haptic_server/volume/import/material_ids.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

bool isInRange(const MaterialRule& rule, double value) {
    return rule.has_range && std::isfinite(value) && (!rule.from || value >= *rule.from) &&
           (!rule.below || value < *rule.below);
}

std::vector<MaterialId> idsByValue(const RawVolume& raw, std::span<const MaterialRule> rules) {
    std::vector<MaterialId> ids(raw.values.size(), kNoMaterial);
    const bool has_ranges =
        std::any_of(rules.begin(), rules.end(), [](const MaterialRule& rule) { return rule.has_range; });
    if (!has_ranges) return ids;
    raw.values.visit([&](auto samples) {
        for (size_t n = 0; n < samples.size(); ++n)
            for (size_t rule = rules.size(); rule > 0 && ids[n] == kNoMaterial; --rule)
                if (isInRange(rules[rule - 1], double(samples[n]))) ids[n] = MaterialId(rule);
    });
    return ids;
}

std::vector<MaterialId> idOfLabel(std::span<const MaterialRule> rules) {
    std::vector<MaterialId> ids(kMostLabel + 1, kNoMaterial);
    for (size_t n = 0; n < rules.size(); ++n)
        for (const uint32_t label : rules[n].labels) ids[label] = MaterialId(n + 1);
    return ids;
}

}  // namespace

std::vector<MaterialId> materialIds(const RawVolume& raw, std::span<const MaterialRule> rules,
                                    const RawVolume* labels) {
    std::vector<MaterialId> ids = idsByValue(raw, rules);
    if (!labels) return ids;
    const std::vector<MaterialId> of_label = idOfLabel(rules);
    labels->values.visit([&](auto samples) {
        for (size_t n = 0; n < ids.size(); ++n) {
            const auto label = double(samples[n]);
            if (label >= 0 && label <= kMostLabel)
                ids[n] = std::max(ids[n], of_label[size_t(label)]);  // the later one wins
        }
    });
    return ids;
}

}  // namespace bonemill
