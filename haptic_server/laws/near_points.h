// The bone's contact points near a tool: what the laws that push or hold the tool off the bone work on. They
// are those of the live point-shell, so that milled bone is felt as it is. It is RT-safe but for
// construction, for the tick thread only.
//
// A point stands for a patch of the surface, here a disc around it at right angles to its normal. The nearest
// place of the disc to the tool is what touches: a rigid tool that rested on the points alone would sink into
// the valleys between them, and feel up to half a voxel by its radius of false slope.
//
// The frame is V, the unit m.
#pragma once

#include <cstdint>
#include <vector>

#include "haptic_server/core/equilibrium/spo_model.h"
#include "haptic_server/core/tool/tool_field.h"

namespace bonemill {

class NearPoints {
  public:
    // There is room for N points.
    explicit NearPoints(size_t most);

    // Collects the points of a shell level whose discs may be nearer than `margin` to the tool. False: there
    // are more than there is room for; the rest is left out.
    bool gather(const SpoWorld& bone, int level, const ToolField& tool, const Pose& X_VT,
                double margin) noexcept;

    size_t count() const noexcept { return count_; }
    Eigen::Vector3d position(size_t n) const noexcept {
        return origin_ + Eigen::Vector3d(double(x_[n]), double(y_[n]), double(z_[n]));
    }
    // It is unit, out of the bone, or zero.
    Eigen::Vector3d normal(size_t n) const noexcept {
        return {double(nx_[n]), double(ny_[n]), double(nz_[n])};
    }

    // Half a patch's diagonal, m.
    double discRadius(size_t n) const noexcept { return double(disc_[n]); }

    // Writes every disc's distance to the tool at this pose, in m, to distance(n); where it is more than
    // `beyond`, only a lower bound above that.
    void measure(const ToolField& tool, const Pose& X_VT, double beyond) noexcept;
    double distance(size_t n) const noexcept { return double(distance_[n]); }

    struct Place {
        Eigen::Vector3d position;  // V
        double distance;           // m, negative in the tool
        Eigen::Vector3d
            out_of_tool;  // V: into the bone at right angles to the disc; at its rim out of the tool
    };
    // Returns the place of the disc that is nearest to the tool, or the deepest in it, by a descent of the
    // tool's distance: at once for a ball, in some steps for a rim.
    Place nearestPlace(size_t n, const ToolField& tool, const Pose& X_VT, const Pose& X_TV) const noexcept;

  private:
    bool add(const ShellBlock& block, uint32_t count, const ToolField& tool, const Pose& X_VT,
             float margin) noexcept;

    Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  // V: the points are counted from here
    std::vector<float> x_, y_, z_, nx_, ny_, nz_, disc_, distance_;
    size_t most_, count_ = 0;
};

}  // namespace bonemill
