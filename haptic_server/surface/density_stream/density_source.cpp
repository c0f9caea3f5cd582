#include "haptic_server/surface/density_stream/density_source.h"

#include <algorithm>

namespace bonemill {
namespace {

constexpr int kTries = 4;  // a copy takes some 10 µs, a tick writes for a part of its 1000 µs
constexpr size_t kVoxelsPerBrick =
    size_t(DensitySource::kBrickVoxels) * DensitySource::kBrickVoxels * DensitySource::kBrickVoxels;

// Calls visit(first voxel, place in the brick) for each row along x.
template <class Visit>
void forEachRowOf(const IndexBox& voxels, Visit&& visit) {
    forEachRow(voxels, [&](const Eigen::Vector3i& first) {
        visit(first, placeIn(Eigen::Vector3i::Constant(DensitySource::kBrickVoxels), first - voxels.min));
    });
}

}  // namespace

IndexBox DensitySource::voxelsOf(uint32_t brick) const {
    const int b = int(brick);
    const Eigen::Vector3i at(b % bricks_.x(), b / bricks_.x() % bricks_.y(), b / bricks_.x() / bricks_.y());
    const Eigen::Vector3i first = at * kBrickVoxels;
    return {first, (first.array() + (kBrickVoxels - 1)).min(scanned_.dims().array() - 1)};
}

std::vector<Density> DensitySource::scanned(uint32_t brick) const {
    std::vector<Density> densities(kVoxelsPerBrick);
    const IndexBox voxels = voxelsOf(brick);
    const int count = voxels.max.x() - voxels.min.x() + 1;
    std::vector<Density> row(size_t(count) + VoxelVolume::kReadSlack);
    forEachRowOf(voxels, [&](const Eigen::Vector3i& first, size_t place) {
        scanned_.readRow(first, count, row.data());
        std::copy_n(row.begin(), count, densities.begin() + ptrdiff_t(place));
    });
    return densities;
}

std::vector<MaterialId> DensitySource::materials(uint32_t brick) const {
    if (!properties_) return {};
    std::vector<MaterialId> materials(kVoxelsPerBrick, kNoMaterial);
    const IndexBox voxels = voxelsOf(brick);
    forEachIndex(voxels, [&](const Eigen::Vector3i& v) {
        materials[placeIn(Eigen::Vector3i::Constant(kBrickVoxels), v - voxels.min)] =
            properties_->material(v);
    });
    return materials;
}

bool DensitySource::isAir(uint32_t brick) const {
    bool is_air = true;
    scanned_.forEachPart(voxelsOf(brick), [&](const IndexBox& part, size_t offset) {
        if (!is_air) return;
        if (const auto uniform = scanned_.uniformDensity(part.min)) {
            is_air = *uniform == 0;
            return;
        }
        const Eigen::Vector3i size = part.max - part.min + Eigen::Vector3i::Ones();
        const Density* const data = scanned_.ownerData() + offset;
        for (int k = 0; k < size.z() && is_air; ++k)
            for (int j = 0; j < size.y() && is_air; ++j) {
                const Density* const row =
                    data + size_t(j) * VoxelVolume::kStrideY + size_t(k) * VoxelVolume::kStrideZ;
                is_air = std::all_of(row, row + size.x(), [](Density density) { return density == 0; });
            }
    });
    return is_air;
}

std::string DensitySource::airBits() const {
    std::string bits((brickCount() + 7) / 8, '\0');
    for (uint32_t brick = 0; brick < brickCount(); ++brick)
        if (isAir(brick)) bits[brick / 8] = char(uint8_t(bits[brick / 8]) | 1u << brick % 8);
    return bits;
}

// A write to a voxel counts up the leaf that owns the cell of its number, among others.
std::optional<uint32_t> DensitySource::revision(uint32_t brick) const {
    uint32_t sum = 0;
    bool is_written = false;
    forEachIndex(bone_.lattice.leavesOfCells(voxelsOf(brick)), [&](const Eigen::Vector3i& leaf) {
        const uint32_t version = bone_.lattice.version(bone_.lattice.leafId(leaf));
        is_written |= version % 2 == 1;
        sum += version;
    });
    if (is_written) return {};
    return sum;
}

std::vector<Density> DensitySource::presentNow(uint32_t brick) const {
    std::vector<Density> densities(kVoxelsPerBrick);
    const IndexBox voxels = voxelsOf(brick);
    forEachRowOf(voxels, [&](const Eigen::Vector3i& first, size_t place) {
        Density* out = densities.data() + place;
        bone_.volume.forEachRun(first, voxels.max.x() - voxels.min.x() + 1, [&](size_t offset, int n) {
            for (int i = 0; i < n; ++i) *out++ = bone_.volume.at(offset + size_t(i));
        });
    });
    return densities;
}

std::optional<DensitySource::Present> DensitySource::present(uint32_t brick) const {
    for (int i = 0; i < kTries; ++i) {
        const std::optional<uint32_t> before = revision(brick);
        if (!before) continue;
        Present present{*before, presentNow(brick)};
        // The voxels were read with acquire, so these versions cannot be older than they are. Each only
        // grows: the same sum is the same versions.
        if (revision(brick) == before) return present;
    }
    return {};
}

}  // namespace bonemill
