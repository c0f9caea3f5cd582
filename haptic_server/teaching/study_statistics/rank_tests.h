// Tests that go by the order of the answers only: they suit scales of few steps, with ties, and small unequal
// groups. Up to kMaxExact values the chances are exact, ties included: the ranks' sums are counted over all
// ways of dealing the values out (Streitberg and Röhmel 1986); above, the normal approximation with ties,
// without a correction for continuity. Pure; any thread may call them.
#pragma once

#include "haptic_server/teaching/study_statistics/samples.h"

namespace bonemill::study {

inline constexpr size_t kMaxExact = 100;

struct RankTest {
    double statistic = kNotKnown;
    // To both sides it is the chance to be at least as far from the expected value; R's coin counts so, too.
    double p = kNotKnown;
    double p_less = kNotKnown, p_greater = kNotKnown;
    bool is_exact = false;
};

// The average ranks, from 1.
std::vector<double> ranksOf(Sample values);

// Mann-Whitney. The statistic is U: how many pairs have a > b, ties counted half.
RankTest mannWhitney(Sample a, Sample b);

// Wilcoxon's test of paired differences as Pratt (1959) has it: zeros are ranked, then left out. The
// statistic is the sum of the positive differences' ranks.
RankTest prattSignedRank(Sample differences);

}  // namespace bonemill::study
