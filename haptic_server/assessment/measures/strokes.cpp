#include "haptic_server/assessment/measures/strokes.h"

#include <complex>
#include <numbers>

namespace bonemill {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kHighestFrequency = 10;  // Hz
constexpr double kMinMagnitude = 0.05;    // of the largest
constexpr int kPadding = 4;               // powers of two

using Complex = std::complex<double>;

// In place; the length is a power of two.
void fourier(std::vector<Complex>& values) {
    const size_t n = values.size();
    for (size_t i = 1, j = 0; i < n; ++i) {
        size_t bit = n >> 1;
        for (; j & bit; bit >>= 1) j ^= bit;
        j ^= bit;
        if (i < j) std::swap(values[i], values[j]);
    }
    for (size_t length = 2; length <= n; length *= 2) {
        for (size_t k = 0; k < length / 2; ++k) {
            const Complex turn = std::polar(1.0, -2 * std::numbers::pi * double(k) / double(length));
            for (size_t first = k; first < n; first += length) {
                const Complex a = values[first], b = values[first + length / 2] * turn;
                values[first] = a + b;
                values[first + length / 2] = a - b;
            }
        }
    }
}

struct Spectrum {
    std::vector<double> magnitude;  // from 0 Hz up to half the rate
    double df = 0;
};

// Zero-padded to 2^(ceil(log2 N) + 4).
Spectrum spectrumOf(std::span<const double> speed, double rate) {
    size_t length = 1;
    while (length < speed.size()) length *= 2;
    length <<= kPadding;
    std::vector<Complex> values(speed.begin(), speed.end());
    values.resize(length);
    fourier(values);
    Spectrum spectrum{{}, rate / double(length)};
    for (size_t i = 0; i <= length / 2; ++i) spectrum.magnitude.push_back(std::abs(values[i]));
    return spectrum;
}

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

double sparc(std::span<const double> speed, double rate) {
    if (speed.empty()) return kNone;
    Spectrum spectrum = spectrumOf(speed, rate);
    std::vector<double>& magnitude = spectrum.magnitude;
    const double largest = *std::ranges::max_element(magnitude);
    if (!(largest > 0)) return kNone;
    while (magnitude.size() > 1 && double(magnitude.size() - 1) * spectrum.df > kHighestFrequency)
        magnitude.pop_back();
    for (double& value : magnitude) value /= largest;
    const auto is_large = [](double value) { return value >= kMinMagnitude; };
    const auto first = std::ranges::find_if(magnitude, is_large);
    const auto last = std::find_if(magnitude.rbegin(), magnitude.rend(), is_large).base();
    const auto steps = double(last - first - 1);
    if (steps < 1) return kNone;
    double length = 0;
    for (auto at = first + 1; at < last; ++at) length += std::hypot(1 / steps, *at - *(at - 1));
    return -length;
}

double logDimensionlessJerk(std::span<const double> speed, double rate) {
    if (speed.size() < 3) return kNone;
    double peak = 0, jerk_squared = 0;
    for (const double value : speed) peak = std::max(peak, std::abs(value));
    for (size_t i = 2; i < speed.size(); ++i) {
        const double jerk = (speed[i] - 2 * speed[i - 1] + speed[i - 2]) * rate * rate;
        jerk_squared += jerk * jerk / rate;
    }
    const double duration = double(speed.size()) / rate;
    const double dimensionless = std::pow(duration, 3) / (peak * peak) * jerk_squared;
    return std::isfinite(dimensionless) && dimensionless > 0 ? -std::log(dimensionless) : kNone;
}

double motionFrequency95(std::span<const double> speed, double rate) {
    if (speed.empty()) return kNone;
    const Spectrum spectrum = spectrumOf(speed, rate);
    double power = 0, below = 0;
    for (const double value : spectrum.magnitude) power += value * value;
    if (!(power > 0)) return kNone;
    for (size_t i = 0; i < spectrum.magnitude.size(); ++i) {
        below += spectrum.magnitude[i] * spectrum.magnitude[i];
        if (below >= 0.95 * power) return double(i) * spectrum.df;
    }
    return kNone;
}

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

}  // namespace bonemill
