// Which scene the daemon goes by: haptic_server's, and its own only while no server has said which.
//
// It is for the main thread, between the loops: it reads files and waits.
#pragma once

#include <optional>
#include <string>

#include "common/ipc/device_link.h"
#include "common/rt/stop_signals.h"
#include "device_daemon/apps/device_daemon/daemon_options.h"
#include "device_daemon/device_setup/device_setup.h"

namespace bonemill {

struct FollowedScene {
    std::string file;
    uint64_t hash = 0;                   // sceneHashOf()
    uint32_t revision = 0;               // SceneNotice; 0: the daemon's own
    uint64_t epoch = 0;                  // likewise
    HandChoice hand = HandChoice::kOwn;  // that the server wants, as far as this daemon does what it wants
    DeviceSetup setup;
};

// The hand that a daemon with these options gives where this is announced: only a scripted hand makes way for
// another, never one that a person may hold. RT-safe.
HandChoice handFor(const SceneNotice& notice, const DaemonOptions& options) noexcept;

// Reads the file; the revision is 0. Throws UserError.
FollowedScene followedSceneOf(const std::string& file);

class SceneFollower {
  public:
    // References must outlive this object.
    SceneFollower(std::optional<FollowedScene> own, const DaemonOptions& options, const DeviceLink& link,
                  const StopSignals& stop_signals);

    // Returns the scene that is in force now: at first the daemon's own will do if no server has announced
    // one; later it waits for the server's, and says in the log why it cannot take it yet. Nothing: a signal
    // ends the program. Throws UserError when no server has announced one within --wait-seconds.
    std::optional<FollowedScene> next();

  private:
    std::optional<FollowedScene> takeAnnounced();

    std::optional<FollowedScene> own_;
    const DaemonOptions& options_;
    const DeviceLink& link_;
    const StopSignals& stop_signals_;
    bool has_begun_ = false;
    std::string told_;  // why the announced scene cannot be taken, as said last
};

}  // namespace bonemill
