#include "haptic_server/laws/blocked_motion.h"

#include <algorithm>

#include "common/geometry/pose.h"

namespace bonemill {
namespace {

constexpr double kShortest = 1e-9;    // m: a shorter way is none
constexpr double kGuardFrom = 0.25;   // thinnest radii, as in the gradient law
constexpr double kLongestStep = 0.5;  // thinnest radii
constexpr double kMarginGrowth = 2;   // of the last tick's motion, and from gathering to gathering
constexpr double kRounding = 1e-9;
constexpr double kTouching = 1e-6;  // m: a point so near counts as a contact
constexpr int kMaxCuts = 8;
constexpr double kShortestCut = 0.02;  // of a step

double reachOf(const ToolField& tool, const Vector6d& motion) noexcept {
    return motion.head<3>().norm() + motion.tail<3>().norm() * tool.reach();
}

double shareWithin(double most, const Eigen::Vector3d& way) noexcept {
    const double length = way.norm();
    return length <= most ? 1 : std::max(0.0, most) / length;
}

// A hand that turns too quickly does not hold the tool's place back: what is left of the tick is for the
// place.
void dropTurn(BlockedMotion::Wish& wish) noexcept {
    wish.may_turn = false;
    wish.K.topRightCorner<3, 3>().setZero();
    wish.K.bottomLeftCorner<3, 3>().setZero();
}

}  // namespace

void BlockedMotion::takePlanes(const ToolField& tool, const Pose& X_VT, const Wish& wish, double reach,
                               double recovery, SpoStep& out) noexcept {
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
        out.has_contact_overflow |= !planes_.add(J, std::min(-at.distance - wish.bite, recovery));
        out.contacts += at.distance < kTouching;
        out.max_penetration = std::max(out.max_penetration, -at.distance);
    }
    const double of_points = double(points_.count()) / kMaxPoints,
                 of_rows = double(planes_.count()) / kMaxRows;
    out.budget_share = std::max({out.budget_share, of_points, of_rows});
}

// Returns the share of the motion after which no point is deeper than it may be: all of it, or found by
// cutting at where the depth of the worst point, taken as linear, reaches what is allowed.
double BlockedMotion::allowedShare(const ToolField& tool, const Pose& X_VT, const Vector6d& motion,
                                   double bite) noexcept {
    for (size_t n = 0; n < points_.count(); ++n) lowest_[n] = float(std::min(-bite, points_.distance(n)));
    double share = 1;
    for (int cut = 0; cut < kMaxCuts; ++cut) {
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
    const Pose X_VT_start = X_VT;
    const double longest = kLongestStep * tool.thinnestRadius();
    const double least = wish.recovery + wish.bite + kTolerance;
    double move_left = wish.most_move, turn_left = wish.most_turn;
    Wish now = wish;
    double margin = std::max(least, kMarginGrowth * last_reach_), left = 0;
    for (int round = 0; round < wish.rounds; ++round) {
        if (turn_left <= 0) dropTurn(now);
        Vector6d wanted = between(X_VT, wish.X_VT);
        if (!now.may_turn) wanted.tail<3>().setZero();
        if (left < least) {  // nothing is gathered, or the tool has gone as far as it was
            margin = std::min(margin, std::max(least, kMarginGrowth * reachOf(tool, wanted)));
            out.has_contact_overflow |= !points_.gather(bone, level, tool, X_VT, margin);
            left = margin;
            margin *= kMarginGrowth;
        }
        points_.measure(tool, X_VT, left);
        takePlanes(tool, X_VT, now, left, round == 0 ? wish.recovery : 0, out);
        const LeastConstraint::Result found = planes_.solve(wanted, now.K);
        out.has_stalled = !found.is_feasible;
        reaction = found.reaction;
        const double reach = reachOf(tool, found.motion);
        ++out.iterations;
        if (reach < kShortest) break;
        const double most =
            std::min({1.0, longest / reach, left / reach, shareWithin(move_left, found.motion.head<3>()),
                      shareWithin(turn_left, found.motion.tail<3>())});
        out.is_motion_clamped |= most < std::min({1.0, longest / reach, left / reach});
        const Vector6d motion = most * found.motion;
        const double share = allowedShare(tool, X_VT, motion, wish.bite);
        X_VT = X_VT.incremented(share * motion.head<3>(), share * motion.tail<3>());
        left -= share * most * reach;
        move_left -= share * motion.head<3>().norm();
        turn_left -= share * motion.tail<3>().norm() * (1 + kRounding);
        if (share == 1 && most == 1) break;
    }
    out.candidates = uint32_t(points_.count());
    last_reach_ = reachOf(tool, between(X_VT_start, X_VT));
    return reaction;
}

}  // namespace bonemill
