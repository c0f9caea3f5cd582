#include "render_client/look/render_scene/node_intake.h"

#include <spdlog/spdlog.h>

#include <stdexcept>

namespace bonemill {

bool NodeIntake::set(const NodeMesh& mesh) {
    try {
        scene_.setNode(mesh);
    } catch (const std::invalid_argument& error) {
        if (refused_.insert(mesh.leaf).second)
            spdlog::warn("the server sent what cannot be drawn: {}", error.what());
        return false;
    }
    refused_.erase(mesh.leaf);
    return true;
}

void NodeIntake::clear() {
    scene_.clearNodes();
    refused_.clear();
}

}  // namespace bonemill
