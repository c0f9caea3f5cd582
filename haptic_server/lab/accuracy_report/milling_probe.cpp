#include "haptic_server/lab/accuracy_report/milling_probe.h"

#include <algorithm>

#include "common/device_messages/device_messages.h"
#include "haptic_server/lab/accuracy_report/truth.h"
#include "haptic_server/lab/simulate/run_path.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr int kMinTicks = 3000, kMaxTicks = 12'000;
constexpr double kDepth = 0.8, kSideways = 1;  // burr radii
constexpr double kFrontThickness = 0.13;  // burr radii that the burr advances while a full voxel vanishes
constexpr double kRestTimes = 1.5;        // times what a full voxel needs to vanish
constexpr int kRefinement = 4;
constexpr size_t kMaxSamples = 4'000'000;
constexpr double kPathStep =
    0.02;  // burr radii between the kept poses: ridges between their spheres are below 1e-4 R

double vanishingTime(const FixedTickConfig& tick) {
    return kMaxDensity / tick.effects.time_removal->rate;
}

// Keeps positions in V, at least `step` apart, and the last one.
std::vector<Vector3d> thinned(const std::vector<Vector3d>& path_W, const Pose& X_VW, double step) {
    std::vector<Vector3d> kept;
    for (const Vector3d& p_W : path_W) {
        const Vector3d p_V = X_VW * p_W;
        if (kept.empty() || (p_V - kept.back()).norm() >= step) kept.push_back(p_V);
    }
    if (!path_W.empty()) kept.push_back(X_VW * path_W.back());
    return kept;
}

// Counts samples of bone inside the burr at any of the positions (V of `before`).
size_t sweptCount(const VoxelVolume& before, const std::vector<Vector3d>& path, double radius) {
    size_t count = 0;
    forEachIndex({Eigen::Vector3i::Zero(), before.dims().array() - 1}, [&](const Eigen::Vector3i& v) {
        if (before.at(v.x(), v.y(), v.z()) < before.iso()) return;
        const Vector3d p_V = before.spacing().cwiseProduct(v.cast<double>());
        count += std::any_of(path.begin(), path.end(), [&](const Vector3d& center) {
            return (p_V - center).squaredNorm() < radius * radius;
        });
    });
    return count;
}

size_t removedCount(const VoxelVolume& before, const VoxelVolume& after) {
    int64_t count = 0;
    forEachIndex({Eigen::Vector3i::Zero(), before.dims().array() - 1}, [&](const Eigen::Vector3i& v) {
        count += int(before.at(v.x(), v.y(), v.z()) >= before.iso()) -
                 int(after.at(v.x(), v.y(), v.z()) >= after.iso());
    });
    return size_t(std::max<int64_t>(count, 0));
}

Eigen::AlignedBox3d boxOfPath(const PosePath& path, const Pose& X_VW) {
    Eigen::AlignedBox3d box;
    for (const Pose& pose : path) box.extend(X_VW * pose.position);
    return box;
}

}  // namespace

PosePath millingPath(const ProbingPlace& place, const FixedTickConfig& tick) {
    const double radius = tick.tool.burr.radius;
    const Vector3d start = place.X_WT.position + place.room * place.normal_W;
    const Vector3d bottom = place.X_WT.position - kDepth * radius * place.normal_W;
    const Vector3d end = bottom + kSideways * radius * tangentOf(place.normal_W);
    const double length = (start - bottom).norm() + (end - bottom).norm();
    const double rest = kRestTimes * vanishingTime(tick);
    const double time = length / (kFrontThickness * radius / vanishingTime(tick)) + rest;
    const double ticks = std::clamp(time / tick.dt, double(kMinTicks), double(kMaxTicks));
    const double rest_ticks = std::min(std::max(rest / tick.dt, 100.0), ticks / 3);
    std::vector<PathKnot> knots;
    constexpr int kKnots = 8;
    for (int n = 0; n < kKnots; ++n) knots.push_back({start + double(n) / kKnots * (bottom - start)});
    for (int n = 0; n <= kKnots; ++n) knots.push_back({bottom + double(n) / kKnots * (end - bottom)});
    PosePath path = smoothPath(place.X_WT.rotation, knots, int(ticks - rest_ticks));
    path.resize(size_t(ticks), path.back());
    return path;
}

MillingRun millAndRestore(const FixedTickConfig& tick, BoneModel& bone, BoneHistory& history,
                          const PosePath& path) {
    const Pose X_WV = bone.volume.geometry().X_WV;
    const double radius = tick.tool.burr.radius;
    const double margin = radius + 2 * bone.volume.spacing().maxCoeff();
    const IndexBox part = voxelsAround(bone.volume, boxOfPath(path, X_WV.inverse()), margin);
    const int times = affordableRefinement(part, kRefinement, kMaxSamples);
    const VoxelVolume before = refinedPart(bone.volume, part, times);
    MillingRun run;
    run.records = runPath(tick, bone, inputsOf(path, tick.dt, kButtonRemove));
    const VoxelVolume after = refinedPart(bone.volume, part, times);
    run.removed = double(removedCount(before, after)) * before.voxelVolume();
    const auto sweptBy = [&](const std::vector<Vector3d>& path_W) {
        const auto centers = thinned(path_W, before.geometry().X_WV.inverse(), kPathStep * radius);
        return double(sweptCount(before, centers, radius)) * before.voxelVolume();
    };
    std::vector<Vector3d> tool_path, device_path;
    for (const TickRecord& record : run.records) tool_path.emplace_back(record.p_WT);
    for (const Pose& pose : path) device_path.push_back(pose.position);
    run.swept = sweptBy(tool_path);
    run.wanted = sweptBy(device_path);
    history.restore();
    history.restoreAll(bone);
    return run;
}

}  // namespace bonemill
