// A frame passes through these buffers: multisampled scene, its resolved copy, half-size occlusion, shadow
// map. In quick quality the scene is not multisampled and has no shadow; the bone alone and the finished
// picture are kept for the next frame.
//
// It belongs to the thread of the context.
#pragma once

#include <optional>

#include "render_client/look/camera/view_settings.h"
#include "render_client/look/gl/gl_object.h"
#include "render_client/look/paint/pixel_box.h"

namespace bonemill {

class RenderTargets {
  public:
    static constexpr int kShadowSize = 2048;  // texels per side
    static constexpr int kWantedSamples = 4;

    // Throws GlError when the driver refuses a buffer of this size (pixels).
    RenderTargets(const GlApi& gl, int width, int height, Quality quality);

    bool suits(int width, int height, Quality quality) const {
        return width_ == width && height_ == height && quality_ == quality;
    }
    int width() const { return width_; }
    int height() const { return height_; }
    int occlusionWidth() const { return (width_ + 1) / 2; }
    int occlusionHeight() const { return (height_ + 1) / 2; }

    GLuint scene() const { return quality_ == Quality::kFull ? scene_.name() : resolved_.name(); }
    GLuint occlusion() const { return occlusion_.name(); }
    GLuint shadow() const { return shadow_.name(); }
    GLuint colourTexture() const { return colour_texture_.name(); }
    GLuint depthTexture() const { return depth_texture_.name(); }
    GLuint occlusionTexture() const { return occlusion_texture_.name(); }
    GLuint shadowTexture() const { return shadow_texture_.name(); }

    GLuint bone() const { return bone_.name(); }          // quick only
    GLuint finished() const { return finished_.name(); }  // quick only

    // Copies colour or depth, or both, of that part from one framebuffer to the other.
    void copy(GLuint from, GLuint to, const PixelBox& part, GLbitfield what) const;
    // Resolves the scene into colourTexture() and depthTexture().
    void resolve() const;
    // Returns the depth (0 to 1) of the resolved picture at a pixel counted from the upper left; nothing
    // outside and on the background.
    std::optional<float> depthAt(int x, int y) const;

  private:
    void makeScene();
    void makeKept();
    void makeResolved();
    void makeLayer(const GlFramebuffer& layer, const GlTexture& colour, const GlTexture& depth,
                   const char* what) const;
    void makeOcclusion();
    void makeShadow();
    void makeTexture(const GlTexture& texture, GLint format, int width, int height, GLenum layout,
                     GLenum type, GLint filter) const;
    void checkComplete(const char* what) const;

    const GlApi& gl_;
    int width_;
    int height_;
    Quality quality_;
    GlFramebuffer scene_, resolved_, occlusion_, shadow_, bone_, finished_;
    GlRenderbuffer scene_colour_, scene_depth_;
    GlTexture colour_texture_, depth_texture_, occlusion_texture_, shadow_texture_, bone_colour_, bone_depth_,
        finished_colour_;
};

}  // namespace bonemill
