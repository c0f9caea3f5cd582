// Turns node meshes into the bytes on the wire and back: the NodeMesh message of proto/topics_scene.proto,
// whose vertex and index buffers are in meshoptimizer's coding. It is not RT-safe (it allocates), but
// thread-safe.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/geometry/node_mesh.h"

namespace bonemill {

// It goes with a node mesh over the wire (proto/topics_scene.proto, NodeMesh).
struct NodeTag {
    uint64_t epoch = 0;
    uint64_t batch = 0;
    uint32_t batch_nodes = 0;
    int64_t cut_stamp_ns = 0;
};

struct EncodedNode {
    std::string bytes;
    uint64_t content = 0;  // hash of the revision and of the coded surface: equal on both sides of the wire
};

// Returns the serialized NodeMesh message. Vertices and triangles are put in an order that the vertex cache
// likes and that codes well (the same surface, the same winding), vertices that no triangle names are
// dropped; equal meshes give equal bytes. `mesh.indices` must be a multiple of 3 long and smaller than
// vertices.size() each, `mesh.materials` empty or as many as the vertices.
EncodedNode encodeNodeMesh(const NodeMesh& mesh, const NodeTag& tag);

struct DecodedNode {
    NodeMesh mesh;
    NodeTag tag;
    uint64_t content = 0;
};

// Returns what encodeNodeMesh made, or nothing for any bytes that do not hold a whole and valid mesh:
// it never throws on them, and never allocates more than a small multiple of their size. The leaf is
// the topic's key.
std::optional<DecodedNode> decodeNodeMesh(std::string_view bytes, uint32_t leaf);

}  // namespace bonemill
