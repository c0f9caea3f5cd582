// Shows the other attempt's bone beside that of a replay: its nodes are numbered behind those of the first,
// and come and go with the wish to see it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <stop_token>

#include "common/rt/spsc_ring.h"
#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/surface/mesh/mesh_outbox.h"
#include "haptic_server/surface/mesh/mesher.h"

namespace bonemill {

// It belongs to one normal thread, which is no other's mesher: what a bone of many leaves takes at first is
// not to keep the other waiting.
class BoneBeside {
  public:
    // All must outlive this object; the look is that of the first bone's vertices, and no other thread's.
    BoneBeside(uint32_t first_leaf, const VertexLook& look, const RegionRim* rim, MeshOutbox& outbox)
        : first_leaf_(first_leaf), look_(look), rim_(rim), outbox_(outbox) {}

    // From now on this bone is shown; null: none. What was shown of another one goes.
    void show(std::shared_ptr<const BoneModel> bone);
    // Puts what has changed since, in part; true: there is more at once.
    bool round();

  private:
    void put(NodeGroup&& group);
    void takeAway();

    const uint32_t first_leaf_;
    const VertexLook look_;
    const RegionRim* const rim_;
    MeshOutbox& outbox_;
    SpscRing<Cut> no_cuts_{1};  // a pass finds what has changed
    std::shared_ptr<const BoneModel> bone_;
    std::optional<MeshRounds> rounds_;
    std::set<uint32_t> leaves_;       // that have a mesh
    uint32_t newest_ = 0, base_ = 0;  // revisions: of all that was put, and what those of this bone begin at
};

}  // namespace bonemill
