#include "haptic_server/recording/statistics/effect_statistics.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace bonemill {
namespace {

void raise(std::optional<double>& largest, double value) noexcept {
    if (std::isfinite(value)) largest = std::max(largest.value_or(value), value);
}
void raise(double& largest, double value) noexcept {
    if (std::isfinite(value)) largest = std::max(largest, value);
}

std::string nameOf(size_t id, const std::vector<std::string>& materials) {
    if (id == 0 || id > materials.size()) return "a protected structure";
    const std::string& name = materials[id - 1];
    return name.empty() ? "material " + std::to_string(id) : name;
}

}  // namespace

void EffectStatistics::add(const EffectRecord& record) noexcept {
    raise(max_axis_torque_, std::abs(double(record.axis_torque)));
    raise(max_cutting_power_, double(record.cutting_power));
    if (std::isfinite(record.removed_energy)) removed_energy_ += double(record.removed_energy);
    if (recorded_.heat) raise(max_temperature_, double(record.temperature));
    raise(max_protected_force_, double(record.protected_force));
    noteDistance(record);
    necrotic_ = double(record.necrotic_volume);
    damaged_ = double(record.damaged_volume);
    events_ |= record.events;
    stalled_ticks_ += record.events & kEventSpindleStalled ? 1 : 0;
    book(kEventNearProtected, record.protected_id, record);
    book(kEventProtectedTouched, record.touched_id, record);
    book(kEventProtectedDamaged, record.damaged_id, record);
}

void EffectStatistics::noteDistance(const EffectRecord& record) noexcept {
    const double distance = double(record.protected_distance);
    if (record.protected_id == 0 || !std::isfinite(distance)) return;
    if (least_protected_distance_ && *least_protected_distance_ <= distance) return;
    least_protected_distance_ = distance;
    nearest_id_ = record.protected_id;
}

void EffectStatistics::book(uint32_t event, size_t structure, const EffectRecord& record) noexcept {
    events_of_[std::min(structure, events_of_.size() - 1)] |= record.events & event;
}

std::vector<std::pair<std::string, double>> EffectStatistics::figures() const {
    std::vector<std::pair<std::string, double>> figures;
    if (recorded_.burr) {
        figures.emplace_back("axis_torque_max_nm", max_axis_torque_);
        figures.emplace_back("cutting_power_max_w", max_cutting_power_);
        figures.emplace_back("removed_energy_j", removed_energy_);
        figures.emplace_back("spindle_stalled_ticks", double(stalled_ticks_));
    }
    if (recorded_.heat) {
        if (max_temperature_) figures.emplace_back("temperature_max_c", *max_temperature_);
        figures.emplace_back("necrotic_mm3", necrotic_ * kPerCubicMillimetre);
    }
    if (recorded_.protection) {
        if (least_protected_distance_)
            figures.emplace_back("protected_distance_min_mm", *least_protected_distance_ * kPerMillimetre);
        figures.emplace_back("protected_force_max_n", max_protected_force_);
        figures.emplace_back("protected_damaged_mm3", damaged_ * kPerCubicMillimetre);
    }
    return figures;
}

std::vector<std::string> EffectStatistics::warnings(const std::vector<std::string>& materials) const {
    constexpr std::pair<TickEvent, const char*> kWorstFirst[] = {{kEventProtectedDamaged, "damaged "},
                                                                 {kEventProtectedTouched, "touched "},
                                                                 {kEventNearProtected, "came near "}};
    std::vector<std::string> warnings;
    for (const auto& [event, what] : kWorstFirst)
        for (size_t id = 0; id < events_of_.size(); ++id)
            if (events_of_[id] & event) warnings.push_back(what + nameOf(id, materials));
    if (events_ & kEventTooHot) warnings.emplace_back("bone too hot");
    if (events_ & kEventSpindleStalled) warnings.emplace_back("spindle stalled");
    return warnings;
}

std::string EffectStatistics::nearest(const std::vector<std::string>& materials) const {
    return nearest_id_ == 0 ? "" : nameOf(nearest_id_, materials);
}

std::vector<std::string> EffectStatistics::touched(const std::vector<std::string>& materials) const {
    std::vector<std::string> names;
    for (size_t id = 0; id < events_of_.size(); ++id)
        if (events_of_[id] & (kEventProtectedTouched | kEventProtectedDamaged))
            names.push_back(nameOf(id, materials));
    return names;
}

}  // namespace bonemill
