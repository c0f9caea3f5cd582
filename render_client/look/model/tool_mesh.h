// It is the tool's surface on the GPU, in frame T (m). It belongs to the thread of the context.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "proto/topics.pb.h"
#include "render_client/look/gl/gl_object.h"

namespace bonemill {

class ToolMesh {
  public:
    explicit ToolMesh(const GlApi& gl) : gl_(gl), layout_(gl), vertices_(gl), indices_(gl) {}

    // Takes the tool, and which handpiece holds it. Throws std::invalid_argument when the lists do not fit
    // together; the old mesh stays then.
    void set(const topics::TriangleMesh& tool, topics::SceneInfo::Handpiece handpiece);

    uint32_t revision() const { return revision_; }  // counts the tools that were set

    bool isEmpty() const { return tool_indices_ == 0; }
    // Returns the box around the tool, or around all; T, m; empty without a mesh.
    const Eigen::AlignedBox3f& box() const { return box_; }
    const Eigen::AlignedBox3f& box(bool with_handpiece) const { return with_handpiece ? full_box_ : box_; }
    void draw(bool with_handpiece = false) const;

  private:
    const GlApi& gl_;
    GlVertexArray layout_;
    GlBuffer vertices_;
    GlBuffer indices_;
    uint32_t revision_ = 0;
    GLsizei tool_indices_ = 0, all_indices_ = 0;  // the tool's come first
    Eigen::AlignedBox3f box_, full_box_;
};

}  // namespace bonemill
