#include "haptic_server/mesh/mesh_rounds.h"

#include "common/rt/clock.h"

namespace bonemill {
namespace {

constexpr uint32_t kOthersPerRound = 128;  // while the whole bone is meshed, no cut waits for more than these
constexpr int64_t kPassPeriodNs = 8 * kNsPerMillisecond;

}  // namespace

MeshRounds::MeshRounds(const VoxelVolume& volume, const LeafLattice& lattice, SpscRing<Cut>& cuts)
    : lattice_(lattice), cuts_(cuts), mesher_(volume, lattice) {}

bool MeshRounds::round(const Mesher::Sink& sink) {
    takeCuts();
    const bool is_done = mesher_.catchUp(open_leaves_, sink);
    if (is_done) closeCuts();
    return passOverOthers(sink) || !is_done;
}

// A cut in the ring has been written: the versions read from now on are those after it, or newer.
void MeshRounds::takeCuts() {
    Cut cut;
    while (cuts_.tryPop(cut)) {
        open_starts_ns_.push_back(cut.start_ns);
        open_leaves_.include(lattice_.leavesOfWrite(cut.voxels()));
    }
}

void MeshRounds::closeCuts() {
    if (open_starts_ns_.empty()) return;
    const int64_t now_ns = monotonicNowNs();
    for (const int64_t start_ns : open_starts_ns_) cut_to_sink_.record(now_ns - start_ns);
    open_starts_ns_.clear();
    open_leaves_ = {};
}

bool MeshRounds::passOverOthers(const Mesher::Sink& sink) {
    const int64_t now_ns = monotonicNowNs();
    if (now_ns < next_pass_ns_) return false;
    if (mesher_.pass(sink, kOthersPerRound).read == kOthersPerRound) return true;
    next_pass_ns_ = now_ns + kPassPeriodNs;
    return false;
}

}  // namespace bonemill
