#include "render_client/look/paint/pixel_tiles.h"

#include <algorithm>
#include <cmath>

namespace bonemill {

PixelBox PixelBox::joined(const PixelBox& other) const {
    if (isEmpty()) return other;
    if (other.isEmpty()) return *this;
    return {std::min(x0, other.x0), std::min(y0, other.y0), std::max(x1, other.x1), std::max(y1, other.y1)};
}

PixelBox PixelBox::within(const PixelBox& other) const {
    return {std::max(x0, other.x0), std::max(y0, other.y0), std::min(x1, other.x1), std::min(y1, other.y1)};
}

PixelBox PixelBox::around(const Eigen::AlignedBox3f& box, const Eigen::Matrix4f& clip_from_model, int width,
                          int height) {
    if (box.isEmpty()) return {};
    Eigen::AlignedBox2f ndc;
    for (int i = 0; i < 8; ++i) {
        const Eigen::Vector4f corner =
            clip_from_model * box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(i)).homogeneous();
        if (!(corner.w() > 0) || !(corner.z() >= -corner.w()) || !corner.allFinite())
            return whole(width, height);
        ndc.extend(Eigen::Vector2f(corner.head<2>() / corner.w()));
    }
    const auto pixel = [](float value, int size) {
        return std::clamp((value + 1) / 2 * float(size), -1.0f, float(size) + 1);
    };
    constexpr int kRounding = 1;  // rasterisation may round either way
    const PixelBox touched{
        int(std::floor(pixel(ndc.min().x(), width))), int(std::floor(pixel(ndc.min().y(), height))),
        int(std::ceil(pixel(ndc.max().x(), width))), int(std::ceil(pixel(ndc.max().y(), height)))};
    return touched.grown(kRounding).within(whole(width, height));
}

Eigen::Matrix4f PixelBox::zoom(int picture_width, int picture_height) const {
    const float scale_x = float(picture_width) / float(width()),
                scale_y = float(picture_height) / float(height());
    const float middle_x = float(x0 + x1) / float(picture_width) - 1;
    const float middle_y = float(y0 + y1) / float(picture_height) - 1;
    Eigen::Matrix4f zoom = Eigen::Matrix4f::Identity();
    zoom(0, 0) = scale_x;
    zoom(1, 1) = scale_y;
    zoom(0, 3) = -middle_x * scale_x;
    zoom(1, 3) = -middle_y * scale_y;
    return zoom;
}

std::vector<Eigen::AlignedBox3f> sliced(const Eigen::AlignedBox3f& box, int count) {
    Eigen::Index longest = 0;
    box.sizes().maxCoeff(&longest);
    return sliced(box, longest, count);
}

std::vector<Eigen::AlignedBox3f> sliced(const Eigen::AlignedBox3f& box, Eigen::Index axis, int count) {
    std::vector<Eigen::AlignedBox3f> slices;
    if (box.isEmpty()) return slices;
    const float length = box.sizes()[axis];
    for (int n = 0; n < count; ++n) {
        Eigen::AlignedBox3f slice = box;
        slice.min()[axis] = box.min()[axis] + length * float(n) / float(count);
        slice.max()[axis] = box.min()[axis] + length * float(n + 1) / float(count);
        slices.push_back(slice);
    }
    return slices;
}

PixelTiles::PixelTiles(int width, int height)
    : width_(width),
      height_(height),
      columns_((width + kTile - 1) / kTile),
      rows_((height + kTile - 1) / kTile),
      has_(size_t(columns_) * size_t(rows_), 0) {}

PixelTiles PixelTiles::whole(int width, int height) {
    PixelTiles tiles(width, height);
    std::ranges::fill(tiles.has_, uint8_t(1));
    return tiles;
}

void PixelTiles::add(const PixelBox& box) {
    const PixelBox seen = box.within(PixelBox::whole(width_, height_));
    if (seen.isEmpty()) return;
    for (int row = seen.y0 / kTile; row <= (seen.y1 - 1) / kTile; ++row)
        for (int column = seen.x0 / kTile; column <= (seen.x1 - 1) / kTile; ++column)
            has_[size_t(row * columns_ + column)] = 1;
}

void PixelTiles::add(const PixelTiles& other) {
    for (size_t n = 0; n < has_.size(); ++n) has_[n] |= other.has_[n];
}

void PixelTiles::keep(const PixelTiles& other) {
    for (size_t n = 0; n < has_.size(); ++n) has_[n] &= other.has_[n];
}

bool PixelTiles::isEmpty() const {
    return std::ranges::none_of(has_, [](uint8_t is_in) { return is_in != 0; });
}

PixelTiles PixelTiles::grown(int pixels) const {
    PixelTiles larger(width_, height_);
    for (const PixelBox& box : boxes()) larger.add(box.grown(pixels));
    return larger;
}

PixelBox PixelTiles::bounds() const {
    PixelBox all;
    for (const PixelBox& box : boxes()) all = all.joined(box);
    return all;
}

// The tiles of a row that lie side by side are one box.
std::vector<PixelBox> PixelTiles::runs(int row) const {
    std::vector<PixelBox> runs;
    const int y0 = row * kTile, y1 = std::min(y0 + kTile, height_);
    for (int column = 0; column < columns_; ++column) {
        if (!has(column, row)) continue;
        const int x0 = column * kTile;
        while (column + 1 < columns_ && has(column + 1, row)) ++column;
        runs.push_back({x0, y0, std::min((column + 1) * kTile, width_), y1});
    }
    return runs;
}

// A box goes on upwards for as long as the next row has the same run.
std::vector<PixelBox> PixelTiles::boxes() const {
    std::vector<PixelBox> boxes;
    for (int row = 0; row < rows_; ++row)
        for (const PixelBox& run : runs(row)) {
            const auto below = std::ranges::find_if(boxes, [&](const PixelBox& box) {
                return box.x0 == run.x0 && box.x1 == run.x1 && box.y1 == run.y0;
            });
            if (below != boxes.end())
                below->y1 = run.y1;
            else
                boxes.push_back(run);
        }
    return boxes;
}

}  // namespace bonemill
