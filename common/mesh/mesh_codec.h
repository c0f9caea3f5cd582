// Node meshes to and from the bytes on the wire: the NodeMesh message of proto/topics.proto, whose vertex and
// index buffers are in meshoptimizer's coding. Not RT-safe (allocates); thread-safe.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/geometry/node_mesh.h"

namespace bonemill {

// Serialized NodeMesh message. Vertices and triangles are put in an order that the vertex cache likes and
// that codes well (the same surface, the same winding), vertices that no triangle names are dropped; equal
// meshes give equal bytes. `mesh.indices` must be a multiple of 3 long and smaller than vertices.size() each.
std::string encodeNodeMesh(const NodeMesh& mesh, uint64_t epoch);

// What encodeNodeMesh made, or nothing (epoch untouched) for any bytes that do not hold a whole and valid
// mesh: never throws on them, never allocates more than a small multiple of their size. The leaf is the
// topic's key.
std::optional<NodeMesh> decodeNodeMesh(std::string_view bytes, uint32_t leaf, uint64_t& epoch);

}  // namespace bonemill
