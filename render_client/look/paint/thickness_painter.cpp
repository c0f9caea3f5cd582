#include "render_client/look/paint/thickness_painter.h"

#include <string>

#include "render_client/look/shaders/shaders.h"
#include "render_client/look/structures/structure_colours.h"

namespace bonemill {

ThicknessPainter::ThicknessPainter(const GlApi& gl, const ThicknessField& field)
    : gl_(gl),
      surface_(gl, "bone of thickness", std::string("#define THICKNESS\n") + shaders::kMeshVertex,
               std::string("#define THICKNESS\n") + shaders::kBoneFragment),
      texture_(gl),
      // A texture's corner is half a sample before its first one.
      first_V_(field.first_V - Eigen::Vector3f::Constant(0.5f * field.step)),
      extent_(field.step * field.size.cast<float>()) {
    constexpr uint8_t kFar = 255;
    const bool is_empty = field.shares.empty();
    gl_.ActiveTexture(GL_TEXTURE0 + GLenum(kUnit));
    gl_.BindTexture(GL_TEXTURE_3D, texture_.name());
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl_.TexImage3D(GL_TEXTURE_3D, 0, GL_R8, is_empty ? 1 : field.size.x(), is_empty ? 1 : field.size.y(),
                   is_empty ? 1 : field.size.z(), 0, GL_RED, GL_UNSIGNED_BYTE,
                   is_empty ? &kFar : field.shares.data());
    for (const GLenum direction : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        gl_.TexParameteri(GL_TEXTURE_3D, direction, GL_CLAMP_TO_EDGE);
    gl_.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl_.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl_.ActiveTexture(GL_TEXTURE0);
    if (is_empty) extent_.setOnes();
}

void ThicknessPainter::setUniforms() const {
    gl_.ActiveTexture(GL_TEXTURE0 + GLenum(kUnit));
    gl_.BindTexture(GL_TEXTURE_3D, texture_.name());
    gl_.ActiveTexture(GL_TEXTURE0);
    surface_.set("thickness", kUnit);
    for (int i = 0; i < kThicknessColours; ++i)
        surface_.set(("thickness_colours[" + std::to_string(i) + "]").c_str(), thicknessColours()[size_t(i)]);
    surface_.set("thickness_first", first_V_);
    surface_.set("thickness_extent", extent_);
}

}  // namespace bonemill
