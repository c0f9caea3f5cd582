// What every effect that reads the burr's contacts tells of the burr.
#pragma once

#include "common/base/units.h"
#include "haptic_server/core/telemetry/effect_figure.h"

namespace bonemill {

inline constexpr EffectFigure kBurrFigures[] = {
    {"spin_rpm", "1/min", "speed of the burr about T's +y",
     [](const EffectRecord& r) -> ColumnValue { return double(r.spin_speed) / kRpm; }},
    {"burr_force_n", "N", "sum of the normal forces on the burr",
     [](const EffectRecord& r) -> ColumnValue { return r.burr_force; }},
    {"axis_torque_nm",
     "N m",
     "torque against the spin, on the tool",
     [](const EffectRecord& r) -> ColumnValue { return r.axis_torque; },
     {RunSummary::kLargestSize, "axis_torque_max_nm", "axis torque, max"},
     {"N\u00b7mm", kPerMilli}},
    {"cutting_power_w",
     "W",
     "power of all friction between burr and bone",
     [](const EffectRecord& r) -> ColumnValue { return r.cutting_power; },
     {RunSummary::kLargestSize, "cutting_power_max_w", "cutting power, max"},
     {"W"}},
    {"removal_power_w", "W", "the part of it that removes bone",
     [](const EffectRecord& r) -> ColumnValue { return r.removal_power; }},
    {"removed_energy_j",
     "J",
     "specific energy of what was removed in this tick",
     [](const EffectRecord& r) -> ColumnValue { return r.removed_energy; },
     {RunSummary::kSum, "removed_energy_j", "energy that removed bone"},
     {"J"}},
    {nullptr,
     nullptr,
     nullptr,
     [](const EffectRecord& r) -> ColumnValue { return r.events & kEventSpindleStalled ? 1u : 0u; },
     {RunSummary::kSum, "spindle_stalled_ticks"}},
};

}  // namespace bonemill
