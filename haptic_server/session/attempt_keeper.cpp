#include "haptic_server/session/attempt_keeper.h"

#include <algorithm>

#include "common/rt/clock.h"
#include "common/units.h"
#include "haptic_server/setup/scene_materials.h"

namespace bonemill {

AttemptKeeper::AttemptKeeper(LessonBook& book, Recorder& recorder, BoneHistory& history, double voxel_volume,
                             const scene::Scene& scene)
    : book_(book),
      recorder_(recorder),
      history_(history),
      voxel_mm3_(voxel_volume * kPerCubicMillimetre),
      effects_(scene.effects()),
      material_names_(materialNamesOf(scene)) {}

std::string AttemptKeeper::start(const std::string& trainee) {
    if (std::string problem = LessonBook::traineeProblem(trainee); !problem.empty()) return problem;
    const std::string problem = book_.isAttemptRunning() ? end() : "";
    history_.restore();
    history_.pauseMilling(false);
    recorder_.beginAttempt();
    time_s_ = 0;
    counted_ns_ = monotonicNowNs();
    book_.beginAttempt(trainee);
    return problem.empty() ? "done" : "failed: the attempt before is not in the class table: " + problem;
}

std::string AttemptKeeper::stop() {
    if (!book_.isAttemptRunning()) return "refused: no attempt is under way";
    const std::string problem = end();
    return problem.empty() ? "done" : "failed: it is not in the class table: " + problem;
}

void AttemptKeeper::round() {
    const int64_t now_ns = monotonicNowNs();
    if (!history_.isMillingPaused()) time_s_ += secondsOfNs(now_ns - counted_ns_);
    counted_ns_ = now_ns;
}

std::string AttemptKeeper::end() {
    round();
    const AttemptFigures figures = recorder_.attempt();
    topics::Attempt attempt;
    attempt.set_time_s(time_s_);
    // While the bone is still going back to the scan nothing was removed.
    attempt.set_removed_mm3(history_.isRestoring() ? 0 : double(history_.missingVoxels()) * voxel_mm3_);
    attempt.set_max_force_n(figures.max_force);
    effects_.describe(figures.effects, material_names_, attempt);
    return book_.endAttempt(std::move(attempt));
}

}  // namespace bonemill
