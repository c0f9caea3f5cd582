#include "haptic_server/teaching/attempt_report/learning_curve.h"

#include <algorithm>
#include <cmath>

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

}  // namespace bonemill
