// The mesher thread works like this: after each cut it meshes the leaves that it changed, at once; beside
// that, little by little, all others that changed (at first: the whole bone). Measures how long a cut waits
// for its meshes.
//
// It belongs to one normal thread, beside the tick, and is not RT-safe.
#pragma once

#include <chrono>
#include <vector>

#include "common/rt/latency_histogram.h"
#include "common/rt/spsc_ring.h"
#include "haptic_server/core/telemetry/cut.h"
#include "haptic_server/surface/mesh/mesh_outbox.h"
#include "haptic_server/surface/mesh/mesher.h"

namespace bonemill {

class MeshRounds {
  public:
    // All must outlive this object; properties as for LeafMesher. The ring holds the ticks' cuts, each pushed
    // after its voxels were written; a cut that finds it full is meshed all the same, only later.
    MeshRounds(const VoxelVolume& volume, const LeafLattice& lattice, SpscRing<Cut>& cuts,
               const BoneProperties* properties = nullptr);

    using Sink = std::function<void(NodeGroup&&)>;

    // Makes one round; the meshes are as those of Mesher::pass, what changed together in one group. True
    // means that more is waiting: call again at once, else after kPeriod.
    bool round(const Sink& sink);
    static constexpr std::chrono::microseconds kPeriod{500};

    // When nothing writes any more: makes all rounds that are left, at once, until this instant
    // (CLOCK_MONOTONIC) at most. Then the sink has had the bone as it is.
    void finish(const Sink& sink, int64_t until_ns);

    // As Mesher::setPaint(): what it changes comes with the rounds that follow.
    void setPaint(const ZonePaint* paint) { mesher_.setPaint(paint); }

    bool hasMeshedAll() const noexcept { return mesher_.hasMeshedAll(); }

    // The time of each cut goes from the start of its tick until the sink had the meshes of all leaves that
    // were due with it: no less than until the last mesh with the cut in it.
    const LatencyHistogram& cutToSink() const noexcept { return cut_to_sink_; }

  private:
    void takeCuts();
    void closeCuts(const Sink& sink);
    bool passOverOthers(const Sink& sink);

    const LeafLattice& lattice_;
    SpscRing<Cut>& cuts_;
    Mesher mesher_;
    std::vector<int64_t> open_starts_ns_;  // of the cuts that wait for their meshes
    IndexBox open_leaves_;                 // box of all leaves that these cuts changed
    NodeGroup open_group_;                 // their meshes so far
    int64_t next_pass_ns_ = 0;
    LatencyHistogram cut_to_sink_;
};

}  // namespace bonemill
