// Draws bone, tool, signs and the ghost of the device pose with light, shadow and ambient occlusion.
//
// It belongs to the thread of the context. The frames are W (world), V (volume), T (tool) and C (camera, see
// camera.h); the units are m and rad.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "render_client/look/gl/gl_api.h"
#include "render_client/look/model/node_store.h"
#include "render_client/look/model/tool_mesh.h"
#include "render_client/look/paint/bone_painter.h"
#include "render_client/look/paint/frame.h"
#include "render_client/look/paint/frame_passes.h"
#include "render_client/look/paint/marker_painter.h"
#include "render_client/look/paint/picture_changes.h"
#include "render_client/look/paint/render_targets.h"
#include "render_client/look/paint/shadow_map.h"
#include "render_client/look/paint/structure_painter.h"
#include "render_client/look/paint/tool_painter.h"

namespace bonemill {

// It is a part of a framebuffer, in pixels: x counts from its left edge, the part takes its whole height.
struct PictureArea {
    int x = 0;
    int width = 0;
    int height = 0;
    double aspect() const { return double(width) / height; }
};

struct DrawnEffects {
    bool film = false, particles = false, spin = false;
};

class SceneRenderer {
  public:
    // Throws GlError with the compiler's log when the driver refuses a shader.
    explicit SceneRenderer(const GlApi& gl);

    // Leaves the picture (without figures) in that part of `target`, a framebuffer. Takes the nodes' changes.
    void draw(const FrameView& view, NodeStore& nodes, const ToolMesh& tool, const PictureArea& area,
              GLuint target);
    // Passes the colours on to the bone, as BonePainter::setPalette().
    void setPalette(const std::vector<Eigen::Vector4f>& colours);
    // Replaces the surface of the protected structure that the mesh's leaf names. Throws GlError.
    void setStructure(const NodeMesh& mesh) { structures_.set(mesh); }
    void clearStructures() { structures_.clear(); }
    // Replaces what is drawn on the bone. Throws GlError.
    void setStrokes(const std::vector<Stroke>& strokes) {
        strokes_.set(strokes);
        changes_.forget();
    }
    // Bone shows what is near below its surface from here on.
    void setNearStructures(const NearStructures& near);
    // Makes what a scene's effects need to be drawn, and nothing else. Throws GlError.
    void prepare(const DrawnEffects& needs);
    // As BonePainter::setFaces().
    void setFaces(const CtFaces* faces) { bone_.setFaces(faces); }
    // As BonePainter::setMilledGrey().
    void setMilledGrey(const std::optional<Eigen::Vector2f>& grey_of_density) {
        if (std::exchange(milled_grey_, grey_of_density) != grey_of_density) changes_.forget();
        bone_.setMilledGrey(grey_of_density);
    }
    // Bone looks different in that box (V) from the next picture on.
    void hasChanged(const Eigen::AlignedBox3f& box_V) { look_changed_.push_back(box_V); }
    // Nothing of the last picture is kept for the next one.
    void drawWholeNext() { changes_.forget(); }

    // Returns the nearest surface of bone or tool (W, m) under a pixel of the last picture, counted from its
    // upper left corner; nothing over the background.
    std::optional<Eigen::Vector3d> pick(int x, int y) const;

    // Returns the width and height of the last picture, pixels; 0 before the first.
    Eigen::Vector2i pictureSize() const {
        return targets_ ? Eigen::Vector2i(targets_->width(), targets_->height()) : Eigen::Vector2i::Zero();
    }

    // Returns how many bone triangles were inside the view volume of the last picture.
    size_t trianglesDrawn() const { return bone_.trianglesDrawn(); }

  private:
    // What a picture is drawn of.
    struct Shown {
        const Frame& frame;
        const FrameView& view;
        const NodeStore& nodes;
        const ToolMesh& tool;
    };
    void prepareTargets(const PictureArea& area, Quality quality);
    PictureChanges::Changed takeChanges(const Frame& frame, const FrameView& view, NodeStore& nodes,
                                        const ToolMesh& tool);
    void drawThrough(const Shown& shown);
    void drawKept(const Shown& shown, PictureChanges::Changed changed);
    void updateShadow(const Shown& shown, const Eigen::AlignedBox3f& changed_V, PictureChanges::Dirty& dirty);
    void addShadowed(const Shown& shown, const std::vector<Eigen::AlignedBox3f>& boxes,
                     PixelTiles& tiles) const;
    void drawBone(const Shown& shown, const PixelBox& part);
    void drawLook(const Shown& shown, const PixelTiles& parts);
    void drawTool(const Shown& shown, const PixelTiles& parts);
    void finish(const Frame& frame, const PixelTiles& parts);
    void showFinished(const PictureArea& area, GLuint target) const;
    PixelBox pixelsOf(const Frame& frame, const Eigen::AlignedBox3f& box, const Eigen::Matrix4f& X_CB) const;
    std::vector<PixelBox> shadowPixels(const Frame& frame) const;
    PixelTiles movingPixels(const Frame& frame, const FrameView& view, const ToolMesh& tool);
    void addTool(const Frame& frame, const Eigen::AlignedBox3f& tool_T, const Eigen::Matrix4f& X_CT,
                 PixelTiles& tiles) const;
    static std::vector<float> stillLike(const Frame& frame, const FrameView& view, const ToolMesh& tool);
    void chooseSurface(const FrameView& view);
    void drawOver(const Frame& frame, const FrameView& view, const ToolMesh& tool);
    void drawParticles(const Frame& frame, const FrameView& view);

    const GlApi& gl_;
    BonePainter bone_;
    ToolPainter tool_;
    MarkerPainter markers_;
    FramePasses passes_;
    StructurePainter structures_;
    StrokePainter strokes_;
    StrokePainter drawn_;                         // FrameView::drawn
    bool shows_strokes_ = true;                   // in the last picture
    std::unique_ptr<NearStructurePainter> near_;  // null: nothing is near
    bool shows_thickness_ = false;                // in the last picture
    std::unique_ptr<FilmPainter> film_;
    std::unique_ptr<ParticlePainter> particles_;
    std::unique_ptr<RenderTargets> targets_;
    std::unique_ptr<ShadowMap> shadow_;
    PictureChanges changes_;
    std::vector<Eigen::AlignedBox3f> look_changed_;  // since the last picture, and no triangle with it
    std::optional<Eigen::Vector2f> milled_grey_;
    Camera last_camera_;  // of the last picture, for pick()
    Eigen::Vector2f last_near_far_ = Eigen::Vector2f::Zero();
};

}  // namespace bonemill
