#!/usr/bin/env python3
"""Writes tables.h, the numbers behind pinned_math.h, to standard output. It needs nothing but Python: all values come
from integer arithmetic of kBits fractional bits.

    common/math/make_tables.py > common/math/tables.h"""
from fractions import Fraction

BITS = 1400  # after the binary point; 2/π alone needs 1200
ONE = 1 << BITS


def exp(x):
    """e^x of a fraction, as a fraction."""
    term = total = ONE
    n = 1
    while term:
        term = term * x.numerator // (x.denominator * n)
        total += term
        n += 1
    return Fraction(total, ONE)


def atanh_of_inverse(n):
    """atanh(1/n) in units of 1/ONE."""
    term, total, k = ONE // n, 0, 1
    while term:
        total += term // k
        term //= n * n
        k += 2
    return total


def log(x):
    """ln of a positive fraction near 1, from 2 atanh((x-1)/(x+1))."""
    ratio = (x - 1) / (x + 1)
    term, total, k = ONE * ratio.numerator // ratio.denominator, 0, 1
    while abs(term) > 1:
        total += 2 * term // k
        term = term * ratio.numerator ** 2 // ratio.denominator ** 2
        k += 2
    return Fraction(total, ONE)


def atan(x):
    """Arc tangent of a fraction from 0 to 1; halved first, so that the series is short."""
    if x > Fraction(1, 4):  # atan x = atan 1/4 + atan (x - 1/4) / (1 + x/4)
        return atan(Fraction(1, 4)) + atan((x - Fraction(1, 4)) / (1 + x / 4))
    term, total, k = ONE * x.numerator // x.denominator, 0, 1
    while abs(term) > 1:
        total += term // k
        term = -(term * x.numerator ** 2 // x.denominator ** 2)
        k += 2
    return Fraction(total, ONE)


LN2 = Fraction(2 * atanh_of_inverse(3), ONE)
PI = 4 * (4 * atan(Fraction(1, 5)) - atan(Fraction(1, 239)))


def rounded(x, place):
    """The nearest multiple of 2^-place."""
    return Fraction(round(x * (1 << place)), 1 << place)


def number(x):
    return float(x).hex()  # Fraction to float rounds to nearest


def parts(x, *places):
    """x as a sum: multiples of 2^-place for each place, and a double for the rest."""
    found = []
    for place in places:
        found.append(rounded(x, place))
        x -= found[-1]
    return [number(part) for part in [*found, x]]


def pair(x):
    high = Fraction(float(x))
    return [number(high), number(x - high)]


def table(kind, name, size, rows, comment):
    print(f"\n// {comment}\nconstexpr {kind} {name}[{size}] = {{")
    for row in rows:
        print("    {" + ", ".join(row) + "},")
    print("};")


def constants(comment, **values):
    print(f"\n// {comment}")
    for name, value in values.items():
        print(f"constexpr double {name} = {value};")


def log_rows():
    for i in range(128):
        # The bits of x run on from those of 0.6875, in steps of 2^-7 of the binade that x lies in.
        step = i - 80
        low, high = (1 + Fraction(step, 256), 1 + Fraction(step + 1, 256)) if step < 0 else (
            1 + Fraction(step, 128), 1 + Fraction(step + 1, 128))
        factor = Fraction(1) if step in (-1, 0) else rounded(2 / (low + high), 10)
        yield [number(factor), *parts(-log(factor), 40)]


print("""// Written by make_tables.py: values that take more than a line of arithmetic, each as the sum of what stands
// in its row.
#pragma once

#include <cstdint>
#include <limits>

// clang-format off
namespace bonemill::pinned {

struct Pair { double high, low; };
struct LogStep { double factor, high, low; };

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();""")
constants("ln 2 / 64, the first so short that 2^17 times it is exact; ln 2 for log, as multiples of 2^-40 and the rest.",
          **dict(zip(("kLn2By64High", "kLn2By64Low"), parts(LN2 / 64, 41))), **dict(zip(("kLn2High", "kLn2Low"), parts(LN2, 40))),
          k64ByLn2=number(64 / LN2))
constants("π/2 in three parts, the first two so short that 2^10 times them is exact; 2/π; π/2 and π as pairs.",
          **dict(zip(("kHalfPi1", "kHalfPi2", "kHalfPi3"), parts(PI / 2, 42, 84))), kTwoByPi=number(2 / PI),
          **dict(zip(("kHalfPiHigh", "kHalfPiLow"), pair(PI / 2))), **dict(zip(("kPiHigh", "kPiLow"), pair(PI))))
table("Pair", "kExp", 64, (pair(exp(LN2 * Fraction(i, 64))) for i in range(64)), "2^(i/64).")
table("LogStep", "kLog", 128, log_rows(), "A factor of 11 bits that brings the i-th interval next to 1, and minus its logarithm.")
table("Pair", "kAtan", 17, (pair(atan(Fraction(i, 16))) for i in range(17)), "The arc tangent of i/16.")
bits = int(2 / PI * (1 << 1216))
print("\n// The binary places of 2/π, after 64 zeros.\nconstexpr uint64_t kTwoByPiBits[20] = {\n    0x0000000000000000,")
for i in range(19):
    print(f"    0x{bits >> (1216 - 64 * (i + 1)) & (2**64 - 1):016x},")
print("""};

}  // namespace bonemill::pinned""")
