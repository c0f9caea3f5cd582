// It has the node meshes of the client, and the changes that the renderer has not seen yet. It is
// for one thread.
//
// Applies what arrives idempotently, whatever its order: the newest epoch counts, and in it the newest
// revision. What belongs together comes out together, so that no crack shows: nodes wait until the newest
// batch is whole. DDS delivers a writer's samples in order, but of each node keeps only the newest; so an
// older batch may lack nodes that were overtaken, and is whole as soon as the newest one is.
#pragma once

#include <chrono>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "common/dds/node_digest.h"
#include "common/mesh/mesh_codec.h"

namespace bonemill {

class SceneModel {
  public:
    using Clock = std::chrono::steady_clock;
    // What has waited for longer comes out all the same.
    static constexpr std::chrono::milliseconds kLongestWait{50};

    struct Change {
        NodeMesh mesh;             // empty: removes the leaf
        int64_t cut_stamp_ns = 0;  // NodeTag
    };
    struct Changes {
        bool is_cleared = false;    // first forget every node: another server run began
        std::vector<Change> nodes;  // then, in this order: replace the leaf's mesh
    };

    // It is told the epoch of everything that arrives. Returns false when it comes from an older run and
    // must be ignored.
    bool enterEpoch(uint64_t epoch);

    // `writer` identifies who sent it (dds::SampleInfo::writer).
    void applyNode(DecodedNode&& node, uint64_t writer, Clock::time_point now);
    // A removal does not name its epoch: that of its writer's meshes counts, when some are known.
    void removeNode(uint32_t leaf, uint64_t writer);

    // Returns what changed since the last call.
    Changes takeChanges(Clock::time_point now);

    uint64_t epoch() const noexcept { return epoch_; }  // 0: nothing arrived yet
    // The digest is of what takeChanges() has given out or is about to.
    const NodeDigest& digest() const noexcept { return digest_; }

  private:
    struct Node {
        uint32_t revision;
        uint64_t content;
    };
    bool isNewestWhole() const;
    void release();
    void show(DecodedNode&& node);
    void hide(uint32_t leaf);

    uint64_t epoch_ = 0;
    std::unordered_map<uint32_t, Node> nodes_;  // the leaves with a mesh
    std::unordered_map<uint64_t, uint64_t> writer_epochs_;
    uint64_t batch_ = 0;                // the newest one
    uint32_t batch_nodes_ = 0;          // of it
    std::vector<DecodedNode> waiting_;  // in the order of their arrival; an empty mesh removes its leaf
    Clock::time_point waiting_since_;
    NodeDigest digest_;
    Changes changes_;
};

}  // namespace bonemill
