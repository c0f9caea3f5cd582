// This is the default contact model: every shell point near the tool stores energy, and force and torque are
// exactly minus the gradient of the sum. No closed path gains energy, noisy bone normals do no harm, and the
// points' areas make the result independent of how densely the surface is sampled.
//
// With φ the tool's distance at bone point b, δ = -φ, g = R∇φ, n the bone's outward normal and a the
// point's area:
//   E = Σ κ a λ Ψ(δ),   Ψ = ½δ² for δ > 0, going on linearly beyond the depth cap.
// A point stands for a patch of the surface, the triangles in its cells. Stiff contact is often narrower than
// the points are apart: near the tool these triangles are cut into pieces (surface_pieces.h), and the pieces'
// centroids, moved onto the trilinear surface, take the point's place. Wide contact has points enough.
//
// λ <= 1 is frozen when the candidates are gathered, so that each solve has one energy. It is 1 unless
// - the stiffness in the direction of g is above the cap (then the total is the same for a plane, a slot and
//   a full surround);
// - the tool is deep in the bone (kGuardFrom, or its point inside): then points that it reaches from their
//   far side (s = -n·g <= 0) are left out, so that no wall that the tool's medial axis has passed pulls it on
//   or locks it in.
// A λ that changes from tick to tick is not conservative; in ordinary contact none does.
//
// The frame is V, the units are m and N; torques are about the tool point. Everything but construction is
// RT-safe, for the tick thread only.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "haptic_server/core/contact/candidates.h"
#include "haptic_server/core/contact/contact_configs.h"
#include "haptic_server/core/contact/near_shell.h"
#include "haptic_server/core/contact/point_shell.h"
#include "haptic_server/core/contact/surface_pieces.h"
#include "haptic_server/core/coupling/energy_coupling.h"
#include "haptic_server/core/tool/tool_field.h"

namespace bonemill {

// Its points are gathered.
struct ShellView {
    const VoxelVolume& volume;
    const LeafLattice& lattice;
    const PointShell& shell;
    int level;
    double sample_spacing;                 // m, near the tool; 0: one sample per point
    int most_samples;                      // about as many near the tool; the spacing gives way
    size_t affordable_samples = SIZE_MAX;  // how many there is time for
    bool may_coarsen = true;               // patches that are known, if there are too many samples
};

struct GradientContactResult {
    EnergyTerm term;
    uint32_t contacts = 0;
    double max_depth = 0;  // m
};

class GradientContact {
  public:
    // What is nearer to the tool is sampled finely, m.
    static constexpr double kFineWithin = 50e-6;
    // In tool's thinnest radii, this is the depth from which on the force of a point no longer grows, and
    // those between which the far-side guard sets in.
    static constexpr double kDepthCap = 0.75, kGuardFrom = 0.25, kGuardFull = 0.5;
    static constexpr double kGuardWidth = 0.25;  // of s, over which the guard fades a point out

    // It has room for this many candidate points, and allocates.
    explicit GradientContact(const GradientContactConfig& config, size_t most_candidates = 65536);

    // Collects the points of a shell level that can touch the tool after a motion of at most `margin` (m, of
    // any of its points) from X_VT. False: more than there is room for, or than `most_tests` points near the
    // tool; the rest is left out.
    bool gather(const ShellView& bone, const ToolField& tool, const Pose& X_VT, double margin,
                size_t most_tests = SIZE_MAX) noexcept;

    // From the next gathering on.
    void setStiffness(const GradientContactConfig& config) noexcept { config_ = config; }

    // From now on there are not more candidates than this, however much room there is.
    void limitCandidates(size_t most) noexcept {
        near_.most = candidates_.most = std::min(most, candidates_.patch.size());
    }

    // The last gathering has fewer samples than its view asked for, for there is no time for more.
    bool hasFewerSamples() const noexcept { return has_fewer_samples_; }

    // Forgets of the last gatherings how finely which patch was sampled. This is called when the shell level
    // or the sampling changes, or the tool is placed anew or is another one.
    void forget() noexcept {
        patch_memory_.forget();
        crowd_ = {};
        forgetNear();
    }
    // The tool has grown by so much all around, m.
    void noteGrowth(double by) noexcept { near_shell_.comeNearer(by); }
    // What is found does not depend on it: forgets what was near the tool.
    void forgetNear() noexcept { near_shell_.forget(); }

    // Returns energy, wrench on the tool and stiffness at this pose, over the gathered points.
    template <class Scalar>
    GradientContactResult evaluate(const ToolField& tool, const Pose& X_VT) const noexcept;

    // The gathered points that touch the tool at this pose, as many as `out` has room for; returns how many.
    size_t list(const ToolField& tool, const Pose& X_VT, std::span<SurfaceContact> out) const noexcept;

    // Scales the weights at each gathering from now on; null: nothing does.
    void setWeights(ContactWeights* weights) noexcept { weights_ = weights; }

    // Returns the largest share t of the motion `step` (world increment x, ω) for which no gathered point
    // that is free at X_VT comes deeper than `allowed_depth`, and none in contact gets deeper by more than
    // that: conservative advancement. The share may be smaller than the largest, never larger. It lies in 0
    // .. 1. Ends early after about `most_tests` point tests.
    double advance(const ToolField& tool, const Pose& X_VT, const Vector6d& step, double allowed_depth,
                   size_t most_tests = SIZE_MAX) noexcept;

    // Work of gather() and advance() since the last call, in distances of one candidate to the tool.
    size_t takePointTests() noexcept { return std::exchange(point_tests_, 0); }

    size_t room() const noexcept { return candidates_.patch.size(); }
    size_t candidateCount() const noexcept { return candidates_.count; }
    double margin() const noexcept { return margin_; }

  private:
    // Four times as many as there may ever be samples: what was cut or is out of reach takes room, too.
    static constexpr size_t kMaxPieces = 4 * 65536;
    // What was sampled as finely as asked for may come to N times most_samples.
    static constexpr size_t kMaxTimes = 2;
    // Beyond most_samples known patches are cut less finely, by one level and so many at a gathering, the
    // finest first, which changes the force by less than is felt.
    static constexpr size_t kMostCoarsened = 2;
    // Where many patches are near, each is small against the contact, and half as many of them as there may
    // be pieces are samples enough. From half of that on there are fewer pieces the more patches there are,
    // of the nearest of them.
    static constexpr size_t kPiecesPerPatch = 4;
    static size_t piecesBeside(size_t coarse_patches, size_t most) noexcept {
        return std::min(most, 2 * (most - std::min(most, 2 * coarse_patches)));
    }
    // To cut the surface into samples and to solve with them takes as long as N point tests, each.
    static constexpr size_t kTestsPerSample = 20;
    // A contact counts for the stiffness cap in proportion to its depth, so that a new one comes in smoothly.
    static constexpr double kFullShareDepth = 20e-6;  // m
    static double shareInContact(double distance) noexcept {
        return std::clamp(-distance / kFullShareDepth, 0.0, 1.0);
    }
    // The spheres of these blocks of points are tested together.
    struct BlockBatch {
        static constexpr int kCapacity = PointBatch<float>::kCapacity;
        const ShellBlock* block[kCapacity];
        int points[kCapacity];
        LeafId leaf[kCapacity];
        int count = 0;
        void add(const ShellBlock& b, uint32_t point_count, LeafId of_leaf) noexcept {
            block[count] = &b;
            points[count] = int(point_count);
            leaf[count++] = of_leaf;
        }
    };
    bool collect(const ShellView& bone, const ToolField& tool, const Pose& X_VT, size_t most_tests) noexcept;
    bool collectFrom(const BlockBatch& blocks, const ToolField& tool, const Pose& X_VT) noexcept;
    NearTest nearTest(const ToolField& tool, const Pose& X_VT) const noexcept;
    bool addCandidates(const ShellBlock& block, LeafId leaf, int count, const SampleBatch<float>& at,
                       const NearTest& test) noexcept;
    // The tool seldom moves by more than half of the margin, which is a guess of twice its motion.
    double fineWithin() const noexcept { return std::min(margin_ / 2, kFineWithin); }
    void refine(const ShellView& bone, const ToolField& tool, const Pose& X_VT, size_t most_tests) noexcept;
    void cutPatches(const ShellView& bone, const ToolField& tool, const Pose& X_VT,
                    size_t most_tests) noexcept;
    void keepNearest(size_t most) noexcept;
    void findCoarse(const ToolField& tool) noexcept;
    size_t giveCells(const ShellView& bone) noexcept;
    void takeWholePatches() noexcept;
    size_t countPieces() noexcept;
    void takePieces() noexcept;
    void movePlacesOntoSurface(const VoxelVolume& volume, size_t from) noexcept;
    void startSweep(const ToolField& tool, const Pose& X_VT, const Vector6d& step,
                    double allowed_depth) noexcept;
    double sweptShare(const ToolField& tool, const Pose& X_VT) const noexcept;
    void sumStiffness() noexcept;
    void guardFarSide(const VoxelVolume& volume, const ToolField& tool, const Pose& X_VT) noexcept;
    void capStiffness(const ToolField& tool, const Pose& X_VT) noexcept;

    GradientContactConfig config_;
    ContactWeights* weights_ = nullptr;
    NearShell near_shell_;
    Candidates near_;                   // patches with a place near the tool, as one sample each
    std::vector<float> near_distance_;  // m: of those samples
    Candidates candidates_;             // samples that the tool can reach
    SurfacePieces pieces_{kMaxPieces};
    PatchMemory patch_memory_{4096};
    std::vector<uint32_t>
        split_;  // ascending: the first split_count_ are patches whose pieces take their place
    size_t split_count_ = 0;
    std::vector<uint8_t*> new_level_;  // of those that were not known, in patch_memory_
    // The last gathering that might make patches coarser had too many samples, but not if all patches were of
    // the coarsest level; its finest was the other one.
    struct Crowd {
        uint8_t finest = PatchMemory::kNew, coarsest = 0;
        bool makesCoarser(uint8_t level) const noexcept { return level <= finest && level < coarsest; }
    };
    Crowd crowd_;
    bool has_fewer_samples_ = false;
    std::vector<uint32_t> next_place_;  // per patch that is cut: of its pieces, where the next one goes
    std::vector<uint32_t> source_;      // per candidate: its patch
    std::vector<float> piece_area_;     // m²: per place of a piece
    // A sweep needs how near each candidate may come, in m, and 1/(the most that the whole step can bring
    // it nearer).
    std::vector<float> lowest_, inverse_rate_;
    size_t point_tests_ = 0;
    double most_stiffness_ = 0;  // N/m: those that may be in contact have no more, all directions together
    double deepest_ = 0;         // m
    double margin_ = 0;
    double patch_reach_ = 0;  // m: no place of a patch is farther from its point; 0 without pieces
    Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  // V: the tool point at the gathering
};

}  // namespace bonemill
