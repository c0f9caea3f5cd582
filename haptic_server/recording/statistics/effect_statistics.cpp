#include "haptic_server/recording/statistics/effect_statistics.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

// What a run's figure is before its first tick.
std::optional<double> startOf(RunSummary summary) noexcept {
    if (summary == RunSummary::kLargest || summary == RunSummary::kMin) return std::nullopt;
    return 0;
}

double summedUp(RunSummary summary, std::optional<double> before, double value) noexcept {
    switch (summary) {
        case RunSummary::kLargest:
            return std::max(before.value_or(value), value);
        case RunSummary::kLargestSize:
            return std::max(before.value_or(0), std::abs(value));
        case RunSummary::kMin:
            return std::min(before.value_or(value), value);
        case RunSummary::kSum:
            return before.value_or(0) + value;
        case RunSummary::kLast:
        case RunSummary::kNone:
            return value;
    }
    return value;
}

std::string nameOf(size_t id, const std::vector<std::string>& materials) {
    if (id == 0 || id > materials.size()) return "a protected structure";
    const std::string& name = materials[id - 1];
    return name.empty() ? "material " + std::to_string(id) : name;
}

}  // namespace

EffectStatistics::EffectStatistics(const RecordedEffects& recorded) : recorded_(recorded) {
    for (size_t n = 0; n < figures_.size(); ++n) figures_[n] = startOf(kEffectFigures[n].run.summary);
}

void EffectStatistics::add(const EffectRecord& record) noexcept {
    const std::optional<double> nearest_before = figure("protected_distance_min_mm");
    for (size_t n = 0; n < figures_.size(); ++n) {
        const EffectFigure& figure = kEffectFigures[n];
        if (!figure.run.key || !figure.isToldBy(recorded_)) continue;
        const double value = figure.numberIn(record);
        if (std::isfinite(value)) figures_[n] = summedUp(figure.run.summary, figures_[n], value);
    }
    if (figure("protected_distance_min_mm") != nearest_before) nearest_id_ = record.protected_id;
    events_ |= record.events;
    book(kEventNearProtected, record.protected_id, record);
    book(kEventProtectedTouched, record.touched_id, record);
    book(kEventProtectedDamaged, record.damaged_id, record);
}

void EffectStatistics::book(uint32_t event, size_t structure, const EffectRecord& record) noexcept {
    events_of_[std::min(structure, events_of_.size() - 1)] |= record.events & event;
}

std::vector<EffectStatistics::Figure> EffectStatistics::figures() const {
    std::vector<Figure> figures;
    for (size_t n = 0; n < figures_.size(); ++n)
        if (kEffectFigures[n].run.key && figures_[n] && kEffectFigures[n].isToldBy(recorded_))
            figures.push_back({&kEffectFigures[n], *figures_[n]});
    return figures;
}

std::optional<double> EffectStatistics::figure(std::string_view key) const noexcept {
    for (size_t n = 0; n < figures_.size(); ++n)
        if (kEffectFigures[n].run.key && kEffectFigures[n].run.key == key) return figures_[n];
    return std::nullopt;
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
