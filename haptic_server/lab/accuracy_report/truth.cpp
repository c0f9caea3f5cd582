#include "haptic_server/lab/accuracy_report/truth.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>

#include "haptic_server/lab/accuracy_report/analytic_probe.h"
#include "haptic_server/lab/simulate/run_path.h"

namespace bonemill {
namespace {

Eigen::Vector3i refinedDims(const IndexBox& box, int times) {
    return (box.max - box.min) * times + Eigen::Vector3i::Ones();
}

// Writes a row of voxels along x as numbers, interpolated between four rows.
void interpolateRow(const VoxelVolume& volume, const IndexBox& box, int j, int k, double fy, double fz,
                    std::vector<double>& row) {
    for (int i = box.min.x(); i <= box.max.x(); ++i) {
        const auto at = [&](int dj, int dk) { return double(volume.at(i, j + dj, k + dk)); };
        const double low = fy > 0 ? at(0, 0) + fy * (at(1, 0) - at(0, 0)) : at(0, 0);
        double value = low;
        if (fz > 0) {
            const double high = fy > 0 ? at(0, 1) + fy * (at(1, 1) - at(0, 1)) : at(0, 1);
            value = low + fz * (high - low);
        }
        row[size_t(i - box.min.x())] = value;
    }
}

constexpr size_t kMostVoxels = 100'000'000;  // 200 MB of densities per thread
constexpr int kToolRefinement = 4;
constexpr double kTrueSpacing = 15e-6;  // m: half of what `exact` samples
constexpr double kVoxelsAcross = 8;
constexpr double kLightForce = 1;  // N
constexpr double kReach = 0.5e-3;  // m: bone this near to the tool's way may be touched
// The part's cut faces, which are no bone surface, lie beyond it: farther from the tool than
// any touchable surface.
constexpr double kMargin = 1.5 * kReach;
constexpr size_t kEveryPose = 8;

// This is all bone that the tool can come near, which lags behind the device by as much as the hand presses.
IndexBox partFor(const ProbingStroke& stroke, const BoneModel& bone, const TouchProbe& probe) {
    std::vector<Pose> poses;
    for (size_t n = 0; n < stroke.device.size(); n += kEveryPose) poses.push_back(stroke.device[n]);
    const Eigen::AlignedBox3d near = probe.surfaceNear(poses, kReach + stroke.deepest);
    if (near.isEmpty()) return {};
    return voxelsAround(bone.volume, near, kMargin);
}

RunRecords runRefined(const ProbingStroke& stroke, const FixedTickConfig& tick, const BoneModel& bone,
                      const IndexBox& part, int times) {
    FixedTickConfig config = tick;
    config.accuracy = truthSettings();
    config.gradient.most_point_tests = GradientConfig{}.most_point_tests;  // there is no hurry
    BoneModel fine(refinedPart(bone.volume, part, times), Eigen::Vector3i::Constant(kLeafCells),
                   {.spare_points = 1});
    return runPath(config, fine, inputsOf(stroke.device, config.dt));
}

bool hasOverflow(const RunRecords& records) {
    return std::any_of(records.begin(), records.end(),
                       [](const auto& r) { return r.faults & kFaultContactOverflow; });
}

Truth computeOne(const ProbingStroke& stroke, const FixedTickConfig& tick, const BoneModel& bone,
                 const TouchProbe& probe) {
    const IndexBox part = partFor(stroke, bone, probe);
    Truth truth;
    if (part.isEmpty()) return truth;
    truth.refinement =
        affordableRefinement(part, wantedRefinement(bone.volume.spacing().maxCoeff(), tick), kMostVoxels);
    RunRecords records = runRefined(stroke, tick, bone, part, truth.refinement);
    while (hasOverflow(records) && truth.refinement > 1)
        records = runRefined(stroke, tick, bone, part, --truth.refinement);
    truth.answers = answersOf(records);
    for (const TickRecord& r : records)
        truth.max_penetration = std::max(truth.max_penetration, r.max_penetration);
    if (truth.refinement > 1)
        truth.coarser = answersOf(runRefined(stroke, tick, bone, part, truth.refinement / 2));
    return truth;
}

}  // namespace

size_t refinedCount(const IndexBox& box, int times) {
    const Eigen::Vector3i dims = refinedDims(box, times);
    return size_t(dims.x()) * size_t(dims.y()) * size_t(dims.z());
}

int affordableRefinement(const IndexBox& box, int most, size_t room) {
    int times = most;
    while (times > 1 && refinedCount(box, times) > room) --times;
    return times;
}

IndexBox voxelsAround(const VoxelVolume& volume, const Eigen::AlignedBox3d& box_V, double margin) {
    const Eigen::Array3d spacing = volume.spacing().array();
    const Eigen::Array3d low = ((box_V.min().array() - margin) / spacing).floor();
    const Eigen::Array3d high = ((box_V.max().array() + margin) / spacing).ceil();
    const Eigen::Array3d dims = volume.dims().cast<double>().array();
    return {low.max(-1.0).min(dims).cast<int>().matrix(), high.max(-1.0).min(dims).cast<int>().matrix()};
}

VoxelVolume refinedPart(const VoxelVolume& volume, const IndexBox& box, int times) {
    VolumeGeometry geometry = volume.geometry();
    geometry.dims = refinedDims(box, times);
    geometry.X_WV.position = volume.geometry().X_WV * volume.spacing().cwiseProduct(box.min.cast<double>());
    geometry.spacing /= times;
    VoxelVolume fine(geometry, volume.iso());
    std::vector<double> row(size_t(box.max.x() - box.min.x() + 1));
    for (int k = 0; k < geometry.dims.z(); ++k)
        for (int j = 0; j < geometry.dims.y(); ++j) {
            interpolateRow(volume, box, box.min.y() + j / times, box.min.z() + k / times,
                           double(j % times) / times, double(k % times) / times, row);
            for (int i = 0; i < geometry.dims.x(); ++i) {
                const size_t cell = size_t(i / times);
                const double f = double(i % times) / times;
                const double value = f > 0 ? row[cell] + f * (row[cell + 1] - row[cell]) : row[cell];
                fine.set(i, j, k, Density(std::lround(value)));
            }
        }
    return fine;
}

int wantedRefinement(double spacing, const FixedTickConfig& tick) noexcept {
    const double width =
        contactWidth(tick.gradient.contact.stiffness_per_area, tick.tool.burr.radius, kLightForce);
    return int(std::clamp(std::ceil(kVoxelsAcross * spacing / width), double(kMinRefinement),
                          double(kMaxRefinement)));
}

AccuracySettings truthSettings() noexcept {
    return {.law = ContactLaw::kGradient,
            .shell_factor = 1,
            .sample_spacing = kTrueSpacing,
            .most_samples = kUnlimitedSamples,
            .tool_distance = ToolDistance::kAnalytic,
            .sdf_refinement = kToolRefinement,
            .precision = Precision::kDouble,
            .iterations = AccuracySettings::kMaxIterations,
            .continuous_collision = true};
}

std::vector<Truth> computeTruth(const std::vector<ProbingStroke>& strokes, const FixedTickConfig& tick,
                                const BoneModel& bone, const TouchProbe& probe, int threads,
                                const TruthProgress& progress) {
    std::vector<Truth> truth(strokes.size());
    std::vector<std::exception_ptr> failures(strokes.size());
    std::atomic<size_t> next{0};
    std::mutex telling;
    size_t done = 0;
    {
        std::vector<std::jthread> workers;
        for (int n = 0; n < threads; ++n)
            workers.emplace_back([&] {
                for (size_t i = next++; i < strokes.size(); i = next++) try {
                        truth[i] = computeOne(strokes[i], tick, bone, probe);
                        const std::lock_guard only(telling);
                        ++done;
                        if (progress) progress(done);
                    } catch (...) {
                        failures[i] = std::current_exception();
                    }
            });
    }
    for (const std::exception_ptr& failure : failures)
        if (failure) std::rethrow_exception(failure);
    return truth;
}

}  // namespace bonemill
