#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "common/math/pinned_math.h"
#include "common/math/tables.h"

namespace bonemill::pinned {
namespace {

constexpr double kQuarterPi = kHalfPiHigh / 2;

// It holds an angle from -π/4 to π/4 or little more, as a sum, and by how many right angles it
// was turned back.
struct Turned {
    int quarter;
    Pair angle;
};

// Returns a + b and what the sum lost.
Pair sumOf(double a, double b) noexcept {
    const double sum = a + b, b_part = sum - a;
    return {sum, (a - (sum - b_part)) + (b - b_part)};
}

// Returns a · b and what the product lost.
Pair productOf(double a, double b) noexcept {
    const auto upper = [](double x) {
        return std::bit_cast<double>(std::bit_cast<uint64_t>(x) & ~((uint64_t(1) << 27) - 1));
    };
    const double a_high = upper(a), a_low = a - a_high, b_high = upper(b), b_low = b - b_high,
                 product = a * b;
    return {product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

constexpr double kManyTurns = 1000;  // from here on too many for three parts of π/2

Turned turnedByFew(double x) noexcept {
    constexpr double kToInteger = 0x1.8p52;
    const double quarters = (x * kTwoByPi + kToInteger) - kToInteger;
    const Pair first = sumOf(x - quarters * kHalfPi1, -quarters * kHalfPi2);  // all exact
    const double rest = first.low - quarters * kHalfPi3;
    const double high = first.high + rest;
    return {int(quarters), {high, (first.high - high) + rest}};
}

// Returns three words of the places of 2/π, from the place `first` on, where place 0 is the first
// after 64 zeros.
std::array<uint64_t, 3> placesFrom(int first) noexcept {
    const int word = (first + 64) / 64, shift = (first + 64) % 64;
    std::array<uint64_t, 3> found{};
    for (int i = 0; i < 3; ++i) {
        found[size_t(i)] = kTwoByPiBits[word + i] << shift;
        if (shift > 0) found[size_t(i)] |= kTwoByPiBits[word + i + 1] >> (64 - shift);
    }
    return found;
}

// Takes the product of x's digits with the places of 2/π that matter: two bits of whole right angles and 190
// of the rest (Payne and Hanek 1983).
Turned turnedByMany(double x) noexcept {
    __extension__ using Wide = unsigned __int128;
    const uint64_t bits = std::bit_cast<uint64_t>(x);
    const uint64_t digits = (bits & ((uint64_t(1) << 52) - 1)) | uint64_t(1) << 52;
    const int exponent = int(bits >> 52 & 0x7ff) - 1075;
    const std::array<uint64_t, 3> places = placesFrom(exponent - 2);
    const Wide low = Wide(digits) * places[2];
    const Wide middle = Wide(digits) * places[1] + uint64_t(low >> 64);
    std::array<uint64_t, 3> product{digits * places[0] + uint64_t(middle >> 64), uint64_t(middle),
                                    uint64_t(low)};

    // It is rounded to the nearest right angle: what is beyond half of one is missing to the next.
    int quarter = int(product[0] >> 62);
    const bool is_beyond = (product[0] >> 61 & 1) != 0;
    quarter += is_beyond;
    if (is_beyond)
        for (uint64_t& word : product) word = ~word;
    product[0] &= (uint64_t(1) << 62) - 1;
    Pair share{0, 0};
    double weight = 0x1p-30;
    for (const uint64_t word : product)
        for (const uint64_t half : {word >> 32, word & 0xffffffff}) {
            const Pair sum = sumOf(share.high, double(half) * weight);
            share = {sum.high, share.low + sum.low};
            weight *= 0x1p-32;
        }
    const Pair angle = productOf(share.high, kHalfPiHigh);
    const double rest = angle.low + share.high * kHalfPiLow + share.low * kHalfPiHigh;
    const double high = angle.high + rest, rest_of_sum = (angle.high - high) + rest;
    const double sign = is_beyond == std::signbit(x) ? 1 : -1;
    return {std::signbit(x) ? -quarter : quarter, {sign * high, sign * rest_of_sum}};
}

Turned turned(double x) noexcept {
    const double size = std::abs(x);
    if (size <= kQuarterPi) return {0, {x, 0}};
    return size < kManyTurns ? turnedByFew(x) : turnedByMany(x);
}

double sineOf(const Pair& x) noexcept {
    if (std::abs(x.high) < 0x1p-27) return x.high;  // also zero with its sign
    const double s = x.high * x.high, s2 = s * s;
    const double first = -1.0 / 6 + s * (1.0 / 120), second = -1.0 / 5040 + s * (1.0 / 362880);
    const double third = -1.0 / 39916800 + s * (1.0 / 6227020800);
    const double last = -1.0 / 1307674368000 + s * (1.0 / 355687428096000);
    const double series = (first + s2 * second) + s2 * s2 * (third + s2 * last);
    return x.high + (x.high * s * series + x.low * (1 - s / 2));
}

double cosineOf(const Pair& x) noexcept {
    const Pair square = productOf(x.high, x.high);
    const double s = square.high, s2 = s * s, half = s / 2, main = 1 - half;
    const double first = 1.0 / 24 - s * (1.0 / 720), second = 1.0 / 40320 - s * (1.0 / 3628800);
    const double third = 1.0 / 479001600 - s * (1.0 / 87178291200);
    const double series = (first + s2 * second) + s2 * s2 * (third + s2 * (1.0 / 20922789888000));
    return main + (((1 - main) - half) + (s2 * series - (square.low / 2 + x.high * x.low)));
}

// Returns atan(num / den) for 0 <= num <= den, where den is neither 0 nor near the ends of the range.
Pair atanOfShare(double num, double den) noexcept {
    const int n = int(16 * (num / den));
    const double near = n / 16.0;
    const double den_high = std::bit_cast<double>(std::bit_cast<uint64_t>(den) & ~((uint64_t(1) << 27) - 1));
    const double way = (num - near * den_high) - near * (den - den_high);
    const double u = way / (den + near * num), s = u * u, s2 = s * s;
    const double series = ((-1.0 / 3 + s * (1.0 / 5)) + s2 * (-1.0 / 7 + s * (1.0 / 9))) +
                          s2 * s2 * (-1.0 / 11 + s * (1.0 / 13));
    return {kAtan[n].high, u + (kAtan[n].low + u * s * series)};
}

}  // namespace

double sin(double x) noexcept {
    if (!(std::abs(x) < kInfinity)) return kNaN;
    const Turned t = turned(x);
    const double size = t.quarter & 1 ? cosineOf(t.angle) : sineOf(t.angle);
    return t.quarter & 2 ? -size : size;
}

double cos(double x) noexcept {
    if (!(std::abs(x) < kInfinity)) return kNaN;
    const Turned t = turned(x);
    const double size = t.quarter & 1 ? sineOf(t.angle) : cosineOf(t.angle);
    return (t.quarter + 1) & 2 ? -size : size;
}

double atan2(double y, double x) noexcept {
    if (!(x == x && y == y)) return kNaN;
    double across = std::abs(y), along = std::abs(x);
    if (across == kInfinity || along == kInfinity) {
        across = across == kInfinity ? 1 : 0;
        along = along == kInfinity ? 1 : 0;
    }
    const bool is_steep = across > along;
    if (is_steep) std::swap(across, along);
    if (along > 0x1p500 || along < 0x1p-500) {
        const double scale = along > 1 ? 0x1p-500 : 0x1p500;
        across *= scale;
        along *= scale;
    }
    const Pair share = along > 0 ? atanOfShare(across, along) : Pair{0, 0};

    // The angle is `base` plus or minus that of the share.
    const bool is_behind = std::signbit(x);
    const Pair base = is_steep    ? Pair{kHalfPiHigh, kHalfPiLow}
                      : is_behind ? Pair{kPiHigh, kPiLow}
                                  : Pair{0, 0};
    const double sign = is_steep == is_behind ? 1 : -1;
    const double high = base.high + sign * share.high;
    const double rest = base.high > 0 ? (base.high - high) + sign * share.high : 0;
    const double angle = high + (rest + base.low + sign * share.low);
    return std::signbit(y) ? -angle : angle;
}

}  // namespace bonemill::pinned
