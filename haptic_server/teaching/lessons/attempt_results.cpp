#include "haptic_server/teaching/lessons/attempt_results.h"

#include <exception>
#include <filesystem>

#include "common/text/hex_text.h"
#include "haptic_server/teaching/attempt_report/result_folder.h"

namespace bonemill {
namespace {

void fillVerdict(const AttemptResult& result, topics::Verdict& verdict) {
    const Assessment& assessment = result.assessment;
    if (!assessment.gates.empty()) verdict.set_passed(assessment.hasPassed());
    for (const GateResult& gate : assessment.gates)
        if (!gate.is_passed) verdict.add_failed_gates(gate.label);
    if (assessment.total) verdict.set_score_percent(100 * assessment.total->score);
    verdict.set_results(fileStemOf(result));
}

}  // namespace

std::string writeResults(const AttemptJudgement& judgement, const std::string& class_table,
                         const std::string& scene, topics::Attempt& attempt) {
    try {
        JudgedAttempt judged = judgement.judge();
        AttemptResult result;
        result.pseudonym = attempt.trainee();
        result.number = attempt.number();
        result.scene_id = attempt.scene_id();
        result.scene_title = scene;
        result.scene_hash = hexText(judgement.scene_hash);
        result.start_unix_ns = attempt.start_stamp_ns();
        result.duration_s = attempt.time_s();
        result.journal = judgement.journal;
        result.is_exam = judgement.is_exam;
        result.assessment = std::move(judged.assessment);
        const ResultFolder folder(std::filesystem::absolute(class_table).parent_path());
        folder.write(result, std::move(judged.pictures), judgement.begin_s);
        fillVerdict(result, *attempt.mutable_verdict());
        return "";
    } catch (const std::exception& error) {
        return error.what();
    }
}

}  // namespace bonemill
