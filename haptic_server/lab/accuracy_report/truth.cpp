#include "haptic_server/lab/accuracy_report/truth.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <thread>

#include "haptic_server/lab/accuracy_report/analytic_probe.h"
#include "haptic_server/lab/accuracy_report/fine_bone.h"
#include "haptic_server/lab/simulate/run_path.h"

namespace bonemill {
namespace {

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
                                const BoneModel& bone, const TouchProbe& probe, int threads) {
    std::vector<Truth> truth(strokes.size());
    std::vector<std::exception_ptr> failures(strokes.size());
    std::atomic<size_t> next{0};
    {
        std::vector<std::jthread> workers;
        for (int n = 0; n < threads; ++n)
            workers.emplace_back([&] {
                for (size_t i = next++; i < strokes.size(); i = next++) try {
                        truth[i] = computeOne(strokes[i], tick, bone, probe);
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
