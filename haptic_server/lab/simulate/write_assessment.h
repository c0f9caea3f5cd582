// Writes what a run without a live session came to as a session writes an attempt: results and report in a
// folder, and a statement. It waits for the disk; normal threads.
#pragma once

#include <string>

#include "common/config/scene_file.h"
#include "haptic_server/lab/simulate/task_run.h"
#include "haptic_server/recording/statistics/bone_files.h"

namespace bonemill {

struct AssessmentTarget {
    std::string folder;
    std::string pseudonym;
    double duration_s = 0;
    uint32_t number = 1;
    int64_t start_unix_ns = 0;  // 0: now
    std::string journal = {};   // the recording's file name; empty: none
};

// Returns the files' name without endings. What could not be written is noted in `files`.
std::string writeAssessment(const AssessmentTarget& target, const LoadedScene& loaded,
                            const TaskRun::Result& result, FinalFiles& files);

}  // namespace bonemill
