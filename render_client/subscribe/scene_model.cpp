#include "render_client/subscribe/scene_model.h"

#include <algorithm>
#include <utility>

namespace bonemill {
namespace {

// This is far more than any bone has; it bounds what invented ones can take.
constexpr size_t kMostNodes = size_t(1) << 20;

}  // namespace

bool SceneModel::enterEpoch(uint64_t epoch) {
    if (epoch <= epoch_) return epoch == epoch_;
    if (epoch_ != 0) {
        changes_.is_cleared = true;
        changes_.nodes.clear();
        nodes_.clear();
        waiting_.clear();
        writer_epochs_.clear();
        digest_ = NodeDigest();
    }
    epoch_ = epoch;
    batch_ = 0;
    batch_nodes_ = 0;
    return true;
}

void SceneModel::applyNode(DecodedNode&& node, uint64_t writer, Clock::time_point now) {
    if (nodes_.size() >= kMostNodes && !nodes_.contains(node.mesh.leaf)) return;
    writer_epochs_[writer] = node.tag.epoch;
    if (!enterEpoch(node.tag.epoch)) return;
    if (node.tag.batch > batch_) {
        batch_ = node.tag.batch;
        batch_nodes_ = node.tag.batch_nodes;
    } else if (node.tag.batch < batch_ && waiting_.empty()) {
        return show(std::move(node));  // sent again after an interruption
    }
    if (waiting_.empty()) waiting_since_ = now;
    waiting_.push_back(std::move(node));
    if (isNewestWhole()) release();
}

bool SceneModel::isNewestWhole() const {
    const auto is_newest = [this](const DecodedNode& node) {
        return node.tag.batch == batch_ && !node.mesh.isEmpty();
    };
    return std::ranges::count_if(waiting_, is_newest) >= int64_t(batch_nodes_);
}

void SceneModel::release() {
    for (DecodedNode& node : std::exchange(waiting_, {}))
        node.mesh.isEmpty() ? hide(node.mesh.leaf) : show(std::move(node));
}

void SceneModel::show(DecodedNode&& node) {
    const uint32_t leaf = node.mesh.leaf;
    const auto known = nodes_.find(leaf);
    if (known != nodes_.end()) {
        if (node.mesh.revision <= known->second.revision) return;
        digest_.remove(leaf, known->second.content);
    }
    digest_.add(leaf, node.content);
    nodes_[leaf] = {node.mesh.revision, node.content};
    changes_.nodes.push_back({std::move(node.mesh), node.tag.cut_stamp_ns});
}

void SceneModel::removeNode(uint32_t leaf, uint64_t writer) {
    const auto writer_epoch = writer_epochs_.find(writer);
    if (writer_epoch != writer_epochs_.end() && writer_epoch->second < epoch_) return;
    if (waiting_.empty()) return hide(leaf);
    DecodedNode removal;
    removal.mesh.leaf = leaf;
    waiting_.push_back(std::move(removal));
}

void SceneModel::hide(uint32_t leaf) {
    const auto known = nodes_.find(leaf);
    if (known == nodes_.end()) return;
    digest_.remove(leaf, known->second.content);
    nodes_.erase(known);
    Change removal;
    removal.mesh.leaf = leaf;
    changes_.nodes.push_back(std::move(removal));
}

SceneModel::Changes SceneModel::takeChanges(Clock::time_point now) {
    if (now - waiting_since_ > kLongestWait) release();
    return std::exchange(changes_, Changes());
}

}  // namespace bonemill
