#include "haptic_server/surface/mesh/mesh_rounds.h"

#include <algorithm>
#include <utility>

#include "common/rt/clock.h"

namespace bonemill {
namespace {

constexpr uint32_t kOthersPerRound = 128;  // while the whole bone is meshed, no cut waits for more than these
constexpr int64_t kMaxNeighbours = 512;    // leaves; a cut's box has some 27
constexpr int64_t kPassPeriodNs = 8 * kNsPerMillisecond;

}  // namespace

MeshRounds::MeshRounds(const VoxelVolume& volume, const LeafLattice& lattice, SpscRing<Cut>& cuts,
                       const BoneProperties* properties)
    : lattice_(lattice), cuts_(cuts), mesher_(volume, lattice, MeshGrid::kStreamedStepsPerCell, properties) {}

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
