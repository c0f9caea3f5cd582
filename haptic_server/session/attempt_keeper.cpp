#include "haptic_server/session/attempt_keeper.h"

#include <algorithm>
#include <utility>

#include "common/rt/clock.h"
#include "common/units.h"
#include "haptic_server/setup/scene_materials.h"

namespace bonemill {

AttemptKeeper::AttemptKeeper(LessonBook& book, Recorder& recorder, BoneHistory& history,
                             JournalKeeper& journal, double voxel_volume, const scene::Scene& scene,
                             std::function<void(bool begins)> tell_device)
    : book_(book),
      recorder_(recorder),
      history_(history),
      journal_(journal),
      voxel_mm3_(voxel_volume * kPerCubicMillimetre),
      effects_(scene.effects()),
      tell_device_(std::move(tell_device)),
      material_names_(materialNamesOf(scene)) {}

std::optional<std::string> AttemptKeeper::start(const topics::Command& order) {
    const std::string& trainee = order.start_attempt();
    if (std::string problem = LessonBook::traineeProblem(trainee); !problem.empty()) return problem;
    const bool is_answered_later = book_.isAttemptRunning() && end(order);
    journal_.expectPutBack(Checkpoints::kScannedBone);
    recorder_.beginAttempt(history_.restore());
    history_.pauseMilling(false);
    time_s_ = 0;
    counted_ns_ = monotonicNowNs();
    book_.beginAttempt(trainee);
    journal_.noteAttemptBegan(trainee);
    if (tell_device_) tell_device_(true);
    if (is_answered_later) return std::nullopt;
    return "done";
}

std::optional<std::string> AttemptKeeper::stop(const topics::Command& order) {
    if (!book_.isAttemptRunning()) return "refused: no attempt is under way";
    const bool is_answered_later = end(order);
    history_.pauseMilling(true);
    if (tell_device_) tell_device_(false);
    if (is_answered_later) return std::nullopt;
    return "done";
}

void AttemptKeeper::stop() {
    if (book_.isAttemptRunning()) end(std::nullopt);
}

void AttemptKeeper::noteRestored() {
    if (!book_.isAttemptRunning()) recorder_.beginAttempt(history_.newestOrder());
}

void AttemptKeeper::round() {
    const int64_t now_ns = monotonicNowNs();
    if (!history_.isMillingPaused()) time_s_ += secondsOfNs(now_ns - counted_ns_);
    counted_ns_ = now_ns;
}

bool AttemptKeeper::end(const std::optional<topics::Command>& order) {
    round();
    // While the bone is still going back to the scan nothing was removed.
    const int64_t removed_voxels = history_.isRestoring() ? 0 : history_.missingVoxels();
    if (removed_voxels == 0 && time_s_ < kShortest) {
        book_.dropAttempt();
        return false;
    }
    const AttemptFigures figures = recorder_.attempt();
    topics::Attempt attempt;
    attempt.set_time_s(time_s_);
    attempt.set_removed_mm3(double(removed_voxels) * voxel_mm3_);
    attempt.set_max_force_n(figures.max_force);
    effects_.describe(figures.effects, material_names_, attempt);
    journal_.noteAttemptEnded(attempt);
    book_.endAttempt(std::move(attempt), order);
    return true;
}

}  // namespace bonemill
