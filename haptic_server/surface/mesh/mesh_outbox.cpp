#include "haptic_server/surface/mesh/mesh_outbox.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/rt/clock.h"

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
        if (mesh.isEmpty()) continue;  // an emptied leaf has no place
        nearest = std::min(nearest, (positionOf(mesh, mesh.vertices.front()) - point).norm());
    }
    return nearest < std::numeric_limits<float>::max() ? nearest : 0;  // nothing but emptied: costs nothing
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
    into.leaves.insert(other.leaves.begin(), other.leaves.end());
    into.oldest_cut_ns = olderCut(into.oldest_cut_ns, other.oldest_cut_ns);
    into.since_ns = std::min(into.since_ns, other.since_ns);
}

bool MeshOutbox::isEmpty() const {
    const std::lock_guard lock(mutex_);
    return groups_.empty();
}

void MeshOutbox::markWhole(int64_t now_ns) {
    const std::lock_guard lock(mutex_);
    if (whole_ns_ == 0) whole_ns_ = now_ns;
}

bool MeshOutbox::hasGivenWhole() const {
    const std::lock_guard lock(mutex_);
    const auto is_of_whole = [this](const auto& group) { return group.second.since_ns <= whole_ns_; };
    return whole_ns_ != 0 && std::ranges::none_of(groups_, is_of_whole);
}

void MeshOutbox::put(NodeGroup&& group, int64_t now_ns) {
    if (group.meshes.empty()) return;
    Waiting joined;
    joined.since_ns = group.since_ns != 0 ? group.since_ns : now_ns;
    joined.oldest_cut_ns = group.oldest_cut_ns;
    joined.leaves.insert(group.neighbours.begin(), group.neighbours.end());
    for (NodeMesh& mesh : group.meshes) {
        joined.leaves.insert(mesh.leaf);
        joined.meshes.insert_or_assign(mesh.leaf, std::move(mesh));
    }
    const std::lock_guard lock(mutex_);
    std::set<uint64_t> touched;
    for (const uint32_t leaf : joined.leaves)
        if (const auto group_id = group_of_.find(leaf); group_id != group_of_.end())
            touched.insert(group_id->second);
    for (const uint64_t id : touched) join(joined, std::move(groups_.extract(id).mapped()));
    const uint64_t id = next_group_++;
    for (const uint32_t leaf : joined.leaves) group_of_[leaf] = id;
    groups_.emplace(id, std::move(joined));
    if (group.since_ns != 0) return;
    is_news_ = true;
    has_come_.notify_one();
}

bool MeshOutbox::awaitPut(std::chrono::nanoseconds longest) {
    std::unique_lock lock(mutex_);
    has_come_.wait_for(lock, longest, [this] { return is_news_; });
    return std::exchange(is_news_, false);
}

std::vector<NodeGroup> MeshOutbox::takeNearest(const Eigen::Vector3f& point, int64_t bytes, int64_t now_ns) {
    const std::lock_guard lock(mutex_);
    std::vector<std::pair<float, uint64_t>> order;
    for (const auto& [id, waiting] : groups_) {
        const float age_s = float(secondsOfNs(now_ns - waiting.since_ns));
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
        taken.back().since_ns = group.since_ns;
        for (const uint32_t leaf : group.leaves)
            if (!group.meshes.contains(leaf)) taken.back().neighbours.push_back(leaf);
        for (auto& [leaf, mesh] : group.meshes) taken.back().meshes.push_back(std::move(mesh));
        for (const uint32_t leaf : group.leaves) group_of_.erase(leaf);
    }
    return taken;
}

}  // namespace bonemill
