// It has the node meshes of the client, and the changes that the renderer has not seen yet. It is
// for one thread.
//
// Applies what arrives idempotently, whatever its order: the newest revision counts. What belongs together
// comes out together, so that no crack shows: nodes wait until the newest batch is whole. DDS delivers a
// writer's samples in order, but of each node keeps only the newest; so an older batch may lack nodes that
// were overtaken, and is whole as soon as the newest one is.
#pragma once

#include <chrono>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "common/dds/node_digest.h"
#include "common/mesh_codec/mesh_codec.h"

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
        std::vector<Change> nodes;  // then replace the leaves' meshes, each once
    };

    // Begins another run of a server, whose model is empty; in the run that is shown it does nothing.
    void begin(uint64_t epoch);
    // So many leaves the server's octree has: others than those are invented.
    void setLeafCount(uint32_t count) { leaf_count_ = count; }

    // A node of another run than that begun is ignored. It is false for one that no octree has, or that is
    // beyond kMostNodes or kMaxTriangles.
    bool applyNode(DecodedNode&& node, Clock::time_point now);
    void removeNode(uint32_t leaf);
    // These are many times those of a whole head (534,000 triangles).
    static constexpr size_t kMostNodes = size_t(1) << 16;
    static constexpr size_t kMaxTriangles = 6'000'000;

    // Nodes wait for others of their batch.
    bool isWaiting() const noexcept { return !waiting_.empty(); }

    // Returns what changed since the last call, of each leaf the newest.
    Changes takeChanges(Clock::time_point now);

    uint64_t epoch() const noexcept { return epoch_; }  // 0: nothing arrived yet
    // The digest is of what takeChanges() has given out or is about to.
    const NodeDigest& digest() const noexcept { return digest_; }

  private:
    struct Node {
        uint32_t revision;
        uint64_t content;
        size_t triangles;
    };
    bool hasRoomFor(const NodeMesh& mesh) const;
    bool isNewestWhole() const;
    void release();
    void show(DecodedNode&& node);
    void hide(uint32_t leaf);
    void note(Change&& change);

    uint64_t epoch_ = 0;
    std::unordered_map<uint32_t, Node> nodes_;  // the leaves with a mesh
    size_t triangles_ = 0;                      // of them
    size_t waiting_triangles_ = 0;              // of what waits
    uint32_t leaf_count_ = UINT32_MAX;
    uint64_t batch_ = 0;                // the newest one
    uint32_t batch_nodes_ = 0;          // of it
    std::vector<DecodedNode> waiting_;  // in the order of their arrival; an empty mesh removes its leaf
    Clock::time_point waiting_since_;
    NodeDigest digest_;
    Changes changes_;
    std::unordered_map<uint32_t, size_t> change_of_;  // by leaf, in changes_.nodes
};

}  // namespace bonemill
