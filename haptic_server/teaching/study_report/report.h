// Writes all that `study report` makes. It is for one thread. Throws UserError.
#pragma once

#include <filesystem>
#include <string>

namespace bonemill::study {

class StudyFolder;

// report.md, checklist.md, analysis.R and the tables, each whole or not there, readable for their user alone.
void writeReport(const StudyFolder& folder, const std::filesystem::path& out,
                 const std::string& program_version);

}  // namespace bonemill::study
