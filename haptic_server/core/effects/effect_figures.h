// All figures that effects tell of a tick, in the order of their columns, and who tells which. Plain
// constants; any thread.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "common/base/units.h"
#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/telemetry/effect_figure.h"

namespace bonemill {

// What every effect that reads the burr's contacts tells of the burr.
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

template <class Config>
constexpr std::span<const EffectFigure> declaredFigures() noexcept {
    if constexpr (requires { Config::kFigures; })
        return Config::kFigures;
    else
        return {};
}

template <class Config>
constexpr RecordedEffects declaredParts() noexcept {
    if constexpr (requires { Config::kRecords; })
        return Config::kRecords;
    else
        return {};
}

// Calls visit.operator()<Config>() for each effect, in the order of kEffects.
template <class Visit>
constexpr void forEachConfig(Visit visit) {
    const auto one = [&]<class Config>(std::optional<Config> EffectConfigs::*) {
        visit.template operator()<Config>();
    };
    std::apply([&](auto... member) { (one(member), ...); }, kEffects);
}

// The burr's figures come first, then those of each effect.
inline constexpr auto kEffectFigures = [] {
    constexpr size_t kCount = [] {
        size_t count = std::size(kBurrFigures);
        forEachConfig([&]<class Config>() { count += declaredFigures<Config>().size(); });
        return count;
    }();
    std::array<EffectFigure, kCount> figures;
    auto next = figures.begin();
    int slot = 0;
    const auto add = [&](std::span<const EffectFigure> declared, const RecordedEffects& part) {
        for (EffectFigure figure : declared) {
            figure.told_with = figure.value ? part : RecordedEffects{.own = 1u << slot};
            figure.slot = figure.value ? kNoSlot : slot++;
            *next++ = figure;
        }
    };
    add(kBurrFigures, {.burr = true});
    forEachConfig([&]<class Config>() {
        RecordedEffects part = declaredParts<Config>();
        part.burr = false;
        add(declaredFigures<Config>(), part);
    });
    return figures;
}();
static_assert(std::ranges::all_of(kEffectFigures,
                                  [](const EffectFigure& f) { return f.slot < int(kMaxOwnFigures); }));

// Where the figures of one effect lie in kEffectFigures.
template <class Config>
constexpr std::span<const EffectFigure> figuresOf() noexcept {
    size_t first = std::size(kBurrFigures);
    bool is_found = false;
    forEachConfig([&]<class Other>() {
        is_found |= std::is_same_v<Other, Config>;
        if (!is_found) first += declaredFigures<Other>().size();
    });
    return std::span(kEffectFigures).subspan(first, declaredFigures<Config>().size());
}

// Writes the nth of an effect's figures into the record; it must be one without a value() of its own.
// RT-safe.
template <class Config, size_t n = 0>
void tell(EffectRecord& record, double value) noexcept {
    constexpr int kSlot = figuresOf<Config>()[n].slot;
    static_assert(kSlot != kNoSlot);
    record.own[kSlot] = float(value);
}

// What an effect of this kind writes into the record of a tick.
template <class Config>
constexpr RecordedEffects recordedBy() noexcept {
    RecordedEffects recorded = declaredParts<Config>();
    for (const EffectFigure& figure : figuresOf<Config>()) recorded.own |= figure.told_with.own;
    return recorded;
}

// What the effects that are listed write into it.
inline RecordedEffects recordedBy(const EffectConfigs& configs) noexcept {
    RecordedEffects recorded;
    forEachEffect(configs, [&]<class Config>(const std::optional<Config>& config) {
        if (config) recorded.include(recordedBy<Config>());
    });
    return recorded;
}

}  // namespace bonemill
