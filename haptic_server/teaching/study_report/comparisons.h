// Every comparison that a study's protocol leads to, each with two tests and effect sizes, and P adjusted for
// their number. Pure; any thread may call the functions.
#pragma once

#include "haptic_server/teaching/study_report/study_data.h"
#include "haptic_server/teaching/study_statistics/rank_tests.h"

namespace bonemill::study {

// Two groups of people; each person counts once.
struct GroupComparison {
    const Measure* measure = nullptr;
    std::string first, second;
    Summary of_first, of_second;
    TTest welch;
    RankTest rank;
    double g = kNotKnown, delta = kNotKnown, auc = kNotKnown;
    Interval of_g, of_delta, of_auc;
    double holm_welch = kNotKnown, holm_rank = kNotKnown;
};

// Two conditions, by the people who answered under both.
struct ConditionComparison {
    const Measure* measure = nullptr;
    std::string first, second;
    Summary of_first, of_second;
    TTest paired;
    RankTest pratt;
    double d = kNotKnown;  // mean difference over the differences' standard deviation
    double holm_paired = kNotKnown, holm_pratt = kNotKnown;
};

// A family, in which Holm's adjustment counts, is all items of a form, or all its scores, over all pairs.
std::vector<GroupComparison> compareGroups(const StudyData& data, const std::vector<Measure>& measures);
std::vector<ConditionComparison> compareConditions(const StudyData& data,
                                                   const std::vector<Measure>& measures);

}  // namespace bonemill::study
