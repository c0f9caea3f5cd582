// Keeps what the effects of a run told, from its tick records: extremes, totals, and what the trainee
// was warned of.
//
// One normal thread calls it; add() allocates nothing. Units are those of the figures' keys.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "haptic_server/core/effects/effect_figures.h"
#include "haptic_server/core/telemetry/effect_record.h"

namespace bonemill {

class EffectStatistics {
  public:
    struct Figure {
        const EffectFigure* is;
        double value;
    };

    explicit EffectStatistics(const RecordedEffects& recorded = {});

    void add(const EffectRecord& record) noexcept;

    const RecordedEffects& recorded() const noexcept { return recorded_; }
    // What is recorded and has a value yet: effects' figures in the order of effects/effect_figures.h.
    std::vector<Figure> figures() const;
    // The one with this key; nothing while it has no value.
    std::optional<double> figure(std::string_view key) const noexcept;
    // The name of the structure that the least distance is of; empty while there is none.
    std::string nearest(const std::vector<std::string>& materials) const;
    // Each warning comes once, in words; `materials` are the materials' names in the scene's order.
    std::vector<std::string> warnings(const std::vector<std::string>& materials) const;
    // The protected structures that the burr touched, by name.
    std::vector<std::string> touched(const std::vector<std::string>& materials) const;

  private:
    void book(uint32_t event, size_t structure, const EffectRecord& record) noexcept;

    RecordedEffects recorded_;
    std::array<std::optional<double>, kEffectFigures.size()> figures_;
    uint32_t nearest_id_ = 0;                   // of the least distance to a protected structure
    uint32_t events_ = 0;                       // that were ever set
    std::array<uint32_t, 256> events_of_ = {};  // by material
};

}  // namespace bonemill
