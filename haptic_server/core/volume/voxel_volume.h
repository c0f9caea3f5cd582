// The bone is the densities of all voxels, shared between the tick (only writer) and the mesher (reader).
//
// Voxel (i, j, k) of frame I lies at V-position spacing ∘ (i, j, k) and W-position X_WV * that
// (docs/reference/frames.md). A border of one voxel of air surrounds the data: indices -1 .. dims are
// readable, 0 .. dims-1 writable, so every surface is closed. Density 0..255 of the thesis is stored as 16
// bit, 257 counts per unit.
//
// Cell (i, j, k) is the cube between voxels (i, j, k) and (i+1, j+1, k+1). The voxels are stored in bricks
// of 16³ cells (brick_store.h): memory goes to what is neither all air nor all of the highest density. Each
// brick has copies of its neighbours' nearest voxels, so that whatever is computed for a cell reads one
// brick only.
#pragma once

#include <algorithm>
#include <optional>
#include <span>

#include "haptic_server/core/volume/brick_store.h"
#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

inline constexpr int kDensityCountsPerUnit = 257;  // 255 units = 65535 counts

class VoxelVolume {
  public:
    // The volume begins as air everywhere. It allocates, so it is not RT-safe. `iso` is the density of the
    // bone surface (counts, > 0).
    VoxelVolume(const VolumeGeometry& geometry, Density iso);

    const VolumeGeometry& geometry() const noexcept { return geometry_; }
    const Eigen::Vector3i& dims() const noexcept { return geometry_.dims; }
    const Eigen::Vector3d& spacing() const noexcept { return geometry_.spacing; }
    Density iso() const noexcept { return iso_; }
    double voxelVolume() const noexcept { return geometry_.spacing.prod(); }  // m³
    const BrickStore& bricks() const noexcept { return bricks_; }

    // A voxel lies here in the memory; any index in -1 .. dims is right. From there, -kBrickLow .. kBrickHigh
    // steps of 1, kStrideY and kStrideZ lead to the neighbours of the cell that starts at the voxel.
    size_t offset(int i, int j, int k) const noexcept { return bricks_.offset(i + 1, j + 1, k + 1); }
    static constexpr size_t kStrideY = kBrickStrideY;
    static constexpr size_t kStrideZ = kBrickStrideZ;

    // RT-safe; any thread may read, only the owner of the volume (the tick) writes. Acquire/release (plain
    // moves on x86) keep each voxel between the odd and the even leaf version around its write: a reader that
    // finds the same even LeafLattice::version before and after its reads saw one consistent node.
    Density at(size_t offset) const noexcept {
        return std::atomic_ref<Density>(const_cast<Density&>(bricks_.data()[offset]))
            .load(std::memory_order_acquire);
    }
    Density at(int i, int j, int k) const noexcept { return at(offset(i, j, k)); }
    // Is the voxel nearest to this place (V, m) bone? There is none outside. For any thread; RT-safe.
    bool isBoneAt(const Eigen::Vector3d& p_V) const noexcept;
    // Returns plain densities by offset, which the compiler can read many at a time. It is for the owner
    // of the volume only (tick thread): no other thread writes, so its reads race with nothing. Other
    // threads use at().
    const Density* ownerData() const noexcept { return bricks_.data(); }
    // Copies `count` voxels along x to `out`, and up to kReadSlack more behind them. Only the owner may call
    // it; it is RT-safe.
    void readRow(const Eigen::Vector3i& first, int count, Density* out) const noexcept;
    static constexpr int kMaxInBrick = kBrickCells + kBrickHigh;  // of a row, from its own first cell on
    static constexpr int kReadSlack = kMaxInBrick - 1;

    // Calls visit(offset, n) for runs that make up this row of voxels, each in one brick: n voxels from
    // `offset` on. It is RT-safe, for any thread.
    template <class Visit>
    void forEachRun(const Eigen::Vector3i& first, int count, Visit&& visit) const noexcept {
        for (int i = first.x(); count > 0;) {
            const int n = stretch(i, i + count - 1, kMaxInBrick);
            visit(offset(i, first.y(), first.z()), n);
            i += n;
            count -= n;
        }
    }
    // Calls visit(part, offset) for parts that make up the box of voxels (in -1 .. dims), each in one brick:
    // its voxels lie at `offset` and the strides from there. It is RT-safe, for any thread.
    template <class Visit>
    void forEachPart(const IndexBox& voxels, Visit&& visit) const noexcept {
        forEachPiece<kMaxInBrick>(voxels, visit);
    }
    // This does the same without copies: each part is what the brick itself owns of the box.
    template <class Visit>
    void forEachOwnedPart(const IndexBox& voxels, Visit&& visit) const noexcept {
        forEachPiece<kBrickCells>(voxels, visit);
    }
    // This is the density of all that is stored around this cell, if its brick has no memory of its own. It
    // is RT-safe, for any thread.
    std::optional<Density> uniformDensity(const Eigen::Vector3i& cell) const noexcept;

    // Writes `count` voxels along x. Only the owner may call it; it is RT-safe. There must be spare bricks
    // for those that it opens: none for voxels that were written before.
    void writeRow(const Eigen::Vector3i& first, int count, const Density* densities) noexcept;
    // Gives memory to all bricks that a change in this box of voxels may need. Only the owner may call it; it
    // is RT-safe. False says that there are not enough spare ones.
    bool openBricksIn(const IndexBox& voxels) noexcept;
    // Makes memory for bricks to be changed that now share theirs. It allocates.
    void makeSpareBricks(size_t count) { bricks_.makeSpare(count); }
    VoxelVolume withoutSpareBricks() const { return {geometry_, iso_, bricks_.withoutSpare()}; }

    // Makes room as it needs: allocates, not RT-safe, no other thread may look.
    void set(int i, int j, int k, Density density);
    // Fills all voxels at once with density(i, j, k), which is asked for some voxels more than once.
    template <class DensityAt>
    void fill(DensityAt&& density) {
        fillRows([](const Eigen::Vector3i&) { return false; },
                 [&](const Eigen::Vector3i& first, std::span<Density> out) {
                     for (size_t n = 0; n < out.size(); ++n)
                         out[n] = density(first.x() + int(n), first.y(), first.z());
                 });
    }
    // Does the same row by row, in layers of bricks from below: fill_row(first, out) writes out.size() voxels
    // along x. A brick for which is_air(brick) stays air, copies of its neighbours' voxels included.
    template <class IsAir, class FillRow>
    void fillRows(IsAir&& is_air, FillRow&& fill_row);
    void shareUniformBricks() { bricks_.shareUniformBricks(); }

    // Returns the density's gradient at this voxel, counts per m, V axes. Any index in -1 .. dims is right.
    // It is RT-safe.
    Eigen::Vector3f gradient(int i, int j, int k) const noexcept;

  private:
    VoxelVolume(const VolumeGeometry& geometry, Density iso, BrickStore bricks);
    // Returns how many voxels from here on are among the first `most` of a brick, from its first cell on.
    static int stretch(int index, int last, int most) noexcept {
        return std::min(most - ((index + 1) & (kBrickCells - 1)), last - index + 1);
    }
    template <int kMax, class Visit>
    void forEachPiece(const IndexBox& voxels, Visit&& visit) const noexcept {
        Eigen::Vector3i low, n;
        for (low.z() = voxels.min.z(); low.z() <= voxels.max.z(); low.z() += n.z()) {
            n.z() = stretch(low.z(), voxels.max.z(), kMax);
            for (low.y() = voxels.min.y(); low.y() <= voxels.max.y(); low.y() += n.y()) {
                n.y() = stretch(low.y(), voxels.max.y(), kMax);
                for (low.x() = voxels.min.x(); low.x() <= voxels.max.x(); low.x() += n.x()) {
                    n.x() = stretch(low.x(), voxels.max.x(), kMax);
                    visit(IndexBox{low, low + n - Eigen::Vector3i::Ones()},
                          offset(low.x(), low.y(), low.z()));
                }
            }
        }
    }
    // Bricks that hold any of these voxels, copies included.
    IndexBox bricksHolding(const IndexBox& voxels) const noexcept;
    // Returns the voxels that a brick holds: indices, border and beyond included.
    static IndexBox voxelsIn(const Eigen::Vector3i& brick) noexcept {
        const Eigen::Vector3i low = brick.array() * kBrickCells - 1 - kBrickLow;
        return {low, low.array() + (kBrickEdge - 1)};
    }
    bool hasOwn(BrickId brick, const Density* densities, int count) noexcept;

    VolumeGeometry geometry_;
    Density iso_;
    Eigen::Vector3f inverse_spacing_;
    BrickStore bricks_;
};

template <class IsAir, class FillRow>
void VoxelVolume::fillRows(IsAir&& is_air, FillRow&& fill_row) {
    constexpr size_t kMoreBricks = 1024;
    bricks_ = BrickStore(geometry_.dims.array() + 2);
    const IndexBox data{Eigen::Vector3i::Zero(), geometry_.dims.array() - 1};
    BrickId next = 0;
    forEachIndex(bricks_.allBricks(), [&](const Eigen::Vector3i& brick) {
        const BrickId id = next++;
        if (is_air(brick)) return;
        if (bricks_.spareCount() == 0) bricks_.makeSpare(kMoreBricks);
        Density* contents = bricks_.nextSpare();
        std::fill_n(contents, kBrickSize, Density(0));
        const Eigen::Vector3i low = voxelsIn(brick).min;
        const IndexBox held = voxelsIn(brick).clamped(data.min, data.max);
        const auto count = size_t(std::max(0, held.max.x() - held.min.x() + 1));
        for (int k = held.min.z(); k <= held.max.z(); ++k)
            for (int j = held.min.y(); j <= held.max.y(); ++j)
                fill_row(Eigen::Vector3i(held.min.x(), j, k),
                         std::span(contents + (held.min.x() - low.x()) + kStrideY * size_t(j - low.y()) +
                                       kStrideZ * size_t(k - low.z()),
                                   count));
        bricks_.adoptNextSpare(id);
    });
    bricks_.dropSpare();
}

}  // namespace bonemill
