// What must not be touched, as a scene asks for it and as ticks tell of it (protected_structures.cpp). Needs
// materials with is_protected, and EffectConfigs::protected_field.
#pragma once

#include "haptic_server/core/effects/effect_declaration.h"

namespace bonemill {

struct ProtectedStructuresConfig {
    static constexpr const char* kName = "protected_structures";
    static constexpr RecordedEffects kRecords{.protection = true};
    static constexpr EffectFigure kFigures[] = {
        {"protected_id", "1", "1 + index of the nearest structure's material; 0: none in reach",
         [](const EffectRecord& r) -> ColumnValue { return r.protected_id; }},
        {"protected_distance_mm",
         "mm",
         "burr's surface to the nearest structure; of no meaning with id 0",
         [](const EffectRecord& r) -> ColumnValue { return double(r.protected_distance) * kPerMillimetre; },
         {RunSummary::kMin, "protected_distance_min_mm", "nearest to a protected structure"},
         {"mm"},
         [](const EffectRecord& r) { return r.protected_id != 0; }},
        {"protected_force_n",
         "N",
         "on the tool, from protected structures",
         [](const EffectRecord& r) -> ColumnValue { return r.protected_force; },
         {RunSummary::kLargestSize, "protected_force_max_n"}},
        {"damaged_mm3",
         "mm^3",
         "protected structures removed in all",
         [](const EffectRecord& r) -> ColumnValue { return double(r.damaged_volume) * kPerCubicMillimetre; },
         {RunSummary::kLast, "protected_damaged_mm3", "damage to them"},
         {"mm\u00b3"}},
    };
    static constexpr auto parameters() {
        using C = ProtectedStructuresConfig;
        return std::to_array<EffectParameter<C>>({
            {"warning_distance_mm", [](C& c, double v) { c.warning_distance = v * kMillimetre; }},
        });
    }
    std::unique_ptr<HapticEffect> make(const EffectNeeds& needs) const;

    double warning_distance;  // m
};

}  // namespace bonemill
