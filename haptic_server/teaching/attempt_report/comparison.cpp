#include "haptic_server/teaching/attempt_report/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bonemill {
namespace {

constexpr double kSlowest = 0.05, kFastest = 3;  // b: slower is a straight line, faster a step
constexpr int kTries = 60;

// For a given rate the rest is a straight line in n^-b: least squares.
LearningCurve withRate(std::span<const double> values, double rate) {
    const auto n = double(values.size());
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (size_t i = 0; i < values.size(); ++i) {
        const double x = std::pow(double(i + 1), -rate);
        sx += x, sy += values[i], sxx += x * x, sxy += x * values[i];
    }
    const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
    LearningCurve curve;
    curve.limit = (sy - slope * sx) / n;
    curve.first = curve.limit + slope;
    curve.rate = rate;
    double squares = 0;
    for (size_t i = 0; i < values.size(); ++i) squares += std::pow(values[i] - curve.at(double(i + 1)), 2);
    curve.deviation = std::sqrt(squares / n);
    return curve;
}

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

double LearningCurve::at(double attempt) const {
    return limit + (first - limit) * std::pow(attempt, -rate);
}

std::optional<LearningCurve> fitLearningCurve(std::span<const double> values) {
    if (values.size() < LearningCurve::kMinAttempts) return std::nullopt;
    if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) return std::nullopt;
    const auto [least, most] = std::ranges::minmax(values);
    if (least == most) return std::nullopt;
    const auto rateOf = [](double step) { return kSlowest * std::pow(kFastest / kSlowest, step / kTries); };
    double best = 0;
    for (int step = 1; step <= kTries; ++step)
        if (withRate(values, rateOf(step)).deviation < withRate(values, rateOf(best)).deviation) best = step;
    double low = std::max(0.0, best - 1), high = std::min(double(kTries), best + 1);
    for (int n = 0; n < 40; ++n) {  // thirds: the deviation has one minimum between two tries
        const double a = low + (high - low) / 3, b = high - (high - low) / 3;
        (withRate(values, rateOf(a)).deviation < withRate(values, rateOf(b)).deviation ? high : low) =
            withRate(values, rateOf(a)).deviation < withRate(values, rateOf(b)).deviation ? b : a;
    }
    return withRate(values, rateOf(0.5 * (low + high)));
}

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
