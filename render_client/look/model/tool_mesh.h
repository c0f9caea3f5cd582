// It is the tool's surface on the GPU, in frame T (m). It belongs to the thread of the context.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "proto/topics.pb.h"
#include "render_client/look/gl/gl_api.h"

namespace bonemill {

// The handpiece that holds the tool is made here, of tubes. It is only drawn: contact knows nothing of it.
//
// Lengths are m in frame T: the tool's axis is y, the hand is at +y. The functions are pure, for any thread.
//
// The shaft ends there; behind it there is room.
struct ShaftEnd {
    float y;
    float radius;
};

// Returns the end of the tool's shaft; nothing where no shaft goes along +y.
std::optional<ShaftEnd> shaftEndOf(const topics::TriangleMesh& tool);

// A tube goes through these places; where the radius is 0 it is closed.
struct TubeStation {
    Eigen::Vector3f center;
    float radius;
};

// Adds the tube's surface, with normals that point outwards and are smooth but at sharp edges.
void addTube(const std::vector<TubeStation>& stations, topics::TriangleMesh* mesh);

// Nothing of it lies nearer to the burr than the shaft's end, but for the sleeve of a drill guide, which
// stands around the shaft's rear part. It is empty for NO_HANDPIECE.
topics::TriangleMesh makeHandpiece(topics::SceneInfo::Handpiece kind, const ShaftEnd& shaft);

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
