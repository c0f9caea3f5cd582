// Draws the bone with blood and water on it, with a surface shader of its own and the film as a texture.
//
// It belongs to the thread of the context.
#pragma once

#include <memory>

#include "render_client/look/gl/gl_object.h"
#include "render_client/look/gl/program.h"
#include "render_client/look/paint/effect_picture.h"
#include "render_client/look/visual_effects/surface_film.h"

namespace bonemill {

class FilmPainter {
  public:
    // has_materials says whether bone has its materials' colours (MaterialPalette). Throws GlError with the
    // compiler's log when the driver refuses the shader.
    FilmPainter(const GlApi& gl, bool has_materials);
    void setMaterials(bool has_materials);

    // Uploads the slices that changed. Returns the box (V) in which the bone looks different now.
    Eigen::AlignedBox3f update(const EffectPicture& picture);
    // surface() draws bone in place of the plain surface's program. While it is in use setUniforms() sets the
    // film's uniforms; the film takes texture unit 1.
    const Program& surface() const { return *surface_; }
    void setUniforms() const;

  private:
    const GlApi& gl_;
    std::unique_ptr<Program> surface_;
    GlTexture texture_;
    float period_ = 1;
    Eigen::AlignedBox3f shown_;
    Eigen::Vector2f strength_ = Eigen::Vector2f::Zero();
    Eigen::Vector3f blood_colour_ = Eigen::Vector3f::Zero();
};

}  // namespace bonemill
