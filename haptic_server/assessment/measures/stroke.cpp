#include "haptic_server/assessment/measures/stroke.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/assessment/measures/smoothness.h"

namespace bonemill {
namespace {

constexpr size_t kMinSmoothnessSamples = 5;  // 0.1 s: below that a spectrum says nothing

std::vector<double> speedsOf(std::span<const MotionSample> samples) {
    std::vector<double> speeds(samples.size());
    for (size_t i = 0; i < samples.size(); ++i) {
        const size_t before = i == 0 ? 0 : i - 1, after = std::min(i + 1, samples.size() - 1);
        speeds[i] =
            (samples[after].p_W - samples[before].p_W).norm() / (double(after - before) * MotionSample::kDt);
    }
    return speeds;
}

}  // namespace

double wayOf(std::span<const MotionSample> samples) noexcept {
    double way = 0;
    for (size_t i = 1; i < samples.size(); ++i) way += (samples[i].p_W - samples[i - 1].p_W).norm();
    return way;
}

StrokeMeasures measuresOf(std::span<const MotionSample> samples) {
    StrokeMeasures stroke;
    stroke.length = wayOf(samples);
    stroke.duration = double(samples.size() - 1) * MotionSample::kDt;
    if (stroke.duration > 0) stroke.mean_speed = stroke.length / stroke.duration;
    for (const MotionSample& sample : samples) {
        stroke.mean_force += sample.force / double(samples.size());
        stroke.removed += sample.removed;
    }
    if (samples.size() < kMinSmoothnessSamples) return stroke;
    const std::vector<double> speeds = speedsOf(samples);
    stroke.sparc = sparc(speeds, MotionSample::kRate);
    stroke.ldlj = logDimensionlessJerk(speeds, MotionSample::kRate);
    stroke.f95 = motionFrequency95(speeds, MotionSample::kRate);
    return stroke;
}

double StrokeList::median(double StrokeMeasures::*measure) const {
    std::vector<double> values;
    for (const StrokeMeasures& stroke : kept_)
        if (std::isfinite(stroke.*measure)) values.push_back(stroke.*measure);
    if (values.empty()) return StrokeMeasures::kNone;
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

}  // namespace bonemill
