#include "haptic_server/lab/simulate/run_path.h"

#include "common/rt/clock.h"
#include "haptic_server/core/tick/fixed_tick.h"

namespace bonemill {
namespace {

// Time comes from the path; the clock only tells how long a tick took.
class PathIo final : public TickIo {
  public:
    explicit PathIo(std::span<const DeviceInput> path) : path_(path) {}

    bool read(DeviceInput& input) noexcept override {
        if (next_ == path_.size()) return false;
        input = path_[next_++];
        input.start_ns = monotonicNowNs();
        return true;
    }
    int64_t write(const Wrench&) noexcept override { return monotonicNowNs(); }
    int64_t now() noexcept override { return monotonicNowNs(); }

  private:
    std::span<const DeviceInput> path_;
    size_t next_ = 0;
};

}  // namespace

std::vector<DeviceInput> inputsOf(std::span<const Pose> path_WT, double dt, uint32_t buttons) {
    std::vector<DeviceInput> inputs(path_WT.size(), DeviceInput{});
    for (size_t n = 0; n < path_WT.size(); ++n) {
        inputs[n].t_s = double(n) * dt;
        inputs[n].X_WT_device = path_WT[n];
        inputs[n].buttons = buttons;
    }
    return inputs;
}

void runPath(HapticTick& tick, std::span<const DeviceInput> path,
             const std::function<void(const TickRecord&)>& see) {
    PathIo io(path);
    while (const TickRecord* record = tick.tick(io)) see(*record);
}

std::vector<TickRecord> runPath(const FixedTickConfig& config, BoneModel& bone,
                                std::span<const DeviceInput> path) {
    std::vector<TickRecord> records;
    records.reserve(path.size());
    FixedTick tick(config, bone);
    runPath(tick.whole(), path, [&records](const TickRecord& record) { records.push_back(record); });
    return records;
}

}  // namespace bonemill
