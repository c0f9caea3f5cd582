#include "haptic_server/accuracy_report/run_path.h"

#include <algorithm>

#include "common/rt/clock.h"
#include "haptic_server/tick/fixed_tick.h"

namespace bonemill {
namespace {

class PathIo final : public TickIo {
  public:
    PathIo(std::span<const Pose> path, double dt, uint32_t buttons)
        : path_(path), dt_(dt), buttons_(buttons) {
        records.reserve(path.size());
    }

    bool read(DeviceInput& input) noexcept override {
        if (next_ == path_.size()) return false;
        input.t_s = double(next_) * dt_;
        input.X_WT_device = path_[next_++];
        input.buttons = buttons_;
        input.start_ns = monotonicNowNs();
        return true;
    }
    int64_t write(const Wrench&) noexcept override { return monotonicNowNs(); }
    int64_t now() noexcept override { return monotonicNowNs(); }
    void push(const TickRecord& record) noexcept override { records.push_back(record); }  // reserved above

    RunRecords records;

  private:
    std::span<const Pose> path_;
    double dt_;
    uint32_t buttons_;
    size_t next_ = 0;
};

}  // namespace

RunRecords runPath(const FixedTickConfig& config, BoneModel& bone, std::span<const Pose> path,
                   uint32_t buttons) {
    PathIo io(path, config.dt, buttons);
    FixedTick(config, bone).run(io);
    return std::move(io.records);
}

RunRecords runPathTimed(const FixedTickConfig& config, BoneModel& bone, std::span<const Pose> path) {
    RunRecords records = runPath(config, bone, path);
    for (int pass = 1; pass < kPasses; ++pass) keepShorterTimes(records, runPath(config, bone, path));
    return records;
}

void keepShorterTimes(RunRecords& records, const RunRecords& again) noexcept {
    for (size_t n = 0; n < std::min(records.size(), again.size()); ++n)
        records[n].compute_ns = std::min(records[n].compute_ns, again[n].compute_ns);
}

}  // namespace bonemill
