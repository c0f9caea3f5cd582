// Painters of what is in the bone, and on it: structures and strokes. They belong to the thread of the
// context.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "render_client/look/camera/view_settings.h"
#include "render_client/look/gl/gl_api.h"
#include "render_client/look/model/node_store.h"
#include "render_client/look/paint/bone_painter.h"
#include "render_client/look/paint/frame.h"

namespace bonemill {

// Draws protected structures: what is exposed as solid bodies, what lies behind bone seen through it, like
// glass with an outline. Their surfaces are cut by the cut-planes, as bone is.
class StructurePainter {
  public:
    explicit StructurePainter(const GlApi& gl) : gl_(gl), no_attributes_(gl) {}

    // Replaces the structure that the mesh's leaf names. Throws GlError with the compiler's log when the
    // driver refuses the shader.
    void set(const NodeMesh& mesh);
    void clear();
    // From now on they are red where this film has bruises, or nowhere when null. It must outlive its use.
    void setFilm(const FilmPainter* film) { film_ = film; }

    // Returns the box (V, m) of structures that look otherwise than in the last call, or came or went. How
    // far one has risen makes no difference while none of it was seen.
    Eigen::AlignedBox3f takeChanged(const std::vector<StructureLook>& looks);

    // Draws into the bound framebuffer, which has the bone, uses the stencil's lower bits, and leaves depth
    // test and depth writes on; the depth is then the nearest of bone and exposed structures.
    void draw(const Frame& frame, const std::vector<StructureLook>& looks, GLuint shadow_texture) const;
    // Draws what is exposed once more over bone of the same shape, from which no cut-plane takes anything.
    void drawAgain(const Frame& frame, const std::vector<StructureLook>& looks, GLuint shadow_texture) const;
    // Draws whole bodies, as opaque things are drawn under transparent bone.
    void drawSolid(const Frame& frame, const std::vector<StructureLook>& looks, GLuint shadow_texture) const;

  private:
    struct Shape {
        NodeStore surface;
        Eigen::AlignedBox3f box;  // V, m
        StructureLook look;       // in the last picture
        GlQuery sight;            // asks whether some of its open surface was drawn
        mutable bool is_asked = false;
        bool is_whole = true, is_seen = false;  // is_whole: its box was drawn anew
    };
    enum class Part { kBehind, kExposed, kExposedAgain };
    void drawPart(const Frame& frame, const std::vector<StructureLook>& looks, GLuint shadow_texture,
                  Part part) const;

    bool isSeen(Shape& shape) const;
    void countFaces(const Frame& frame, const Shape& shape) const;
    void drawSections(const Frame& frame, const std::vector<StructureLook>& looks) const;

    const Program& surface() const { return film_ ? *bruised_ : *program_; }

    const GlApi& gl_;
    std::unique_ptr<Program> program_, bruised_, section_;  // null: there was no structure yet
    const FilmPainter* film_ = nullptr;
    GlVertexArray no_attributes_;
    std::map<uint32_t, Shape> shapes_;
    Eigen::AlignedBox3f changed_;
};

// Draws what people drew on the bone as lines of a constant width, and where a note belongs as a dot. They
// lie a little before the surface that they were drawn on, and are hidden by what is in front of them.
// The frames are W (world) and C (camera); the unit is m.
class StrokePainter {
  public:
    explicit StrokePainter(const GlApi& gl);

    // Replaces all strokes.
    void set(const std::vector<Stroke>& strokes);
    // Draws into the bound framebuffer, whose depth it reads and leaves as it is.
    void draw(const Frame& frame, const FrameView& view) const;
    // Returns the box (C) around a stroke as it is drawn.
    static Eigen::AlignedBox3f box(const Stroke& stroke, const Frame& frame, const FrameView& view);

  private:
    struct Point {
        Eigen::Vector3f p_W, colour;
        float half_width;  // picture heights, of the line to the next point; 0: there is none
    };

    const GlApi& gl_;
    Program program_;
    GlVertexArray layout_;
    GlBuffer buffer_;
    GLsizei lines_ = 0;
};

}  // namespace bonemill
