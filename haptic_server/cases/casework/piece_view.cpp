#include "haptic_server/cases/casework/piece_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bonemill {
namespace {

constexpr uint8_t kNothing = 255;
constexpr double kSlack = 1e-6;    // of a pixel
constexpr float kSameSurface = 4;  // pixels: a larger step in depth is an edge
constexpr double kAmbient = 0.3;

int pixelsOver(double length, double pixel) {
    return std::max(1, int(std::ceil(length / pixel - kSlack)));
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

}  // namespace bonemill
