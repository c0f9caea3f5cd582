// Painters of the tool and of what flies around it. They belong to the thread of the context.
#pragma once

#include <memory>
#include <vector>

#include "render_client/look/gl/gl_api.h"
#include "render_client/look/model/tool_mesh.h"
#include "render_client/look/paint/frame.h"
#include "render_client/look/visual_effects/effect_input.h"

namespace bonemill {

// Draws the tool, and the ghosts of where the hand and an expert hold it.
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

// Draws grains and drops as lit discs and streaks that face the eye. They read the depth
// and leave it as it is.
class ParticlePainter {
  public:
    // Throws GlError with the compiler's log when the driver refuses the shader.
    explicit ParticlePainter(const GlApi& gl);

    // Draws into the bound framebuffer, a picture of this height (pixels).
    void draw(const Frame& frame, const Particles& particles, int height, GLuint shadow_texture);
    // Returns a box (C, m) around each that is drawn: the smallest are drawn larger than they are.
    static std::vector<Eigen::AlignedBox3f> boxes(const Frame& frame, const Particles& particles, int height);

  private:
    struct Vertex {
        Eigen::Vector3f p_C;
        Eigen::Vector2f uv;     // along and across the streak, in radii
        Eigen::Vector2f along;  // the streak's direction in the picture
        float half_length;      // of the streak, in radii
        Eigen::Vector4f colour;
        float gloss;
    };
    void add(const Frame& frame, const Particle& particle, int height);

    const GlApi& gl_;
    Program program_;
    GlVertexArray layout_;
    GlBuffer buffer_;
    std::vector<Vertex> vertices_;
};

}  // namespace bonemill
