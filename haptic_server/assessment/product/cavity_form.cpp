#include "haptic_server/assessment/product/cavity_form.h"

#include <cmath>

#include "common/base/units.h"
#include "haptic_server/assessment/product/weighted_sample.h"

namespace bonemill {
namespace {

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

}  // namespace

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

}  // namespace bonemill
