// Draws grains and drops as lit discs and streaks that face the eye. They read the depth
// and leave it as it is.
//
// It belongs to the thread of the context.
#pragma once

#include <vector>

#include "render_client/look/gl/gl_object.h"
#include "render_client/look/paint/frame.h"
#include "render_client/look/visual_effects/particle.h"

namespace bonemill {

class ParticlePainter {
  public:
    // Throws GlError with the compiler's log when the driver refuses the shader.
    explicit ParticlePainter(const GlApi& gl);

    // Draws into the bound framebuffer, a picture of this height (pixels).
    void draw(const Frame& frame, const Particles& particles, int height, GLuint shadow_texture);
    // Returns the box (C, m) around all that is drawn: the smallest are drawn larger than they are.
    static Eigen::AlignedBox3f box(const Frame& frame, const Particles& particles, int height);

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
