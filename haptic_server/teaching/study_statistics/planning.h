// What a study can see before it is made, and what many tests in it do to its errors. Pure; any thread may
// call them.
#pragma once

#include "haptic_server/teaching/study_statistics/samples.h"

namespace bonemill::study {

// The chance of at least one false alarm in `tests` independent tests at `alpha` when nothing differs.
double falseAlarmChance(size_t tests, double alpha);

// Holm's (1979) adjusted P, in the order of `p`. Tests without a P (NaN) are none and stay so.
std::vector<double> holm(Sample p);

// The power of Student's test to both sides for a true difference of `d` standard deviations, by the shifted
// t.
double powerOfTTest(double d, size_t n1, size_t n2, double alpha);
// The least d that it sees with this power; NaN for groups that have no spread (fewer than three people in
// all).
double smallestDetectableD(size_t n1, size_t n2, double alpha, double power);
// How many people each of two groups of one size needs for that; 0 when more than 100,000.
size_t neededPerGroup(double d, double alpha, double power);

// The d that a printed P of Student's test means, and the interval of true d that go with it.
double impliedD(double p, size_t n1, size_t n2);
Interval intervalOfD(double d, size_t n1, size_t n2, double level = 0.95);

// The interval of a share (Wilson 1927): `hits` of `n`.
Interval wilson(size_t hits, size_t n, double level = 0.95);

}  // namespace bonemill::study
