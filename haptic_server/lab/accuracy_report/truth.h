// Computes what a stroke should feel like: the same contact law and coupling on the same trilinear surface,
// as finely as can be waited for.
#pragma once

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

// There is one for each stroke. `tick` gives the rest of the configuration. It uses `threads` at a time.
std::vector<Truth> computeTruth(const std::vector<ProbingStroke>& strokes, const FixedTickConfig& tick,
                                const BoneModel& bone, const TouchProbe& probe, int threads);

}  // namespace bonemill
