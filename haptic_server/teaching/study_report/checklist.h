// What a report of a simulation study owes its readers: the items of CONSORT and STROBE with their extensions
// for simulation-based research (Cheng et al. 2016, doi 10.1186/s41077-016-0025-y) and what reviewers of
// haptics ask, filled in as far as the study knows. Pure; any thread may call it.
#pragma once

#include "haptic_server/teaching/study_report/study_data.h"

namespace bonemill::study {

std::string checklistText(const StudyData& data, const std::string& program_version);

}  // namespace bonemill::study
