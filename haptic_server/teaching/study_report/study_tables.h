// The tables of a study for other programs: commas, a header, all digits, an empty field for what is not
// known. Pure; any thread may call the functions.
#pragma once

#include "haptic_server/teaching/study_report/study_data.h"

namespace bonemill::study {

struct TableFile {
    std::string name, text;
};

// answers.csv (one line per answer, by session and pseudonym), sessions.csv, scores.csv, items.csv,
// group_comparisons.csv, condition_comparisons.csv, alpha.csv.
std::vector<TableFile> tablesOf(const StudyData& data, const std::vector<Measure>& measures,
                                const std::vector<GroupComparison>& groups,
                                const std::vector<ConditionComparison>& conditions);

// How many people answered at least the threshold.
size_t hitsOf(const std::vector<double>& values, double threshold);

}  // namespace bonemill::study
