#include "haptic_server/recording/foxglove/bone_topics.h"

#include <algorithm>
#include <cstdio>

#include "haptic_server/recording/foxglove/foxglove_messages.h"

namespace bonemill {
namespace {

constexpr Rgb kBoneColor{0.89, 0.85, 0.76};

Eigen::Vector3i nodesOf(const Eigen::Vector3i& leaves, int shift) {
    return leaves.unaryExpr([shift](int count) { return ((count - 1) >> shift) + 1; });
}

std::string nameOf(size_t node) {
    char text[16];
    std::snprintf(text, sizeof text, "%02zu", node);
    return text;
}

}  // namespace

BoneTopics::BoneTopics(const SceneSetup& simulation, FoxgloveFile& file)
    : file_(file),
      lattice_(simulation.bone->lattice),
      mesher_(simulation.bone->volume, lattice_, MeshGrid::kStreamedStepsPerCell, {},
              simulation.surroundings ? &simulation.surroundings->rim : nullptr) {
    while (nodesOf(lattice_.leavesPerAxis(), shift_).prod() > kMostNodes) ++shift_;
    nodes_ = nodesOf(lattice_.leavesPerAxis(), shift_);
    all_nodes_.resize(size_t(nodes_.prod()));
}

size_t BoneTopics::nodeOf(uint32_t leaf) const {
    const Eigen::Vector3i index = lattice_.leafIndex(leaf);
    const Eigen::Vector3i node = index.unaryExpr([shift = shift_](int n) { return n >> shift; });
    return size_t(node.x() + nodes_.x() * (node.y() + nodes_.y() * node.z()));
}

void BoneTopics::takeChanges() {
    mesher_.pass([&](NodeMesh&& mesh) {
        const size_t place = nodeOf(mesh.leaf);
        Node& node = all_nodes_[place];
        if (!node.is_waiting) waiting_.push_back(place);
        node.is_waiting = true;
        if (mesh.isEmpty())
            node.leaves.erase(mesh.leaf);
        else
            node.leaves[mesh.leaf] = std::move(mesh);
    });
}

size_t BoneTopics::put(size_t place, uint64_t stamp_ns) {
    Node& node = all_nodes_[place];
    node.is_waiting = false;
    const std::string name = nameOf(place);
    if (!node.channel) node.channel = file_.addTopic("/bone/" + name, *foxglove::SceneUpdate::descriptor());
    foxglove::SceneUpdate update;
    foxglove::SceneEntity* const entity = addEntity(stamp_ns, "V", "bone " + name, &update);
    for (const auto& [leaf, mesh] : node.leaves) addNode(mesh, kBoneColor, entity);
    return file_.put(*node.channel, stamp_ns, update);
}

void BoneTopics::update(double t_s, uint64_t stamp_ns) {
    if (next_s_ && t_s < *next_s_) return;
    const bool is_first = !next_s_;
    next_s_ = std::max(t_s, next_s_.value_or(t_s) + kPeriod);
    if (is_first) return finish(stamp_ns);
    takeChanges();
    allowance_ = std::min(allowance_, 0.0) + double(kBytesPerUpdate);
    while (!waiting_.empty() && allowance_ > 0) {
        allowance_ -= double(put(waiting_.front(), stamp_ns));
        waiting_.pop_front();
    }
}

void BoneTopics::finish(uint64_t stamp_ns) {
    takeChanges();
    for (const size_t node : waiting_) put(node, stamp_ns);
    waiting_.clear();
}

}  // namespace bonemill
