// The bone of a running session as files, while the session goes on: a snapshot is taken as for a checkpoint,
// and a thread of its own meshes and writes it. All members from one normal thread, the keeper of the
// history.
#pragma once

#include <future>
#include <optional>
#include <string>

#include "haptic_server/bone/bone_history.h"

namespace bonemill {

class SessionExport {
  public:
    // Into this folder; empty: every export is refused. References must outlive this object. Throws UserError
    // if files cannot be made there.
    SessionExport(BoneHistory& history, const BoneModel& bone, std::string folder);

    // NAME.stl, NAME.ply, NAME.nrrd (densities) and NAME_difference.nrrd of the bone as it is now. Nothing:
    // it has begun; else "refused: <why>". Not RT-safe, but no tick waits for it.
    std::optional<std::string> begin(const std::string& name);
    // Once, when the export under way has ended: "done" or "failed: <why>". Failed: none of its files is
    // left.
    std::optional<std::string> takeResult();

  private:
    BoneHistory& history_;
    const BoneModel& bone_;
    std::string folder_;
    std::future<std::string> result_;  // waits for its thread where it goes
};

}  // namespace bonemill
