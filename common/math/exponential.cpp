#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "common/math/pinned_math.h"
#include "common/math/tables.h"

#ifdef __FAST_MATH__
#error "The order of the operations is what makes the results exact."
#endif

namespace bonemill::pinned {
namespace {

constexpr uint64_t bitsOf(double x) noexcept {
    return std::bit_cast<uint64_t>(x);
}
double powerOfTwo(int k) noexcept {
    return std::bit_cast<double>(uint64_t(k + 1023) << 52);
}  // |k| < 1023

// Returns the upper 26 bits: the product of two such numbers is exact.
double upperHalf(double x) noexcept {
    return std::bit_cast<double>(bitsOf(x) & ~((uint64_t(1) << 27) - 1));
}

// e^(x + x_low) is 2^k · (step.high + step.low) · (1 + part), with |part| < 0.006.
struct Exponential {
    int k;
    Pair step;
    double part;
};

// It wants |x| < 800, and x_low less than the last place of x.
Exponential exponentialOf(double x, double x_low) noexcept {
    constexpr double kToInteger = 0x1.8p52;  // added: the sum has no places after the point
    const double steps = (x * k64ByLn2 + kToInteger) - kToInteger;
    const double r = ((x - steps * kLn2By64High) - steps * kLn2By64Low) + x_low;
    const int n = int(steps);
    const double square = r * r;
    const double even = 1.0 / 2 + square * (1.0 / 24 + square * (1.0 / 720));
    const double odd = 1.0 / 6 + square * (1.0 / 120);
    return {n >> 6, kExp[n & 63], r + square * (even + r * odd)};
}

// It takes two steps, as the power itself may be no number, and rounds once.
double scaled(double x, int k) noexcept {
    return x * powerOfTwo(k / 2) * powerOfTwo(k - k / 2);
}

double expOfSum(double x, double x_low) noexcept {
    if (x > 710) return kInfinity;
    if (x < -746) return 0;
    const Exponential e = exponentialOf(x, x_low);
    return scaled(e.step.high + (e.step.low + e.step.high * e.part), e.k);
}

// Returns ln((1 + share) x) of a positive, finite, normal x as a sum whose rest is below the last place of
// its first part; share is tiny.
Pair logOf(double x, double share) noexcept {
    const bool is_normal = x >= std::numeric_limits<double>::min();
    if (!is_normal) x *= 0x1p54;
    constexpr uint64_t kFirst = bitsOf(0.6875);
    const uint64_t from_first = bitsOf(x) - kFirst;
    const double k = double(int64_t(from_first) >> 52) - (is_normal ? 0 : 54);
    const double z = std::bit_cast<double>(bitsOf(x) - (from_first & ~((uint64_t(1) << 52) - 1)));
    const LogStep& step = kLog[from_first >> 45 & 127];
    const double z_high = upperHalf(z);
    const double r_high = z_high * step.factor - 1, r_low = (z - z_high) * step.factor;  // both exact
    const double r = r_high + r_low;
    const double r_rest = ((r_high - r) + r_low) + share;

    const double base = k * kLn2High + step.high;  // exact
    const double high = base + r;
    const double square = r * r, fourth = square * square;
    const double series = (-1.0 / 2 + r * (1.0 / 3)) + square * (-1.0 / 4 + r * (1.0 / 5)) +
                          fourth * ((-1.0 / 6 + r * (1.0 / 7)) - square * (1.0 / 8));
    const double low = ((base - high) + r) + (r_rest + (k * kLn2Low + step.low) + square * series);
    const double sum = high + low;
    return {sum, (high - sum) + low};
}

}  // namespace

double exp(double x) noexcept {
    return x == x ? expOfSum(x, 0) : x;
}

double expm1(double x) noexcept {
    if (!(x > -40)) return x == x ? -1 : x;
    if (x > 40) return expOfSum(x, 0);
    if (x == 0) return x;  // with its sign
    if (std::abs(x) < 1.0 / 16) {
        const double square = x * x, fourth = square * square;
        const double first = 1.0 / 2 + x * (1.0 / 6), second = 1.0 / 24 + x * (1.0 / 120);
        const double third = 1.0 / 720 + x * (1.0 / 5040), last = 1.0 / 40320 + x * (1.0 / 362880);
        return x + square * ((first + square * second) +
                             fourth * (third + square * (last + square * (1.0 / 3628800))));
    }
    const Exponential e = exponentialOf(x, 0);
    const double power = powerOfTwo(e.k), step = power * e.step.high;
    const double high = step - 1;
    const double rest = step > 1 ? (step - high) - 1 : step - (1 + high);
    return high + (rest + power * (e.step.low + e.step.high * e.part));
}

double log(double x) noexcept {
    if (x > 0 && x < kInfinity) return logOf(x, 0).high;
    return x == 0 ? -kInfinity : x > 0 ? x : kNaN;
}

double log1p(double x) noexcept {
    if (std::abs(x) < 0x1p-54) return x;
    if (!(x > -1 && x < kInfinity)) return x == -1 ? -kInfinity : x > 0 ? x : kNaN;
    const double sum = 1 + x;
    const double rest = x < 1 ? x - (sum - 1) : 1 - (sum - x);
    return logOf(sum, rest / sum).high;
}

double pow(double x, double y) noexcept {
    if (!(x >= 0) || y != y) return kNaN;
    if (y == 0) return 1;
    if (x == 0 || x == kInfinity) return (x == 0) == (y > 0) ? 0 : kInfinity;
    const Pair log = logOf(x, 0);
    const double product = y * log.high;
    if (!(std::abs(product) < 1000)) return product == product ? expOfSum(product, 0) : product;
    const double y_high = upperHalf(y), y_low = y - y_high, log_high = upperHalf(log.high),
                 log_low = log.high - log_high;
    const double lost =
        ((y_high * log_high - product) + y_high * log_low + y_low * log_high) + y_low * log_low;
    return expOfSum(product, lost + y * log.low);
}

}  // namespace bonemill::pinned
