// Recorded sessions as trajectories: what went into the ticks, for `simulate`, which comes to the same bits
// with it (docs/reference/simulate.md); and the way of the tool in one attempt. For one normal thread.
#pragma once

#include <fstream>
#include <limits>
#include <string>

#include "common/files/whole_file.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "haptic_server/recording/rerun/recording.h"

namespace bonemill {

// The way of the simulated tool in one attempt of a recorded session, for a scene's `assessment.expert_path`
// and for people: the columns of a trajectory (trajectory/trajectory_reader.h), whose t_s counts from the
// attempt's begin on and rests in pauses.
class ToolPathExport {
  public:
    // Of the attempt with this number, from 1; 0 takes the last one, or all of a session without attempts.
    // Throws UserError: no such attempt, a file that cannot be written.
    ToolPathExport(const std::string& path, const Recording& recording, int attempt);

    // Every tick in order.
    void add(const TickRecord& record, bool is_paused);
    void finish();

  private:
    WholeFile file_;
    std::ofstream out_;
    uint64_t first_bone_order_ = 0;                        // with which the attempt began
    uint64_t end_ = std::numeric_limits<uint64_t>::max();  // tick
    bool has_begun_ = false;
    double last_s_ = 0, attempt_s_ = 0, next_row_s_ = 0;
};

// What went into all ticks. A session whose bone was put back is written up to there; the log says so. Throws
// UserError if the file cannot be written.
void writeTrajectory(const std::string& path, const Recording& recording);

}  // namespace bonemill
