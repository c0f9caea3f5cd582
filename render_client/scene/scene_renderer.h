// Draws bone, tool and the ghost of the device pose with light, shadow and ambient occlusion.
//
// Thread: the one of the context. Frames: W world, V volume, T tool, C camera (orbit_camera.h); m, rad.
#pragma once

#include <memory>
#include <optional>

#include "render_client/gl/program.h"
#include "render_client/scene/node_store.h"
#include "render_client/scene/orbit_camera.h"
#include "render_client/scene/render_targets.h"
#include "render_client/scene/tool_mesh.h"

namespace bonemill {

enum class BurrWork { kIdle, kRemoving, kAdding };

// What one frame shows.
struct FrameView {
    OrbitCamera camera;
    Pose X_WV;
    Eigen::AlignedBox3d bone_V;  // the bone at start; empty: nothing known yet
    double burr_radius = 0;
    std::optional<Pose> X_WT;         // the simulated tool (SPO)
    std::optional<Pose> X_WT_device;  // where the hand is; drawn when it differs visibly
    BurrWork burr_work = BurrWork::kIdle;
};

// Does the device pose lie visibly off the simulated tool?
bool isGhostVisible(const Pose& X_WT, const Pose& X_WT_device);

class SceneRenderer {
  public:
    // Throws GlError with the compiler's log when the driver refuses a shader.
    explicit SceneRenderer(const GlApi& gl);

    // Leaves the picture (without HUD) in `target`, a framebuffer of this size (pixels).
    void draw(const FrameView& view, const NodeStore& nodes, const ToolMesh& tool, int width, int height,
              GLuint target);

    // Bone triangles inside the view volume of the last frame.
    size_t trianglesDrawn() const { return triangles_drawn_; }

  private:
    struct Frame;  // matrices of the frame being drawn
    Frame makeFrame(const FrameView& view, const ToolMesh& tool, double aspect) const;
    void drawShadowMap(const Frame& frame, const NodeStore& nodes, const ToolMesh& tool) const;
    void drawBackground() const;
    void drawBone(const Frame& frame, const NodeStore& nodes);
    void drawTool(const Frame& frame, const FrameView& view, const ToolMesh& tool) const;
    void drawGhost(const Frame& frame, const ToolMesh& tool) const;
    void drawOcclusion(const Frame& frame) const;
    void compose(const Frame& frame, GLuint target) const;
    void setLight(const Program& program, const Frame& frame) const;
    void drawFullScreen() const;

    const GlApi& gl_;
    Program bone_, tool_, ghost_, depth_, background_, occlusion_, composite_;
    GlVertexArray no_attributes_;
    std::unique_ptr<RenderTargets> targets_;
    size_t triangles_drawn_ = 0;
};

}  // namespace bonemill
