// The pieces of bone as seen from one side: an orthographic picture with the nearest piece at each pixel.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "haptic_server/core/volume/raw_volume.h"
#include "haptic_server/scans/find_bone/bone_pieces.h"

namespace bonemill {

using Colour = Eigen::Vector3d;  // red, green, blue, 0 .. 255

// Axes of W: those to the right and up in the picture, and the one along which it looks.
struct ViewSide {
    int right, up, depth;
    double towards_viewer;  // 1: the viewer is at the far end of the depth's axis, -1: at its beginning
};

// Start-up only.
class PieceView {
  public:
    // `box` in W, m, holds all that is drawn.
    PieceView(const ViewSide& side, const Eigen::AlignedBox3d& box, double pixel);

    // A voxel of this middle and half edges, in W.
    void add(uint8_t piece, const Eigen::Vector3d& p_W, const Eigen::Vector3d& half);

    int width() const noexcept { return width_; }
    int height() const noexcept { return height_; }
    // Rows from the bottom up, three bytes a pixel, lit from the upper left; white where nothing is.
    std::vector<uint8_t> rgb(std::span<const Colour> colour_of_piece) const;
    // The pixel of a piece that is nearest to the middle of all of them, if it is seen at all.
    struct Pixel {
        int column, row;
    };
    std::vector<Pixel> labelsOf(uint8_t pieces) const;  // column < 0: it is not seen

  private:
    size_t at(int column, int row) const noexcept { return size_t(column) + size_t(width_) * size_t(row); }
    std::vector<float> smoothDepth() const;

    ViewSide side_;
    Eigen::AlignedBox3d box_;
    double pixel_;
    int width_, height_;
    std::vector<uint8_t> piece_;  // kNothing: none
    std::vector<float> depth_;    // m, towards the viewer
};

}  // namespace bonemill
