// Draws protected structures: what is exposed as solid bodies, what lies behind bone seen through it, like
// glass with an outline. Their surfaces are cut by the cut-planes, as bone is.
//
// It belongs to the thread of the context.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "render_client/look/camera/view_settings.h"
#include "render_client/look/gl/gl_object.h"
#include "render_client/look/model/node_store.h"
#include "render_client/look/paint/frame.h"

namespace bonemill {

class StructurePainter {
  public:
    explicit StructurePainter(const GlApi& gl) : gl_(gl), no_attributes_(gl) {}

    // Replaces the structure that the mesh's leaf names. Throws GlError with the compiler's log when the
    // driver refuses the shader.
    void set(const NodeMesh& mesh);
    void clear();

    // Returns the box (V, m) of structures that look otherwise than in the last call, or came or went.
    Eigen::AlignedBox3f takeChanged(const std::vector<StructureLook>& looks);

    // Draws into the bound framebuffer, which has the bone, uses the stencil's lower bits, and leaves depth
    // test and depth writes on; the depth is then the nearest of bone and exposed structures.
    void draw(const Frame& frame, const std::vector<StructureLook>& looks, GLuint shadow_texture) const;
    // Draws whole bodies, as opaque things are drawn under transparent bone.
    void drawSolid(const Frame& frame, const std::vector<StructureLook>& looks, GLuint shadow_texture) const;

  private:
    struct Shape {
        NodeStore surface;
        Eigen::AlignedBox3f box;  // V, m
        StructureLook look;       // in the last picture
    };
    enum class Part { kBehind, kExposed };
    void drawPart(const Frame& frame, const std::vector<StructureLook>& looks, GLuint shadow_texture,
                  Part part) const;

    void countFaces(const Frame& frame, const Shape& shape) const;
    void drawSections(const Frame& frame, const std::vector<StructureLook>& looks) const;

    const GlApi& gl_;
    std::unique_ptr<Program> program_, section_;  // null: there was no structure yet
    GlVertexArray no_attributes_;
    std::map<uint32_t, Shape> shapes_;
    Eigen::AlignedBox3f changed_;
};

}  // namespace bonemill
