#include "haptic_server/lab/simulate/write_assessment.h"

#include <chrono>
#include <exception>

#include "common/text/hex_text.h"
#include "haptic_server/teaching/attempt_report/report_words.h"
#include "haptic_server/teaching/attempt_report/result_folder.h"

namespace bonemill {

std::string writeAssessment(const AssessmentTarget& target, const LoadedScene& loaded,
                            const TaskRun::Result& result, FinalFiles& files) {
    AttemptResult attempt;
    attempt.pseudonym = target.pseudonym;
    attempt.number = target.number;
    attempt.journal = target.journal;
    attempt.scene_id = loaded.file.stem().string();
    attempt.scene_title = loaded.scene.has_title() ? loaded.scene.title() : loaded.scene.name();
    attempt.scene_hash = hexText(sceneHashOf(loaded.scene));
    attempt.start_unix_ns =
        std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
    if (target.start_unix_ns != 0) attempt.start_unix_ns = target.start_unix_ns;
    attempt.duration_s = target.duration_s;
    attempt.is_exam = loaded.scene.assessment().exam();
    attempt.assessment = result.assessment;
    std::vector<ReportPicture> pictures;
    if (!result.picture.png.empty())
        pictures.push_back({deviationCaption(result.picture.scale), "image/png", result.picture.png});
    try {
        ResultFolder(target.folder).write(attempt, std::move(pictures), result.begin_s);
    } catch (const std::exception& error) {
        files.note(error.what());
    }
    return fileStemOf(attempt);
}

}  // namespace bonemill
