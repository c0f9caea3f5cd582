#include "haptic_server/surface/mesh/mesher.h"

#include <utility>

namespace bonemill {
namespace {

// They are odd: no version at rest equals them.
constexpr uint32_t kNeverMeshed = 1, kPaintedAnew = 3;

// Once the tick has written, there is its whole period before it writes again: mostly the second
// try succeeds.
constexpr int kTries = 4;

bool isBeingWritten(uint32_t version) noexcept {
    return (version & 1) != 0;
}

}  // namespace

Mesher::Mesher(const VoxelVolume& volume, const LeafLattice& lattice, int most_steps_per_cell,
               const BoneProperties* properties)
    : lattice_(lattice),
      leaf_mesher_(volume, lattice, most_steps_per_cell, properties),
      meshed_version_(lattice.leafCount(), kNeverMeshed),
      has_mesh_(lattice.leafCount(), false) {}

Mesher::PassResult Mesher::pass(const Sink& sink, uint32_t max_leaves) {
    PassResult result;
    const uint32_t count = lattice_.leafCount();
    const LeafId start = next_leaf_;
    for (uint32_t n = 0; n < count; ++n) {
        const LeafId leaf = (start + n) % count;
        const uint32_t version = lattice_.version(leaf);
        const bool is_due = isBeingWritten(version) || version != meshed_version_[leaf];
        if (!is_due) continue;
        if (isBeingWritten(version) || result.read == max_leaves) {
            ++result.pending;
            continue;
        }
        ++result.read;
        next_leaf_ = (leaf + 1) % count;
        if (!tryMesh(leaf, sink)) ++result.pending;
    }
    return result;
}

bool Mesher::catchUp(const IndexBox& leaves, const Sink& sink) {
    bool is_done = true;
    forEachIndex(leaves,
                 [&](const Eigen::Vector3i& leaf) { is_done &= catchUp(lattice_.leafId(leaf), sink); });
    return is_done;
}

bool Mesher::catchUp(LeafId leaf, const Sink& sink) {
    for (int tries = 0; tries < kTries; ++tries) {
        const uint32_t version = lattice_.version(leaf);
        if (isBeingWritten(version)) continue;
        if (version == meshed_version_[leaf] || tryMesh(leaf, sink)) return true;
    }
    return false;
}

void Mesher::setPaint(const ZonePaint* paint) {
    if (paint == paint_) return;
    ++repaints_;
    leaf_mesher_.setPaint(paint);
    const auto changes = [](const ZonePaint* painted, const IndexBox& voxels) {
        return painted != nullptr && painted->mayPaint(voxels);
    };
    for (LeafId leaf = 0; leaf < lattice_.leafCount(); ++leaf) {
        if (meshed_version_[leaf] == kNeverMeshed || !has_mesh_[leaf]) continue;
        const IndexBox cells = lattice_.cellsOf(leaf);
        const IndexBox voxels{cells.min, cells.max.array() + 1};
        if (changes(paint, voxels) || changes(paint_, voxels)) meshed_version_[leaf] = kPaintedAnew;
    }
    paint_ = paint;
}

// False means that a write got in between: the leaf stays due.
bool Mesher::tryMesh(LeafId leaf, const Sink& sink) {
    std::optional<NodeMesh> mesh = leaf_mesher_.mesh(leaf);
    if (!mesh) return false;
    if (meshed_version_[leaf] == kNeverMeshed) ++meshed_leaves_;
    meshed_version_[leaf] = mesh->revision;
    mesh->revision += 2 * repaints_;
    const bool had_mesh = has_mesh_[leaf];
    has_mesh_[leaf] = !mesh->isEmpty();
    if (had_mesh || !mesh->isEmpty()) sink(std::move(*mesh));
    return true;
}

}  // namespace bonemill
