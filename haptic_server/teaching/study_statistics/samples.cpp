#include "haptic_server/teaching/study_statistics/samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/base/assert.h"
#include "haptic_server/teaching/study_statistics/distributions.h"

namespace bonemill::study {
namespace {

TTest testOf(double difference, double standard_error, double df, double level) {
    TTest test;
    test.difference = difference;
    if (!(standard_error > 0)) return test;
    test.t = difference / standard_error;
    test.df = df;
    test.p = studentTwoSided(test.t, df);
    const double reach = studentQuantile((1 + level) / 2, df) * standard_error;
    test.interval = {difference - reach, difference + reach};
    return test;
}

}  // namespace

double meanOf(Sample sample) {
    if (sample.empty()) return kNotKnown;
    return std::accumulate(sample.begin(), sample.end(), 0.0) / double(sample.size());
}

double varianceOf(Sample sample) {
    if (sample.size() < 2) return kNotKnown;
    const double mean = meanOf(sample);
    double squares = 0;
    for (const double x : sample) squares += (x - mean) * (x - mean);
    return squares / double(sample.size() - 1);
}

Summary summarise(Sample sample) {
    Summary summary{.n = sample.size()};
    if (sample.empty()) return summary;
    std::vector<double> sorted(sample.begin(), sample.end());
    std::sort(sorted.begin(), sorted.end());
    const size_t half = sorted.size() / 2;
    summary.mean = meanOf(sample);
    summary.sd = std::sqrt(varianceOf(sample));
    summary.median = sorted.size() % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
    summary.least = sorted.front();
    summary.most = sorted.back();
    return summary;
}

TTest welch(Sample a, Sample b, double level) {
    const double u = varianceOf(a) / double(a.size()), v = varianceOf(b) / double(b.size());
    const double df = (u + v) * (u + v) / (u * u / (double(a.size()) - 1) + v * v / (double(b.size()) - 1));
    return testOf(meanOf(a) - meanOf(b), std::sqrt(u + v), df, level);
}

TTest pairedT(Sample a, Sample b, double level) {
    const std::vector<double> differences = differencesOf(a, b);
    const double n = double(differences.size());
    return testOf(meanOf(differences), std::sqrt(varianceOf(differences) / n), n - 1, level);
}

std::vector<double> differencesOf(Sample a, Sample b) {
    BONEMILL_ASSERT(a.size() == b.size());
    std::vector<double> differences(a.size());
    std::transform(a.begin(), a.end(), b.begin(), differences.begin(), std::minus<>());
    return differences;
}

}  // namespace bonemill::study
