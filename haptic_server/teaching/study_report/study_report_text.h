// The report of a study as Markdown: what was planned and done, what such a study can see, each question,
// each comparison with what it can bear. Pure; any thread may call the functions.
#pragma once

#include "haptic_server/teaching/study_report/study_data.h"

namespace bonemill::study {

std::string reportText(const StudyData& data, const std::vector<Measure>& measures,
                       const std::vector<GroupComparison>& groups,
                       const std::vector<ConditionComparison>& conditions);

// A cell of a table may not end it.
std::string cellText(const std::string& text);

// Who came, and who answered all that was asked.
std::string flowTable(const StudyData& data);

}  // namespace bonemill::study
