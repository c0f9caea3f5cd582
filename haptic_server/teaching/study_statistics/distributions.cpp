#include "haptic_server/teaching/study_statistics/distributions.h"

#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace bonemill::study {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

bool isUsable(double t, double df) {
    return std::isfinite(t) && std::isfinite(df) && df > 0;
}

}  // namespace

double normalCdf(double x) {
    if (std::isnan(x)) return kNone;
    if (std::isinf(x)) return x > 0 ? 1 : 0;
    return boost::math::cdf(boost::math::normal(), x);
}

double normalQuantile(double p) {
    if (std::isnan(p)) return kNone;
    if (p <= 0 || p >= 1) return p <= 0 ? -HUGE_VAL : HUGE_VAL;
    return boost::math::quantile(boost::math::normal(), p);
}

double studentTwoSided(double t, double df) {
    if (!isUsable(t, df)) return kNone;
    return 2 * boost::math::cdf(boost::math::complement(boost::math::students_t(df), std::abs(t)));
}

double studentQuantile(double p, double df) {
    if (!isUsable(p, df) || p <= 0 || p >= 1) return kNone;
    return boost::math::quantile(boost::math::students_t(df), p);
}

double shiftedStudentCdf(double t, double df, double shift) {
    if (!isUsable(t, df) || !std::isfinite(shift)) return kNone;
    return boost::math::cdf(boost::math::non_central_t(df, shift), t);
}

}  // namespace bonemill::study
