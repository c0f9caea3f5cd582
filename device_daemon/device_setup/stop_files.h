// Says where the last seconds before a stop are written.
#pragma once

#include <cstdint>
#include <filesystem>

#include "common/device_messages/device_state.h"

namespace bonemill {

// Returns $XDG_STATE_HOME/bonemill, or ~/.local/state/bonemill.
std::filesystem::path defaultStopDir();

// A device that stops again and again fills no disk: the newest N files stay in the folder.
inline constexpr size_t kMaxStopFiles = 100;

// Returns a new name in the folder, which is made if need be: stop_SESSION_TIME_CAUSE.csv. Makes room for it
// by removing the oldest files of such names. Never throws: a folder that cannot be made shows when the file
// is written.
std::filesystem::path stopFile(const std::filesystem::path& dir, uint32_t session, StopCause cause);

}  // namespace bonemill
