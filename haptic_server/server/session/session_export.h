// Writes the bone of a running session to files while the session goes on: a snapshot is taken as for a
// checkpoint, and a thread of its own meshes and writes it. All members belong to one normal thread, the
// keeper of the history.
#pragma once

#include <future>
#include <optional>
#include <string>

#include "common/commands/answer.h"
#include "haptic_server/core/bone/bone_history.h"

namespace bonemill {

class SessionExport {
  public:
    // Files go into this folder; every export is refused if it is empty. References must outlive this object.
    // Throws UserError if files cannot be made there.
    SessionExport(BoneHistory& history, const BoneModel& bone, std::string folder);

    // Begins to write NAME.stl, NAME.ply, NAME.nrrd (densities) and NAME_difference.nrrd of the bone as it
    // is now. The answer is nothing when it has begun, else "refused: <why>". Not RT-safe, but no tick
    // waits for it.
    std::optional<Answer> begin(const std::string& name);
    // There is one answer when the export under way has ended. After a failure
    // none of its files is left.
    std::optional<Answer> takeResult();
    // Waits for the end of the export under way, if there is one.
    void wait() {
        if (result_.valid()) result_.wait();
    }

  private:
    BoneHistory& history_;
    const BoneModel& bone_;
    std::string folder_;
    std::future<Answer> result_;  // waits for its thread where it goes
};

}  // namespace bonemill
