// The distributions that the tests of a study need, behind plain functions, so that only one source reads
// Boost.Math. Pure; any thread may call them. What is not defined (no degrees of freedom, an infinite
// argument) is NaN.
#pragma once

namespace bonemill::study {

double normalCdf(double x);
// `p` is above 0 and below 1, else the result is infinite.
double normalQuantile(double p);

// The chance of a value at least as far from zero as `t`, to either side.
double studentTwoSided(double t, double df);
double studentQuantile(double p, double df);
// Student's distribution about a true effect: `shift` is the expected value of its numerator.
double shiftedStudentCdf(double t, double df, double shift);

}  // namespace bonemill::study
