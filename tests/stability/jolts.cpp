#include "tests/stability/jolts.h"

#include <algorithm>
#include <stdexcept>

#include "common/ipc/stale_ramp.h"
#include "tests/stability/hard_scenes.h"
#include "tests/stability/jolt_bench.h"
#include "tests/support/typical_effects.h"

namespace bonemill::test {
namespace {

using Eigen::Vector3d;

constexpr double kPressed = 1.5e-3;  // m: how far the hand is below where the burr rests, about 4 N
constexpr double kWorking = 20e-3;   // m/s
constexpr int kWatched = 600;        // ticks
constexpr double kSunk = 0.75;       // of the radius: the burr must not sink so far into the face
const Vector3d kUp = Vector3d::UnitZ(), kAside = Vector3d::UnitX();

WrongSide below(double height) {
    return [=](const Vector3d& p) { return p.z() < height; };
}

// Bone below z = kTop, wider than the other scenes', and deep enough to be buried in.
constexpr double kWide = 9e-3;
const Vector3d kFace(kWide / 2 + 0.05e-3, kWide / 2 - 0.05e-3, 4e-3);
VoxelVolume faceBone() {
    return bodyVolume(boxOf({kWide, kWide, 5e-3}), halfSpace(kFace, kUp));
}

// The burr is pressed on the face by a hand at rest.
struct PressedBench : JoltBench {
    explicit PressedBench(const Variant& variant, const std::function<void(FixedTickConfig&)>& edit = {})
        : JoltBench(faceBone(), variant, kFace + kBurrRadius * kUp, edit) {
        run(int(kPressed / (kWorking * kDt)), -kWorking * kUp);
        settle();
        forbid(below(kFace.z() + (1 - kSunk) * kBurrRadius));
    }
};

JoltFigures watched(JoltBench& bench) {
    bench.beginRecovery();
    bench.run(kWatched);
    return bench.figures();
}

// --- bone where the tool is -----------------------------------------------------------------------------

JoltFigures drawnOutOf(JoltBench& bench) {
    bench.run(int(5e-3 / (kWorking * JoltBench::kDt)), kWorking * kUp);
    JoltFigures figures = watched(bench);
    figures.on_side = bench.stepper().spo().position.z() > kFace.z() + kBurrRadius;
    return figures;
}

JoltFigures buriedDrawnOut(const Variant& variant) {
    JoltBench bench(faceBone(), variant, kFace - 2.2 * kBurrRadius * kUp);
    return drawnOutOf(bench);
}

// The burr has milled itself in, and the bone is put back around it.
struct MilledIn : JoltBench {
    explicit MilledIn(const Variant& variant)
        : JoltBench(faceBone(), variant, kFace + 1.2 * kBurrRadius * kUp) {
        run(int(2e-3 / (kWorking * kDt)), -kWorking * kUp, kButtonRemove);
        run(100, Vector3d::Zero(), kButtonRemove);
        settle();
    }
};

JoltFigures checkpoint(const Variant& variant) {
    MilledIn bench(variant);
    bench.history().restore();
    return watched(bench);
}

JoltFigures checkpointDrawnOut(const Variant& variant) {
    MilledIn bench(variant);
    bench.history().restore();
    bench.run(100);
    return drawnOutOf(bench);
}

constexpr double kNeedle = 0.2e-3, kNeedleHeight = 2e-3;  // m, radius and height of a spike on the face
VoxelVolume needleBone() {
    const auto needle = [](const Vector3d& p) {
        const Vector3d r = p - kFace;
        const double up = std::clamp(r.z(), 0.0, kNeedleHeight - kNeedle);
        return std::min(r.z(), (r - up * kUp).norm() - kNeedle);
    };
    return bodyVolume(boxOf({kWide, kWide, 9e-3}), needle);
}

// The burr is pressed beside the axis on the needle's tip, and is drawn over it and down its side.
JoltFigures slidOffNeedle(const Variant& variant) {
    JoltBench bench(needleBone(), variant, kFace + (kNeedleHeight + kBurrRadius) * kUp - 0.1e-3 * kAside);
    bench.run(int(0.5e-3 / (kWorking * JoltBench::kDt)), -kWorking * kUp);
    bench.settle();
    bench.forbid(below(kFace.z()));
    bench.run(int(2.5e-3 / (kWorking * JoltBench::kDt)), kWorking * kAside);
    return watched(bench);
}

// The burr's centre is on the needle's axis, as after a checkpoint, and is drawn off along it or across.
JoltFigures leavesNeedle(const Variant& variant, const Vector3d& direction) {
    JoltBench bench(needleBone(), variant, kFace + 1.2e-3 * kUp);
    bench.forbid(below(kFace.z()));
    bench.run(int(4e-3 / (kWorking * JoltBench::kDt)), kWorking * direction);
    return watched(bench);
}
JoltFigures drawnOffNeedle(const Variant& variant) {
    return leavesNeedle(variant, kUp);
}
JoltFigures pulledAcrossNeedle(const Variant& variant) {
    return leavesNeedle(variant, (kAside + 0.3 * kUp).normalized());
}

// --- what is chosen -------------------------------------------------------------------------------------

JoltFigures toTool(const Variant& variant, size_t tool) {
    PressedBench bench(variant);
    bench.forbid(below(kFace.z() + (1 - kSunk) * JoltBench::kSmall));
    bench.change(tool);
    return watched(bench);
}
JoltFigures growingBurr(const Variant& variant) {
    return toTool(variant, JoltBench::kLargeBurr);
}
JoltFigures shrinkingBurr(const Variant& variant) {
    return toTool(variant, JoltBench::kSmallBurr);
}

JoltFigures worseOf(const JoltFigures& a, const JoltFigures& b) {
    return {std::max(a.jolt, b.jolt), a.on_side && b.on_side, std::max(a.recovery, b.recovery),
            a.is_finite && b.is_finite};
}

// To each of these presets and back.
template <class Bench>
JoltFigures changes(const Variant& variant, const std::vector<Preset>& presets) {
    JoltFigures worst;
    for (const Preset preset : presets) {
        Bench bench(variant);
        bench.choose(preset);
        worst = worseOf(worst, watched(bench));
        bench.choose(variant.preset);
        worst = worseOf(worst, watched(bench));
    }
    return worst;
}

// The voxels are nearly as large as the burr: what is felt depends on how finely the face is sampled.
struct CoarseBench : JoltBench {
    explicit CoarseBench(const Variant& variant) : JoltBench(bone(), variant, kFace + kBurrRadius * kNormal) {
        run(int(kPressed / (kWorking * kDt)), -kWorking * kNormal);
        settle();
        forbid([](const Vector3d& p) { return (p - kFace).dot(kNormal) < (1 - kSunk) * kBurrRadius; });
    }
    static VoxelVolume bone() {
        return bodyVolume(boxOf({kWide, kWide, 7e-3}, 0.8e-3), halfSpace(kFace, kNormal));
    }
    inline static const Vector3d kNormal = Vector3d(0.3, -0.2, 1).normalized();
};

JoltFigures otherAccuracy(const Variant& variant) {
    return changes<CoarseBench>(variant, {Preset::kFast, Preset::kBalanced, Preset::kExact});
}
// Not to vps, in which such a burr sinks into the face (docs/explanation/laws.md).
JoltFigures otherLaw(const Variant& variant) {
    return changes<PressedBench>(variant, {Preset::kThesis2012, Preset::kBalanced, Preset::kProxy3Dof,
                                           Preset::kPenaltySdf, Preset::kConstraint});
}

// --- what the device says -------------------------------------------------------------------------------

constexpr int kShort = 1, kLong = 60;  // ticks

// The hand moves on meanwhile, along the face.
JoltFigures falseSamples(const Variant& variant, int ticks, const Pose& sample) {
    PressedBench bench(variant);
    bench.runFalse(ticks, sample, 0.5 * kWorking * kAside);
    return watched(bench);
}
Pose notFinite() {
    return upright(Vector3d::Constant(kNan));
}
Pose outside() {
    return upright({900, 0, 0});
}
// It is on the other side of the bone.
Pose inside() {
    return upright(kFace - 30e-3 * kUp);
}
JoltFigures oneNotFinite(const Variant& variant) {
    return falseSamples(variant, kShort, notFinite());
}
JoltFigures manyNotFinite(const Variant& variant) {
    return falseSamples(variant, kLong, notFinite());
}
JoltFigures oneInside(const Variant& variant) {
    return falseSamples(variant, kShort, inside());
}
JoltFigures manyInside(const Variant& variant) {
    return falseSamples(variant, kLong, inside());
}
JoltFigures oneOutside(const Variant& variant) {
    return falseSamples(variant, kShort, outside());
}
JoltFigures manyOutside(const Variant& variant) {
    return falseSamples(variant, kLong, outside());
}

// The device is silent for 0.2 s, in which the hand goes 2 mm along the face.
JoltFigures silence(const Variant& variant) {
    constexpr int64_t kTick_ns = 1'000'000;
    PressedBench bench(variant);
    StaleRamp ramp;
    int64_t now = 0;
    for (; now < 2000 * kTick_ns; now += kTick_ns) ramp.update(now, now);
    const int64_t last_heard = now;
    const Pose sample = bench.hand();
    for (int n = 0; n < 200; ++n) {
        now += kTick_ns;
        const double factor = ramp.update(now, last_heard);
        bench.stepper().fadeDevice(factor, ramp.isStale());
        bench.runFalse(1, sample, 0.5 * kWorking * kAside);
    }
    bench.beginRecovery();
    for (int n = 0; n < kWatched; ++n) {
        now += kTick_ns;
        const double factor = ramp.update(now, now);
        bench.stepper().fadeDevice(factor, ramp.isStale());
        bench.run(1);
    }
    return bench.figures();
}

// --- the pedal ------------------------------------------------------------------------------------------

JoltFigures pedal(const Variant& variant, const std::function<void(FixedTickConfig&)>& edit) {
    PressedBench bench(variant, edit);
    bench.forbid({});
    bench.beginRecovery();
    bench.run(kWatched, Vector3d::Zero(), kButtonRemove);
    return bench.figures();
}
JoltFigures pedalByTime(const Variant& variant) {
    return pedal(variant, [](FixedTickConfig& config) {
        config.effects = {};
        config.effects.time_removal = kTimeRemoval;
    });
}
JoltFigures pedalByEnergy(const Variant& variant) {
    return pedal(variant, [](FixedTickConfig& config) {
        config.effects = {};
        config.effects.energy_removal = kEnergyRemoval;
        config.tool.burr.speed = kSpinSpeed;
        config.tool.burr.friction = kCuttingFriction;
    });
}

}  // namespace

const std::vector<JoltEvent>& joltEvents() {
    static const std::vector<JoltEvent> kEvents{
        {"buried_drawn_out", buriedDrawnOut},
        {"checkpoint", checkpoint},
        {"checkpoint_drawn_out", checkpointDrawnOut},
        {"slid_off_needle", slidOffNeedle},
        {"drawn_off_needle", drawnOffNeedle},
        {"pulled_across_needle", pulledAcrossNeedle},
        {"growing_burr", growingBurr},
        {"shrinking_burr", shrinkingBurr},
        {"other_accuracy", otherAccuracy, true},
        {"other_law", otherLaw},
        {"not_finite_1_tick", oneNotFinite},
        {"not_finite_60_ticks", manyNotFinite},
        {"jump_30_mm_1_tick", oneInside},
        {"jump_30_mm_60_ticks", manyInside},
        {"jump_900_m_1_tick", oneOutside},
        {"jump_900_m_60_ticks", manyOutside},
        {"device_silent", silence},
        {"pedal_time_removal", pedalByTime},
        {"pedal_energy_removal", pedalByEnergy, true},
    };
    return kEvents;
}

const JoltEvent& joltEvent(const std::string& name) {
    for (const JoltEvent& event : joltEvents())
        if (name == event.name) return event;
    throw std::invalid_argument("no jolt event " + name);
}

std::vector<Variant> joltVariants() {
    std::vector<Variant> variants;
    for (const Variant& variant : allVariants())
        if (!variant.isBaseline()) variants.push_back(variant);
    variants.push_back(baselineVariant());
    for (const Variant& variant : lawVariants()) variants.push_back(variant);
    return variants;
}

}  // namespace bonemill::test
