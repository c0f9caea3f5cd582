#include "render_client/look/paint/tool_painter.h"

#include <string>

#include "render_client/look/shaders/shaders.h"

namespace bonemill {
namespace {

// The burr has a light of its own while it works: orange where it removes, blue where it adds.
Eigen::Vector3f glowOf(BurrWork work) {
    switch (work) {
        case BurrWork::kRemoving:
            return {1.9f, 0.30f, 0.02f};
        case BurrWork::kAdding:
            return {0.05f, 0.75f, 1.1f};
        case BurrWork::kIdle:
            break;
    }
    return Eigen::Vector3f::Zero();
}

}  // namespace

ToolPainter::ToolPainter(const GlApi& gl)
    : gl_(gl),
      tool_(gl, "tool", shaders::kToolVertex, shaders::kToolFragment),
      ghost_(gl, "ghost", shaders::kToolVertex, shaders::kGhostFragment) {}

void ToolPainter::prepareSpin(bool is_needed) {
    spinning_tool_.reset();
    if (!is_needed) return;
    const std::string fragment = std::string("#define SPIN\n") + shaders::kToolFragment;
    spinning_tool_ = std::make_unique<Program>(gl_, "turning tool", shaders::kToolVertex, fragment);
}

void ToolPainter::drawTool(const Frame& frame, const FrameView& view, const ToolMesh& tool,
                           GLuint shadow_texture) const {
    if (!frame.X_CT) return;
    const bool spins = spinning_tool_ && view.effects->turn;
    const Program& program = spins ? *spinning_tool_ : tool_;
    program.use();
    frame.setLight(gl_, program, shadow_texture);
    program.set("camera_from_model", *frame.X_CT);
    program.set("burr_radius", float(view.burr_radius));
    program.set("milling_glow", glowOf(view.burr_work));
    if (spins) {
        program.set("spin_angle", view.effects->turn->angle);
        program.set("spin_sweep", view.effects->turn->sweep);
        program.set("flutes", view.effects->turn->flutes);
    }
    tool.draw(view.shows_handpiece);
}

// Ghosts are seen through the bone too, but fainter there: the hand usually is inside when the tool is
// stopped at the surface.
void ToolPainter::drawGhosts(const Frame& frame, const ToolMesh& tool) const {
    if (frame.ghosts.empty()) return;
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    gl_.Enable(GL_CULL_FACE);
    gl_.DepthMask(GL_FALSE);
    ghost_.use();
    ghost_.set("clip_from_camera", frame.clip_from_camera);
    constexpr struct {
        GLenum depth_test;
        float strength;
    } kPasses[] = {{GL_GREATER, 0.6f}, {GL_LEQUAL, 0.8f}};
    for (const Ghost& ghost : frame.ghosts) {
        ghost_.set("camera_from_model", ghost.X_CT);
        ghost_.set("tint", ghost.colour);
        for (const auto& pass : kPasses) {
            gl_.DepthFunc(pass.depth_test);
            ghost_.set("strength", pass.strength);
            tool.draw();
        }
    }
    gl_.DepthFunc(GL_LESS);
    gl_.DepthMask(GL_TRUE);
    gl_.Disable(GL_CULL_FACE);
    gl_.Disable(GL_BLEND);
}

}  // namespace bonemill
