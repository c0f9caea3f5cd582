// Blood, water, burns and bruises lie on the bone around the burr: 0 to 1 per cell of a grid that follows the
// burr. What the grid leaves behind is forgotten.
//
// The grid is a torus: cell (i, j, k) of the volume frame's lattice lies in texel (i, j, k) mod kCells,
// so that moving it copies nothing. The frame is V, the unit m. It is for one thread and allocates only
// in the constructor.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <bitset>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace bonemill {

class SurfaceFilm {
  public:
    static constexpr int kCells = 64;  // per axis
    enum Layer : size_t { kBlood, kWater, kBurn, kBruise, kLayers };

    explicit SurfaceFilm(float cell);

    float cell() const { return cell_; }
    float extent() const { return cell_ * kCells; }
    // These say where the shown part begins and ends; one cell is left at the border, where
    // the torus meets itself.
    Eigen::AlignedBox3f shownBox() const;

    void centreOn(const Eigen::Vector3f& p_V);
    bool holds(const Eigen::Vector3f& p_V) const { return isInside(cellOf(p_V)); }
    float at(Layer layer, const Eigen::Vector3f& p_V) const;
    // Adds to the cells within `radius` (at least the nearest one), less at its rim.
    // Cells stay between 0 and 1.
    void add(Layer layer, const Eigen::Vector3f& p_V, float amount, float radius);
    // Makes the cells within `radius` at least that strong, less at its rim.
    void raise(Layer layer, const Eigen::Vector3f& p_V, float value, float radius);
    void scale(Layer layer, const Eigen::Vector3f& p_V, float factor, float radius);
    void scaleAll(Layer layer, float factor);
    void clear();

    // Returns all layers of each texel of slice z, 0 to 255, x fastest.
    std::span<const uint8_t> slice(int z) const {
        return {texels_.data() + size_t(z) * kSliceBytes, kSliceBytes};
    }
    // The film changes all over in each step; pictures follow when it is due.
    void markDue() { is_due_ = true; }
    bool takeDue() { return std::exchange(is_due_, false); }
    // Returns the slices whose texels changed since the last call, and boxes around the cells (V) that show
    // something else now.
    std::bitset<kCells> takeChangedSlices() { return std::exchange(changed_slices_, {}); }
    std::vector<Eigen::AlignedBox3f> takeChanged();

  private:
    static constexpr size_t kSliceBytes = size_t(kCells) * kCells * kLayers;
    static constexpr int kBlock = 8,
                         kBlocks = kCells / kBlock;  // cells per axis of a block, and blocks of the grid
    static constexpr size_t kTexels = size_t(kCells) * kCells * kCells;

    Eigen::Array3i cellOf(const Eigen::Vector3f& p_V) const;
    Eigen::Vector3f middleOf(const Eigen::Array3i& c) const;
    bool isInside(const Eigen::Array3i& c) const;
    static size_t texelOf(const Eigen::Array3i& c);
    template <class Change>
    void changeAround(const Eigen::Vector3f& p_V, float radius, Change&& change);
    void write(Layer layer, const Eigen::Array3i& c, float value);
    void forgetSlab(int axis, int from, int to);
    void noteLeftBehind(const Eigen::Array3i& next_low);
    void noteChange(const Eigen::Array3i& c);

    float cell_;
    Eigen::Array3i low_ = Eigen::Array3i::Zero();  // first cell of the grid
    bool is_placed_ = false, is_due_ = true;
    std::array<std::vector<float>, kLayers> values_;
    std::array<bool, kLayers> has_any_{};
    std::vector<uint8_t> texels_;
    std::bitset<kCells> changed_slices_;
    std::array<Eigen::AlignedBox3f, kBlocks * kBlocks * kBlocks> changed_;  // by block of the grid
};

}  // namespace bonemill
