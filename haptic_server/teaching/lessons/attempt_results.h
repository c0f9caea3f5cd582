// What an ended attempt still needs before it is in the class table: its judgement, which takes a second or
// two, and its files in the folder of the table. It is made by the publisher thread and carried out by the
// table's writer.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "haptic_server/teaching/attempt_report/html_report.h"
#include "proto/topics.pb.h"

namespace bonemill {

struct JudgedAttempt {
    Assessment assessment;
    std::vector<ReportPicture> pictures;
};

struct AttemptJudgement {
    // May wait; throws what kept it from judging. It needs nothing that ends with the scene.
    std::function<JudgedAttempt()> judge;
    uint64_t scene_hash = 0;  // sceneHashOf()
    double begin_s = 0;       // of the session
    std::string journal;      // the recording's file name; empty: none
    bool is_exam = false;
    bool is_told = true;  // trainees may learn how it went
};

// Judges the attempt, writes results and report beside the class table, and fills in the attempt's verdict.
// `scene` is the scene's title. Returns why the files are not there, or "".
std::string writeResults(const AttemptJudgement& judgement, const std::string& class_table,
                         const std::string& scene, topics::Attempt& attempt);

}  // namespace bonemill
