#include "haptic_server/recording/rerun/moment.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "common/base/user_error.h"
#include "common/text/foreign_text.h"
#include "haptic_server/recording/journal/build_facts.h"
#include "haptic_server/recording/rerun/rerun.h"
#include "haptic_server/scene/setup/scene_accuracy.h"

namespace bonemill {
namespace {

// The last one that is not behind the tick.
const Keyframe& keyframeBefore(const std::vector<Keyframe>& keyframes, uint64_t tick) {
    const auto after = std::ranges::upper_bound(keyframes, tick, {}, &Keyframe::tick);
    return after == keyframes.begin() ? keyframes.front() : *std::prev(after);
}

void requireSameScene(const Recording& recording, const LoadedScene& scene) {
    if (recording.manifest().scene_hash() == sceneHashOf(scene.scene)) return;
    throw UserError(recording.path().string() + ": is a session of the scene '" +
                    printableLine(recording.manifest().scene_name()) + "' as it was then, which " +
                    scene.file.string() + " is not");
}

// Whoever goes on mills this PC's files, wherever they lay then: by name and hash they are the session's.
void requireSameVolume(const Recording& recording, const LoadedScene& scene) {
    for (const NamedFile& read : filesOf(scene)) {
        if (read.path == scene.file) continue;
        const std::string hash = sha256Of(read.path);
        const auto is_same = [&](const journal::File& file) {
            return file.what() == read.name && file.sha256() == hash;
        };
        if (std::ranges::none_of(recording.manifest().files(), is_same))
            throw UserError(recording.path().string() + ": " + read.name + " " + read.path.string() +
                            " is not the one that the session milled");
    }
}

std::string secondsText(double seconds) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f s", seconds);
    return text;
}

}  // namespace

MomentName momentNameOf(const std::string& text) {
    const size_t at = text.rfind('@');
    MomentName name;
    bool is_number = false;
    if (at != std::string::npos) {
        const char* const end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data() + at + 1, end, name.seconds);
        is_number = error == std::errc() && stop == end && std::isfinite(name.seconds) && name.seconds >= 0;
    }
    if (!is_number || at == 0)
        throw UserError("--from " + text + ": expected FILE.mcap@SECONDS, such as session.mcap@95");
    name.journal = text.substr(0, at);
    return name;
}

BoneModel scannedCopyOf(const Simulation& simulation, const LoadedScene& scene) {
    const BoneModel& bone = *simulation.bone;
    return {bone.volume.withoutSpareBricks(), bone.lattice.leafCells(), shellConfigOf(scene.scene)};
}

RecordedMoment momentOf(const Recording& recording, const Simulation& simulation, const LoadedScene& scene,
                        double seconds) {
    requireSameScene(recording, scene);
    requireSameVolume(recording, scene);
    if (seconds > recording.lengthS())
        throw UserError(recording.path().string() + ": ends after " + secondsText(recording.lengthS()) +
                        ", before " + secondsText(seconds));
    const uint64_t tick = recording.tickAt(seconds);
    BoneModel bone = scannedCopyOf(simulation, scene);
    const Recording::Bones bones = recording.readBones(bone);
    if (!bones.problem.empty()) throw UserError(recording.path().string() + ": " + bones.problem);
    Rerun rerun(recording, simulation, bones.checkpoints, bone, bones.keyframes.front());
    if (const Keyframe& from = keyframeBefore(bones.keyframes, tick); from.tick > 0) rerun.startAt(from);
    TickDecisions decisions;
    while (rerun.next() <= tick) decisions = rerun.step().input.decisions;
    RecordedMoment moment;
    moment.bone = rerun.history().snapshot(bone);
    moment.tool = decisions.tool;
    moment.accuracy = decisions.accuracy;
    moment.from.set_file(recording.path().filename().string());
    moment.from.set_journal_id(recording.manifest().journal_id());
    moment.from.set_tick(tick + 1);
    moment.from.set_segment(recording.manifest().resumed_from().segment() + 1);
    return moment;
}

}  // namespace bonemill
