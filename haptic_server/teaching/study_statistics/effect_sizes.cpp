#include "haptic_server/teaching/study_statistics/effect_sizes.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "haptic_server/teaching/study_statistics/distributions.h"

namespace bonemill::study {
namespace {

// The value of which the share `p` of the sorted replicates lies below; between two of them it follows the
// normal distribution (Davison and Hinkley 1997, equation 5.8).
double quantileOf(const std::vector<double>& sorted, double p) {
    const size_t count = sorted.size();
    const double place = double(count + 1) * p;
    const size_t k = size_t(std::clamp(place, 0.0, double(count)));
    if (k == 0) return sorted.front();
    if (k == count) return sorted.back();
    const double low = normalQuantile(double(k) / double(count + 1));
    const double high = normalQuantile(double(k + 1) / double(count + 1));
    return sorted[k - 1] + (normalQuantile(p) - low) / (high - low) * (sorted[k] - sorted[k - 1]);
}

// std::uniform_int_distribution differs between libraries; the bias of a remainder of 64 bits is below 1e-16.
std::vector<double> drawnFrom(Sample sample, std::mt19937_64& random) {
    std::vector<double> drawn(sample.size());
    for (double& value : drawn) value = sample[random() % sample.size()];
    return drawn;
}

std::vector<double> without(Sample sample, size_t index) {
    std::vector<double> rest(sample.begin(), sample.end());
    rest.erase(rest.begin() + long(index));
    return rest;
}

// By leaving out one of `varied` after the other (jackknife), over the group's size.
template <class Statistic>
void addInfluence(Sample varied, const Statistic& statistic, std::vector<double>& influence) {
    std::vector<double> values(varied.size());
    for (size_t i = 0; i < varied.size(); ++i) values[i] = statistic(without(varied, i));
    const double mean = meanOf(values), n = double(varied.size());
    for (const double value : values) influence.push_back((n - 1) * (mean - value) / n);
}

}  // namespace

double cohensD(Sample a, Sample b) {
    const double n = double(a.size()), m = double(b.size());
    const double pooled = ((n - 1) * varianceOf(a) + (m - 1) * varianceOf(b)) / (n + m - 2);
    return pooled > 0 ? (meanOf(a) - meanOf(b)) / std::sqrt(pooled) : kNotKnown;
}

double hedgesG(Sample a, Sample b) {
    return cohensD(a, b) * (1 - 3 / (4 * double(a.size() + b.size()) - 9));
}

double aucOf(Sample a, Sample b) {
    if (a.empty() || b.empty()) return kNotKnown;
    double higher = 0;
    for (const double x : a)
        for (const double y : b) higher += x > y ? 1 : x == y ? 0.5 : 0;
    return higher / double(a.size() * b.size());
}

Interval bcaInterval(std::vector<double> replicates, double observed, Sample influence, double level) {
    double below = 0;
    for (const double value : replicates) below += value < observed ? 1 : value == observed ? 0.5 : 0;
    const double z0 = normalQuantile(below / double(replicates.size()));
    double squares = 0, cubes = 0;
    for (const double l : influence) {
        squares += l * l;
        cubes += l * l * l;
    }
    std::sort(replicates.begin(), replicates.end());
    const bool has_spread = !replicates.empty() && replicates.front() < replicates.back();
    if (!std::isfinite(z0) || !(squares > 0) || !has_spread) return {};
    const double acceleration = cubes / (6 * std::pow(squares, 1.5));
    const auto end = [&](double p) {
        const double z = z0 + normalQuantile(p);
        return quantileOf(replicates, normalCdf(z0 + z / (1 - acceleration * z)));
    };
    return {end((1 - level) / 2), end((1 + level) / 2)};
}

Interval bootstrapInterval(Sample a, Sample b, const TwoGroupStatistic& statistic, uint64_t seed,
                           double level) {
    const double observed = statistic(a, b);
    if (a.size() < 3 || b.size() < 3 || !std::isfinite(observed)) return {};
    std::mt19937_64 random(seed);
    std::vector<double> replicates;
    for (size_t i = 0; i < kReplicates; ++i) {
        const std::vector<double> drawn_a = drawnFrom(a, random), drawn_b = drawnFrom(b, random);
        const double value = statistic(drawn_a, drawn_b);
        if (std::isfinite(value)) replicates.push_back(value);
    }
    if (100 * replicates.size() < 99 * kReplicates) return {};
    std::vector<double> influence;
    addInfluence(
        a, [&](const std::vector<double>& rest) { return statistic(rest, b); }, influence);
    addInfluence(
        b, [&](const std::vector<double>& rest) { return statistic(a, rest); }, influence);
    return bcaInterval(std::move(replicates), observed, influence, level);
}

}  // namespace bonemill::study
