// The buffers that a frame passes through. They belong to the thread of the context.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "render_client/look/camera/view_settings.h"
#include "render_client/look/gl/gl_api.h"
#include "render_client/look/paint/pixel_tiles.h"
#include "render_client/look/paint/surface_maps.h"

namespace bonemill {

// A frame passes through these buffers: the bone alone, the scene with the tool, its resolved copy, half-size
// occlusion, the finished picture. Bone and finished picture are kept for the next frame. In full quality
// bone and scene have several samples per pixel; in quick quality the scene is its own resolved copy.
class RenderTargets {
  public:
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
    GLuint colourTexture() const { return colour_texture_.name(); }
    GLuint depthTexture() const { return depth_texture_.name(); }
    GLuint occlusionTexture() const { return occlusion_texture_.name(); }

    BoneLayer sceneLayer() const { return {scene(), scene_surface_.name(), *maps_}; }

    GLuint bone() const { return bone_.name(); }
    BoneLayer keptLayer() const { return {bone_.name(), bone_surface_.name(), *maps_}; }
    GLuint boneDepthTexture() const { return bone_depth_.name(); }  // in quick quality only
    // It stands on its head, as Mesa keeps what is shown: it is copied there row by row, at least off screen.
    // To turn it took its renderer in software a seventh of a picture's time; the eyes of an anaglyph pay
    // that.
    GLuint finished() const { return finished_.name(); }

    // Resolves those parts of the scene into colourTexture() and depthTexture().
    void resolve(const std::vector<PixelBox>& parts) const;
    // Returns the depth (0 to 1) of the resolved picture at a pixel counted from the upper left; nothing
    // outside and on the background.
    std::optional<float> depthAt(int x, int y) const;

  private:
    void makeSampled();
    void makePlain();
    void makeSampledLayer(const GlFramebuffer& layer, const GlRenderbuffer& colour,
                          const GlRenderbuffer& depth, GLsizei samples, const char* what) const;
    void makeSampledSurface(const GlFramebuffer& surface, const GlRenderbuffer& depth,
                            const char* what) const;
    void makeFinished();
    void makeResolved();
    void makeSurface(const GlFramebuffer& surface, const GlTexture& depth, const char* what) const;
    void makeLayer(const GlFramebuffer& layer, const GlTexture& colour, const GlTexture& depth,
                   const char* what) const;
    void makeOcclusion();
    void makeTexture(const GlTexture& texture, GLint format, int width, int height, GLenum layout,
                     GLenum type, GLint filter) const;
    void checkComplete(const char* what) const;

    const GlApi& gl_;
    int width_;
    int height_;
    Quality quality_;
    GlFramebuffer scene_, scene_surface_, resolved_, occlusion_, bone_, bone_surface_, finished_;
    GlRenderbuffer scene_colour_, scene_depth_, sampled_bone_colour_, sampled_bone_depth_;
    GlTexture colour_texture_, depth_texture_, occlusion_texture_, bone_colour_, bone_depth_,
        finished_colour_;
    std::optional<SurfaceMaps> maps_;
};

}  // namespace bonemill
