// The bone of a recorded session at any moment, for who goes on from there. It is for normal threads, at the
// start.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "haptic_server/recording/rerun/recording.h"
#include "haptic_server/scene/setup/scene_setup.h"

namespace bonemill {

// FILE@SECONDS, as --from takes it.
struct MomentName {
    std::filesystem::path journal;
    double seconds = 0;
};
// Throws UserError.
MomentName momentNameOf(const std::string& text);

struct RecordedMoment {
    journal::ResumedFrom from;
    std::shared_ptr<const BoneSnapshot> bone;
    uint32_t tool = 0, accuracy = 0;  // in force then
};

// Another bone like that of a fresh simulation of the scene.
BoneModel scannedCopyOf(const Simulation& simulation, const LoadedScene& scene);

// Runs the ticks up to there again, from the state of the bone before it. `simulation` is fresh, and stays
// so. Throws UserError if the recording is of another scene, or ends before.
RecordedMoment momentOf(const Recording& recording, const Simulation& simulation, const LoadedScene& scene,
                        double seconds);

}  // namespace bonemill
