#include "common/mesh/mesh_codec.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "proto/topics.pb.h"

namespace bonemill {
namespace {

// meshoptimizer spends at least one byte on each triangle.
constexpr uint64_t kMaxIndicesPerByte = 3;
// m: no bone is there; what is computed from it stays finite.
constexpr float kFarthest = 1e6f;
constexpr float kLargestStep = 1;

struct Buffers {
    std::vector<PackedVertex> vertices;
    std::vector<uint32_t> indices;
};

Buffers optimised(const NodeMesh& mesh) {
    Buffers b{std::vector<PackedVertex>(mesh.vertices.size()), std::vector<uint32_t>(mesh.indices.size())};
    meshopt_optimizeVertexCache(b.indices.data(), mesh.indices.data(), mesh.indices.size(),
                                mesh.vertices.size());
    const size_t used =
        meshopt_optimizeVertexFetch(b.vertices.data(), b.indices.data(), b.indices.size(),
                                    mesh.vertices.data(), mesh.vertices.size(), sizeof(PackedVertex));
    b.vertices.resize(used);
    return b;
}

std::string codedVertices(const std::vector<PackedVertex>& vertices) {
    std::string out(meshopt_encodeVertexBufferBound(vertices.size(), sizeof(PackedVertex)), '\0');
    out.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(),
                                          vertices.data(), vertices.size(), sizeof(PackedVertex)));
    return out;
}

std::string codedIndices(const Buffers& b) {
    std::string out(meshopt_encodeIndexBufferBound(b.indices.size(), b.vertices.size()), '\0');
    out.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(),
                                         b.indices.data(), b.indices.size()));
    return out;
}

// FNV-1a, 64 bits (Fowler, Noll, Vo).
void hashInto(uint64_t& hash, const void* bytes, size_t size) {
    const auto* byte = static_cast<const unsigned char*>(bytes);
    for (size_t i = 0; i < size; ++i) hash = (hash ^ byte[i]) * 0x100000001b3u;
}

uint64_t contentOf(const topics::NodeMesh& message) {
    uint64_t hash = 0xcbf29ce484222325u;
    const uint32_t revision = message.revision();
    hashInto(hash, &revision, sizeof revision);
    for (const auto* vector : {&message.origin_m(), &message.step_m()})
        hashInto(hash, vector->data(), size_t(vector->size()) * sizeof(float));
    for (const std::string* part : {&message.vertices(), &message.indices()})
        hashInto(hash, part->data(), part->size());
    return hash;
}

std::optional<Eigen::Vector3f> finiteVector(const google::protobuf::RepeatedField<float>& field) {
    if (field.size() != 3) return std::nullopt;
    const Eigen::Vector3f v(field[0], field[1], field[2]);
    if (!v.allFinite()) return std::nullopt;
    return v;
}

bool hasPlausibleCounts(const topics::NodeMesh& message) {
    const uint64_t index_count = message.index_count();
    // Every vertex is named by a triangle, so the indices bound the vertices too.
    return index_count % 3 == 0 && index_count <= kMaxIndicesPerByte * message.indices().size() &&
           message.vertex_count() <= index_count;
}

const unsigned char* unsignedBytes(const std::string& s) {
    return reinterpret_cast<const unsigned char*>(s.data());
}

bool decodeBuffers(const topics::NodeMesh& message, NodeMesh& mesh) {
    if (message.index_count() == 0) return message.vertices().empty() && message.indices().empty();
    mesh.vertices.resize(message.vertex_count());
    mesh.indices.resize(message.index_count());
    if (meshopt_decodeVertexBuffer(mesh.vertices.data(), mesh.vertices.size(), sizeof(PackedVertex),
                                   unsignedBytes(message.vertices()), message.vertices().size()) != 0)
        return false;
    if (meshopt_decodeIndexBuffer(mesh.indices.data(), mesh.indices.size(), sizeof(uint32_t),
                                  unsignedBytes(message.indices()), message.indices().size()) != 0)
        return false;
    return std::ranges::all_of(mesh.indices, [&](uint32_t index) { return index < mesh.vertices.size(); });
}

}  // namespace

EncodedNode encodeNodeMesh(const NodeMesh& mesh, const NodeTag& tag) {
    topics::NodeMesh message;
    message.set_epoch(tag.epoch);
    message.set_batch(tag.batch);
    message.set_batch_nodes(tag.batch_nodes);
    message.set_cut_stamp_ns(tag.cut_stamp_ns);
    message.set_revision(mesh.revision);
    for (int axis = 0; axis < 3; ++axis) {
        message.add_origin_m(mesh.origin[axis]);
        message.add_step_m(mesh.step[axis]);
    }
    if (!mesh.isEmpty()) {
        const Buffers buffers = optimised(mesh);
        message.set_vertex_count(uint32_t(buffers.vertices.size()));
        message.set_index_count(uint32_t(buffers.indices.size()));
        message.set_vertices(codedVertices(buffers.vertices));
        message.set_indices(codedIndices(buffers));
    }
    return {message.SerializeAsString(), contentOf(message)};
}

std::optional<DecodedNode> decodeNodeMesh(std::string_view bytes, uint32_t leaf) {
    topics::NodeMesh message;
    if (bytes.size() > size_t(std::numeric_limits<int>::max())) return std::nullopt;
    if (!message.ParseFromArray(bytes.data(), int(bytes.size()))) return std::nullopt;
    const auto origin = finiteVector(message.origin_m());
    const auto step = finiteVector(message.step_m());
    if (!origin || !step || !hasPlausibleCounts(message)) return std::nullopt;
    if (origin->cwiseAbs().maxCoeff() > kFarthest || step->maxCoeff() > kLargestStep ||
        !(step->minCoeff() > 0))
        return std::nullopt;

    DecodedNode node;
    NodeMesh& mesh = node.mesh;
    mesh.leaf = leaf;
    mesh.revision = message.revision();
    mesh.origin = *origin;
    mesh.step = *step;
    if (!decodeBuffers(message, mesh)) return std::nullopt;
    node.tag = {message.epoch(), message.batch(), message.batch_nodes(), message.cut_stamp_ns()};
    node.content = contentOf(message);
    return node;
}

}  // namespace bonemill
