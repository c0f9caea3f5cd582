// Keeps the node meshes up with the voxels, and what the mesher thread does with them.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "common/rt/latency_histogram.h"
#include "common/rt/spsc_ring.h"
#include "haptic_server/core/telemetry/cut.h"
#include "haptic_server/surface/mesh/leaf_mesher.h"
#include "haptic_server/surface/mesh/mesh_outbox.h"

namespace bonemill {

// Keeps the node meshes up with the voxels: finds the leaves that changed, meshes them, hands the results on.
//
// Runs in its own normal thread beside the tick, which writes voxels between LeafLattice::beginWrite and
// endWrite. Takes no lock: a leaf is read between two reads of its version, and read again in a later pass if
// the version was odd or moved. It is not RT-safe, and one thread calls all members.
class Mesher {
  public:
    // All must outlive the mesher. most_steps_per_cell as for MeshGrid, the rim as for LeafMesher.
    Mesher(const VoxelVolume& volume, const LeafLattice& lattice,
           int most_steps_per_cell = MeshGrid::kMaxStepsPerCell, const VertexLook& look = {},
           const RegionRim* rim = nullptr);

    using Sink = std::function<void(NodeMesh&&)>;
    static constexpr uint32_t kAllLeaves = std::numeric_limits<uint32_t>::max();

    struct PassResult {
        uint32_t read = 0;     // leaves whose voxels were read
        uint32_t pending = 0;  // leaves still to be read: beyond the budget, or being written
    };

    // Meshes the leaves whose voxels changed since they were last meshed (at first: all), at most max_leaves
    // of them; goes on from there in the next pass. The sink gets each mesh that changed; a leaf that lost
    // its surface once comes as an empty mesh, one that never had any does not come. Exceptions of the sink
    // pass through; that leaf counts as meshed.
    PassResult pass(const Sink& sink, uint32_t max_leaves = kAllLeaves);

    // Meshes those of these leaves (lattice indices) that changed since they were last meshed. False: the
    // tick wrote them meanwhile and some are still due.
    bool catchUp(const IndexBox& leaves, const Sink& sink);

    // Vertices show this from now on; null: none. It must outlive the mesher, or the next call. Leaves that
    // it may change are due again, with a newer revision, and so are those whose paint changes later. It
    // looks at every voxel.
    void setPaint(const VertexPaint* paint);

    // Every leaf has been meshed at least once: the sink has seen the whole bone.
    bool hasMeshedAll() const noexcept { return meshed_leaves_ == meshed_version_.size(); }

  private:
    bool catchUp(LeafId leaf, const Sink& sink);
    bool tryMesh(LeafId leaf, const Sink& sink);
    void lookAtPaint();

    const LeafLattice& lattice_;
    LeafMesher leaf_mesher_;
    std::vector<uint32_t> meshed_version_;
    size_t meshed_leaves_ = 0;    // leaves meshed at least once
    std::vector<bool> has_mesh_;  // what the sink was told last
    const VertexPaint* paint_ = nullptr;
    std::vector<uint32_t> painted_version_;  // of the paint, as looked at last
    uint32_t repaints_ = 0;                  // each one makes revisions newer
    LeafId next_leaf_ = 0;  // where the next pass starts, so that busy leaves do not starve the others
};

// The mesher thread works like this: after each cut it meshes the leaves that it changed, at once; beside
// that, little by little, all others that changed (at first: the whole bone). Measures how long a cut waits
// for its meshes.
//
// It belongs to one normal thread, beside the tick, and is not RT-safe.
class MeshRounds {
  public:
    // All must outlive this object. The ring holds the ticks' cuts, each pushed
    // after its voxels were written; a cut that finds it full is meshed all the same, only later.
    MeshRounds(const VoxelVolume& volume, const LeafLattice& lattice, SpscRing<Cut>& cuts,
               const VertexLook& look = {}, const RegionRim* rim = nullptr);

    using Sink = std::function<void(NodeGroup&&)>;

    // Makes one round; the meshes are as those of Mesher::pass, what changed together in one group. True
    // means that more is waiting: call again at once, else after kPeriod.
    bool round(const Sink& sink);
    static constexpr std::chrono::microseconds kPeriod{500};

    // When nothing writes any more: makes all rounds that are left, at once, until this instant
    // (CLOCK_MONOTONIC) at most. Then the sink has had the bone as it is.
    void finish(const Sink& sink, int64_t until_ns);

    // As Mesher::setPaint(): what it changes comes with the rounds that follow.
    void setPaint(const VertexPaint* paint) { mesher_.setPaint(paint); }

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
