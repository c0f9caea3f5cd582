#include "render_client/subscribe/scene_model.h"

#include <utility>

namespace bonemill {

bool SceneModel::enterEpoch(uint64_t epoch) {
    if (epoch <= epoch_) return epoch == epoch_;
    if (epoch_ != 0) {
        changes_.is_cleared = true;
        changes_.nodes.clear();
        revisions_.clear();
        digest_ = NodeDigest();
    }
    epoch_ = epoch;
    return true;
}

void SceneModel::applyNode(NodeMesh&& mesh, uint64_t epoch, uint64_t writer) {
    writer_epochs_[writer] = epoch;
    if (!enterEpoch(epoch)) return;
    const auto known = revisions_.find(mesh.leaf);
    if (known != revisions_.end()) {
        if (mesh.revision <= known->second) return;
        digest_.remove(mesh.leaf, known->second);
    }
    digest_.add(mesh.leaf, mesh.revision);
    revisions_[mesh.leaf] = mesh.revision;
    changes_.nodes.push_back(std::move(mesh));
}

void SceneModel::removeNode(uint32_t leaf, uint64_t writer) {
    const auto writer_epoch = writer_epochs_.find(writer);
    if (writer_epoch != writer_epochs_.end() && writer_epoch->second < epoch_) return;
    const auto known = revisions_.find(leaf);
    if (known == revisions_.end()) return;
    digest_.remove(leaf, known->second);
    revisions_.erase(known);
    NodeMesh removal;
    removal.leaf = leaf;
    changes_.nodes.push_back(std::move(removal));
}

SceneModel::Changes SceneModel::takeChanges() {
    return std::exchange(changes_, Changes());
}

}  // namespace bonemill
