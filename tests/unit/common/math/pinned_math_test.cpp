// The functions are compared with the long doubles of the C library, whose last bit is 2^-11 of a double's.
#include "common/math/pinned_math.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "common/math/tables.h"

namespace bonemill {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kSubnormal = std::numeric_limits<double>::denorm_min();
constexpr double kHuge = std::numeric_limits<double>::max();
constexpr int kArguments = 100000;

static_assert(std::numeric_limits<long double>::digits >= 64);

// It counts units in the last place of the double next to the truth.
double errorOf(double found, long double truth) {
    const double near = double(truth);
    if (std::isnan(found) && std::isnan(near)) return 0;
    if (!std::isfinite(found) || !std::isfinite(near)) return found == near ? 0 : kInfinity;
    const double place = std::nextafter(std::abs(near), kInfinity) - std::abs(near);
    return double(std::abs(found - truth) / place);
}

struct Worst {
    double error = 0, at = 0;

    void take(double found, long double truth, double argument) {
        const double here = errorOf(found, truth);
        if (here > error) *this = {here, argument};
    }
};

// The arguments go from low to high, alike on the line.
template <class Function, class Truth>
Worst worstOver(double low, double high, Function function, Truth truth) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> any(low, high);
    Worst worst;
    for (int n = 0; n < kArguments; ++n) {
        const double x = n == 0 ? low : n == 1 ? high : any(random);
        worst.take(function(x), truth((long double)x), x);
    }
    return worst;
}

// The arguments are of both signs, with exponents from low to high, alike on the scale of exponents, and with
// the neighbours of powers of two.
template <class Function, class Truth>
Worst worstOverExponents(int low, int high, bool with_negative, Function function, Truth truth) {
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> digits(1, 2);
    std::uniform_int_distribution<int> exponent(low, high);
    Worst worst;
    for (int n = 0; n < kArguments; ++n) {
        const double power = std::ldexp(1.0, exponent(random));
        const double size = n % 8 == 0   ? std::nextafter(power, 0)
                            : n % 8 == 1 ? power
                                         : digits(random) * power;
        const double x = with_negative && n % 2 ? -size : size;
        worst.take(function(x), truth((long double)x), x);
    }
    return worst;
}

void expectBelow(double limit, const Worst& worst) {
    EXPECT_LT(worst.error, limit) << "at " << std::hexfloat << worst.at;
}

const auto kExpl = [](long double x) { return expl(x); };
const auto kExpm1l = [](long double x) { return expm1l(x); };
const auto kLogl = [](long double x) { return logl(x); };
const auto kLog1pl = [](long double x) { return log1pl(x); };
const auto kSinl = [](long double x) { return sinl(x); };
const auto kCosl = [](long double x) { return cosl(x); };

TEST(PinnedMath, ExpIsExactToTheLastPlace) {
    expectBelow(0.6, worstOver(-1, 1, pinned::exp, kExpl));
    expectBelow(0.6, worstOver(-50, 50, pinned::exp, kExpl));
    expectBelow(0.6, worstOver(-708, 709.78, pinned::exp, kExpl));
    expectBelow(1.1, worstOver(-746, -708, pinned::exp, kExpl));
    expectBelow(0.6, worstOverExponents(-1074, 5, true, pinned::exp, kExpl));
    EXPECT_EQ(pinned::exp(0), 1);
    EXPECT_EQ(pinned::exp(-0.0), 1);
    EXPECT_EQ(pinned::exp(kSubnormal), 1);
    EXPECT_EQ(pinned::exp(710), kInfinity);
    EXPECT_EQ(pinned::exp(kHuge), kInfinity);
    EXPECT_EQ(pinned::exp(kInfinity), kInfinity);
    EXPECT_EQ(pinned::exp(-kHuge), 0);
    EXPECT_EQ(pinned::exp(-kInfinity), 0);
    EXPECT_TRUE(std::isnan(pinned::exp(kNaN)));
}

TEST(PinnedMath, Expm1IsExactToTheLastPlace) {
    expectBelow(0.8, worstOver(-0.1, 0.1, pinned::expm1, kExpm1l));
    expectBelow(0.8, worstOver(-1, 1, pinned::expm1, kExpm1l));
    expectBelow(0.8, worstOver(-50, 50, pinned::expm1, kExpm1l));
    expectBelow(0.8, worstOver(30, 709.78, pinned::expm1, kExpm1l));
    expectBelow(0.8, worstOverExponents(-1021, 8, true, pinned::expm1, kExpm1l));
    EXPECT_EQ(pinned::expm1(0), 0);
    EXPECT_FALSE(std::signbit(pinned::expm1(0.0)));
    EXPECT_TRUE(std::signbit(pinned::expm1(-0.0)));
    EXPECT_EQ(pinned::expm1(kSubnormal), kSubnormal);
    EXPECT_EQ(pinned::expm1(kInfinity), kInfinity);
    EXPECT_EQ(pinned::expm1(-kInfinity), -1);
    EXPECT_EQ(pinned::expm1(-kHuge), -1);
    EXPECT_TRUE(std::isnan(pinned::expm1(kNaN)));
}

TEST(PinnedMath, LogIsExactToTheLastPlace) {
    expectBelow(0.6, worstOver(0.5, 2, pinned::log, kLogl));
    expectBelow(0.6, worstOver(0.98, 1.02, pinned::log, kLogl));
    expectBelow(0.6, worstOver(0.1, 1000, pinned::log, kLogl));
    expectBelow(0.6, worstOverExponents(-1074, 1022, false, pinned::log, kLogl));
    EXPECT_EQ(pinned::log(1), 0);
    EXPECT_EQ(pinned::log(0), -kInfinity);
    EXPECT_EQ(pinned::log(-0.0), -kInfinity);
    EXPECT_EQ(pinned::log(kInfinity), kInfinity);
    EXPECT_TRUE(std::isnan(pinned::log(-1)));
    EXPECT_TRUE(std::isnan(pinned::log(-kInfinity)));
    EXPECT_TRUE(std::isnan(pinned::log(kNaN)));
}

TEST(PinnedMath, Log1pIsExactToTheLastPlace) {
    expectBelow(0.8, worstOver(0, 1, pinned::log1p, kLog1pl));
    expectBelow(0.8, worstOver(-0.999, 0, pinned::log1p, kLog1pl));
    expectBelow(0.8, worstOver(-0.02, 0.02, pinned::log1p, kLog1pl));
    expectBelow(0.8, worstOver(1, 1e6, pinned::log1p, kLog1pl));
    expectBelow(0.8, worstOverExponents(-1021, -2, true, pinned::log1p, kLog1pl));
    expectBelow(0.8, worstOverExponents(0, 1022, false, pinned::log1p, kLog1pl));
    EXPECT_EQ(pinned::log1p(0), 0);
    EXPECT_EQ(pinned::log1p(kSubnormal), kSubnormal);
    EXPECT_EQ(pinned::log1p(-1), -kInfinity);
    EXPECT_EQ(pinned::log1p(kInfinity), kInfinity);
    EXPECT_TRUE(std::isnan(pinned::log1p(-1.5)));
    EXPECT_TRUE(std::isnan(pinned::log1p(kNaN)));
}

TEST(PinnedMath, PowIsExactToTheLastPlace) {
    for (const double y : {1.5, 0.5, 2.0, 3.0, -1.0, -1.7, 0.37, 1 / 2.5, 12.3})
        expectBelow(0.6, worstOver(
                             0.02, 50, [&](double x) { return pinned::pow(x, y); },
                             [&](long double x) { return powl(x, y); }));
    for (const double x : {1e-300, 1e-3, 0.3, 0.999, 1.001, 7.0, 1e300, kSubnormal})
        expectBelow(1.1, worstOver(
                             -1, 1, [&](double y) { return pinned::pow(x, y); },
                             [&](long double y) { return powl(x, y); }));
    EXPECT_EQ(pinned::pow(3, 0), 1);
    EXPECT_EQ(pinned::pow(0, 0), 1);
    EXPECT_EQ(pinned::pow(kInfinity, 0), 1);
    EXPECT_EQ(pinned::pow(1, 1e300), 1);
    EXPECT_EQ(pinned::pow(0, 1.5), 0);
    EXPECT_EQ(pinned::pow(0, -1.5), kInfinity);
    EXPECT_EQ(pinned::pow(kInfinity, 1.5), kInfinity);
    EXPECT_EQ(pinned::pow(kInfinity, -1.5), 0);
    EXPECT_EQ(pinned::pow(2, 1024), kInfinity);
    EXPECT_EQ(pinned::pow(2, 1e300), kInfinity);
    EXPECT_EQ(pinned::pow(2, -1e300), 0);
    EXPECT_EQ(pinned::pow(2, -1074), kSubnormal);
    EXPECT_TRUE(std::isnan(pinned::pow(-1, 2)));
    EXPECT_TRUE(std::isnan(pinned::pow(2, kNaN)));
    EXPECT_TRUE(std::isnan(pinned::pow(0, kNaN)));
    EXPECT_TRUE(std::isnan(pinned::pow(kNaN, 2)));
}

template <class Function, class Truth>
void expectErrorBelow(double limit, Function function, Truth truth) {
    for (const double range : {0.1, 0.8, 7.0, 1000.0, 1e5, 1e15}) {
        const Worst worst = worstOver(-range, range, function, truth);
        expectBelow(limit, worst);
    }
    const Worst worst = worstOverExponents(-1021, 1022, true, function, truth);
    expectBelow(limit, worst);
    // The sine or the cosine is smallest at the doubles next to multiples of a right angle.
    Worst near;
    for (int quarter = 1; quarter < kArguments; ++quarter) {
        const double x = double(quarter * (M_PIl / 2));
        near.take(function(x), truth((long double)x), x);
    }
    expectBelow(limit, near);
    for (const double x : {kInfinity, -kInfinity, kNaN}) EXPECT_TRUE(std::isnan(function(x)));
    // This double lies closest to a multiple of a right angle.
    const double closest = std::ldexp(6381956970095103.0, 797);
    EXPECT_LT(errorOf(function(closest), truth((long double)closest)), limit);
    EXPECT_LT(errorOf(function(kHuge), truth((long double)kHuge)), limit);
}

TEST(PinnedMath, SineAndCosineAreExactToTheLastPlace) {
    expectErrorBelow(0.9, pinned::sin, kSinl);
    expectErrorBelow(0.9, pinned::cos, kCosl);
    for (const double x : {0.0, -0.0, kSubnormal, -kSubnormal, 1e-300}) {
        EXPECT_EQ(std::bit_cast<uint64_t>(pinned::sin(x)), std::bit_cast<uint64_t>(x));
        EXPECT_EQ(pinned::cos(x), 1);
    }
}

TEST(PinnedMath, Atan2IsExactToTheLastPlace) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(-1, 1), angle(-M_PI, M_PI);
    std::uniform_int_distribution<int> exponent(-1000, 1000);
    Worst worst;
    for (int n = 0; n < 4 * kArguments; ++n) {
        double y = unit(random), x = unit(random);
        if (n % 4 == 1) y *= 1e-3;
        if (n % 4 == 2) {
            const double turn = angle(random);
            y = std::sin(turn);
            x = std::cos(turn);
        }
        if (n % 4 == 3) {
            const int power = exponent(random);
            y = std::ldexp(y, power);
            x = std::ldexp(x, std::clamp(power + n % 61 - 30, -1000, 1000));
        }
        worst.take(pinned::atan2(y, x), atan2l(y, x), y / x);
    }
    expectBelow(1.4, worst);
}

TEST(PinnedMath, Atan2AtTheEdges) {
    for (const double y : {0.0, 1.0, kInfinity, kSubnormal, kHuge})
        for (const double x : {0.0, 1.0, kInfinity, kSubnormal, kHuge})
            for (const double signed_y : {y, -y})
                for (const double signed_x : {x, -x}) {
                    const double found = pinned::atan2(signed_y, signed_x),
                                 truth = double(atan2l(signed_y, signed_x));
                    EXPECT_NEAR(found, truth, 5e-16) << signed_y << " " << signed_x;
                    EXPECT_EQ(std::signbit(found), std::signbit(truth)) << signed_y << " " << signed_x;
                }
    EXPECT_TRUE(std::isnan(pinned::atan2(kNaN, 1)));
    EXPECT_TRUE(std::isnan(pinned::atan2(1, kNaN)));
    EXPECT_TRUE(std::isnan(pinned::atan2(kInfinity, kNaN)));
}

// The tables are written by a script; a wrong digit far down shows here and nowhere else.
TEST(PinnedMath, TablesHoldMoreThanADouble) {
    for (int i = 0; i < 64; ++i)
        EXPECT_NEAR(double((pinned::kExp[i].high - exp2l(i / 64.0L)) + pinned::kExp[i].low), 0, 3e-19) << i;
    for (int i = 0; i <= 16; ++i)
        EXPECT_NEAR(double((pinned::kAtan[i].high - atanl(i / 16.0L)) + pinned::kAtan[i].low), 0, 1.5e-19)
            << i;
    for (const pinned::LogStep& step : pinned::kLog)
        EXPECT_NEAR(double((step.high + logl(step.factor)) + step.low), 0, 1e-19) << step.factor;
}

// The bits are the same with every compiler, every C library and every CPU. Whoever changes a function on
// purpose changes this.
TEST(PinnedMath, BitsAreThese) {
    uint64_t hash = 14695981039346656037u;
    const auto add = [&](double x) {
        hash = (hash ^ std::bit_cast<uint64_t>(x)) * 1099511628211u;
        hash ^= hash >> 29;
    };
    uint64_t state = 1;
    const auto any = [&] {  // from -1 to 1
        state = state * 6364136223846793005u + 1442695040888963407u;
        return double(int64_t(state)) * 0x1p-63;
    };
    for (int n = 0; n < 100000; ++n) {
        const double x = any(), y = any();
        for (const double scale : {1.0, 30.0, 1e6}) {
            add(pinned::exp(scale * x));
            add(pinned::expm1(scale * x));
            add(pinned::sin(scale * x));
            add(pinned::cos(scale * x));
            add(pinned::atan2(scale * x, y));
            const double size = scale * (1.0 + x);
            add(pinned::log(size));
            add(pinned::log1p(size));
            add(pinned::pow(size, 3 * y));
        }
    }
    EXPECT_EQ(hash, 16115796386222493812u);
}

}  // namespace
}  // namespace bonemill
