// Checks what comes off the wire: there is nothing when the bytes are not what the rest of the client may
// rely on. It is thread-safe and never throws on any bytes (other than std::bad_alloc).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/mesh_codec/mesh_codec.h"
#include "proto/topics.pb.h"
#include "render_client/link/density_store/density_store.h"

namespace bonemill {

// The node has at least one triangle. `leaf` and `revision` are those of the sample's envelope.
std::optional<DecodedNode> parseNode(std::span<const uint8_t> payload, uint32_t leaf, uint32_t revision);

// It is a protected structure's surface, as it was scanned.
struct StructureSurface {
    NodeMesh mesh;                // its leaf is the structure: 1 + its index in SceneInfo.materials
    double warning_distance = 0;  // m, above 0
    uint64_t epoch = 0;
    uint64_t change = 0;  // SceneSubscriber::structureChanges() when it came
};
inline constexpr size_t kMaxStructureVertices = 100000;
// All structures of a session together have no more triangles.
inline constexpr size_t kMaxTrianglesOfStructures = 1000000;

// It has at least one triangle, and no more than kMaxStructureVertices; `structure` is that of the sample's
// envelope.
std::optional<StructureSurface> parseStructure(std::span<const uint8_t> payload, uint32_t structure);

// Vectors have their length, numbers are finite, quaternions are of unit length, the tool's triangles name
// vertices; of effects and materials only what a viewer uses, within the ranges of scene files.
std::optional<topics::SceneInfo> parseSceneInfo(std::span<const uint8_t> payload);
std::optional<topics::ToolState> parseToolState(std::span<const uint8_t> payload);
std::optional<topics::Ticks> parseTicks(std::span<const uint8_t> payload);
std::optional<topics::Status> parseStatus(std::span<const uint8_t> payload);
// Names and texts are cut to what stands on a screen; there are 64 scenes at most, with pictures of at most
// 64 KiB, and 256 attempts.
std::optional<topics::Lesson> parseLesson(std::span<const uint8_t> payload);
// `scene` is that of the sample's envelope, one of the 64.
std::optional<topics::ScenePicture> parseScenePicture(std::span<const uint8_t> payload, uint32_t scene);
// It is a note, with one point at most, or a stroke of two points or more; `place` is that of the sample's
// envelope. Texts are cut to what stands on a screen (common/dds/remark_bounds.h).
std::optional<topics::Remark> parseRemark(std::span<const uint8_t> payload, uint32_t place);
// `sender` is that of the sample's envelope. The name is cut to 64 bytes of printable UTF-8; only an
// instructor points.
std::optional<topics::Viewer> parseViewer(std::span<const uint8_t> payload, uint64_t sender);

// Every number is in a range in which a viewer can compute with it, and `air` has a bit for each brick.
bool isUsableGrid(const topics::DensityGrid& grid);

// The grid must be usable.
DensityGrid densityGridOf(const topics::DensityGrid& grid);

// What it holds is still coded.
std::optional<topics::DensityBrick> parseDensityBrick(std::span<const uint8_t> payload);

}  // namespace bonemill
