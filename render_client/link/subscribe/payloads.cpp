#include "render_client/link/subscribe/payloads.h"

#include <algorithm>

#include "common/bounds/message_bounds.h"
#include "common/commands/role_rules.h"
#include "common/config/viewer_effects.h"
#include "common/dds/remark_bounds.h"

namespace bonemill {
namespace {

constexpr int64_t kMaxBricks = 1 << 20;  // of a server's 16³ voxels, a scan of 1600³

int64_t bricksOf(const topics::DensityGrid& grid) {
    int64_t bricks = 1;
    for (const uint32_t voxels : grid.voxels())
        bricks *= (int64_t(voxels) + grid.brick_edge() - 1) / grid.brick_edge();
    return bricks;
}

// Forgets what is no viewer's business, so that nobody relies on it.
void keepShownParts(scene::Material& material) {
    scene::Material kept;
    kept.set_name(material.name());
    if (material.has_color()) kept.mutable_color()->Swap(material.mutable_color());
    kept.set_is_protected(material.is_protected());
    material.Swap(&kept);
    material.DiscardUnknownFields();
}

constexpr size_t kMaxMaterialName = 64;  // bytes
constexpr uint32_t kMaxScenes = 64;

// What the bounds of single fields cannot say: fields that must go together.
bool isConsistent(const topics::TriangleMesh& mesh) {
    const int coordinates = mesh.vertices_m_size();
    const auto vertex_count = static_cast<uint32_t>(coordinates / 3);
    const auto& indices = mesh.indices();
    return coordinates % 3 == 0 && mesh.normals_size() == coordinates && indices.size() % 3 == 0 &&
           std::ranges::all_of(indices, [&](uint32_t index) { return index < vertex_count; });
}

bool isConsistent(const topics::Camera& camera) {
    return !camera.has_target() || camera.target_m_size() == 3;
}

bool isConsistent(const topics::SceneInfo& info) {
    return isConsistent(info.tool()) && isConsistent(info.camera()) && info.burr_balls_m_size() % 4 == 0 &&
           (!info.has_densities() || isUsableGrid(info.densities()));
}

bool isConsistent(const topics::ToolState& state) {
    return state.p_wt_expert_m().empty() == state.q_wt_expert().empty();
}

bool isConsistent(const topics::Remark& remark) {
    const int points = remark.points_m_size() / 3;
    return remark.points_m_size() % 3 == 0 && lettersOf(remark.note()) <= kMaxNoteLetters &&
           (remark.note().empty() ? points >= 2 : points <= 1);
}

bool isConsistent(const topics::Viewer& viewer) {
    return isConsistent(viewer.camera());
}

bool isConsistent(const google::protobuf::Message&) {
    return true;
}

template <class Message>
std::optional<Message> parse(std::span<const uint8_t> payload) {
    Message message;
    if (!parseWithinBounds(payload, message) || !isConsistent(message)) return std::nullopt;
    return message;
}

}  // namespace

bool isUsableGrid(const topics::DensityGrid& grid) {
    if (!isWithinBounds(grid)) return false;
    const int64_t bricks = bricksOf(grid);
    return bricks <= kMaxBricks && int64_t(grid.air().size()) == (bricks + 7) / 8 &&
           grid.value_at_0() < grid.value_at_65535();
}

DensityGrid densityGridOf(const topics::DensityGrid& grid) {
    const auto& n = grid.voxels();
    return {.voxels = {int(n[0]), int(n[1]), int(n[2])},
            .spacing_m = Eigen::Map<const Eigen::Vector3d>(grid.spacing_m().data()),
            .origin_m = Eigen::Map<const Eigen::Vector3d>(grid.origin_m().data()),
            .brick_edge = int(grid.brick_edge()),
            .value_at_0 = grid.value_at_0(),
            .value_at_65535 = grid.value_at_65535(),
            .iso_value = grid.iso_value()};
}

std::optional<topics::DensityBrick> parseDensityBrick(std::span<const uint8_t> payload) {
    topics::DensityBrick brick;
    if (!parseWithinBounds(payload, brick)) return std::nullopt;
    return brick;
}

std::optional<DecodedNode> parseNode(std::span<const uint8_t> payload, uint32_t leaf, uint32_t revision) {
    const std::string_view bytes(reinterpret_cast<const char*>(payload.data()), payload.size());
    std::optional<DecodedNode> node = decodeNodeMesh(bytes, leaf);
    if (!node || node->mesh.isEmpty() || node->mesh.revision != revision || node->tag.epoch == 0)
        return std::nullopt;
    return node;
}

std::optional<StructureSurface> parseStructure(std::span<const uint8_t> payload, uint32_t structure) {
    const auto message = parse<topics::StructureMesh>(payload);
    if (!message || structure == 0 || structure > uint32_t(kMaxVertexMaterials)) return std::nullopt;
    std::optional<DecodedNode> node = decodeNodeMesh(message->surface(), structure);
    if (!node || node->mesh.isEmpty() || node->tag.epoch != message->epoch() ||
        std::max(node->mesh.vertices.size(), node->mesh.indices.size() / 3) > kMaxStructureVertices)
        return std::nullopt;
    return StructureSurface{std::move(node->mesh), message->warning_distance_m(), message->epoch()};
}

std::optional<topics::SceneInfo> parseSceneInfo(std::span<const uint8_t> payload) {
    std::optional<topics::SceneInfo> info = parse<topics::SceneInfo>(payload);
    if (!info) return info;
    if (info->has_viewer_effects()) keepViewerEffects(*info->mutable_viewer_effects());
    for (scene::Material& material : *info->mutable_materials()) {
        keepShownParts(material);
        material.set_name(shownText(material.name(), kMaxMaterialName));
    }
    return info;
}

std::optional<topics::ToolState> parseToolState(std::span<const uint8_t> payload) {
    return parse<topics::ToolState>(payload);
}

std::optional<topics::Ticks> parseTicks(std::span<const uint8_t> payload) {
    return parse<topics::Ticks>(payload);
}

std::optional<topics::Status> parseStatus(std::span<const uint8_t> payload) {
    return parse<topics::Status>(payload);
}

std::optional<topics::Lesson> parseLesson(std::span<const uint8_t> payload) {
    std::optional<topics::Lesson> lesson = parse<topics::Lesson>(payload);
    if (lesson) lesson->DiscardUnknownFields();
    return lesson;
}

std::optional<topics::ScenePicture> parseScenePicture(std::span<const uint8_t> payload, uint32_t scene) {
    std::optional<topics::ScenePicture> picture = parse<topics::ScenePicture>(payload);
    if (!picture || scene >= kMaxScenes) return std::nullopt;
    picture->DiscardUnknownFields();
    return picture;
}

std::optional<topics::Remark> parseRemark(std::span<const uint8_t> payload, uint32_t place) {
    std::optional<topics::Remark> remark = parse<topics::Remark>(payload);
    if (!remark || place >= kMaxRemarks) return std::nullopt;
    remark->DiscardUnknownFields();
    remark->set_color(remark->color() & 0xffffff);
    return remark;
}

std::optional<topics::Viewer> parseViewer(std::span<const uint8_t> payload, uint64_t sender) {
    std::optional<topics::Viewer> viewer = parse<topics::Viewer>(payload);
    if (!viewer || viewer->sender() != sender || sender == 0) return std::nullopt;
    viewer->DiscardUnknownFields();
    if (!mayPoint(viewer->role())) viewer->clear_pointer_m();
    if (!mayHoldTool(viewer->role())) viewer->clear_is_holding();
    return viewer;
}

}  // namespace bonemill
