// Writes all that `study report` makes. It is for one thread. Throws UserError.
#pragma once

#include <filesystem>
#include <string>

#include "haptic_server/teaching/study_report/study_data.h"

namespace bonemill::study {

// What a report of a simulation study owes its readers: the items of CONSORT and STROBE with their extensions
// for simulation-based research (Cheng et al. 2016, doi 10.1186/s41077-016-0025-y) and what reviewers of
// haptics ask, filled in as far as the study knows.
std::string checklistText(const StudyData& data, const std::string& program_version);

// report.md, checklist.md, analysis.R and the tables, each whole or not there, readable for their user alone.
void writeReport(const StudyFolder& folder, const std::filesystem::path& out,
                 const std::string& program_version);

}  // namespace bonemill::study
