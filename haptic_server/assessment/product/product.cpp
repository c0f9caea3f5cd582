#include "haptic_server/assessment/product/product.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/base/units.h"
#include "haptic_server/assessment/product/breach.h"
#include "haptic_server/assessment/product/structures_left.h"
#include "haptic_server/assessment/product/zone_tally.h"

namespace bonemill {
namespace {

constexpr int kPlanVersion = 1;
constexpr double kBeside = 10e-3;  // m from the line; what was removed farther off is no part of the hole
constexpr int64_t kMinVoxels = 30;
constexpr double kMinSlenderness = 1.5;  // standard deviations along and across

// Its axis is that of the voxels that were removed around the planned line, by their moments.
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

// Adds the figures "plan.*"; none without a hole that is longer than wide.
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

// The form of what was hollowed out, seen along the way into the bone.
// With u out of the bone against that way and n a piece's normal: floor where n·u is above cos 45°, wall
// where it lies between, undercut below -sin 5°. The isthmus is the 5th percentile of the width from wall to
// wall, each measured along a wall's normal: the least width but for 5 % of the wall.

constexpr int kCavityVersion = 1;
constexpr double kWalkStepsPerVoxel = 4;
constexpr size_t kMaxSteps = 40'000'000;  // of all walks; a second

// Something was taken away right in front of it: it is no part of the surface as it was.
bool isCut(const ChangeGrid& changes, const CutPiece& piece) {
    const Eigen::Vector3d out = 0.6 * changes.spacing().cwiseProduct(piece.normal_V);
    return changes.isRemoved(changes.voxelOf(piece.center_V + out));
}

// Goes from `start` along `way` through the box in small steps.
class Walk {
  public:
    explicit Walk(const ChangeGrid& changes)
        : changes_(changes), step_(changes.spacing().minCoeff() / kWalkStepsPerVoxel) {
        const Eigen::Vector3d size =
            (changes.box().max - changes.box().min).cast<double>().cwiseProduct(changes.spacing());
        steps_ = int(size.norm() / step_) + 1;
    }

    int steps() const noexcept { return steps_; }
    // Returns the way to the end of the last voxel that was bone, 0 if there is none.
    double toSurface(const Eigen::Vector3d& start, const Eigen::Vector3d& way) const {
        double last = 0;
        for (int n = 1; n <= steps_; ++n)
            if (changes_.wasBone(changes_.voxelOf(start + n * step_ * way))) last = n * step_;
        return last;
    }
    // Returns the way to the next bone, 0 if there is none.
    double toBone(const Eigen::Vector3d& start, const Eigen::Vector3d& way) const {
        // The piece lies between a voxel of bone and one of none: the bone that it is of does not count.
        bool is_out = false;
        for (int n = 1; n <= steps_; ++n) {
            const bool is_bone = changes_.isBone(changes_.voxelOf(start + n * step_ * way));
            is_out |= !is_bone;
            if (is_out && is_bone) return n * step_;
        }
        return 0;
    }

  private:
    const ChangeGrid& changes_;
    double step_;
    int steps_;
};

// Adds the figures "cavity.*". `approach_V` goes into the bone and has length 1.
void addCavityFigures(const ChangeGrid& changes, const std::vector<CutPiece>& pieces,
                      const Eigen::Vector3d& approach_V, Figures& figures) {
    const double floor_cosine = std::cos(45 * kDegree), undercut_cosine = -std::sin(5 * kDegree);
    const Walk walk(changes);
    WeightedSample depth, width, taper;
    double undercut = 0;
    bool is_hollow = false;
    // Of very many pieces every n-th stands for the others.
    const size_t stride = 1 + pieces.size() * size_t(walk.steps()) / kMaxSteps;
    for (size_t n = 0; n < pieces.size(); n += stride) {
        const CutPiece& piece = pieces[n];
        if (!piece.is_judged || !isCut(changes, piece)) continue;
        is_hollow = true;
        const double cosine = -piece.normal_V.dot(approach_V);
        if (cosine < undercut_cosine) undercut += piece.area * double(stride);
        if (cosine > floor_cosine) {
            depth.add(walk.toSurface(piece.center_V, -approach_V), piece.area);
        } else if (cosine > -floor_cosine) {
            taper.add(std::asin(cosine), piece.area);
            const double across = walk.toBone(piece.center_V, piece.normal_V);
            if (across > 0) width.add(across, piece.area);
        }
    }
    if (!is_hollow) return;
    const auto add = [&](const char* id, const char* label, double value, const char* unit) {
        figures.push_back({std::string("cavity.") + id, kCavityVersion, label, value, unit});
    };
    if (!depth.isEmpty()) {
        add("depth_mean", "Depth of the floor, mean", depth.mean() * kPerMillimetre, "mm");
        add("depth_sd", "Depth of the floor, SD", depth.deviation() * kPerMillimetre, "mm");
    }
    if (!width.isEmpty()) add("isthmus", "Least width", width.percentile(0.05) * kPerMillimetre, "mm");
    if (!taper.isEmpty()) add("wall_taper", "Walls open by, median", taper.percentile(0.5) / kDegree, "deg");
    add("undercut_area", "Undercut walls", undercut * kPerMillimetre * kPerMillimetre, "mm2");
}

constexpr int64_t kMaxGridVoxels = 16'000'000;  // time and memory are bounded
constexpr double kMargin = 4e-3;                // m around what is gone or shall be

IndexBox gridBoxOf(const IndexBox& changed, const VoxelVolume& volume) {
    const Eigen::Vector3i margin = (kMargin / volume.spacing().array()).ceil().cast<int>();
    return IndexBox{changed.min - margin, changed.max + margin}.clamped(Eigen::Vector3i::Constant(-1),
                                                                        volume.dims());
}

// Without a way into the bone it is seen from where most of what is judged looks out.
Eigen::Vector3d viewOf(const Deviation& deviation, const JudgedTask& task) {
    if (task.approach_V) return *task.approach_V;
    if (task.plan) return (task.plan->tip_V - task.plan->entry_V).normalized();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const CutPiece& piece : deviation.pieces) sum -= piece.area * piece.normal_V;
    return sum.norm() > 0 ? Eigen::Vector3d(sum.normalized()) : Eigen::Vector3d(-Eigen::Vector3d::UnitZ());
}

void measureShape(const ProductInput& input, const IndexBox& changed, Product& product) {
    const JudgedTask& task = input.task;
    const ChangeGrid changes(gridBoxOf(changed, input.now), input.scanned, input.now, task);
    const std::vector<CutPiece> pieces = surfaceIn(input.now, changes);
    const Deviation deviation = deviationOf(changes, pieces);
    addDeviationFigures(deviation, product.figures);
    if (task.approach_V) addCavityFigures(changes, pieces, *task.approach_V, product.figures);
    product.picture =
        drawDeviation(deviation, pieces, viewOf(deviation, task), input.now.spacing().maxCoeff());
    if (task.plan) addPlanFigures(changes, *task.plan, SolidBone(input.scanned, *task.plan), product.figures);
}

}  // namespace

Product measureProduct(const ProductInput& input) {
    Product product;
    const ProductCounts counts = countProduct(input.scanned, input.now, input.task);
    const double voxel_volume = input.scanned.voxelVolume();
    addZoneFigures(counts, input.task, voxel_volume, product.figures);
    if (input.breach) addBreachFigures(*input.breach, product.figures);
    if (!counts.changed.isEmpty()) {
        if (gridBoxOf(counts.changed, input.now).count() <= kMaxGridVoxels)
            measureShape(input, counts.changed, product);
        else
            product.left_out.push_back(
                "over- and under-cut, form and plan: what is gone and what should be lie too far apart for "
                "the time there is");
    }
    addStructureFigures(structuresLeft(input.scanned, input.now, input.task), voxel_volume, product.figures);
    return product;
}

}  // namespace bonemill
