// The buffers that a frame passes through, and which pixels of them are drawn anew. The buffers belong to the
// thread of the context.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "render_client/look/camera/view_settings.h"
#include "render_client/look/gl/gl_api.h"
#include "render_client/look/paint/frame.h"
#include "render_client/look/paint/surface_maps.h"

namespace bonemill {

// It is a rectangle of pixels, half open, counted from the picture's lower left corner as OpenGL does.
struct PixelBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

    static PixelBox whole(int width, int height) { return {0, 0, width, height}; }

    bool isEmpty() const { return x1 <= x0 || y1 <= y0; }
    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
    bool operator==(const PixelBox&) const = default;

    // joined() is the smallest box around both, within() the part in the other one, grown() wider by so
    // many pixels on each side.
    PixelBox joined(const PixelBox& other) const;
    PixelBox within(const PixelBox& other) const;
    PixelBox grown(int pixels) const { return {x0 - pixels, y0 - pixels, x1 + pixels, y1 + pixels}; }

    // Returns every pixel that the box (in the frame that clip_from_model takes) may touch in a picture of
    // this size; this is the whole picture when part of the box is at or behind the eye.
    static PixelBox around(const Eigen::AlignedBox3f& box, const Eigen::Matrix4f& clip_from_model, int width,
                           int height);

    // Returns what scales clip space so that this box fills it, to leave out what lies beside it.
    Eigen::Matrix4f zoom(int picture_width, int picture_height) const;
};

// Finds which pixels of a resting view have to be drawn anew. It is a plain value, for one thread.
class PictureChanges {
  public:
    struct Dirty {
        PixelBox bone;  // bone and background
        PixelBox all;   // and what moves before them
    };

    // Returns a range that holds the needed one, and stays the same as long as it can while the camera rests.
    DepthRange range(const Camera& camera, const DepthRange& needed);

    // Returns what the next picture of this size must draw: all of it when anything but nodes and
    // moving things has changed. changed_V is the box around the nodes that changed, `moving` are the
    // pixels of what moves now, and still_like are numbers that are the same only while all of it stands
    // still as it is (empty: it does not).
    Dirty next(const Frame& frame, int width, int height, const Eigen::AlignedBox3f& changed_V,
               const PixelBox& moving, std::vector<float> still_like);

    // The next picture is drawn whole.
    void forget() { signature_.clear(); }

  private:
    std::vector<float> signature_;  // of the last view
    Camera camera_;
    DepthRange range_;
    PixelBox moving_;                // in the last picture
    std::vector<float> still_like_;  // in the last picture
};

// A frame passes through these buffers: multisampled scene, its resolved copy, half-size occlusion, shadow
// map. In quick quality the scene is not multisampled and has no shadow; the bone alone and the finished
// picture are kept for the next frame.
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

    BoneLayer sceneLayer() const { return {scene(), scene_surface_.name(), *maps_}; }

    // In quick quality only.
    GLuint bone() const { return bone_.name(); }
    BoneLayer keptLayer() const { return {bone_.name(), bone_surface_.name(), *maps_}; }
    GLuint boneDepthTexture() const { return bone_depth_.name(); }
    GLuint finished() const { return finished_.name(); }

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
    void makeSurface(const GlFramebuffer& surface, const GlTexture& depth, const char* what) const;
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
    GlFramebuffer scene_, scene_surface_, resolved_, occlusion_, shadow_, bone_, bone_surface_, finished_;
    GlRenderbuffer scene_colour_, scene_depth_;
    GlTexture colour_texture_, depth_texture_, occlusion_texture_, shadow_texture_, bone_colour_, bone_depth_,
        finished_colour_;
    std::optional<SurfaceMaps> maps_;
};

}  // namespace bonemill
