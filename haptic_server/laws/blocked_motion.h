// A tool goes towards where the hand wants it as far as the bone lets it, and never into it: proxy_3dof and
// constraint.
//
// A tick makes up to `rounds` steps. Each takes the contact points that the tool could reach as planes
// (J_i Δ >= -gap_i), finds the allowed motion nearest to the wanted one (least_constraint.h), and goes along
// it as far as no point comes deeper than kTolerance into the tool. No step is longer than half the radius of
// the tool's thinnest part, so that no point can pass through it unseen; a point that grazes it passes at
// most 1/32 of that radius below its surface. A tool that is in the bone already, because bone was put back
// or another tool chosen, is let out at kRecovery. Points that the tool reaches from inside the bone, deeper
// than a quarter of its thinnest radius, do not hold it.
//
// It is RT-safe but for construction, for the tick thread only. Frame V, SI.
#pragma once

#include "haptic_server/laws/least_constraint.h"
#include "haptic_server/laws/near_points.h"

namespace bonemill {

class BlockedMotion {
  public:
    static constexpr double kTolerance = 2e-6;  // m
    static constexpr double kRecovery = 10e-3;  // m/s
    static constexpr size_t kMaxPoints = 16384, kMaxRows = 4096;

    BlockedMotion() : points_(kMaxPoints), planes_(kMaxRows) {}

    struct Wish {
        Pose X_VT;      // where the hand wants the tool: all the way, or balance would be sought elsewhere
        Matrix6d K;     // what makes motions near to each other
        bool may_turn;  // false: the tool has the wanted rotation already, and contact turns it no more
        int rounds;
        double recovery;              // m in this tick
        double bite;                  // m: so deep in the bone the planes lie
        double most_move, most_turn;  // m and rad in this tick
    };
    // Forgets earlier ticks.
    void restart() noexcept { last_reach_ = 0; }
    // Moves X_VT; fills contacts, candidates, iterations, max_penetration, has_contact_overflow and
    // has_stalled of `out`. Returns the reaction of the last step's contacts on the tool in units of K Δ.
    Vector6d go(const SpoWorld& bone, int level, const ToolField& tool, const Wish& wish, Pose& X_VT,
                SpoStep& out) noexcept;

  private:
    void takePlanes(const ToolField& tool, const Pose& X_VT, const Wish& wish, double reach, double recovery,
                    SpoStep& out) noexcept;
    double allowedShare(const ToolField& tool, const Pose& X_VT, const Vector6d& motion,
                        double bite) noexcept;

    NearPoints points_;
    LeastConstraint planes_;
    double last_reach_ = 0;  // m: how far the last tick's motion moved any of the tool's points
    std::vector<float> lowest_ = std::vector<float>(kMaxPoints);  // m: how near each point may come
};

}  // namespace bonemill
