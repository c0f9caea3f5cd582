#include "haptic_server/teaching/study_statistics/planning.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/teaching/study_statistics/distributions.h"

namespace bonemill::study {
namespace {

// Where `rising` crosses `target` between the two bounds.
template <class Rising>
double crossing(const Rising& rising, double target, double low, double high) {
    for (int i = 0; i < 200 && high - low > 1e-13 * std::max(1.0, std::abs(low)); ++i) {
        const double middle = (low + high) / 2;
        (rising(middle) < target ? low : high) = middle;
    }
    return (low + high) / 2;
}

// The expected t for one standard deviation of difference.
double shiftPerD(size_t n1, size_t n2) {
    return std::sqrt(double(n1) * double(n2) / double(n1 + n2));
}

bool haveSpread(size_t n1, size_t n2) {
    return n1 > 0 && n2 > 0 && n1 + n2 > 2;
}

}  // namespace

double falseAlarmChance(size_t tests, double alpha) {
    return 1 - std::pow(1 - alpha, double(tests));
}

std::vector<double> holm(Sample p) {
    std::vector<size_t> order;
    for (size_t i = 0; i < p.size(); ++i)
        if (!std::isnan(p[i])) order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](size_t i, size_t j) { return p[i] < p[j]; });
    std::vector<double> adjusted(p.size(), kNotKnown);
    double highest = 0;
    for (size_t i = 0; i < order.size(); ++i) {
        highest = std::max(highest, double(order.size() - i) * p[order[i]]);
        adjusted[order[i]] = std::min(1.0, highest);
    }
    return adjusted;
}

double powerOfTTest(double d, size_t n1, size_t n2, double alpha) {
    if (!haveSpread(n1, n2)) return kNotKnown;
    const double df = double(n1 + n2) - 2, shift = d * shiftPerD(n1, n2);
    const double limit = studentQuantile(1 - alpha / 2, df);
    // The upper tail is the lower one about the opposite shift: nothing cancels.
    return shiftedStudentCdf(-limit, df, -shift) + shiftedStudentCdf(-limit, df, shift);
}

double smallestDetectableD(size_t n1, size_t n2, double alpha, double power) {
    if (!haveSpread(n1, n2)) return kNotKnown;
    double high = 1;
    while (powerOfTTest(high, n1, n2, alpha) < power) {
        high *= 2;
        if (high > 64) return kNotKnown;
    }
    return crossing([&](double d) { return powerOfTTest(d, n1, n2, alpha); }, power, 0, high);
}

size_t neededPerGroup(double d, double alpha, double power) {
    constexpr size_t kMax = 100'000;
    size_t low = 1, high = 2;
    while (high <= kMax && powerOfTTest(d, high, high, alpha) < power) {
        low = high;
        high *= 2;
    }
    if (high > kMax) return 0;
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        (powerOfTTest(d, middle, middle, alpha) < power ? low : high) = middle;
    }
    return high;
}

double impliedD(double p, size_t n1, size_t n2) {
    if (!haveSpread(n1, n2)) return kNotKnown;
    return studentQuantile(1 - p / 2, double(n1 + n2) - 2) / shiftPerD(n1, n2);
}

Interval intervalOfD(double d, size_t n1, size_t n2, double level) {
    if (!haveSpread(n1, n2) || !std::isfinite(d)) return {};
    const double df = double(n1 + n2) - 2, per_d = shiftPerD(n1, n2), t = d * per_d;
    const auto endAt = [&](double share) {
        // The larger the true effect, the more of the distribution lies above t.
        const auto above = [&](double true_d) { return shiftedStudentCdf(-t, df, -true_d * per_d); };
        return crossing(above, share, d - 20 / per_d, d + 20 / per_d);
    };
    return {endAt((1 - level) / 2), endAt((1 + level) / 2)};
}

Interval wilson(size_t hits, size_t n, double level) {
    if (n == 0) return {};
    const double z = normalQuantile((1 + level) / 2), count = double(n), share = double(hits) / count;
    const double middle = share + z * z / (2 * count);
    const double reach = z * std::sqrt(share * (1 - share) / count + z * z / (4 * count * count));
    const double scale = 1 + z * z / count;
    return {hits == 0 ? 0 : (middle - reach) / scale, hits == n ? 1 : (middle + reach) / scale};
}

}  // namespace bonemill::study
