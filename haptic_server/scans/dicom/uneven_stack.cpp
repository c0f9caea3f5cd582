#include "haptic_server/scans/dicom/uneven_stack.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace bonemill {
namespace {

// Decimal text rounds places; a slice so near to the next one's share is that slice.
constexpr double kSameShare = 1e-6;

class StackSampler {
  public:
    StackSampler(const RawValues& values, const std::vector<SlicePlace>& places, const Eigen::Vector2i& size,
                 const SliceGrid& grid)
        : values_(values), places_(places), size_(size), grid_(grid), beside_(float(values.range().low)) {}

    // All of the grid's slice k. Between two slices it goes along the line from pixel to pixel.
    void fill(int k, std::span<float> out) {
        const double along = grid_.spacing_mm.z() * k;
        while (below_ + 2 < places_.size() && places_[below_ + 1].along_mm <= along) ++below_;
        const double gap = places_[below_ + 1].along_mm - places_[below_].along_mm;
        const double share = std::clamp((along - places_[below_].along_mm) / gap, 0.0, 1.0);
        std::ranges::fill(out, 0.0f);
        const Eigen::Vector2d aside_mm =
            (1 - share) * places_[below_].aside_mm + share * places_[below_ + 1].aside_mm;
        add(below_, 1 - share, aside_mm, out);
        add(below_ + 1, share, aside_mm, out);
    }

  private:
    void add(size_t slice, double weight, const Eigen::Vector2d& aside_mm, std::span<float> out) const {
        if (weight < kSameShare) return;
        const float w = weight > 1 - kSameShare ? 1 : float(weight);
        const Eigen::Vector2d pixel = grid_.spacing_mm.head<2>();
        const Eigen::Array2d first = (grid_.aside_mm - aside_mm).array() / pixel.array();
        const int columns = grid_.dims.x();
        for (int j = 0; j < grid_.dims.y(); ++j)
            for (int i = 0; i < columns; ++i)
                out[size_t(i) + size_t(columns) * size_t(j)] += w * at(slice, first.x() + i, first.y() + j);
    }
    // Between four pixels; beyond the outermost ones there is nothing.
    float at(size_t slice, double x, double y) const {
        constexpr double kEdge = 1e-6;
        if (x < -kEdge || y < -kEdge || x > size_.x() - 1 + kEdge || y > size_.y() - 1 + kEdge)
            return beside_;
        const auto low = [](double v, int count) { return std::clamp(int(v), 0, std::max(count - 2, 0)); };
        const int i = low(x, size_.x()), j = low(y, size_.y());
        const float u = float(std::clamp(x - i, 0.0, 1.0)), v = float(std::clamp(y - j, 0.0, 1.0));
        const int next_i = std::min(i + 1, size_.x() - 1), next_j = std::min(j + 1, size_.y() - 1);
        return (1 - v) * ((1 - u) * pixel(slice, i, j) + u * pixel(slice, next_i, j)) +
               v * ((1 - u) * pixel(slice, i, next_j) + u * pixel(slice, next_i, next_j));
    }
    float pixel(size_t slice, int i, int j) const {
        return values_[size_t(i) + size_t(size_.x()) * (size_t(j) + size_t(size_.y()) * slice)];
    }

    const RawValues& values_;
    const std::vector<SlicePlace>& places_;
    Eigen::Vector2i size_;
    SliceGrid grid_;
    float beside_;
    size_t below_ = 0;  // the slice at or below the one that was filled last
};

}  // namespace

SliceGrid gridAround(const std::vector<SlicePlace>& places, const Eigen::Vector2i& size,
                     const Eigen::Vector2d& pixel_spacing_mm, double slice_spacing_mm) {
    constexpr double kNoVoxel = 1e-3;  // of a voxel: rounding adds none
    Eigen::Array2d low = places.front().aside_mm, high = low;
    for (const SlicePlace& place : places) {
        low = low.min(place.aside_mm.array());
        high = high.max(place.aside_mm.array());
    }
    const Eigen::Array2d more = ((high - low) / pixel_spacing_mm.array() - kNoVoxel).ceil().max(0);
    const double extent = places.back().along_mm - places.front().along_mm;
    SliceGrid grid;
    grid.dims << size + more.cast<int>().matrix(), int(std::ceil(extent / slice_spacing_mm - kNoVoxel)) + 1;
    grid.spacing_mm << pixel_spacing_mm, slice_spacing_mm;
    grid.aside_mm = low;
    return grid;
}

RawValues resampleStack(const RawValues& values, const std::vector<SlicePlace>& places,
                        const Eigen::Vector2i& size, const SliceGrid& grid) {
    StackSampler sampler(values, places, size, grid);
    RawValues out;
    std::vector<float> slice(size_t(grid.dims.x()) * size_t(grid.dims.y()));
    out.reserve(slice.size() * size_t(grid.dims.z()));
    for (int k = 0; k < grid.dims.z(); ++k) {
        sampler.fill(k, slice);
        if (values.range().are_integers)
            for (float& value : slice) value = std::nearbyint(value);
        out.append(std::span<const float>(slice));
    }
    return out;
}

}  // namespace bonemill
