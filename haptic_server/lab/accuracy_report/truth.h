// Computes what a stroke should feel like: the same contact law and coupling on the same trilinear surface,
// as finely as can be waited for; for that, a part of the bone with denser voxels and the same surface.
#pragma once

#include <functional>

#include "haptic_server/core/volume/voxel_volume.h"
#include "haptic_server/lab/accuracy_report/measures.h"
#include "haptic_server/lab/accuracy_report/probing_path.h"

namespace bonemill {

struct Truth {
    std::vector<TickAnswer> answers;
    double max_penetration = 0;       // m
    int refinement = 0;               // of the voxels; wantedRefinement() unless memory forbade it
    std::vector<TickAnswer> coarser;  // the same with half that refinement: how far the truth can be off
};
inline constexpr int kMinRefinement = 4, kMaxRefinement = 16;

// The voxels are denser by so much that the burr on a plane touches some 8 of them across already with 1
// N: then the sums over the contact points are good to 0.1 % (patch.csv).
int wantedRefinement(double spacing, const FixedTickConfig& tick) noexcept;

// The truth has these settings: 2 × 2 contact points in each (refined) cell, analytic tool or its grid
// refined 4 times, double precision, the most iterations.
AccuracySettings truthSettings() noexcept;

// There is one for each stroke. `tick` gives the rest of the configuration. It uses `threads` at a time, each
// of which says when one is there.
using TruthProgress = std::function<void(size_t done)>;
std::vector<Truth> computeTruth(const std::vector<ProbingStroke>& strokes, const FixedTickConfig& tick,
                                const BoneModel& bone, const TouchProbe& probe, int threads,
                                const TruthProgress& progress = {});

// Holds the voxels of `box` (indices -1 .. dims, both ends included) and `times` - 1 further ones between any
// two neighbours per axis, with the trilinear density: the trilinear iso-surface stays the same but for
// rounding, at the same place in W. What leaves the box ends at the new volume's border of air.
VoxelVolume refinedPart(const VoxelVolume& volume, const IndexBox& box, int times);

// How many voxels refinedPart() would make.
size_t refinedCount(const IndexBox& box, int times);

// This is the largest refinement 1 .. `most` with at most `room` voxels.
int affordableRefinement(const IndexBox& box, int most, size_t room);

// These are the voxels around a box of positions in V (m) grown by `margin`, cut to what can be read.
IndexBox voxelsAround(const VoxelVolume& volume, const Eigen::AlignedBox3d& box_V, double margin);

}  // namespace bonemill
