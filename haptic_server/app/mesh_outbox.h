// Node meshes on their way from the mesher thread to the publisher thread. Any normal thread; never the tick.
#pragma once

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
    std::vector<NodeMesh> takeAll() {
        const std::lock_guard lock(mutex_);
        return std::exchange(meshes_, {});
    }

  private:
    std::mutex mutex_;
    std::vector<NodeMesh> meshes_;
};

}  // namespace bonemill
