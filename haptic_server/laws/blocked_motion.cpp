#include "haptic_server/laws/blocked_motion.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

constexpr double kShortest = 1e-9;    // m: a shorter way is none
constexpr double kGuardFrom = 0.25;   // thinnest radii, as in the gradient law
constexpr double kLongestStep = 0.5;  // thinnest radii
constexpr double kTouching = 1e-6;    // m: a point so near counts as a contact
constexpr int kMostCuts = 8;
constexpr double kShortestCut = 0.02;  // of a step

double reachOf(const ToolField& tool, const Vector6d& motion) noexcept {
    return motion.head<3>().norm() + motion.tail<3>().norm() * tool.reach();
}

Vector6d wayTo(const Pose& X_VT, const Pose& X_VT_wanted) noexcept {
    Vector6d way;
    way << X_VT_wanted.position - X_VT.position,
        logRotation(X_VT_wanted.rotation * X_VT.rotation.conjugate());
    return way;
}

}  // namespace

void BlockedMotion::takePlanes(const ToolField& tool, const Pose& X_VT, const Wish& wish, double reach,
                               SpoStep& out) noexcept {
    planes_.clear();
    out.contacts = 0;
    const Pose X_TV = X_VT.inverse();
    const double guard = -kGuardFrom * tool.thinnestRadius();
    for (size_t n = 0; n < points_.count(); ++n) {
        if (points_.distance(n) > reach) continue;
        const NearPoints::Place at = points_.nearestPlace(n, tool, X_VT, X_TV);
        if (at.distance < guard && points_.normal(n).dot(at.out_of_tool) >= 0) continue;
        // The gap closes when the tool moves along its own outward direction there.
        Vector6d J;
        J << -at.out_of_tool, Eigen::Vector3d::Zero();
        if (wish.may_turn) J.tail<3>() = -(at.position - X_VT.position).cross(at.out_of_tool);
        out.has_contact_overflow |= !planes_.add(J, std::min(-at.distance, wish.recovery));
        out.contacts += at.distance < kTouching;
        out.max_penetration = std::max(out.max_penetration, -at.distance);
    }
}

// Returns the share of the motion after which no point is deeper than it may be: all of it, or found by
// cutting at where the depth of the worst point, taken as linear, reaches what is allowed.
double BlockedMotion::allowedShare(const ToolField& tool, const Pose& X_VT, const Vector6d& motion) noexcept {
    for (size_t n = 0; n < points_.count(); ++n) lowest_[n] = float(std::min(0.0, points_.distance(n)));
    double share = 1;
    for (int cut = 0; cut < kMostCuts; ++cut) {
        points_.measure(tool, X_VT.incremented(share * motion.head<3>(), share * motion.tail<3>()), 0);
        double deepest = 0;
        for (size_t n = 0; n < points_.count(); ++n)
            deepest = std::max(deepest, double(lowest_[n]) - points_.distance(n));
        if (deepest <= kTolerance) return share;
        share *= std::max(kShortestCut, 0.9 * kTolerance / deepest);
    }
    return 0;
}

Vector6d BlockedMotion::go(const SpoWorld& bone, int level, const ToolField& tool, const Wish& wish,
                           Pose& X_VT, SpoStep& out) noexcept {
    Vector6d reaction = Vector6d::Zero();
    const double longest = kLongestStep * tool.thinnestRadius();
    const double whole = std::max(reachOf(tool, wayTo(X_VT, wish.X_VT)), wish.recovery);
    out.has_contact_overflow |= !points_.gather(bone, level, tool, X_VT, 2 * whole + kTolerance);
    out.candidates = uint32_t(points_.count());
    double left = 2 * whole;  // what was gathered for
    for (int round = 0; round < wish.rounds; ++round) {
        const Vector6d wanted = wayTo(X_VT, wish.X_VT);
        const double to_go = std::max(reachOf(tool, wanted), wish.recovery) + kTolerance;
        points_.measure(tool, X_VT, to_go);
        takePlanes(tool, X_VT, wish, to_go, out);
        const LeastConstraint::Result found = planes_.solve(wanted, wish.K);
        out.has_stalled = !found.is_feasible;
        reaction = found.reaction;
        const double reach = reachOf(tool, found.motion);
        ++out.iterations;
        if (reach < kShortest) break;
        const double most = std::min({1.0, longest / reach, left / reach});
        const Vector6d motion = most * found.motion;
        const double share = allowedShare(tool, X_VT, motion);
        X_VT = X_VT.incremented(share * motion.head<3>(), share * motion.tail<3>());
        left -= share * most * reach;
        if (share == 1 && most == 1) break;
    }
    return reaction;
}

}  // namespace bonemill
