#include "haptic_server/mesh/mesh_outbox.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace bonemill {
namespace {

// Measured on CT heads (docs/measurements.md); the publisher counts what it really wrote.
constexpr int64_t kBytesPerTriangle = 4;
constexpr int64_t kBytesPerNode = 120;

int64_t codedSize(const std::map<uint32_t, NodeMesh>& meshes) {
    int64_t bytes = 0;
    for (const auto& [leaf, mesh] : meshes)
        bytes += kBytesPerNode + kBytesPerTriangle * int64_t(mesh.indices.size() / 3);
    return bytes;
}

float distanceOf(const std::map<uint32_t, NodeMesh>& meshes, const Eigen::Vector3f& point) {
    float nearest = std::numeric_limits<float>::max();
    for (const auto& [leaf, mesh] : meshes) {
        if (mesh.isEmpty()) return 0;  // an emptied leaf has no place, and costs nothing to send
        const PackedVertex& v = mesh.vertices.front();
        const Eigen::Vector3f p = mesh.origin + mesh.step.cwiseProduct(Eigen::Vector3f(v.x, v.y, v.z));
        nearest = std::min(nearest, (p - point).norm());
    }
    return nearest;
}

int64_t olderCut(int64_t a, int64_t b) {
    return a == 0 ? b : b == 0 ? a : std::min(a, b);
}

}  // namespace

void MeshOutbox::join(Waiting& into, Waiting&& other) {
    for (auto& [leaf, mesh] : other.meshes) {
        const auto [place, is_new] = into.meshes.try_emplace(leaf);
        if (is_new || place->second.revision < mesh.revision) place->second = std::move(mesh);
    }
    into.leaves.insert(into.leaves.end(), other.leaves.begin(), other.leaves.end());
    into.oldest_cut_ns = olderCut(into.oldest_cut_ns, other.oldest_cut_ns);
    into.since_ns = std::min(into.since_ns, other.since_ns);
}

bool MeshOutbox::isEmpty() const {
    const std::lock_guard lock(mutex_);
    return groups_.empty();
}

void MeshOutbox::put(NodeGroup&& group, int64_t now_ns) {
    if (group.meshes.empty()) return;
    Waiting joined;
    joined.since_ns = now_ns;
    joined.oldest_cut_ns = group.oldest_cut_ns;
    joined.leaves = std::move(group.neighbours);
    for (NodeMesh& mesh : group.meshes) {
        joined.leaves.push_back(mesh.leaf);
        joined.meshes.insert_or_assign(mesh.leaf, std::move(mesh));
    }
    const std::lock_guard lock(mutex_);
    const std::vector<uint32_t> leaves = joined.leaves;
    for (const uint32_t leaf : leaves) {
        const auto of_leaf = group_of_.find(leaf);
        if (of_leaf == group_of_.end()) continue;
        const auto waiting = groups_.find(of_leaf->second);
        if (waiting == groups_.end()) continue;
        join(joined, std::move(waiting->second));
        groups_.erase(waiting);
    }
    const uint64_t id = next_group_++;
    for (const uint32_t leaf : joined.leaves) group_of_[leaf] = id;
    groups_.emplace(id, std::move(joined));
}

std::vector<NodeGroup> MeshOutbox::takeNearest(const Eigen::Vector3f& point, int64_t bytes, int64_t now_ns) {
    const std::lock_guard lock(mutex_);
    std::vector<std::pair<float, uint64_t>> order;
    for (const auto& [id, waiting] : groups_) {
        const float age_s = float(now_ns - waiting.since_ns) * 1e-9f;
        order.emplace_back(distanceOf(waiting.meshes, point) - kAgeing * age_s, id);
    }
    std::sort(order.begin(), order.end());
    std::vector<NodeGroup> taken;
    for (const auto& [nearness, id] : order) {
        if (bytes <= 0) break;
        auto waiting = groups_.extract(id);
        Waiting& group = waiting.mapped();
        bytes -= codedSize(group.meshes);
        taken.emplace_back().oldest_cut_ns = group.oldest_cut_ns;
        for (const uint32_t leaf : group.leaves)
            if (!group.meshes.contains(leaf)) taken.back().neighbours.push_back(leaf);
        for (auto& [leaf, mesh] : group.meshes) taken.back().meshes.push_back(std::move(mesh));
        for (const uint32_t leaf : group.leaves) group_of_.erase(leaf);
    }
    return taken;
}

}  // namespace bonemill
