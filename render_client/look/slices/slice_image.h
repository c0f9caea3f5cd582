// Reads the densities of a plane through the scan, trilinear between voxels, and gives them colours.
//
// It is for the thread of the store. No picture depends on the one before.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render_client/link/density_store/density_store.h"
#include "render_client/look/camera/view_settings.h"
#include "render_client/look/slices/slice_plane.h"

namespace bonemill {

// Window and level turn the scan's values into grey, by functions that are pure, for any thread.

// Returns what the scan measured (HU where it is CT) for a density, and back; the density is not rounded and
// may lie beyond its range.
double valueOf(const DensityGrid& grid, double density);
double densityOf(const DensityGrid& grid, double value);

// Returns 0 (black) to 1 (white).
double greyOf(const GreyWindow& window, double value);
// Returns the grey of every density, 0 to 255.
std::vector<uint8_t> greyTable(const DensityGrid& grid, const GreyWindow& window);

// Returns factor and summand that make grey, 0 to 1 where it is not beyond, of a density that goes from 0
// to 1.
Eigen::Vector2d greyOfDensity(const DensityGrid& grid, const GreyWindow& window);

// Returns the window that shows bone in the upper two thirds of grey and what is softer below, as far as the
// scan's range goes.
GreyWindow startWindow(const DensityGrid& grid);

// Returns the window after a drag by these parts of the pane's size: to the right is wider, down is a higher
// level, which is darker. Neither leaves the scan's range by more than its width.
GreyWindow draggedWindow(const GreyWindow& window, const DensityGrid& grid, double right, double down);

// Returns how radiologists write it: "W 2000 L 800".
std::string textOf(const GreyWindow& window);

enum class SliceState : uint8_t { kOutside, kLoading, kHere };  // outside of the scan; not arrived yet

struct SliceImage {
    int width = 0, height = 0;
    std::vector<uint16_t> scanned, present;  // 0 where the state is not kHere
    std::vector<SliceState> state;
    // Red, green, blue (linear) and 65535 per pixel, all 0 where the state is not kHere; empty where nobody
    // asked for them.
    std::vector<uint16_t> colours;
    bool operator==(const SliceImage&) const = default;
};

// Linear red, green and blue, 0 to 1, of bone by its material (DensityBrick::materials).
using BoneColours = std::array<Eigen::Vector3f, 256>;

struct SampledDensity {
    SliceState state = SliceState::kOutside;
    uint16_t scanned = 0, present = 0;
    bool was_changed = false;  // a voxel around the place is not as scanned
};

// Its store must not change while it lives.
class DensitySampler {
  public:
    // The store must have a grid.
    explicit DensitySampler(const DensityStore& store);

    SampledDensity at(const Eigen::Vector3d& p_V) const { return atVoxel(voxelAt(p_V)); }
    // With `colours` it has those of the materials, which fade into each other between voxels; where voxels
    // differ in density the denser one counts for more, since a voxel that bone fills only partly looks like
    // something less dense.
    SliceImage image(const SlicePlane& plane, const BoneColours* colours = nullptr) const;

  private:
    struct Corner {
        uint32_t brick;
        size_t index;  // in the brick
        double weight;
    };
    struct AxisPlace {
        uint32_t brick = 0;  // what the axis adds to the number
        uint32_t index = 0;  // what it adds to the index in the brick
    };
    Eigen::Vector3d voxelAt(const Eigen::Vector3d& p_V) const {
        return (p_V - grid_.origin_m).cwiseQuotient(grid_.spacing_m);
    }
    SampledDensity atVoxel(const Eigen::Vector3d& voxel) const;
    Eigen::Vector3f colourAtVoxel(const Eigen::Vector3d& voxel, const BoneColours& colours) const;
    int cornersAround(const Eigen::Vector3d& voxel, std::array<Corner, 8>& corners) const;
    const DensityBrick* brick(uint32_t number) const;

    const DensityStore& store_;
    const DensityGrid& grid_;
    std::array<std::vector<AxisPlace>, 3> places_;  // of each voxel of an axis
    mutable std::vector<const DensityBrick*> bricks_;
    mutable std::vector<bool> is_known_;  // whether bricks_ was filled there
};

// Returns red, green, blue and opacity per pixel, row by row: grey values of the scan; a tint where
// milling took bone away and another one where material was added; plain tints outside and where nothing has
// arrived yet.
std::vector<uint8_t> coloursOf(const SliceImage& image, const DensityGrid& grid, const GreyWindow& window);

using Rgb = std::array<uint8_t, 3>;
inline constexpr Rgb kSliceOutside{0, 0, 0}, kSliceLoading{44, 56, 84};
// A tinted pixel has this part of its own grey, and the rest of the tint.
inline constexpr double kSliceTintGrey = 0.55;
inline constexpr Rgb kMilledTint{255, 70, 40}, kAddedTint{60, 160, 255};

}  // namespace bonemill
