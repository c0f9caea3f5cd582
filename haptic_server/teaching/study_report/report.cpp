#include "haptic_server/teaching/study_report/report.h"

#include "common/files/whole_file.h"
#include "haptic_server/teaching/study/shipped_files.h"
#include "haptic_server/teaching/study_report/checklist.h"
#include "haptic_server/teaching/study_report/study_report_text.h"
#include "haptic_server/teaching/study_report/study_tables.h"

namespace bonemill::study {

void writeReport(const StudyFolder& folder, const std::filesystem::path& out,
                 const std::string& program_version) {
    const StudyData data = readStudy(folder);
    const std::vector<Measure> measures = measuresOf(data);
    const std::vector<GroupComparison> groups = compareGroups(data, measures);
    const std::vector<ConditionComparison> conditions = compareConditions(data, measures);
    for (const TableFile& table : tablesOf(data, measures, groups, conditions))
        writePrivateFile(out / table.name, table.text);
    writePrivateFile(out / "report.md", reportText(data, measures, groups, conditions));
    writePrivateFile(out / "checklist.md", checklistText(data, program_version));
    writePrivateFile(out / "analysis.R", shippedAnalysis());
}

}  // namespace bonemill::study
