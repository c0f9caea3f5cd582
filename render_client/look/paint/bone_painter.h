// Draws the bone, whole or cut, opaque or transparent.
//
// Where a cut opens solid bone its cap is drawn: a ray that reaches a back face first was inside the bone
// already when it came through the plane. This holds for a closed surface; where the scan's border leaves it
// open, and where the eye itself is inside, the back face is shown in dark red.
//
// Of transparent bone one sees the nearest layers from outside and from inside, and the farthest wall that
// can be looked at. Each is found by depth and blended once, which gives the same picture in whatever order
// the triangles come. The tool is drawn between them.
//
// It belongs to the thread of the context.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "render_client/look/gl/gl_api.h"
#include "render_client/look/model/material_palette.h"
#include "render_client/look/model/node_store.h"
#include "render_client/look/paint/frame.h"
#include "render_client/look/paint/picture_parts.h"
#include "render_client/look/paint/scan_painters.h"
#include "render_client/look/paint/surface_maps.h"
#include "render_client/look/structures/near_structures.h"
#include "render_client/look/visual_effects/surface_film.h"

namespace bonemill {

// What lies on the bone, as a texture.
//
// It belongs to the thread of the context.
class FilmPainter {
  public:
    explicit FilmPainter(const GlApi& gl);

    // Uploads the slices that changed. Returns the boxes (V) in which the bone looks different now.
    std::vector<Eigen::AlignedBox3f> update(const EffectPicture& picture);
    // The program (with FILM) must be in use.
    void setUniforms(const Program& program) const;

  private:
    const GlApi& gl_;
    GlTexture texture_;
    float period_ = 1;
    Eigen::AlignedBox3f shown_;
    Eigen::Vector4f strength_ = Eigen::Vector4f::Zero();
    Eigen::Vector3f blood_colour_ = Eigen::Vector3f::Zero();
};

// The structures near below the bone's surface, as a texture: they shine through, or the bone shows how far
// it is to the next of them.
//
// It belongs to the thread of the context.
class NearStructurePainter {
  public:
    // There is at least one sample.
    NearStructurePainter(const GlApi& gl, const NearStructures& near);

    // The program (with NEAR_STRUCTURES) must be in use.
    void setUniforms(const Program& program, bool shows_thickness) const;

  private:
    const GlApi& gl_;
    GlTexture texture_;
    Eigen::Vector3f first_V_, extent_;  // m, of the texture
    float reach_;                       // m
};

class BonePainter {
  public:
    // Throws GlError with the compiler's log when the driver refuses a shader.
    explicit BonePainter(const GlApi& gl);

    // Both draw into the layer's picture, whose depth and stencil are clear, and leave it bound, with depth
    // test and depth writes on. drawOpaque() draws that part, and leaves the scissor around it. draw_tool
    // draws opaque things. They throw GlError with the compiler's log when the driver refuses the surface's
    // shader with what it is to show for the first time.
    void drawOpaque(const Frame& frame, const NodeStore& nodes, const BoneLayer& layer, const PixelBox& part,
                    GLuint shadow_texture);
    void drawTransparent(const Frame& frame, const NodeStore& nodes, const BoneLayer& layer,
                         GLuint shadow_texture, double opacity, const std::function<void()>& draw_tool);

    // Shades those parts of the layer once more, over what draw_under draws of each, as drawOpaque() left it
    // without cut-planes: the bone has kept its shape there. Leaves the layer's picture bound, and its depth
    // as it is. Parts may overlap.
    void shadeAgain(const Frame& frame, const BoneLayer& layer, GLuint shadow_texture,
                    const std::vector<PixelBox>& parts,
                    const std::function<void(const PixelBox&)>& draw_under);

    // From now on bone has these colours (vertexColoursOf()).
    void setPalette(const std::vector<Eigen::Vector4f>& colours);
    // From now on bone is drawn with this film, or as it is when null. The film must outlive its use.
    void setFilm(const FilmPainter* film) { film_ = film; }
    // From now on the faces of cuts show the scan, or are plain when null. They must outlive their use.
    void setFaces(const CtFaces* faces) { faces_ = faces; }
    // From now on milled bone has the grey of what the scan measured there (greyOfDensity()), or its own
    // colour.
    void setMilledGrey(const std::optional<Eigen::Vector2f>& grey_of_density) {
        milled_grey_ = grey_of_density;
    }

    // From now on bone shows what is near below its surface, or its own looks alone when null. It must
    // outlive its use.
    void setNearStructures(const NearStructurePainter* near) { near_ = near; }
    // Whether that is how far it is to the next structure, and not what shines through. No film lies on it.
    void showThickness(bool shows_thickness) { shows_thickness_ = shows_thickness; }

    // Returns how many bone triangles were inside the view volume of the last picture.
    size_t trianglesDrawn() const { return triangles_drawn_; }

  private:
    struct Look {
        Eigen::Vector2f opacity;  // facing the eye, and what the outline adds
        Eigen::Vector3f inside;   // linear colour of the surface seen from within
    };
    // Where bone is drawn, and in which light.
    struct Canvas {
        const Frame& frame;
        const BoneLayer& layer;
        GLuint shadow_texture;
    };
    struct Place : Canvas {
        const NodeStore& nodes;
    };
    bool hasFilm() const { return film_ && !(near_ && shows_thickness_); }
    const Program& shading(const SurfaceMaps& maps);
    void drawSurface(const Place& place, const Look& look);
    void clearMaps(const BoneLayer& layer) const;
    void gather(const Place& place);
    const Program& prepareShading(const Canvas& canvas, const Look& look);
    void blendShaded(const Program& shading) const;
    void drawDepth(const Place& place) const;
    void drawFarWall(const Place& place);
    void drawInnerWall(const Place& place);
    void findNearestLayer(const Place& place, GLenum culled) const;
    void drawFoundLayer(const Place& place, const Look& look);
    void markOpened(const Place& place) const;
    void beginMarking() const;
    void drawCap(const Place& place, float opacity) const;
    void drawFullScreen() const;

    const GlApi& gl_;
    Program depth_, surface_, cap_;
    // By what bone shows (shading()); null until it is shown first.
    std::array<std::unique_ptr<Program>, 8> shadings_;
    GlVertexArray no_attributes_;
    std::unique_ptr<MaterialPalette> palette_;
    const FilmPainter* film_ = nullptr;
    const CtFaces* faces_ = nullptr;
    std::optional<Eigen::Vector2f> milled_grey_;
    const NearStructurePainter* near_ = nullptr;
    bool shows_thickness_ = false;
    size_t triangles_drawn_ = 0;
};

}  // namespace bonemill
