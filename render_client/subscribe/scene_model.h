// Which node meshes the client has, and the changes that the renderer has not seen yet. One thread.
//
// Applies what arrives idempotently, whatever its order: the newest epoch counts, and in it the newest
// revision.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "common/dds/node_digest.h"
#include "common/geometry/node_mesh.h"

namespace bonemill {

class SceneModel {
  public:
    struct Changes {
        bool is_cleared = false;  // first forget every node: another server run began
        std::vector<NodeMesh>
            nodes;  // then, in this order: replace the leaf's mesh; an empty mesh removes it
    };

    // To be told the epoch of everything that arrives. False: it comes from an older run and must be ignored.
    bool enterEpoch(uint64_t epoch);

    // `writer` identifies who sent it (dds::SampleInfo::writer).
    void applyNode(NodeMesh&& mesh, uint64_t epoch, uint64_t writer);
    // A removal does not name its epoch: that of its writer's meshes counts, when some are known.
    void removeNode(uint32_t leaf, uint64_t writer);

    // What changed since the last call.
    Changes takeChanges();

    uint64_t epoch() const noexcept { return epoch_; }  // 0: nothing arrived yet
    const NodeDigest& digest() const noexcept { return digest_; }

  private:
    uint64_t epoch_ = 0;
    std::unordered_map<uint32_t, uint32_t> revisions_;  // of the leaves with a mesh
    std::unordered_map<uint64_t, uint64_t> writer_epochs_;
    NodeDigest digest_;
    Changes changes_;
};

}  // namespace bonemill
