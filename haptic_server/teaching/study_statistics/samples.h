// What describes one sample, and the tests of means. Pure; any thread may call them. What a sample cannot
// tell (a spread of one value, a test without any spread) is NaN.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace bonemill::study {

using Sample = std::span<const double>;
inline constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

struct Interval {
    double low = kNotKnown, high = kNotKnown;
};

struct Summary {
    size_t n = 0;
    double mean = kNotKnown, sd = kNotKnown, median = kNotKnown, least = kNotKnown, most = kNotKnown;
};

double meanOf(Sample sample);
// The sum of squares about the mean over n - 1.
double varianceOf(Sample sample);
Summary summarise(Sample sample);

struct TTest {
    double difference = kNotKnown;  // of the means, first less second
    double t = kNotKnown, df = kNotKnown;
    double p = kNotKnown;  // to both sides
    Interval interval;     // of the difference
};

// Two groups with unequal variances (Welch 1947); the degrees of freedom are Satterthwaite's.
TTest welch(Sample a, Sample b, double level = 0.95);
// The same people twice; samples of one length.
TTest pairedT(Sample a, Sample b, double level = 0.95);

std::vector<double> differencesOf(Sample a, Sample b);

}  // namespace bonemill::study
