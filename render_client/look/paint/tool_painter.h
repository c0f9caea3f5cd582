// Draws the tool, and the ghosts of where the hand and an expert hold it.
//
// It belongs to the thread of the context.
#pragma once

#include <memory>

#include "render_client/look/gl/program.h"
#include "render_client/look/model/tool_mesh.h"
#include "render_client/look/paint/frame.h"

namespace bonemill {

class ToolPainter {
  public:
    // Throws GlError with the compiler's log when the driver refuses a shader.
    explicit ToolPainter(const GlApi& gl);

    // From now on the burr's flutes can turn, or no longer. Throws GlError.
    void prepareSpin(bool is_needed);

    // Draws into the bound framebuffer, with depth test and depth writes on.
    void drawTool(const Frame& frame, const FrameView& view, const ToolMesh& tool,
                  GLuint shadow_texture) const;
    // Draws over what is there and leaves the depth as it is.
    void drawGhosts(const Frame& frame, const ToolMesh& tool) const;

  private:
    const GlApi& gl_;
    Program tool_, ghost_;
    std::unique_ptr<Program> spinning_tool_;
};

}  // namespace bonemill
