// What the bone's surface has in each pixel, before it is shaded. They belong to the thread of the context.
#pragma once

#include "render_client/look/gl/gl_api.h"

namespace bonemill {

class SurfaceMaps {
  public:
    // Of this size (pixels), with so many samples in each pixel; 0: the textures are plain ones.
    SurfaceMaps(const GlApi& gl, int width, int height, int samples);

    int samples() const { return samples_; }
    // The bound framebuffer, whose depth is of the same kind, takes what kBoneSurfaceFragment writes.
    void attach() const;
    // Nothing is known of any pixel of the bound framebuffer that the scissor leaves.
    void clear() const;
    // kBoneShadeFragment, in use, reads them.
    void setUniforms(const Program& program) const;

  private:
    void makeMap(const GlTexture& map, GLenum format, GLenum layout, GLenum type) const;
    GLenum target() const { return samples_ > 0 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D; }

    const GlApi& gl_;
    int width_, height_, samples_;
    GlTexture normal_and_scan_, material_, depth_and_milled_;
};

// A picture of bone: framebuffers that share depth and stencil.
struct BoneLayer {
    GLuint picture;  // takes colours
    GLuint surface;  // takes what the maps hold
    const SurfaceMaps& maps;
};

}  // namespace bonemill
