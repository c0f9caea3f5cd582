#include "haptic_server/server/replay/bone_beside.h"

#include <algorithm>
#include <utility>

#include "common/rt/clock.h"

namespace bonemill {

void BoneBeside::show(std::shared_ptr<const BoneModel> bone) {
    if (bone == bone_) return;
    rounds_.reset();
    takeAway();
    bone_ = std::move(bone);
    if (bone_) rounds_.emplace(bone_->volume, bone_->lattice, no_cuts_, look_, rim_);
}

bool BoneBeside::round() {
    return rounds_ && rounds_->round([this](NodeGroup&& group) { put(std::move(group)); });
}

// Of each leaf the newer revision wins, whichever bone it is of.
void BoneBeside::put(NodeGroup&& group) {
    for (NodeMesh& mesh : group.meshes) {
        mesh.leaf += first_leaf_;
        mesh.revision += base_;
        newest_ = std::max(newest_, mesh.revision);
        if (mesh.isEmpty())
            leaves_.erase(mesh.leaf);
        else
            leaves_.insert(mesh.leaf);
    }
    for (uint32_t& leaf : group.neighbours) leaf += first_leaf_;
    outbox_.put(std::move(group), monotonicNowNs());
}

void BoneBeside::takeAway() {
    NodeGroup gone;
    for (const uint32_t leaf : leaves_) {
        NodeMesh& none = gone.meshes.emplace_back();
        none.leaf = leaf;
        none.revision = newest_ + 1;
    }
    leaves_.clear();
    base_ = newest_ + 2;
    newest_ = base_;
    outbox_.put(std::move(gone), monotonicNowNs());
}

}  // namespace bonemill
