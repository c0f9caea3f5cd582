#include "haptic_server/cases/casework/pieces_figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

#include "common/base/units.h"
#include "common/text/printed_text.h"
#include "haptic_server/scans/find_bone/bone_pieces.h"

namespace bonemill {
namespace {

constexpr uint8_t kNothing = 255;
constexpr double kSlack = 1e-6;    // of a pixel
constexpr float kSameSurface = 4;  // pixels: a larger step in depth is an edge
constexpr double kAmbient = 0.3;

int pixelsOver(double length, double pixel) {
    return std::max(1, int(std::ceil(length / pixel - kSlack)));
}

constexpr size_t kMaxColours = 8;   // pieces: those that make-case lists; the others are grey
constexpr double kMaxPixels = 420;  // along the longest edge
constexpr double kPale = 0.7;       // how white a piece is that is left out
constexpr double kDrawn = 780, kAround = 80, kBetween = 110, kLegend = 380;  // pixels of the figure
constexpr double kMargin = 0.03;                                             // of the longest edge
constexpr size_t kMaxMetal = 20;

const std::array<Colour, kMaxColours + 1> kColours = {{{222, 190, 130},
                                                       {70, 130, 220},
                                                       {210, 70, 60},
                                                       {80, 170, 80},
                                                       {150, 100, 200},
                                                       {60, 180, 180},
                                                       {240, 150, 50},
                                                       {230, 120, 170},
                                                       {150, 150, 150}}};

struct SideOfFigure {
    const char* file;
    const char* title;        // for patients
    const char* plain_title;  // where it is unknown how the patient lay
    ViewSide side;
};

constexpr SideOfFigure kSides[] = {{"top.rgb", "from the top", "seen against z", {0, 1, 2, 1}},
                                   {"front.rgb", "from the front", "seen along y", {0, 2, 1, -1}},
                                   {"left.rgb", "from the left", "seen against x", {1, 2, 0, 1}}};

Eigen::AlignedBox3d boxOfDrawn(const BonePieces& pieces, const VolumeGeometry& geometry, size_t count) {
    Eigen::AlignedBox3d box;
    for (const BonePiece& piece : pieces.list().first(count)) {
        const Eigen::AlignedBox3d voxels(piece.box.min.cast<double>() - Eigen::Vector3d::Constant(0.5),
                                         piece.box.max.cast<double>() + Eigen::Vector3d::Constant(0.5));
        for (int corner = 0; corner < 8; ++corner)
            box.extend(geometry.X_WV * Eigen::Vector3d(voxels.corner(Eigen::AlignedBox3d::CornerType(corner))
                                                           .cwiseProduct(geometry.spacing)));
    }
    const double margin = kMargin * box.sizes().maxCoeff();
    return {box.min().array() - margin, box.max().array() + margin};
}

uint8_t colourOf(size_t piece) {
    return uint8_t(std::min(piece, kMaxColours));
}

std::vector<PieceView> viewsOf(const CasePlan& plan, const VolumeGeometry& geometry,
                               const Eigen::AlignedBox3d& box, double pixel, size_t count) {
    std::vector<PieceView> views;
    for (const SideOfFigure& side : kSides) views.emplace_back(side.side, box, pixel);
    const Eigen::Matrix3d axes = geometry.X_WV.rotation.toRotationMatrix() * geometry.spacing.asDiagonal();
    const Eigen::Vector3d half = axes.cwiseAbs().rowwise().sum() / 2;
    plan.all_pieces->forEachRun([&](size_t piece, const Eigen::Vector3i& first, int length) {
        if (piece >= count) return;
        for (int n = 0; n < length; ++n) {
            const Eigen::Vector3d p_W =
                geometry.X_WV.position + axes * (first + Eigen::Vector3i(n, 0, 0)).cast<double>();
            for (PieceView& view : views) view.add(colourOf(piece), p_W, half);
        }
    });
    return views;
}

std::string hexOf(const Colour& colour) {
    return printed("#%02x%02x%02x", int(colour[0]), int(colour[1]), int(colour[2]));
}

// Where the three views lie in the figure, in its pixels from the lower left: the top view above the front's,
// the left's beside it.
struct Layout {
    double scale, width, height;
    Eigen::Vector3d size;  // of the views, along the axes of W

    explicit Layout(const Eigen::Vector3d& size_mm) {
        scale = kDrawn / (std::max(size_mm.x(), size_mm.z()) + size_mm.y());
        size = scale * size_mm;
        width = size.x() + std::max(size.y(), kLegend) + 3 * kAround;
        height = size.z() + size.y() + 1.5 * kAround + kBetween;
    }
    Eigen::Vector2d cornerOf(const ViewSide& side) const {
        return {side.right == 0 ? kAround : size.x() + 2 * kAround,
                side.up == 2 ? kAround : size.z() + kAround + kBetween};
    }
    std::string marginsOf(const ViewSide& side) const {
        const Eigen::Vector2d low = cornerOf(side),
                              high = low + Eigen::Vector2d(size[side.right], size[side.up]);
        std::ostringstream text;
        text << "set lmargin at screen " << low.x() / width << "\nset rmargin at screen " << high.x() / width
             << "\nset bmargin at screen " << low.y() / height << "\nset tmargin at screen "
             << high.y() / height << '\n';
        return text.str();
    }
};

std::string axisName(int axis, bool lacks_patient_axes) {
    const char* const names[] = {"x, mm", "y, mm", "z, mm"};
    const char* const sides[] = {" (to the left)", " (to the back)", " (to the head)"};
    return names[axis] + std::string(lacks_patient_axes ? "" : sides[axis]);
}

std::string regionIn(const ViewSide& side, const Eigen::AlignedBox3d& region) {
    const Eigen::Vector3d low = region.min() * kPerMillimetre, high = region.max() * kPerMillimetre;
    std::ostringstream text;
    text << "set object 1 rectangle from " << low[side.right] << ',' << low[side.up] << " to "
         << high[side.right] << ',' << high[side.up] << " front fs empty border lc rgb \"black\" lw 2 dt 2\n";
    return text.str();
}

std::string metalIn(const ViewSide& side, const Metal& metal, const VolumeGeometry& geometry) {
    std::ostringstream text;
    for (size_t n = 0; n < std::min(metal.pieces.size(), kMaxMetal); ++n) {
        const Eigen::Vector3d at = geometry.X_WV *
                                   Eigen::Vector3d(metal.pieces[n].middle.cwiseProduct(geometry.spacing)) *
                                   kPerMillimetre;
        text << "set label \"\" at " << at[side.right] << ',' << at[side.up]
             << " point pt 2 ps 2 lw 2 lc rgb \"#e000e0\" front\n";
    }
    return text.str();
}

std::string legendOf(const CasePlan& plan, const VolumeGeometry& geometry, const Layout& layout,
                     size_t count) {
    std::ostringstream text;
    const double left = (layout.size.x() + 2 * kAround) / layout.width;
    double line = layout.height - kAround;
    const auto next = [&](const Colour* colour, const std::string& words) {
        text << "set label \"" << words << "\" at screen " << left << ", screen " << line / layout.height
             << (colour ? " left offset 2,0 point pt 5 ps 2 lc rgb \"" + hexOf(*colour) + '"'
                        : std::string(" left"))
             << " front\n";
        line -= 24;
    };
    next(nullptr, "{/:Bold Pieces of bone}, by the numbers of --drop-piece");
    for (size_t n = 0; n < std::min(count, kMaxColours); ++n) {
        const double volume = double(plan.all_pieces->list()[n].voxels) * geometry.spacing.prod();
        next(&kColours[n],
             std::to_string(n + 1) + ":  " + volumeText(volume) + (plan.is_dropped[n] ? ", left out" : ""));
    }
    if (count > kMaxColours)
        next(&kColours[kMaxColours], std::to_string(count - kMaxColours) + " smaller ones");
    if (plan.region) next(nullptr, "dashed: the part that is milled");
    if (!plan.metal.pieces.empty()) next(nullptr, "crosses: metal");
    return text.str();
}

}  // namespace

PieceView::PieceView(const ViewSide& side, const Eigen::AlignedBox3d& box, double pixel)
    : side_(side),
      box_(box),
      pixel_(pixel),
      width_(pixelsOver(box.sizes()[side.right], pixel)),
      height_(pixelsOver(box.sizes()[side.up], pixel)),
      piece_(size_t(width_) * size_t(height_), kNothing),
      depth_(piece_.size(), -std::numeric_limits<float>::infinity()) {}

void PieceView::add(uint8_t piece, const Eigen::Vector3d& p_W, const Eigen::Vector3d& half) {
    const auto span = [&](int axis, int count) {
        const double low = (p_W[axis] - half[axis] - box_.min()[axis]) / pixel_ + kSlack,
                     high = (p_W[axis] + half[axis] - box_.min()[axis]) / pixel_ - kSlack;
        return std::pair(std::clamp(int(std::floor(low)), 0, count - 1),
                         std::clamp(int(std::floor(high)), 0, count - 1));
    };
    const auto depth = float(side_.towards_viewer * p_W[side_.depth]);
    const auto [left, right] = span(side_.right, width_);
    const auto [bottom, top] = span(side_.up, height_);
    for (int row = bottom; row <= top; ++row)
        for (int column = left; column <= right; ++column) {
            const size_t n = at(column, row);
            if (depth <= depth_[n]) continue;
            depth_[n] = depth;
            piece_[n] = piece;
        }
}

// Voxels make steps of the surface: the mean over pixels of the same surface takes them away.
std::vector<float> PieceView::smoothDepth() const {
    std::vector<float> depth = depth_;
    const auto far = kSameSurface * float(pixel_);
    for (int round = 0; round < 2; ++round) {
        const std::vector<float> before = depth;
        for (int row = 0; row < height_; ++row)
            for (int column = 0; column < width_; ++column) {
                const size_t n = at(column, row);
                if (piece_[n] == kNothing) continue;
                float sum = 0, count = 0;
                for (int r = std::max(0, row - 1); r <= std::min(height_ - 1, row + 1); ++r)
                    for (int c = std::max(0, column - 1); c <= std::min(width_ - 1, column + 1); ++c)
                        if (piece_[at(c, r)] == piece_[n] && std::abs(before[at(c, r)] - before[n]) < far)
                            sum += before[at(c, r)], ++count;
                depth[n] = sum / count;
            }
    }
    return depth;
}

std::vector<uint8_t> PieceView::rgb(std::span<const Colour> colour_of_piece) const {
    const std::vector<float> depth = smoothDepth();
    const auto far = kSameSurface * float(pixel_);
    const Eigen::Vector3d light = Eigen::Vector3d(-0.35, 0.45, 1).normalized();
    // How much nearer the surface gets from one pixel to the next.
    const auto slope = [&](size_t n, size_t before, size_t after) {
        const bool has_both = piece_[before] == piece_[n] && piece_[after] == piece_[n] &&
                              std::abs(depth[after] - depth[before]) < 2 * far;
        return has_both ? double(depth[after] - depth[before]) / (2 * pixel_) : 0.0;
    };
    std::vector<uint8_t> bytes(3 * piece_.size(), 255);
    for (int row = 0; row < height_; ++row)
        for (int column = 0; column < width_; ++column) {
            const size_t n = at(column, row);
            if (piece_[n] == kNothing) continue;
            const double across =
                slope(n, at(std::max(0, column - 1), row), at(std::min(width_ - 1, column + 1), row));
            const double upwards =
                slope(n, at(column, std::max(0, row - 1)), at(column, std::min(height_ - 1, row + 1)));
            const double lit = Eigen::Vector3d(-across, -upwards, 1).normalized().dot(light);
            const double brightness = kAmbient + (1 - kAmbient) * std::max(0.0, lit);
            for (int channel = 0; channel < 3; ++channel)
                bytes[3 * n + size_t(channel)] = uint8_t(colour_of_piece[piece_[n]][channel] * brightness);
        }
    return bytes;
}

std::vector<PieceView::Pixel> PieceView::labelsOf(uint8_t pieces) const {
    std::vector<Eigen::Vector2d> sum(pieces, Eigen::Vector2d::Zero());
    std::vector<double> count(pieces), nearest(pieces, std::numeric_limits<double>::infinity());
    std::vector<Pixel> labels(pieces, Pixel{-1, -1});
    const auto forEachPixel = [&](auto&& see) {
        for (int row = 0; row < height_; ++row)
            for (int column = 0; column < width_; ++column)
                if (const uint8_t piece = piece_[at(column, row)]; piece < pieces) see(piece, column, row);
    };
    forEachPixel([&](uint8_t piece, int column, int row) {
        sum[piece] += Eigen::Vector2d(column, row);
        ++count[piece];
    });
    forEachPixel([&](uint8_t piece, int column, int row) {
        const double away = (Eigen::Vector2d(column, row) - sum[piece] / count[piece]).norm();
        if (away >= nearest[piece]) return;
        nearest[piece] = away;
        labels[piece] = {column, row};
    });
    return labels;
}

PiecesFigure piecesFigure(const RawVolume& scan, const CasePlan& plan) {
    const VolumeGeometry& geometry = scan.geometry;
    const auto noise = std::ranges::count_if(plan.all_pieces->list(), [&](const BonePiece& piece) {
        return piece.voxels < plan.smallest_piece_voxels;
    });
    const size_t count = plan.all_pieces->list().size() - size_t(noise);
    const Eigen::AlignedBox3d box = boxOfDrawn(*plan.all_pieces, geometry, count);
    const double pixel = std::max(box.sizes().maxCoeff() / kMaxPixels, geometry.spacing.minCoeff());
    const std::vector<PieceView> views = viewsOf(plan, geometry, box, pixel, count);
    std::vector<Colour> colours(kColours.begin(), kColours.end());
    for (size_t n = 0; n < std::min(count, kMaxColours); ++n)
        if (plan.is_dropped[n]) colours[n] += kPale * (Colour::Constant(255) - colours[n]);
    const Layout layout(box.sizes() * kPerMillimetre);
    PiecesFigure figure;
    std::ostringstream script;
    script << "set terminal pngcairo size " << int(layout.width) << ',' << int(layout.height)
           << " font \"DejaVu Sans,11\"\nset output \"pieces.png\"\nset multiplot\nunset key\n"
              "set style textbox opaque fillcolor rgb \"white\" border lc rgb \"#404040\" margins 0.6,0.6\n"
              "set grid front lc rgb \"#c0c0c0\" lw 0.5\nset tics out nomirror\n"
           << legendOf(plan, geometry, layout, count);
    for (size_t n = 0; n < views.size(); ++n) {
        const ViewSide& side = kSides[n].side;
        const Eigen::Vector3d low = box.min() * kPerMillimetre, high = box.max() * kPerMillimetre;
        const double mm = pixel * kPerMillimetre;
        script << layout.marginsOf(side) << "set title \""
               << (scan.lacks_patient_axes ? kSides[n].plain_title : kSides[n].title) << "\"\nset xrange ["
               << low[side.right] << ':' << high[side.right] << "]\nset yrange [" << low[side.up] << ':'
               << high[side.up] << "]\nset xlabel \"" << axisName(side.right, scan.lacks_patient_axes)
               << "\"\nset ylabel \"" << axisName(side.up, scan.lacks_patient_axes) << "\"\n";
        if (plan.region) script << regionIn(side, *plan.region);
        script << metalIn(side, plan.metal, geometry);
        const std::vector<PieceView::Pixel> labels = views[n].labelsOf(uint8_t(std::min(count, kMaxColours)));
        for (size_t piece = 0; piece < labels.size(); ++piece)
            if (labels[piece].column >= 0)
                script << "set label \"" << piece + 1 << "\" at "
                       << low[side.right] + (labels[piece].column + 0.5) * mm << ','
                       << low[side.up] + (labels[piece].row + 0.5) * mm
                       << " center boxed font \",13\" front\n";
        script << "plot \"" << kSides[n].file << "\" binary array=(" << views[n].width() << ','
               << views[n].height() << ") format=\"%uchar%uchar%uchar\" origin=(" << low[side.right] + mm / 2
               << ',' << low[side.up] + mm / 2 << ") dx=" << mm << " dy=" << mm
               << " using 1:2:3 with rgbimage\nunset label\n";
        figure.pictures.push_back({kSides[n].file, views[n].rgb(colours)});
    }
    script << "unset multiplot\n";
    figure.script = script.str();
    return figure;
}

}  // namespace bonemill
