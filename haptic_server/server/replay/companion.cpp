#include "haptic_server/server/replay/companion.h"

#include <cmath>
#include <utility>

#include "common/rt/clock.h"
#include "haptic_server/scene/setup/scene_accuracy.h"
#include "haptic_server/scene/setup/scene_setup.h"

namespace bonemill {

Companion::Companion(ComparedAttempt compared, const Recording& shown, const SceneSetup& simulation,
                     const LoadedScene& scene, const VoxelVolume& scanned)
    : compared_(std::move(compared)),
      clock_(shown, *compared_.recording, compared_.attempt),
      bone_(std::make_shared<BoneModel>(scanned.withoutSpareBricks(), simulation.bone->lattice.leafCells(),
                                        shellConfigOf(scene.scene))),
      bones_(compared_.recording->readBones(*bone_)),
      keyframes_(bones_.keyframes),
      rerun_(*compared_.recording, simulation, bones_.checkpoints, *bone_, bones_.keyframes.front()),
      rate_hz_(compared_.recording->manifest().rate_hz()) {}

bool Companion::follow(uint64_t shown_tick, std::chrono::nanoseconds limit, const std::stop_token& stop) {
    goal_ = clock_.otherTickAt(shown_tick);
    const Keyframe from = keyframes_.before(goal_);
    const bool is_past = !X_WT_ || rerun_.next() > goal_ + 1;
    // After a new beginning all but the bone has to settle: a little way it goes tick by tick.
    const bool is_far = double(from.tick) >= double(rerun_.next()) + Keyframes::kEveryS * rate_hz_;
    if (is_past || is_far) rerun_.startAt(from);
    const int64_t until_ns = monotonicNowNs() + limit.count();
    while (rerun_.next() <= goal_) {
        step();
        if (stop.stop_requested() || monotonicNowNs() > until_ns) break;
    }
    return rerun_.next() > goal_;
}

void Companion::step() {
    const TickRecord& record = rerun_.step();
    X_WT_ = Pose{Eigen::Vector3d(record.p_WT),
                 Eigen::Quaterniond(record.q_WT[0], record.q_WT[1], record.q_WT[2], record.q_WT[3])};
    keyframes_.leave(rerun_, *bone_, rate_hz_);
}

double Companion::awayS() const {
    return std::abs(double(goal_) - double(now())) / rate_hz_;
}

}  // namespace bonemill
