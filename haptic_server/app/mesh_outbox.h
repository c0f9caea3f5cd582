// Node meshes on their way from the mesher thread to the publisher thread: of each leaf the newest. Any
// normal thread; never the tick.
#pragma once

#include <atomic>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "common/geometry/node_mesh.h"

namespace bonemill {

class MeshOutbox {
  public:
    void put(NodeMesh&& mesh) {
        const std::lock_guard lock(mutex_);
        const auto [place, is_new] = meshes_.try_emplace(mesh.leaf);
        if (is_new || place->second.revision < mesh.revision) place->second = std::move(mesh);
    }
    // Every leaf has been put once: from now on a client that has all nodes has the whole bone.
    void markWhole() { is_whole_.store(true, std::memory_order_release); }
    bool isWhole() const { return is_whole_.load(std::memory_order_acquire); }
    std::vector<NodeMesh> takeAll() {
        std::vector<NodeMesh> taken;
        for (auto& [leaf, mesh] : takeMap()) taken.push_back(std::move(mesh));
        return taken;
    }

  private:
    std::map<uint32_t, NodeMesh> takeMap() {
        const std::lock_guard lock(mutex_);
        return std::exchange(meshes_, {});
    }

    std::mutex mutex_;
    std::map<uint32_t, NodeMesh> meshes_;  // by leaf
    std::atomic<bool> is_whole_{false};
};

}  // namespace bonemill
