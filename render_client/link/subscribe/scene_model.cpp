#include "render_client/link/subscribe/scene_model.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace bonemill {

void SceneModel::begin(uint64_t epoch) {
    if (epoch == epoch_) return;
    if (epoch_ != 0) {
        changes_.is_cleared = true;
        changes_.nodes.clear();
        change_of_.clear();
        nodes_.clear();
        waiting_.clear();
        triangles_ = waiting_triangles_ = 0;
        digest_ = NodeDigest();
    }
    epoch_ = epoch;
    leaf_count_ = std::numeric_limits<uint32_t>::max();
    batch_ = 0;
    batch_nodes_ = 0;
}

bool SceneModel::hasRoomFor(const NodeMesh& mesh) const {
    const auto known = nodes_.find(mesh.leaf);
    const bool is_new = known == nodes_.end();
    const size_t others = triangles_ + waiting_triangles_ - (is_new ? 0 : known->second.triangles);
    return mesh.leaf < leaf_count_ && others + mesh.indices.size() / 3 <= kMaxTriangles &&
           (!is_new || nodes_.size() + waiting_.size() < kMostNodes);
}

bool SceneModel::applyNode(DecodedNode&& node, Clock::time_point now) {
    if (node.tag.epoch != epoch_) return true;
    if (!hasRoomFor(node.mesh)) return false;
    if (node.tag.batch > batch_) {
        batch_ = node.tag.batch;
        batch_nodes_ = node.tag.batch_nodes;
    } else if (node.tag.batch < batch_ && waiting_.empty()) {
        show(std::move(node));  // sent again after an interruption
        return true;
    }
    if (waiting_.empty()) waiting_since_ = now;
    waiting_triangles_ += node.mesh.indices.size() / 3;
    waiting_.push_back(std::move(node));
    if (isNewestWhole()) release();
    return true;
}

bool SceneModel::isNewestWhole() const {
    const auto is_newest = [this](const DecodedNode& node) {
        return node.tag.batch == batch_ && !node.mesh.isEmpty();
    };
    return std::ranges::count_if(waiting_, is_newest) >= int64_t(batch_nodes_);
}

void SceneModel::release() {
    waiting_triangles_ = 0;
    for (DecodedNode& node : std::exchange(waiting_, {}))
        node.mesh.isEmpty() ? hide(node.mesh.leaf) : show(std::move(node));
}

void SceneModel::show(DecodedNode&& node) {
    const uint32_t leaf = node.mesh.leaf;
    const auto known = nodes_.find(leaf);
    if (known != nodes_.end()) {
        if (node.mesh.revision <= known->second.revision) return;
        digest_.remove(leaf, known->second.content);
        triangles_ -= known->second.triangles;
    }
    digest_.add(leaf, node.content);
    const size_t triangles = node.mesh.indices.size() / 3;
    triangles_ += triangles;
    nodes_[leaf] = {node.mesh.revision, node.content, triangles};
    note({std::move(node.mesh), node.tag.cut_stamp_ns});
}

// A newer mesh shows the older one's cut as well.
void SceneModel::note(Change&& change) {
    const auto [place, is_first] = change_of_.try_emplace(change.mesh.leaf, changes_.nodes.size());
    if (is_first) return changes_.nodes.push_back(std::move(change));
    Change& older = changes_.nodes[place->second];
    if (older.cut_stamp_ns != 0) change.cut_stamp_ns = older.cut_stamp_ns;
    older = std::move(change);
}

void SceneModel::removeNode(uint32_t leaf) {
    if (waiting_.empty()) return hide(leaf);
    if (!nodes_.contains(leaf) && std::ranges::none_of(waiting_, [leaf](const DecodedNode& node) {
            return node.mesh.leaf == leaf && !node.mesh.isEmpty();
        }))
        return;
    DecodedNode removal;
    removal.mesh.leaf = leaf;
    waiting_.push_back(std::move(removal));
}

void SceneModel::hide(uint32_t leaf) {
    const auto known = nodes_.find(leaf);
    if (known == nodes_.end()) return;
    digest_.remove(leaf, known->second.content);
    triangles_ -= known->second.triangles;
    nodes_.erase(known);
    Change removal;
    removal.mesh.leaf = leaf;
    note(std::move(removal));
}

SceneModel::Changes SceneModel::takeChanges(Clock::time_point now) {
    if (now - waiting_since_ > kLongestWait) release();
    change_of_.clear();
    return std::exchange(changes_, Changes());
}

}  // namespace bonemill
