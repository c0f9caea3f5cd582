// Makes a scene and the journal of a session in it, without processes and without waiting: a burr goes
// through a slab as a live session's tick would have felt and recorded it, with jitter, a silent device and
// orders.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill::test {

struct RecordedSessionOptions {
    uint64_t ticks = 3000;      // at 1 kHz
    bool has_orders = true;     // puts the bone back, changes the tool, pauses; else only mills
    double bone_every_s = 0.5;  // states of the bone
    bool has_end = true;
    std::string file = "session.mcap";
    double shift = 0;             // of the whole way along y, m
    double top = 10e-3;           // of the slab, m; the way stays where it is
    std::string scene_text = {};  // to be added to the scene
    // The ticks at which attempts of P1, P2, ... begin, on the bone as it is then; each but the last ends
    // where the next one begins.
    std::vector<uint64_t> attempts = {};
};

// Ticks at which something happens, where there are orders.
inline constexpr uint64_t kTickOfSilence = 400, kTickOfOtherTool = 1400, kTickOfCheckpoint = 1000,
                          kTickOfReset = 1800, kTickOfPause = 2400, kTickOfRestore = 2700;

struct RecordedSession {
    std::filesystem::path journal, scene;
    uint64_t state_hash = 0;              // StateHash of all records and of the bone at the end
    std::vector<int64_t> missing_voxels;  // after each tick
    std::vector<double> x_m;              // of the simulated tool after each tick, W
    std::vector<double> y_m;
};

// Files go into the folder.
RecordedSession recordSession(const std::filesystem::path& folder,
                              const RecordedSessionOptions& options = {});

}  // namespace bonemill::test
