// Gives a scene the nodes that changed, each for itself: one that cannot be drawn is named in the log and
// counted, its leaf stays as it was, and the others are shown all the same.
//
// It belongs to the thread of the OpenGL context.
#pragma once

#include <cstdint>
#include <set>

#include "render_client/look/render_scene/render_scene.h"

namespace bonemill {

class NodeIntake {
  public:
    // The scene must outlive the intake.
    explicit NodeIntake(RenderScene& scene) : scene_(scene) {}

    // Does what RenderScene::setNode() does. Returns false when the mesh contradicts itself and is not shown.
    bool set(const NodeMesh& mesh);
    // Forgets every node, shown or not.
    void clear();

    // Returns how many leaves do not show their newest mesh.
    size_t refusedCount() const { return refused_.size(); }

  private:
    RenderScene& scene_;
    std::set<uint32_t> refused_;  // leaves
};

}  // namespace bonemill
