#include "render_client/look/model/node_store.h"

#include <algorithm>
#include <array>
#include <bit>
#include <stdexcept>
#include <utility>

namespace bonemill {
namespace {

struct Corner {
    PackedVertex vertex;
    uint8_t material;
};
using Triangle = std::array<Corner, 3>;

std::pair<uint64_t, uint8_t> keyOf(const Corner& corner) {
    return {std::bit_cast<uint64_t>(corner.vertex), corner.material};
}

Corner cornerOf(const NodeMesh& mesh, uint32_t index) {
    return {mesh.vertices[index], mesh.materials.empty() ? uint8_t(0) : mesh.materials[index]};
}

bool isBefore(const Triangle& a, const Triangle& b) {
    for (size_t i = 0; i < 3; ++i)
        if (keyOf(a[i]) != keyOf(b[i])) return keyOf(a[i]) < keyOf(b[i]);
    return false;
}

// Each triangle begins with its smallest corner: the same one is the same, however it was numbered.
std::vector<Triangle> sortedTriangles(const NodeMesh& mesh) {
    std::vector<Triangle> triangles(mesh.indices.size() / 3);
    for (size_t n = 0; n < triangles.size(); ++n) {
        Triangle& t = triangles[n];
        for (size_t i = 0; i < 3; ++i) t[i] = cornerOf(mesh, mesh.indices[3 * n + i]);
        const auto first =
            std::min_element(t.begin(), t.end(), [](auto& a, auto& b) { return keyOf(a) < keyOf(b); });
        std::rotate(t.begin(), first, t.end());
    }
    std::sort(triangles.begin(), triangles.end(), isBefore);
    return triangles;
}

constexpr int kCells = 4;  // of the grid, along each axis of the node
constexpr size_t kAllCells = size_t(kCells) * kCells * kCells;

class PlaceGrid {
  public:
    explicit PlaceGrid(const NodeMesh& mesh) : mesh_(mesh) {
        for (const PackedVertex& v : mesh.vertices) box_.extend(Eigen::Vector3i(v.x, v.y, v.z));
    }
    size_t cellOf(uint32_t vertex) const {
        const PackedVertex& v = mesh_.vertices[vertex];
        const Eigen::Array3i at = Eigen::Array3i(v.x, v.y, v.z) - box_.min().array();
        const Eigen::Array3i cell = at * kCells / (box_.sizes().array() + 1);
        return (size_t(cell.z()) * kCells + size_t(cell.y())) * kCells + size_t(cell.x());
    }

  private:
    const NodeMesh& mesh_;
    Eigen::AlignedBox3i box_;  // in steps
};

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

Eigen::AlignedBox3f boxOf(const NodeMesh& mesh) {
    Eigen::AlignedBox3f box;
    for (const PackedVertex& vertex : mesh.vertices) box.extend(positionOf(mesh, vertex));
    return box;
}

Eigen::AlignedBox3f differenceBox(const NodeMesh& before, const NodeMesh& after) {
    if (before.origin != after.origin || before.step != after.step) return boxOf(before).merged(boxOf(after));
    const std::vector<Triangle> old_ones = sortedTriangles(before), new_ones = sortedTriangles(after);
    std::vector<Triangle> different;
    std::set_symmetric_difference(old_ones.begin(), old_ones.end(), new_ones.begin(), new_ones.end(),
                                  std::back_inserter(different), isBefore);
    Eigen::AlignedBox3f box;
    for (const Triangle& triangle : different)
        for (const Corner& corner : triangle) box.extend(positionOf(after, corner.vertex));
    return box;
}

SortedTriangles sortedByPlace(const NodeMesh& mesh) {
    const PlaceGrid grid(mesh);
    const size_t count = mesh.indices.size() / 3;
    std::vector<uint8_t> cells(count);
    std::array<uint32_t, kAllCells + 1> first{};
    for (size_t t = 0; t < count; ++t) {
        cells[t] = uint8_t(grid.cellOf(mesh.indices[3 * t]));
        first[cells[t] + size_t(1)] += 3;
    }
    for (size_t cell = 0; cell < kAllCells; ++cell) first[cell + 1] += first[cell];
    SortedTriangles sorted;
    sorted.indices.resize(3 * count);
    std::array<Eigen::AlignedBox3f, kAllCells> boxes;
    auto place = first;
    for (size_t t = 0; t < count; ++t)
        for (size_t i = 3 * t; i < 3 * t + 3; ++i) {
            sorted.indices[place[cells[t]]++] = mesh.indices[i];
            boxes[cells[t]].extend(positionOf(mesh, mesh.vertices[mesh.indices[i]]));
        }
    for (size_t cell = 0; cell < kAllCells; ++cell)
        if (first[cell + 1] > first[cell])
            sorted.parts.push_back({first[cell], first[cell + 1] - first[cell], boxes[cell]});
    return sorted;
}

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
              mesh};
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
    changed_.extend(changeTo(mesh, node.box));
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
    return differenceBox(known->second.mesh, mesh);
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

void NodeStore::giveFrom(uint32_t first_leaf, NodeStore& other) {
    for (auto node = nodes_.lower_bound(first_leaf); node != nodes_.end();) {
        changed_.extend(node->second.box);
        other.remove(node->first);
        other.nodes_.insert(nodes_.extract(node++));
    }
}

Eigen::AlignedBox3f NodeStore::box() const {
    Eigen::AlignedBox3f box;
    for (const auto& [leaf, node] : nodes_) box.extend(node.box);
    return box;
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
    for (const Node* node : fromTheEye(clip_from_V)) {
        const Sight sight = sightOf(node->box, clip_from_V);
        if (sight == Sight::kOutside) continue;
        program.set(origin, node->origin);
        program.set(step, node->step);
        gl_.BindVertexArray(node->layout.name());
        triangles += sight == Sight::kInside ? drawRun(0, node->index_count) : drawParts(*node, clip_from_V);
    }
    gl_.BindVertexArray(0);
    return triangles;
}

std::vector<const NodeStore::Node*> NodeStore::fromTheEye(const Eigen::Matrix4f& clip_from_V) const {
    std::vector<const Node*> nodes;
    nodes.reserve(nodes_.size());
    for (const auto& [leaf, node] : nodes_) nodes.push_back(&node);
    std::ranges::stable_sort(nodes, {}, [&](const Node* node) {
        return clip_from_V.row(3).dot(node->box.center().homogeneous());
    });
    return nodes;
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
