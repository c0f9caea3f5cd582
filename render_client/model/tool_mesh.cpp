#include "render_client/model/tool_mesh.h"

#include <algorithm>
#include <stdexcept>

namespace bonemill {

void ToolMesh::set(const topics::TriangleMesh& mesh) {
    const auto& positions = mesh.vertices_m();
    const auto& normals = mesh.normals();
    const auto& indices = mesh.indices();
    const auto vertex_count = uint32_t(positions.size() / 3);
    if (positions.size() % 3 != 0 || normals.size() != positions.size() || indices.size() % 3 != 0) {
        throw std::invalid_argument("tool mesh: lists of different lengths");
    }
    if (std::any_of(indices.begin(), indices.end(), [&](uint32_t i) { return i >= vertex_count; })) {
        throw std::invalid_argument("tool mesh: a triangle without its vertex");
    }
    box_.setEmpty();
    for (int i = 0; i < positions.size(); i += 3) {
        box_.extend(Eigen::Vector3f(positions[i], positions[i + 1], positions[i + 2]));
    }
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
    index_count_ = GLsizei(indices.size());
}

void ToolMesh::draw() const {
    gl_.BindVertexArray(layout_.name());
    gl_.DrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
    gl_.BindVertexArray(0);
}

}  // namespace bonemill
