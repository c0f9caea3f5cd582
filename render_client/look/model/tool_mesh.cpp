#include "render_client/look/model/tool_mesh.h"

#include <algorithm>
#include <stdexcept>

#include "render_client/look/model/handpiece.h"

namespace bonemill {
namespace {

void check(const topics::TriangleMesh& mesh) {
    const auto& positions = mesh.vertices_m();
    const auto vertex_count = uint32_t(positions.size() / 3);
    if (positions.size() % 3 != 0 || mesh.normals_size() != positions.size() || mesh.indices_size() % 3 != 0)
        throw std::invalid_argument("tool mesh: lists of different lengths");
    if (std::ranges::any_of(mesh.indices(), [&](uint32_t i) { return i >= vertex_count; }))
        throw std::invalid_argument("tool mesh: a triangle without its vertex");
}

void append(const topics::TriangleMesh& more, topics::TriangleMesh& mesh) {
    const auto first = uint32_t(mesh.vertices_m_size() / 3);
    mesh.mutable_vertices_m()->MergeFrom(more.vertices_m());
    mesh.mutable_normals()->MergeFrom(more.normals());
    for (const uint32_t index : more.indices()) mesh.add_indices(first + index);
}

Eigen::AlignedBox3f boxOf(const topics::TriangleMesh& mesh) {
    Eigen::AlignedBox3f box;
    const auto& p = mesh.vertices_m();
    for (int i = 0; i < p.size(); i += 3) box.extend(Eigen::Vector3f(p[i], p[i + 1], p[i + 2]));
    return box;
}

}  // namespace

void ToolMesh::set(const topics::TriangleMesh& tool, topics::SceneInfo::Handpiece handpiece) {
    check(tool);
    const auto shaft = shaftEndOf(tool);
    const topics::TriangleMesh behind = shaft ? makeHandpiece(handpiece, *shaft) : topics::TriangleMesh();
    topics::TriangleMesh mesh = tool;
    append(behind, mesh);
    box_ = boxOf(tool);
    full_box_ = boxOf(mesh);
    const auto& positions = mesh.vertices_m();
    const auto& normals = mesh.normals();
    const auto& indices = mesh.indices();
    const GLsizeiptr half = GLsizeiptr(size_t(positions.size()) * sizeof(float));
    std::vector<float> packed(positions.begin(), positions.end());
    packed.insert(packed.end(), normals.begin(), normals.end());

    gl_.BindVertexArray(layout_.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_.name());
    gl_.BufferData(GL_ARRAY_BUFFER, 2 * half, packed.data(), GL_STATIC_DRAW);
    gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
    gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(size_t(indices.size()) * sizeof(uint32_t)),
                   indices.data(), GL_STATIC_DRAW);
    gl_.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl_.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, 0, reinterpret_cast<const void*>(half));
    gl_.EnableVertexAttribArray(0);
    gl_.EnableVertexAttribArray(1);
    gl_.BindVertexArray(0);
    ++revision_;
    tool_indices_ = GLsizei(tool.indices_size());
    all_indices_ = GLsizei(indices.size());
}

void ToolMesh::draw(bool with_handpiece) const {
    gl_.BindVertexArray(layout_.name());
    gl_.DrawElements(GL_TRIANGLES, with_handpiece ? all_indices_ : tool_indices_, GL_UNSIGNED_INT, nullptr);
    gl_.BindVertexArray(0);
}

}  // namespace bonemill
