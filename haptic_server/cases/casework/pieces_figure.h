// The pieces of bone seen from the top, the front and the left, each in its colour with the number that
// --drop-piece takes. The views lie as in a drawing, so that a place can be read off in W.
#pragma once

#include <span>

#include "haptic_server/cases/casework/case_plan.h"

namespace bonemill {

struct PiecesFigure {
    struct Picture {
        std::string file;
        std::vector<uint8_t> rgb;  // rows from the bottom up
    };
    std::string script;  // for gnuplot; writes pieces.png where it runs, beside the pictures
    std::vector<Picture> pictures;
};

// Noise is not drawn, and what is dropped is pale. Start-up only.
PiecesFigure piecesFigure(const RawVolume& scan, const CasePlan& plan);

using Colour = Eigen::Vector3d;  // red, green, blue, 0 .. 255

// Axes of W: those to the right and up in the picture, and the one along which it looks.
struct ViewSide {
    int right, up, depth;
    double towards_viewer;  // 1: the viewer is at the far end of the depth's axis, -1: at its beginning
};

// An orthographic picture of the pieces from one side, with the nearest one at each pixel. Start-up only.
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
