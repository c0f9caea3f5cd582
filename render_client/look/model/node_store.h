// The bone is on the graphics card as one vertex and one index buffer per octree leaf, drawn in ascending
// order of the leaf.
//
// It belongs to the thread of the context. The same nodes give the same picture in whatever
// order they arrived.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "common/geometry/node_mesh.h"
#include "render_client/look/gl/gl_api.h"

namespace bonemill {

// Returns the box (V, m) around the triangles that only one of them has; it is empty when both show the same.
Eigen::AlignedBox3f differenceBox(const NodeMesh& before, const NodeMesh& after);

// Returns the box (V, m) around all triangles.
Eigen::AlignedBox3f boxOf(const NodeMesh& mesh);

// A node's triangles by place, so that a picture of a small part of the bone need not draw whole nodes. It is
// for any thread.
struct NodePart {
    uint32_t first = 0, count = 0;  // of the sorted indices
    Eigen::AlignedBox3f box;        // around them (V, m)
};

struct SortedTriangles {
    std::vector<uint32_t> indices;  // 3 per triangle: those of the mesh in another order
    std::vector<NodePart> parts;    // one after the other, without gaps; none is empty
};

// Sorts the triangles by the cell of a coarse grid that their first vertex lies in, and keeps their order
// within a cell. Each index must have its vertex.
SortedTriangles sortedByPlace(const NodeMesh& mesh);

// This went to the graphics card since the start.
struct UploadCount {
    uint64_t nodes = 0;
    uint64_t bytes = 0;
};

class NodeStore {
  public:
    explicit NodeStore(const GlApi& gl) : gl_(gl) {}

    // Replaces the leaf's mesh; an empty one removes it. Throws std::invalid_argument when an index has no
    // vertex or the materials are not as many as the vertices.
    void set(const NodeMesh& mesh);
    void clear();

    // Gives the nodes of the leaves from this one on to another store of the same context.
    void giveFrom(uint32_t first_leaf, NodeStore& other);

    size_t nodeCount() const { return nodes_.size(); }
    size_t triangleCount() const;
    const UploadCount& uploads() const { return uploads_; }

    // Returns the box (V, m) around the triangles that came or went since the last call.
    Eigen::AlignedBox3f takeChanged() { return std::exchange(changed_, {}); }
    // Returns that around all there are.
    Eigen::AlignedBox3f box() const;

    // What the scan measured at a vertex, and whether milling opened it there: 0, or 65535 for yes.
    struct VertexScan {
        uint16_t density;
        uint16_t is_milled;
    };
    // Calls visit(mesh, box, stamp) for each node whose surface is not the scan's any more; the stamp is that
    // of setScan(), 0 since the mesh came.
    template <class Visit>
    void visitMilled(Visit&& visit) const {
        for (const auto& [leaf, node] : nodes_)
            if (node.mesh.revision != 0) visit(node.mesh, node.box, node.scan_stamp);
    }
    // Gives each vertex of that node what the scan measured, until another mesh comes.
    void setScan(uint32_t leaf, const std::vector<VertexScan>& scan, uint64_t stamp);

    // Draws what may be inside the view volume of clip_from_V with the program in use (uniforms origin and
    // step), the nearest first: what it hides is not drawn. Returns the number of triangles drawn.
    size_t draw(const Program& program, const Eigen::Matrix4f& clip_from_V) const;

  private:
    struct Node {
        GlVertexArray layout;
        GlBuffer vertices;
        GlBuffer indices;
        std::optional<GlBuffer> materials;
        std::optional<GlBuffer> scan;
        uint64_t scan_stamp = 0;
        Eigen::AlignedBox3f box;  // V, m
        Eigen::Vector3f origin;   // V, m
        Eigen::Vector3f step;     // V, m
        GLsizei index_count;
        std::vector<NodePart> parts;
        NodeMesh mesh;  // what the buffers hold
    };
    void remove(uint32_t leaf);
    std::vector<const Node*> fromTheEye(const Eigen::Matrix4f& clip_from_V) const;
    size_t drawParts(const Node& node, const Eigen::Matrix4f& clip_from_V) const;
    size_t drawRun(size_t first_index, size_t count) const;
    void uploadMaterials(const std::vector<uint8_t>& materials, Node& node);
    Eigen::AlignedBox3f changeTo(const NodeMesh& mesh, const Eigen::AlignedBox3f& box) const;

    const GlApi& gl_;
    std::map<uint32_t, Node> nodes_;
    UploadCount uploads_;
    Eigen::AlignedBox3f changed_;
};

}  // namespace bonemill
