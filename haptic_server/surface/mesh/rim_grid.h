// One grid for the vertices of all surfaces that meet around a region: that of the milled bone's, with its
// steps. Where two of them meet, they have the same integers.
#pragma once

#include <cmath>

#include "haptic_server/core/volume/surroundings.h"
#include "haptic_server/surface/mesh/mesh_grid.h"

namespace bonemill {

// Thread-safe after construction; the surroundings must outlive it.
class RimGrid {
  public:
    static constexpr int kStepsPerCell =
        MeshGrid::kStreamedStepsPerCell;  // of the scan, too, before rounding

    explicit RimGrid(const Surroundings& surroundings)
        : surroundings_(surroundings), step_(surroundings.rim.spacing() / kStepsPerCell) {
        const double cells = ((kMostSteps * step_).array() / scanSpacing().array()).minCoeff() - kMargin;
        part_cells_ = std::clamp(int(cells), 1, kMostPartCells);
        // A cell of the scan that is more than 50 voxels wide takes longer steps, and the rim fits less well.
        const double longest =
            ((1 + kMargin) * scanSpacing().array() / (kMostSteps * step_).array()).maxCoeff();
        if (longest > 1) step_ *= std::exp2(std::ceil(std::log2(longest)));
    }

    // So many cells of the scan per axis fit a mesh, moved by less than two cells at both ends.
    int partCells() const noexcept { return part_cells_; }
    const Eigen::Vector3d& step() const noexcept { return step_; }  // V, m

    // V, m: of a place on the scan's own grid, in kStepsPerCell to its voxel.
    Eigen::Vector3d placeInScan(const Eigen::Vector3i& scan_steps) const noexcept {
        return surroundings_.X_VS.position +
               scanSpacing().cwiseProduct(scan_steps.cast<double>() / kStepsPerCell);
    }
    Eigen::Vector3i stepsAt(const Eigen::Vector3d& p_V) const noexcept {
        return p_V.cwiseQuotient(step_).array().round().cast<int>();
    }

    // Sets the mesh's grid: from now on its vertices count from there on.
    void begin(NodeMesh& mesh, const Eigen::Vector3i& first_step) const noexcept {
        mesh.origin = step_.cwiseProduct(first_step.cast<double>()).cast<float>();
        mesh.step = step_.cast<float>();
    }

  private:
    static constexpr double kMostSteps = 65535;  // of PackedVertex
    static constexpr double kMargin = 4;         // cells
    static constexpr int kMostPartCells = 32;    // large, for few things to draw

    const Eigen::Vector3d& scanSpacing() const noexcept { return surroundings_.volume.spacing(); }

    const Surroundings& surroundings_;
    Eigen::Vector3d step_;
    int part_cells_;
};

}  // namespace bonemill
