// The buffers a frame passes through: multisampled scene, its resolved copy, half-size occlusion, shadow map.
//
// Thread: the one of the context.
#pragma once

#include <optional>

#include "render_client/gl/gl_object.h"

namespace bonemill {

class RenderTargets {
  public:
    static constexpr int kShadowSize = 2048;  // texels per side
    static constexpr int kWantedSamples = 4;

    // Throws GlError when the driver refuses a buffer of this size (pixels).
    RenderTargets(const GlApi& gl, int width, int height);

    bool hasSize(int width, int height) const { return width_ == width && height_ == height; }
    int width() const { return width_; }
    int height() const { return height_; }
    int occlusionWidth() const { return (width_ + 1) / 2; }
    int occlusionHeight() const { return (height_ + 1) / 2; }

    GLuint scene() const { return scene_.name(); }
    GLuint occlusion() const { return occlusion_.name(); }
    GLuint shadow() const { return shadow_.name(); }
    GLuint colourTexture() const { return colour_texture_.name(); }
    GLuint depthTexture() const { return depth_texture_.name(); }
    GLuint occlusionTexture() const { return occlusion_texture_.name(); }
    GLuint shadowTexture() const { return shadow_texture_.name(); }

    // Scene -> colourTexture and depthTexture.
    void resolve() const;
    // 0 .. 1 of the resolved picture at a pixel from the upper left; nothing outside and on the background.
    std::optional<float> depthAt(int x, int y) const;

  private:
    void makeScene();
    void makeResolved();
    void makeOcclusion();
    void makeShadow();
    void makeTexture(const GlTexture& texture, GLint format, int width, int height, GLenum layout,
                     GLenum type, GLint filter) const;
    void checkComplete(const char* what) const;

    const GlApi& gl_;
    int width_;
    int height_;
    GlFramebuffer scene_, resolved_, occlusion_, shadow_;
    GlRenderbuffer scene_colour_, scene_depth_;
    GlTexture colour_texture_, depth_texture_, occlusion_texture_, shadow_texture_;
};

}  // namespace bonemill
