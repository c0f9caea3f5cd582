#include "haptic_server/surface/mesh/mesher.h"

#include <algorithm>
#include <utility>

#include "common/rt/clock.h"

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
               const VertexLook& look, const RegionRim* rim)
    : lattice_(lattice),
      leaf_mesher_(volume, lattice, most_steps_per_cell, look, rim),
      meshed_version_(lattice.leafCount(), kNeverMeshed),
      has_mesh_(lattice.leafCount(), false),
      painted_version_(lattice.leafCount(), 0) {}

Mesher::PassResult Mesher::pass(const Sink& sink, uint32_t max_leaves) {
    lookAtPaint();
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

void Mesher::setPaint(const VertexPaint* paint) {
    if (paint == paint_) return;
    ++repaints_;
    leaf_mesher_.setPaint(paint);
    const auto changes = [](const VertexPaint* painted, const IndexBox& voxels) {
        return painted != nullptr && painted->mayPaint(voxels);
    };
    for (LeafId leaf = 0; leaf < lattice_.leafCount(); ++leaf) {
        const bool is_behind = paint_ && paint_->version(leaf) != painted_version_[leaf];
        // An odd one is no version at rest: what is written meanwhile is looked at once more.
        painted_version_[leaf] = paint ? paint->version(leaf) : 0;
        if (meshed_version_[leaf] == kNeverMeshed || !has_mesh_[leaf]) continue;
        const IndexBox cells = lattice_.cellsOf(leaf);
        const IndexBox voxels{cells.min, cells.max.array() + 1};
        if (is_behind || changes(paint, voxels) || changes(paint_, voxels))
            meshed_version_[leaf] = kPaintedAnew;
    }
    paint_ = paint;
}

// A leaf that is meshed while its paint is written gets a newer version of it, and is due again.
void Mesher::lookAtPaint() {
    if (!paint_) return;
    bool is_any_due = false;
    for (LeafId leaf = 0; leaf < lattice_.leafCount(); ++leaf) {
        const uint32_t version = paint_->version(leaf);
        if (isBeingWritten(version) || version == painted_version_[leaf]) continue;
        painted_version_[leaf] = version;
        if (meshed_version_[leaf] == kNeverMeshed || !has_mesh_[leaf]) continue;
        meshed_version_[leaf] = kPaintedAnew;
        is_any_due = true;
    }
    if (is_any_due) ++repaints_;
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

namespace {

constexpr uint32_t kOthersPerRound = 128;  // while the whole bone is meshed, no cut waits for more than these
constexpr int64_t kMaxNeighbours = 512;    // leaves; a cut's box has some 27
constexpr int64_t kPassPeriodNs = 8 * kNsPerMillisecond;

}  // namespace

MeshRounds::MeshRounds(const VoxelVolume& volume, const LeafLattice& lattice, SpscRing<Cut>& cuts,
                       const VertexLook& look, const RegionRim* rim)
    : lattice_(lattice), cuts_(cuts), mesher_(volume, lattice, MeshGrid::kStreamedStepsPerCell, look, rim) {}

bool MeshRounds::round(const Sink& sink) {
    takeCuts();
    const bool is_done = mesher_.catchUp(
        open_leaves_, [this](NodeMesh&& mesh) { open_group_.meshes.push_back(std::move(mesh)); });
    if (is_done) closeCuts(sink);
    return passOverOthers(sink) || !is_done;
}

void MeshRounds::finish(const Sink& sink, int64_t until_ns) {
    next_pass_ns_ = 0;
    while (round(sink) && monotonicNowNs() < until_ns) {
    }
}

// A cut in the ring has been written: the versions read from now on are those after it, or newer.
void MeshRounds::takeCuts() {
    Cut cut;
    while (cuts_.tryPop(cut)) {
        open_starts_ns_.push_back(cut.start_ns);
        open_leaves_.include(lattice_.leavesOfWrite(cut.voxels()));
    }
}

void MeshRounds::closeCuts(const Sink& sink) {
    if (open_starts_ns_.empty()) return;
    open_group_.oldest_cut_ns = *std::min_element(open_starts_ns_.begin(), open_starts_ns_.end());
    if (open_leaves_.count() <= kMaxNeighbours)
        forEachIndex(open_leaves_, [this](const Eigen::Vector3i& leaf) {
            open_group_.neighbours.push_back(lattice_.leafId(leaf));
        });
    sink(std::exchange(open_group_, {}));
    const int64_t now_ns = monotonicNowNs();
    for (const int64_t start_ns : open_starts_ns_) cut_to_sink_.record(now_ns - start_ns);
    open_starts_ns_.clear();
    open_leaves_ = {};
}

// At first every leaf goes on its own, so that the model grows; later what one pass finds changed
// goes together.
bool MeshRounds::passOverOthers(const Sink& sink) {
    const int64_t now_ns = monotonicNowNs();
    if (now_ns < next_pass_ns_) return false;
    const bool is_first_time = !mesher_.hasMeshedAll();
    NodeGroup group;
    const auto collect = [&](NodeMesh&& mesh) {
        group.meshes.push_back(std::move(mesh));
        if (is_first_time) sink(std::exchange(group, {}));
    };
    const bool is_more = mesher_.pass(collect, kOthersPerRound).read == kOthersPerRound;
    if (!group.meshes.empty()) sink(std::move(group));
    if (is_more) return true;
    next_pass_ns_ = now_ns + kPassPeriodNs;
    return false;
}

}  // namespace bonemill
