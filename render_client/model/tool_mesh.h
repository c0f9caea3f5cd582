// It is the tool's surface on the GPU, in frame T (m). It belongs to the thread of the context.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "proto/topics.pb.h"
#include "render_client/gl/gl_object.h"

namespace bonemill {

class ToolMesh {
  public:
    explicit ToolMesh(const GlApi& gl) : gl_(gl), layout_(gl), vertices_(gl), indices_(gl) {}

    // Throws std::invalid_argument when the lists do not fit together; the old mesh stays then.
    void set(const topics::TriangleMesh& mesh);

    bool isEmpty() const { return index_count_ == 0; }
    const Eigen::AlignedBox3f& box() const { return box_; }  // T, m; empty without a mesh
    void draw() const;

  private:
    const GlApi& gl_;
    GlVertexArray layout_;
    GlBuffer vertices_;
    GlBuffer indices_;
    GLsizei index_count_ = 0;
    Eigen::AlignedBox3f box_;
};

}  // namespace bonemill
