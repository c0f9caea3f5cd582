#include "haptic_server/teaching/attempt_report/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bonemill {
namespace {

struct Spread {
    size_t count = 0;
    double mean = 0, deviation = 0;
};

// The deviation is that of a sample, with n - 1.
Spread spreadOf(const std::vector<double>& values) {
    Spread spread{values.size(), 0, 0};
    for (const double value : values) spread.mean += value / double(values.size());
    for (const double value : values) spread.deviation += std::pow(value - spread.mean, 2);
    spread.deviation = std::sqrt(spread.deviation / std::max(1.0, double(values.size()) - 1));
    return spread;
}

const SeriesTable* bucketsOf(const AttemptResult& result) {
    const auto& tables = result.assessment.series;
    const auto found = std::ranges::find(tables, "bucket", &SeriesTable::id);
    return found == tables.end() ? nullptr : &*found;
}

Envelope envelopeOf(const Series& column, const std::vector<const AttemptResult*>& experts) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    Envelope envelope{column.id, {}, {}};
    for (size_t row = 0; row < column.values.size(); ++row) {
        std::vector<double> values;
        for (const AttemptResult* expert : experts) {
            const SeriesTable* const table = bucketsOf(*expert);
            if (!table) continue;
            const auto same = std::ranges::find(table->columns, column.id, &Series::id);
            if (same != table->columns.end() && row < same->values.size() && std::isfinite(same->values[row]))
                values.push_back(same->values[row]);
        }
        const Spread spread = spreadOf(values);
        const bool is_known = values.size() >= kMinExperts;
        envelope.low.push_back(is_known ? spread.mean - 2 * spread.deviation : kNone);
        envelope.high.push_back(is_known ? spread.mean + 2 * spread.deviation : kNone);
    }
    return envelope;
}

}  // namespace

std::optional<ExpertComparison> compareWith(std::span<const AttemptResult> experts,
                                            const AttemptResult& result) {
    std::vector<const AttemptResult*> same_scene;
    for (const AttemptResult& expert : experts)
        if (expert.scene_hash == result.scene_hash) same_scene.push_back(&expert);
    if (same_scene.size() < kMinExperts) return std::nullopt;
    ExpertComparison comparison;
    comparison.experts = same_scene.size();
    for (const Figure& figure : result.assessment.figures) {
        std::vector<double> values;
        for (const AttemptResult* expert : same_scene)
            if (const Figure* same = findFigure(expert->assessment.figures, figure.id, figure.version))
                values.push_back(same->value);
        const Spread spread = spreadOf(values);
        if (spread.count < kMinExperts || !(spread.deviation > 0)) continue;
        comparison.figures.push_back({figure.id, (figure.value - spread.mean) / spread.deviation, spread.mean,
                                      spread.deviation, spread.count});
    }
    if (const SeriesTable* table = bucketsOf(result))
        for (const Series& column : table->columns)
            comparison.envelopes.push_back(envelopeOf(column, same_scene));
    return comparison;
}

}  // namespace bonemill
