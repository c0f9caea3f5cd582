#include "haptic_server/assessment/product/plan_error.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr int kPlanVersion = 1;
constexpr double kBeside = 10e-3;  // m from the line; what was removed farther off is no part of the hole
constexpr int64_t kMinVoxels = 30;
constexpr double kMinSlenderness = 1.5;  // standard deviations along and across

struct Hole {
    Eigen::Vector3d start_V, end_V;  // of its axis
};

template <class Visit>
void forEachHoleVoxel(const ChangeGrid& changes, const PlannedLine& line, Visit&& visit) {
    const Eigen::Vector3d along = (line.tip_V - line.entry_V).normalized();
    forEachIndex(changes.box(), [&](const Eigen::Vector3i& v) {
        if (!changes.isRemoved(v)) return;
        const Eigen::Vector3d p_V = v.cast<double>().cwiseProduct(changes.spacing());
        const Eigen::Vector3d way = p_V - line.entry_V;
        if ((way - way.dot(along) * along).norm() < kBeside) visit(p_V);
    });
}

std::optional<Hole> holeOf(const ChangeGrid& changes, const PlannedLine& line) {
    int64_t count = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    forEachHoleVoxel(changes, line, [&](const Eigen::Vector3d& p_V) {
        const Eigen::Vector3d p = p_V - line.entry_V;
        ++count;
        sum += p;
        squares += p * p.transpose();
    });
    if (count < kMinVoxels) return std::nullopt;
    const Eigen::Vector3d middle = sum / double(count);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> moments(squares / double(count) -
                                                                 middle * middle.transpose());
    const Eigen::Vector3d& variance = moments.eigenvalues();  // ascending
    if (variance[2] < kMinSlenderness * kMinSlenderness * variance[1]) return std::nullopt;
    Eigen::Vector3d axis = moments.eigenvectors().col(2);
    if (axis.dot(line.tip_V - line.entry_V) < 0) axis = -axis;
    const Eigen::Vector3d middle_V = line.entry_V + middle;
    double first = std::numeric_limits<double>::infinity(), last = -first;
    forEachHoleVoxel(changes, line, [&](const Eigen::Vector3d& p_V) {
        const double s = (p_V - middle_V).dot(axis);
        first = std::min(first, s);
        last = std::max(last, s);
    });
    const double half_voxel = 0.5 * axis.cwiseAbs().dot(changes.spacing());
    return Hole{middle_V + (first - half_voxel) * axis, middle_V + (last + half_voxel) * axis};
}

double wallDistance(const Hole& hole, const PlannedLine& line, const SolidBone& bone) {
    const Eigen::Vector3d along = (line.tip_V - line.entry_V).normalized();
    const double length = (hole.end_V - hole.start_V).norm(), step = 0.25e-3;
    double least = std::numeric_limits<double>::infinity();
    for (double s = 0; s < length; s += step) {
        const Eigen::Vector3d p_V = hole.start_V + s / length * (hole.end_V - hole.start_V);
        if ((p_V - line.entry_V).dot(along) < line.free || !bone.isNear(p_V)) continue;
        least = std::min(least, bone.depthAt(p_V));
    }
    return least;
}

}  // namespace

void addPlanFigures(const ChangeGrid& changes, const PlannedLine& line, const SolidBone& bone,
                    Figures& figures) {
    const std::optional<Hole> hole = holeOf(changes, line);
    if (!hole) return;
    const Eigen::Vector3d plan = (line.tip_V - line.entry_V).normalized(),
                          axis = (hole->end_V - hole->start_V).normalized();
    const auto add = [&](const char* id, const char* label, double value, const char* unit) {
        if (std::isfinite(value))
            figures.push_back({std::string("plan.") + id, kPlanVersion, label, value, unit});
    };
    // Where the axis goes through the plane across the line at its entry.
    const Eigen::Vector3d entry_V =
        hole->start_V + (line.entry_V - hole->start_V).dot(plan) / axis.dot(plan) * axis;
    add("entry_error", "Entry beside the plan", (entry_V - line.entry_V).norm() * kPerMillimetre, "mm");
    add("tip_error", "Tip from the plan's", (hole->end_V - line.tip_V).norm() * kPerMillimetre, "mm");
    add("angle_error", "Angle to the plan", std::acos(std::clamp(axis.dot(plan), -1.0, 1.0)) / kDegree,
        "deg");
    add("wall_distance", "From the hole's axis to the bone's surface",
        wallDistance(*hole, line, bone) * kPerMillimetre, "mm");
}

}  // namespace bonemill
