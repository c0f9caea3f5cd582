// Node meshes on their way from the mesher thread to the publisher thread. Any normal thread; never the tick.
#pragma once

#include <atomic>
#include <mutex>
#include <utility>
#include <vector>

#include "common/geometry/node_mesh.h"

namespace bonemill {

class MeshOutbox {
  public:
    void put(NodeMesh&& mesh) {
        const std::lock_guard lock(mutex_);
        meshes_.push_back(std::move(mesh));
    }
    // Every leaf has been put once: from now on a client that has all nodes has the whole bone.
    void markWhole() { is_whole_.store(true, std::memory_order_release); }
    bool isWhole() const { return is_whole_.load(std::memory_order_acquire); }
    std::vector<NodeMesh> takeAll() {
        const std::lock_guard lock(mutex_);
        return std::exchange(meshes_, {});
    }

  private:
    std::mutex mutex_;
    std::vector<NodeMesh> meshes_;
    std::atomic<bool> is_whole_{false};
};

}  // namespace bonemill
