#include "render_client/look/model/node_store.h"

#include <algorithm>
#include <stdexcept>

#include "render_client/look/model/mesh_difference.h"

namespace bonemill {
namespace {

enum class Sight { kOutside, kPartly, kInside };

// Nothing of the box can be seen when all its corners lie beyond one face of the view volume, and all of it
// lies inside when none does.
Sight sightOf(const Eigen::AlignedBox3f& box, const Eigen::Matrix4f& clip_from_model) {
    Eigen::Matrix<float, 4, 8> corners;
    for (int i = 0; i < 8; ++i) {
        const auto corner = box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(i));
        corners.col(i) = clip_from_model * corner.homogeneous();
    }
    bool is_inside = true;
    for (int axis = 0; axis < 3; ++axis) {
        const auto value = corners.row(axis).array();
        const auto w = corners.row(3).array();
        if ((value > w).all() || (value < -w).all()) return Sight::kOutside;
        is_inside = is_inside && (value <= w).all() && (value >= -w).all();
    }
    return is_inside ? Sight::kInside : Sight::kPartly;
}

}  // namespace

void NodeStore::set(const NodeMesh& mesh) {
    if (mesh.isEmpty()) return remove(mesh.leaf);
    if (*std::max_element(mesh.indices.begin(), mesh.indices.end()) >= mesh.vertices.size()) {
        throw std::invalid_argument("node " + std::to_string(mesh.leaf) + ": a triangle without its vertex");
    }
    if (!mesh.materials.empty() && mesh.materials.size() != mesh.vertices.size())
        throw std::invalid_argument("node " + std::to_string(mesh.leaf) + ": not one material per vertex");
    SortedTriangles sorted = sortedByPlace(mesh);
    Node node{GlVertexArray(gl_),
              GlBuffer(gl_),
              GlBuffer(gl_),
              std::nullopt,
              std::nullopt,
              0,
              boxOf(mesh),
              mesh.origin,
              mesh.step,
              GLsizei(mesh.indices.size()),
              std::move(sorted.parts),
              {}};
    gl_.BindVertexArray(node.layout.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, node.vertices.name());
    const size_t vertex_bytes = mesh.vertices.size() * sizeof(PackedVertex);
    gl_.BufferData(GL_ARRAY_BUFFER, GLsizeiptr(vertex_bytes), mesh.vertices.data(), GL_DYNAMIC_DRAW);
    gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, node.indices.name());
    const size_t index_bytes = mesh.indices.size() * sizeof(uint32_t);
    gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(index_bytes), sorted.indices.data(), GL_DYNAMIC_DRAW);
    ++uploads_.nodes;
    uploads_.bytes += vertex_bytes + index_bytes;
    constexpr GLsizei kStride = sizeof(PackedVertex);
    gl_.VertexAttribPointer(0, 3, GL_UNSIGNED_SHORT, GL_FALSE, kStride, nullptr);
    gl_.VertexAttribPointer(1, 2, GL_BYTE, GL_FALSE, kStride,
                            reinterpret_cast<const void*>(offsetof(PackedVertex, octahedral_u)));
    gl_.EnableVertexAttribArray(0);
    gl_.EnableVertexAttribArray(1);
    if (!mesh.materials.empty()) uploadMaterials(mesh.materials, node);
    gl_.BindVertexArray(0);
    if (tracks_changes_) changed_.extend(changeTo(mesh, node.box));
    if (tracks_changes_ || mesh.revision != 0) node.mesh = mesh;
    nodes_.insert_or_assign(mesh.leaf, std::move(node));
}

// The materials belong to the layout in use. Vertices of other nodes have the attribute's own value,
// 0, which is no material.
void NodeStore::uploadMaterials(const std::vector<uint8_t>& materials, Node& node) {
    node.materials.emplace(gl_);
    gl_.BindBuffer(GL_ARRAY_BUFFER, node.materials->name());
    gl_.BufferData(GL_ARRAY_BUFFER, GLsizeiptr(materials.size()), materials.data(), GL_DYNAMIC_DRAW);
    gl_.VertexAttribPointer(2, 1, GL_UNSIGNED_BYTE, GL_FALSE, 1, nullptr);
    gl_.EnableVertexAttribArray(2);
    uploads_.bytes += materials.size();
}

void NodeStore::setScan(uint32_t leaf, const std::vector<VertexScan>& scan, uint64_t stamp) {
    const auto known = nodes_.find(leaf);
    if (known == nodes_.end()) return;
    Node& node = known->second;
    if (!node.scan) node.scan.emplace(gl_);
    node.scan_stamp = stamp;
    gl_.BindVertexArray(node.layout.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, node.scan->name());
    gl_.BufferData(GL_ARRAY_BUFFER, GLsizeiptr(scan.size() * sizeof(VertexScan)), scan.data(),
                   GL_DYNAMIC_DRAW);
    gl_.VertexAttribPointer(3, 2, GL_UNSIGNED_SHORT, GL_TRUE, sizeof(VertexScan), nullptr);
    gl_.EnableVertexAttribArray(3);
    gl_.BindVertexArray(0);
    changed_.extend(node.box);
}

Eigen::AlignedBox3f NodeStore::changeTo(const NodeMesh& mesh, const Eigen::AlignedBox3f& box) const {
    const auto known = nodes_.find(mesh.leaf);
    if (known == nodes_.end()) return box;
    const Node& before = known->second;
    return before.mesh ? differenceBox(*before.mesh, mesh) : before.box.merged(box);
}

void NodeStore::remove(uint32_t leaf) {
    const auto node = nodes_.find(leaf);
    if (node == nodes_.end()) return;
    changed_.extend(node->second.box);
    nodes_.erase(node);
}

void NodeStore::clear() {
    for (const auto& [leaf, node] : nodes_) changed_.extend(node.box);
    nodes_.clear();
}

size_t NodeStore::triangleCount() const {
    size_t count = 0;
    for (const auto& [leaf, node] : nodes_) count += size_t(node.index_count) / 3;
    return count;
}

size_t NodeStore::draw(const Program& program, const Eigen::Matrix4f& clip_from_V) const {
    const GLint origin = program.uniform("origin");
    const GLint step = program.uniform("step");
    size_t triangles = 0;
    for (const auto& [leaf, node] : nodes_) {
        const Sight sight = sightOf(node.box, clip_from_V);
        if (sight == Sight::kOutside) continue;
        program.set(origin, node.origin);
        program.set(step, node.step);
        gl_.BindVertexArray(node.layout.name());
        triangles += sight == Sight::kInside ? drawRun(0, node.index_count) : drawParts(node, clip_from_V);
    }
    gl_.BindVertexArray(0);
    return triangles;
}

// Parts that lie side by side in the buffer are drawn at once.
size_t NodeStore::drawParts(const Node& node, const Eigen::Matrix4f& clip_from_V) const {
    size_t triangles = 0;
    uint32_t first = 0, end = 0;
    for (const NodePart& part : node.parts) {
        if (sightOf(part.box, clip_from_V) == Sight::kOutside) continue;
        if (part.first != end) {
            triangles += drawRun(first, end - first);
            first = part.first;
        }
        end = part.first + part.count;
    }
    return triangles + drawRun(first, end - first);
}

size_t NodeStore::drawRun(size_t first_index, size_t count) const {
    if (count > 0)
        gl_.DrawElements(GL_TRIANGLES, GLsizei(count), GL_UNSIGNED_INT,
                         reinterpret_cast<const void*>(first_index * sizeof(uint32_t)));
    return count / 3;
}

}  // namespace bonemill
