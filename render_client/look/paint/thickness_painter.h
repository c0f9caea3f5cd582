// Bone is drawn with this program while it shows how far it is to the next structure.
//
// It belongs to the thread of the context.
#pragma once

#include "render_client/look/gl/gl_object.h"
#include "render_client/look/gl/program.h"
#include "render_client/look/structures/thickness_field.h"

namespace bonemill {

class ThicknessPainter {
  public:
    // Throws GlError with the compiler's log when the driver refuses the shader.
    ThicknessPainter(const GlApi& gl, const ThicknessField& field);

    const Program& surface() const { return surface_; }
    // The program must be in use.
    void setUniforms() const;

  private:
    static constexpr GLint kUnit = 3;  // 0 is the shadow's, 1 the film's, 2 the palette's

    const GlApi& gl_;
    Program surface_;
    GlTexture texture_;
    Eigen::Vector3f first_V_, extent_;  // m, of the texture
};

}  // namespace bonemill
