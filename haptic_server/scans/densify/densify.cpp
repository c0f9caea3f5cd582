#include "haptic_server/scans/densify/densify.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "common/base/user_error.h"
#include "common/text/printed_text.h"

namespace bonemill {
namespace {

using Bricks = std::vector<uint8_t>;  // yes or no, by BrickId

Bricks bricksWithBone(const VoxelVolume& volume) {
    const BrickStore& bricks = volume.bricks();
    Bricks has_bone(bricks.brickCount());
    for (BrickId id = 0; id < bricks.brickCount(); ++id) {
        if (const auto shared = bricks.sharedDensity(id)) {
            has_bone[id] = *shared >= volume.iso();
            continue;
        }
        const Density* held = bricks.contents(id);
        has_bone[id] =
            std::any_of(held, held + kBrickSize, [&](Density density) { return density >= volume.iso(); });
    }
    return has_bone;
}

// Those that no other brick owns.
IndexBox voxelsOf(const VoxelVolume& volume, const Eigen::Vector3i& brick) {
    const Eigen::Vector3i first = brick.array() * kBrickCells - 1;
    return IndexBox{first, first.array() + (kBrickCells - 1)}.clamped(Eigen::Vector3i::Zero(),
                                                                      volume.dims().array() - 1);
}

// Clears them in every brick that holds them.
void clearVoxels(VoxelVolume& volume, const Eigen::Vector3i& brick) {
    if (volume.bricks().sharedDensity(volume.bricks().brickAt(brick.x(), brick.y(), brick.z())) == 0) return;
    const IndexBox owned = voxelsOf(volume, brick);
    if (owned.isEmpty()) return;
    const Density air[kBrickCells] = {};
    const IndexBox rows{owned.min, {owned.min.x(), owned.max.y(), owned.max.z()}};
    forEachIndex(rows, [&](const Eigen::Vector3i& row) {
        volume.writeRow(row, owned.max.x() - owned.min.x() + 1, air);
    });
}

std::string number(double value) {
    return printed("%g", value);
}

// Of integers all densities there can be are in a table, and ascend.
template <class T>
class DensityOf {
  public:
    explicit DensityOf(const DensityMapping& mapping) : mapping_(mapping) {
        if constexpr (std::is_integral_v<T>) {
            for (int value = kLowest; value <= std::numeric_limits<T>::max(); ++value)
                table_.push_back(mapping.density(value));
            least_bone_ = kLowest + int(std::ranges::lower_bound(table_, mapping.iso) - table_.begin());
        }
    }
    bool isBone(T sample) const noexcept {
        if constexpr (std::is_integral_v<T>)
            return sample >= least_bone_;
        else
            return mapping_.density(double(sample)) >= mapping_.iso;
    }
    Density operator()(T sample) const noexcept {
        if constexpr (std::is_integral_v<T>)
            return table_[size_t(int(sample) - int(kLowest))];
        else
            return mapping_.density(double(sample));
    }

  private:
    static constexpr auto kLowest = std::numeric_limits<T>::lowest();

    const DensityMapping& mapping_;
    std::vector<Density> table_;
    int least_bone_ = 0;
};

// Which bricks hold bone, and which are far from it: neither they nor a neighbour do, nor do they own a voxel
// that is kept.
class BoneBricks {
  public:
    template <class T>
    BoneBricks(const VoxelVolume& volume, std::span<const T> samples, const DensityOf<T>& density,
               const std::function<bool(size_t)>& is_kept)
        : bricks_(volume.bricks()), has_bone_(bricks_.brickCount()), is_far_(bricks_.brickCount()) {
        const Eigen::Vector3i& dims = volume.dims();
        std::vector<uint8_t> is_bone(size_t(dims.x()));
        const T* row = samples.data();
        for (int k = 0; k < dims.z(); ++k)
            for (int j = 0; j < dims.y(); ++j, row += dims.x()) {
                for (size_t i = 0; i < is_bone.size(); ++i) is_bone[i] = density.isBone(row[i]);
                takeRow(is_bone, j, k);
            }
        BrickId id = 0;
        forEachIndex(bricks_.allBricks(), [&](const Eigen::Vector3i& brick) {
            is_far_[id++] = !anyBrickAround(bricks_, brick, [&](BrickId near) {
                return has_bone_[near] != 0;
            }) && !ownsAny(volume, brick, is_kept);
        });
    }

    bool isFar(int x, int y, int z) const { return is_far_[bricks_.brickAt(x, y, z)] != 0; }
    // Nothing that it holds, its neighbours' voxels included, is near bone.
    bool isAir(const Eigen::Vector3i& brick) const {
        return !anyBrickAround(bricks_, brick, [&](BrickId near) { return is_far_[near] == 0; });
    }

  private:
    // The bricks along an axis that hold this voxel, copies included.
    struct Holders {
        int first, last;
    };
    Holders holdersOf(int voxel, int axis) const {
        return {std::max(0, (voxel + 1 - kBrickHigh) >> kBrickShift),
                std::min(bricks_.bricksPerAxis()[axis] - 1, (voxel + 1 + kBrickLow) >> kBrickShift)};
    }
    void takeRow(const std::vector<uint8_t>& is_bone, int j, int k) {
        const Holders ys = holdersOf(j, 1), zs = holdersOf(k, 2);
        for (int x = 0; x < bricks_.bricksPerAxis().x(); ++x) {
            const int low = std::max(0, kBrickCells * x - 1 - kBrickLow);
            const int end = std::min(int(is_bone.size()), kBrickCells * (x + 1) - 1 + kBrickHigh);
            if (low >= end || !std::memchr(&is_bone[size_t(low)], 1, size_t(end - low))) continue;
            for (int z = zs.first; z <= zs.last; ++z)
                for (int y = ys.first; y <= ys.last; ++y) has_bone_[bricks_.brickAt(x, y, z)] = 1;
        }
    }

    BrickStore bricks_;  // how they lie; it has no memory of its own
    std::vector<uint8_t> has_bone_, is_far_;
};

// Voxels that a brick far from bone owns become air, in the copies of its neighbours, too.
void clearFar(const BoneBricks& bricks, const Eigen::Vector3i& first, std::span<Density> out) {
    const int y = (first.y() + 1) >> kBrickShift, z = (first.z() + 1) >> kBrickShift;
    for (size_t begin = 0; begin < out.size();) {
        const int u = first.x() + int(begin) + 1;
        const size_t end = std::min(out.size(), begin + size_t(kBrickCells - (u & (kBrickCells - 1))));
        if (bricks.isFar(u >> kBrickShift, y, z))
            std::ranges::fill(out.subspan(begin, end - begin), Density(0));
        begin = end;
    }
}

// Calls before_reading(k) before it reads values of slice k.
template <class BeforeReading>
VoxelVolume nearBone(const RawVolume& raw, const DensityMapping& mapping,
                     const std::function<bool(size_t)>& is_kept, BeforeReading&& before_reading) {
    VoxelVolume volume(raw.geometry, mapping.iso);
    const size_t row = size_t(volume.dims().x()), slice = row * size_t(volume.dims().y());
    raw.values.visit([&]<class T>(std::span<const T> samples) {
        const DensityOf<T> density(mapping);
        const BoneBricks bricks(volume, samples, density, is_kept);
        volume.fillRows([&](const Eigen::Vector3i& brick) { return bricks.isAir(brick); },
                        [&](const Eigen::Vector3i& first, std::span<Density> out) {
                            before_reading(first.z());
                            const T* from = samples.data() + size_t(first.x()) + row * size_t(first.y()) +
                                            slice * size_t(first.z());
                            for (size_t n = 0; n < out.size(); ++n) out[n] = density(from[n]);
                            clearFar(bricks, first, out);
                        });
    });
    return volume;
}

}  // namespace

bool ownsAny(const VoxelVolume& volume, const Eigen::Vector3i& brick,
             const std::function<bool(size_t)>& is_kept) {
    if (!is_kept) return false;
    const Eigen::Vector3i& dims = volume.dims();
    bool owns = false;
    forEachIndex(voxelsOf(volume, brick), [&](const Eigen::Vector3i& v) {
        owns = owns ||
               is_kept(size_t(v.x()) + size_t(dims.x()) * (size_t(v.y()) + size_t(dims.y()) * size_t(v.z())));
    });
    return owns;
}

void clearFarFromBone(VoxelVolume& volume, const std::function<bool(size_t)>& is_kept) {
    const Bricks has_bone = bricksWithBone(volume);
    forEachIndex(volume.bricks().allBricks(), [&](const Eigen::Vector3i& brick) {
        const bool is_near =
            anyBrickAround(volume.bricks(), brick, [&](BrickId near) { return has_bone[near] != 0; });
        if (!is_near && !ownsAny(volume, brick, is_kept)) clearVoxels(volume, brick);
    });
    volume.shareUniformBricks();
}

Density DensityMapping::density(double raw) const noexcept {
    const double counts = (raw - low) / (high - low) * kMaxDensity;
    if (!(counts > 0)) return 0;  // NaN too
    return counts >= kMaxDensity ? kMaxDensity : Density(std::lround(counts));
}

DensityMapping chooseMapping(const RawVolume& raw, const DensityWindow& window) {
    DensityMapping mapping;
    const ValueRange& range = raw.values.range();
    if (range.low > range.high) throw UserError("the volume holds no finite value (" + raw.description + ")");
    mapping.low = window.low.value_or(range.low);
    mapping.high = window.high.value_or(range.high);
    const std::string window_text = number(mapping.low) + " .. " + number(mapping.high);
    if (!(mapping.low < mapping.high))
        throw UserError("the density window " + window_text +
                        " is empty; window_low must be below window_high");
    const std::optional<double> known = window.iso ? window.iso : raw.surface_value;
    if (!known) mapping.proposed = proposeIso(raw);
    mapping.iso_value = known ? *known : mapping.proposed->value;
    mapping.iso = mapping.density(mapping.iso_value);
    if (mapping.iso == 0 || mapping.iso == kMaxDensity)
        throw UserError(std::string("the ") + (mapping.proposed ? "proposed " : "") + "iso-value " +
                        number(mapping.iso_value) + " is not well inside the density window " + window_text +
                        "; set iso_value, window_low and window_high in the scene");
    return mapping;
}

VoxelVolume densifyNearBone(const RawVolume& raw, const DensityMapping& mapping,
                            const std::function<bool(size_t)>& is_kept) {
    return nearBone(raw, mapping, is_kept, [](int) {});
}

VoxelVolume densifyNearBone(RawVolume&& raw, const DensityMapping& mapping,
                            const std::function<bool(size_t)>& is_kept) {
    const size_t slice = size_t(raw.geometry.dims.x()) * size_t(raw.geometry.dims.y());
    size_t kept = 0;  // first slice that has not been given back
    return nearBone(raw, mapping, is_kept, [&](int k) {
        // Bricks are filled layer by layer, so what lies a brick below is not asked for again.
        for (; kept + kBrickEdge <= size_t(k); ++kept) raw.values.forget(slice * kept, slice * (kept + 1));
    });
}

}  // namespace bonemill
