#include "render_client/look/paint/surface_maps.h"

#include <Eigen/Core>
#include <array>

namespace bonemill {
namespace {

constexpr GLenum kFirstMapUnit = 4;  // after those of shadow, film, palette and near structures
constexpr GLint kDepthMap = 2;       // of the framebuffer

}  // namespace

SurfaceMaps::SurfaceMaps(const GlApi& gl, int width, int height, int samples)
    : gl_(gl),
      width_(width),
      height_(height),
      samples_(samples),
      normal_and_scan_(gl),
      material_(gl),
      depth_and_milled_(gl) {
    makeMap(normal_and_scan_, GL_RGBA16, GL_RGBA, GL_UNSIGNED_SHORT);
    makeMap(material_, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE);
    makeMap(depth_and_milled_, GL_RG32F, GL_RG, GL_FLOAT);
}

void SurfaceMaps::makeMap(const GlTexture& map, GLenum format, GLenum layout, GLenum type) const {
    gl_.BindTexture(target(), map.name());
    if (samples_ > 0) {
        gl_.TexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, samples_, format, width_, height_, GL_TRUE);
    } else {
        gl_.TexImage2D(GL_TEXTURE_2D, 0, GLint(format), width_, height_, 0, layout, type, nullptr);
        gl_.setSampling(GL_TEXTURE_2D, GL_NEAREST);
    }
}

void SurfaceMaps::attach() const {
    const std::array<GLuint, 3> maps{normal_and_scan_.name(), material_.name(), depth_and_milled_.name()};
    std::array<GLenum, 3> places{};
    for (GLenum i = 0; i < maps.size(); ++i) {
        places[i] = GL_COLOR_ATTACHMENT0 + i;
        gl_.FramebufferTexture2D(GL_FRAMEBUFFER, places[i], target(), maps[i], 0);
    }
    gl_.DrawBuffers(GLsizei(places.size()), places.data());
}

void SurfaceMaps::clear() const {
    const std::array<GLfloat, 4> nothing{};
    gl_.ClearBufferfv(GL_COLOR, kDepthMap, nothing.data());
}

void SurfaceMaps::setUniforms(const Program& program) const {
    gl_.bindTexture(kFirstMapUnit, target(), normal_and_scan_.name());
    gl_.bindTexture(kFirstMapUnit + 1, target(), material_.name());
    gl_.bindTexture(kFirstMapUnit + 2, target(), depth_and_milled_.name());
    program.set("normal_and_scan", int(kFirstMapUnit));
    program.set("material", int(kFirstMapUnit + 1));
    program.set("depth_and_milled", int(kFirstMapUnit + 2));
    program.set("picture", Eigen::Vector2f(float(width_), float(height_)));
}

}  // namespace bonemill
