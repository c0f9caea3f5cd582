#include "haptic_server/lab/simulate/run_path.h"

#include "haptic_server/core/tick/fixed_tick.h"
#include "haptic_server/core/tick/tick_once.h"

namespace bonemill {

double distanceTo(const VoxelVolume& volume, const Eigen::Vector3d& p_W) {
    const Eigen::Vector3d high_V = volume.spacing().cwiseProduct(volume.dims().cast<double>());
    const Eigen::Vector3d p_V = volume.geometry().X_WV.inverse() * p_W;
    return (p_V - p_V.cwiseMax(0).cwiseMin(high_V)).norm();
}

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
    for (const DeviceInput& input : path) see(tickOnce(tick, input));
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
