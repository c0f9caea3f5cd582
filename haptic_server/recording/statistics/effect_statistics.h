// Keeps what the effects of a run told, from its tick records: extremes, totals, and what the trainee
// was warned of.
//
// One normal thread calls it; add() allocates nothing. Units are SI but for temperatures, which are in °C.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "haptic_server/core/telemetry/effect_record.h"
#include "haptic_server/core/telemetry/recorded_effects.h"

namespace bonemill {

class EffectStatistics {
  public:
    EffectStatistics() = default;
    explicit EffectStatistics(const RecordedEffects& recorded) : recorded_(recorded) {}

    void add(const EffectRecord& record) noexcept;

    const RecordedEffects& recorded() const noexcept { return recorded_; }
    double removedEnergy() const noexcept { return removed_energy_; }
    std::optional<double> maxTemperature() const noexcept { return max_temperature_; }
    double necrotic() const noexcept { return necrotic_; }
    // It is the distance of the burr's surface, and nothing while no structure was in reach.
    std::optional<double> leastProtectedDistance() const noexcept { return least_protected_distance_; }
    // The name of the structure that it is of; empty while there is none.
    std::string nearest(const std::vector<std::string>& materials) const;
    double maxProtectedForce() const noexcept { return max_protected_force_; }
    double damaged() const noexcept { return damaged_; }

    // The keys have unit suffixes; only what is recorded is among them.
    std::vector<std::pair<std::string, double>> figures() const;
    // Each warning comes once, in words; `materials` are the materials' names in the scene's order.
    std::vector<std::string> warnings(const std::vector<std::string>& materials) const;
    // The protected structures that the burr touched, by name.
    std::vector<std::string> touched(const std::vector<std::string>& materials) const;

  private:
    void noteDistance(const EffectRecord& record) noexcept;
    void book(uint32_t event, size_t structure, const EffectRecord& record) noexcept;

    RecordedEffects recorded_;
    double max_axis_torque_ = 0, max_cutting_power_ = 0, removed_energy_ = 0;
    std::optional<double> max_temperature_, least_protected_distance_;
    uint32_t nearest_id_ = 0;  // of that distance
    double necrotic_ = 0, max_protected_force_ = 0, damaged_ = 0;
    uint32_t events_ = 0;  // that were ever set
    uint64_t stalled_ticks_ = 0;
    std::array<uint32_t, 256> events_of_ = {};  // by material
};

}  // namespace bonemill
