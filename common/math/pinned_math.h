// These functions of the mathematics have results with the same bits on every CPU and with every C library.
// The C library picks other code where the CPU has fused multiply-add, and its last bits differ; these are
// made of the basic operations of IEEE 754 alone. Everything that the tick computes with, and what is set up
// for it, calls these. Angles are in rad. The errors are the largest seen in the tests, in units in the last
// place. They are RT-safe, for any thread.
#pragma once

namespace bonemill::pinned {

double exp(double x) noexcept;    // Error below 0.6, and below 1.1 where the result is subnormal.
double expm1(double x) noexcept;  // e^x - 1; error below 0.8.
double log(double x) noexcept;    // Error below 0.6; NaN of negative numbers.
double log1p(double x) noexcept;  // ln(1 + x); error below 0.8.
// Returns x^y for x >= 0 and finite y, and NaN of negative x, whatever y is. The error is below 0.6 where x^y
// lies between e^-50 and e^50.
double pow(double x, double y) noexcept;

// They take any finite angle, and return NaN of an infinite one.
double sin(double x) noexcept;              // Error below 0.9.
double cos(double x) noexcept;              // Error below 0.9.
double atan2(double y, double x) noexcept;  // Signs and infinite arguments as std::atan2. Error below 1.4.

constexpr double square(double x) noexcept {
    return x * x;
}
constexpr double cube(double x) noexcept {
    return x * x * x;
}

}  // namespace bonemill::pinned
