#include "haptic_server/server/replay/survey.h"

#include <spdlog/spdlog.h>

#include "common/base/units.h"
#include "common/rt/clock.h"
#include "haptic_server/server/replay/low_priority.h"

namespace bonemill {
namespace {

VoxelVolume startOf(const Rerun& rerun, const BoneModel& bone, const Keyframe& first) {
    return first.bone ? rerun.history().volumeOf(*first.bone, bone.lattice)
                      : rerun.history().scanned().withoutSpareBricks();
}

}  // namespace

Survey::Survey(const Recording& recording, const SceneSetup& simulation, const LoadedScene& scene,
               const Recording::Bones& bones, Keyframes& keyframes, ReplayEvents& events)
    : recording_(recording),
      keyframes_(keyframes),
      events_(events),
      bone_(scannedCopyOf(simulation, scene)),
      rerun_(recording, simulation, bones.checkpoints, bone_, bones.keyframes.front()),
      start_(startOf(rerun_, bone_, bones.keyframes.front())),
      removals_(start_, bone_.volume) {}

void Survey::start() {
    thread_ = std::jthread([this](const std::stop_token& stop) {
        try {
            run(stop);
        } catch (const std::exception& error) {
            spdlog::error("the recording cannot be looked through: {}", error.what());
        }
    });
}

void Survey::run(const std::stop_token& stop) {
    takeLowPriority(kNiceInBackground);
    const int64_t start_ns = monotonicNowNs();
    while (!rerun_.isAtEnd() && !stop.stop_requested()) {
        const uint64_t tick = rerun_.next();
        look(rerun_.step(), tick);
        known_.store(tick + 1, std::memory_order_release);
        keyframes_.leave(rerun_, bone_, recording_.manifest().rate_hz());
    }
    if (rerun_.isAtEnd())
        spdlog::info("the recording of {:.1f} s was looked through in {:.1f} s", recording_.lengthS(),
                     secondsOfNs(monotonicNowNs() - start_ns));
}

void Survey::look(const TickRecord& record, uint64_t tick) {
    removals_.add(tick, record.cut.voxels());
    if (rerun_.isBonePutBack() && !rerun_.history().isRestoring()) removals_.lookAnew();
    events_.addEffects(tick, record.effects);
}

}  // namespace bonemill
