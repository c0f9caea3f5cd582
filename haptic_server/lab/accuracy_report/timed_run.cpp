#include "haptic_server/lab/accuracy_report/timed_run.h"

#include <algorithm>

#include "haptic_server/lab/simulate/run_path.h"

namespace bonemill {

RunRecords runPathTimed(const FixedTickConfig& config, BoneModel& bone, std::span<const Pose> path_WT) {
    const std::vector<DeviceInput> path = inputsOf(path_WT, config.dt);
    RunRecords records = runPath(config, bone, path);
    for (int pass = 1; pass < kPasses; ++pass) keepShorterTimes(records, runPath(config, bone, path));
    return records;
}

void keepShorterTimes(RunRecords& records, const RunRecords& again) noexcept {
    for (size_t n = 0; n < std::min(records.size(), again.size()); ++n)
        records[n].compute_ns = std::min(records[n].compute_ns, again[n].compute_ns);
}

}  // namespace bonemill
