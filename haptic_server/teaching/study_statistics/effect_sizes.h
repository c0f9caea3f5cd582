// How large a difference between two groups is, whatever its P: the figures that later studies can add up.
// Pure; any thread may call them.
#pragma once

#include <cstdint>
#include <functional>

#include "haptic_server/teaching/study_statistics/samples.h"

namespace bonemill::study {

inline constexpr size_t kReplicates = 2000;

// The difference of the means in pooled standard deviations (Cohen's d).
double cohensD(Sample a, Sample b);
// Cohen's d without its bias in small samples: times 1 - 3 / (4 (n1 + n2) - 9).
double hedgesG(Sample a, Sample b);
// The chance that one of the first group answers higher than one of the second, ties counted half: U / (n1
// n2).
double aucOf(Sample a, Sample b);
// Of an AUC: from -1, all of the first lower, to 1.
inline double cliffsDelta(double auc) {
    return 2 * auc - 1;
}

// The bias-corrected and accelerated interval (Efron 1987) from bootstrap replicates of a statistic.
// `influence` says how far each observation draws the statistic, in any common unit. Replicates equal to the
// observed value count half as lying below it: answers on few steps have many. It is not known when all
// replicates lie to one side.
Interval bcaInterval(std::vector<double> replicates, double observed, Sample influence, double level = 0.95);

using TwoGroupStatistic = std::function<double(Sample, Sample)>;

// It draws within each group, the same values for the same seed on every machine. It is not known when more
// than one replicate in a hundred has no value, or none differs.
Interval bootstrapInterval(Sample a, Sample b, const TwoGroupStatistic& statistic, uint64_t seed,
                           double level = 0.95);

}  // namespace bonemill::study
