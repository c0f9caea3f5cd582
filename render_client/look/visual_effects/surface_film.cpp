#include "render_client/look/visual_effects/surface_film.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

constexpr int kSlack = 8;               // cells that the centre moves before the grid follows
constexpr float kNothing = 1 / 300.0f;  // below what a texel can say

}  // namespace

SurfaceFilm::SurfaceFilm(float cell) : cell_(cell), texels_(kTexels * kLayers, 0) {
    for (auto& layer : values_) layer.assign(kTexels, 0);
    changed_slices_.set();
}

Eigen::Array3i SurfaceFilm::cellOf(const Eigen::Vector3f& p_V) const {
    constexpr float kFarthest = 1e8f;
    return (p_V.array() / cell_).floor().max(-kFarthest).min(kFarthest).cast<int>();
}

Eigen::Vector3f SurfaceFilm::middleOf(const Eigen::Array3i& c) const {
    return (c.cast<float>() + 0.5f) * cell_;
}

bool SurfaceFilm::isInside(const Eigen::Array3i& c) const {
    return is_placed_ && (c >= low_).all() && (c < low_ + kCells).all();
}

size_t SurfaceFilm::texelOf(const Eigen::Array3i& c) {
    static_assert((kCells & (kCells - 1)) == 0);
    const auto wrapped = [](int i) { return size_t(i & (kCells - 1)); };
    return (wrapped(c.z()) * kCells + wrapped(c.y())) * kCells + wrapped(c.x());
}

Eigen::AlignedBox3f SurfaceFilm::shownBox() const {
    if (!is_placed_) return {};
    const Eigen::Vector3f low = (low_ + 1).cast<float>() * cell_;
    return {low, low + Eigen::Vector3f::Constant(cell_ * (kCells - 2))};
}

void SurfaceFilm::centreOn(const Eigen::Vector3f& p_V) {
    const Eigen::Array3i wanted = cellOf(p_V) - kCells / 2;
    if (is_placed_ && ((wanted - low_).abs() <= kSlack).all()) return;
    if (!is_placed_ || ((wanted - low_).abs() >= kCells).any()) {
        clear();
        low_ = wanted;
        is_placed_ = true;
        return;
    }
    noteLeftBehind(wanted);
    for (int axis = 0; axis < 3; ++axis) {
        const int from = low_[axis], to = wanted[axis];
        to > from ? forgetSlab(axis, from, to) : forgetSlab(axis, to + kCells, from + kCells);
        low_[axis] = to;
    }
}

// What lies at the grid's border, or will, is shown from now on, or no longer.
void SurfaceFilm::noteLeftBehind(const Eigen::Array3i& next_low) {
    const auto isDeepIn = [](const Eigen::Array3i& c, const Eigen::Array3i& low) {
        return (c >= low + 2).all() && (c < low + kCells - 2).all();
    };
    for (int z = 0; z < kCells; ++z)
        for (int y = 0; y < kCells; ++y)
            for (int x = 0; x < kCells; ++x) {
                const Eigen::Array3i c = low_ + Eigen::Array3i(x, y, z);
                const uint8_t* const texel = &texels_[texelOf(c) * kLayers];
                if (std::any_of(texel, texel + kLayers, [](uint8_t byte) { return byte != 0; }) &&
                    !(isDeepIn(c, low_) && isDeepIn(c, next_low)))
                    noteChange(c);
            }
}

// The linear interpolation reaches one cell further.
void SurfaceFilm::noteChange(const Eigen::Array3i& c) {
    const Eigen::Array3i block = (c - low_) / kBlock;
    Eigen::AlignedBox3f& box = changed_[size_t((block.z() * kBlocks + block.y()) * kBlocks + block.x())];
    box.extend((c - 1).cast<float>().matrix() * cell_);
    box.extend((c + 2).cast<float>().matrix() * cell_);
}

std::vector<Eigen::AlignedBox3f> SurfaceFilm::takeChanged() {
    std::vector<Eigen::AlignedBox3f> boxes;
    for (Eigen::AlignedBox3f& box : changed_) {
        if (!box.isEmpty()) boxes.push_back(box);
        box.setEmpty();
    }
    return boxes;
}

void SurfaceFilm::forgetSlab(int axis, int from, int to) {
    Eigen::Array3i first = low_, last = low_ + kCells;
    first[axis] = from;
    last[axis] = to;
    for (int z = first.z(); z < last.z(); ++z)
        for (int y = first.y(); y < last.y(); ++y)
            for (int x = first.x(); x < last.x(); ++x)
                for (size_t layer = 0; layer < kLayers; ++layer) write(Layer(layer), {x, y, z}, 0);
}

float SurfaceFilm::at(Layer layer, const Eigen::Vector3f& p_V) const {
    const Eigen::Array3i c = cellOf(p_V);
    return isInside(c) ? values_[layer][texelOf(c)] : 0;
}

void SurfaceFilm::write(Layer layer, const Eigen::Array3i& c, float value) {
    const size_t texel = texelOf(c);
    if (values_[layer][texel] == value) return;
    values_[layer][texel] = value;
    has_any_[layer] = has_any_[layer] || value > 0;
    const auto byte = uint8_t(std::lround(value * 255));
    uint8_t& shown = texels_[texel * kLayers + layer];
    if (shown == byte) return;
    shown = byte;
    changed_slices_.set(texel / (size_t(kCells) * kCells));
    noteChange(c);
}

template <class Change>
void SurfaceFilm::changeAround(const Eigen::Vector3f& p_V, float radius, Change&& change) {
    const Eigen::Vector3f reach = Eigen::Vector3f::Constant(std::min(radius, extent()));
    const Eigen::Array3i low = cellOf(p_V - reach).max(low_),
                         high = cellOf(p_V + reach).min(low_ + kCells - 1);
    for (int z = low.z(); z <= high.z(); ++z)
        for (int y = low.y(); y <= high.y(); ++y)
            for (int x = low.x(); x <= high.x(); ++x) {
                const Eigen::Array3i c(x, y, z);
                const float off = (middleOf(c) - p_V).norm() / std::max(radius, cell_);
                if (off < 1) change(c, 1 - off * off);
            }
}

void SurfaceFilm::add(Layer layer, const Eigen::Vector3f& p_V, float amount, float radius) {
    if (!is_placed_) return;
    changeAround(p_V, radius, [&](const Eigen::Array3i& c, float weight) {
        write(layer, c, std::clamp(values_[layer][texelOf(c)] + amount * weight, 0.0f, 1.0f));
    });
}

void SurfaceFilm::raise(Layer layer, const Eigen::Vector3f& p_V, float value, float radius) {
    if (!is_placed_) return;
    changeAround(p_V, radius, [&](const Eigen::Array3i& c, float weight) {
        const float least = std::clamp(value, 0.0f, 1.0f) * std::min(1.0f, 2 * weight);
        write(layer, c, std::max(values_[layer][texelOf(c)], least));
    });
}

void SurfaceFilm::scale(Layer layer, const Eigen::Vector3f& p_V, float factor, float radius) {
    if (!is_placed_ || !has_any_[layer]) return;
    changeAround(p_V, radius, [&](const Eigen::Array3i& c, float weight) {
        const float value = values_[layer][texelOf(c)];
        if (value > 0) write(layer, c, value * (1 + (factor - 1) * std::min(1.0f, 2 * weight)));
    });
}

void SurfaceFilm::scaleAll(Layer layer, float factor) {
    if (!has_any_[layer] || factor >= 1) return;
    has_any_[layer] = false;
    const Eigen::Array3i end = low_ + kCells;
    for (int z = low_.z(); z < end.z(); ++z)
        for (int y = low_.y(); y < end.y(); ++y)
            for (int x = low_.x(); x < end.x(); ++x) {
                const Eigen::Array3i c(x, y, z);
                const float value = values_[layer][texelOf(c)];
                if (value > 0) write(layer, c, value * factor > kNothing ? value * factor : 0);
            }
}

void SurfaceFilm::clear() {
    if (is_placed_) changed_[0].extend(shownBox());
    changed_slices_.set();
    has_any_ = {};
    for (auto& layer : values_) std::ranges::fill(layer, 0.0f);
    std::ranges::fill(texels_, uint8_t(0));
}

}  // namespace bonemill
