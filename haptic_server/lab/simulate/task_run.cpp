#include "haptic_server/lab/simulate/task_run.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <exception>
#include <fstream>

#include "common/base/user_error.h"
#include "common/text/hex_text.h"
#include "haptic_server/assessment/product/judge.h"
#include "haptic_server/scene/setup/scene_task.h"
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
    attempt.scene_title = titleOf(loaded.scene);
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
        const ResultFolder folder(target.folder);
        folder.write(attempt, std::move(pictures), result.begin_s);
        folder.writeClassPage();
    } catch (const std::exception& error) {
        files.note(error.what());
    }
    return fileStemOf(attempt);
}

TaskRun::TaskRun(const scene::Scene& scene, const SceneSetup& simulation, bool wanted)
    : task_(simulation.task) {
    if (!task_ && !wanted) return;
    if (task_) breach_ = breachWatchOf(simulation);
    technique_ = techniqueMaker(scene, simulation)();
}

void TaskRun::add(const TickRecord& record) {
    if (technique_) technique_->add(record);
    if (breach_) breach_->add(record);
}

void TaskRun::setEye(const Eigen::Vector3d& p_eye_W) {
    if (technique_) technique_->setEye(p_eye_W);
}

TaskRun::Result TaskRun::judgeBone(const VoxelVolume& scanned, const VoxelVolume& now) {
    technique_->finish();
    if (!task_) return {technique_->assessment(), {}, technique_->beginS()};
    ProductInput input{scanned, now, *task_};
    if (breach_) input.breach = breach_->depth();
    Product product = measureProduct(input);
    for (const std::string& what : product.left_out) spdlog::warn("not measured: {}", what);
    Assessment technique = technique_->assessment();
    product.figures.insert(product.figures.end(), technique.figures.begin(), technique.figures.end());
    Result result{judge(*task_, std::move(product.figures)), std::move(product.picture),
                  technique_->beginS()};
    result.assessment.series = std::move(technique.series);
    result.assessment.moments = std::move(technique.moments);
    return result;
}

nlohmann::json assessmentJson(const Assessment& assessment) {
    nlohmann::json json{{"gates", nlohmann::json::array()},
                        {"sub_scores", nlohmann::json::array()},
                        {"figures", nlohmann::json::object()}};
    if (!assessment.gates.empty()) json["passed"] = assessment.hasPassed();
    for (const GateResult& gate : assessment.gates)
        json["gates"].push_back(
            {{"figure", gate.figure_id}, {"is_passed", gate.is_passed}, {"text", gate.text}});
    for (const SubScore& score : assessment.sub_scores)
        json["sub_scores"].push_back({{"figure", score.figure.id},
                                      {"label", score.label},
                                      {"value", score.figure.value},
                                      {"score", score.score},
                                      {"weight", score.weight}});
    if (assessment.total)
        json["total"] = {{"score", assessment.total->score},
                         {"done", assessment.total->done},
                         {"weights_version", assessment.total->weights_version},
                         {"weights_hash", assessment.total->weights_hash}};
    for (const Figure& figure : assessment.figures) json["figures"][figure.id] = figure.value;
    return json;
}

void writeBytes(const std::string& path, const std::string& bytes) {
    std::ofstream file(path, std::ios::binary);
    file.write(bytes.data(), std::streamsize(bytes.size()));
    file.close();
    if (!file) throw UserError("cannot write " + path + ": is the folder there, writable and not full?");
}

}  // namespace bonemill
