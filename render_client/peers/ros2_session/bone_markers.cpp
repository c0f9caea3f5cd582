#include "render_client/peers/ros2_session/bone_markers.h"

#include <utility>

namespace bonemill::ros2 {
namespace {

// visualization_msgs/Marker
constexpr int32_t kTriangleList = 11;
constexpr int32_t kAdd = 0, kDelete = 2, kDeleteAll = 3;
constexpr char kNamespace[] = "bone";
constexpr std_msgs_msg_dds__ColorRGBA_ kBoneColour{0.89f, 0.85f, 0.75f, 1};
constexpr size_t kMarkerBytes = 256;  // of what is not points

Point pointOf(const NodeMesh& mesh, uint32_t index) {
    const Eigen::Vector3d p = positionOf(mesh, mesh.vertices[index]).cast<double>();
    return {p.x(), p.y(), p.z()};
}

size_t bytesOf(const NodeMesh& mesh) {
    return kMarkerBytes + mesh.indices.size() * sizeof(Point);
}

}  // namespace

Marker& MarkerPart::add(uint32_t leaf, int32_t action, int64_t stamp_ns) {
    Marker marker{};
    marker.header = headerOf(stamp_ns, kVolumeFrame);
    marker.ns = textOf(kNamespace);
    marker.id = int32_t(leaf);
    marker.type = kTriangleList;
    marker.action = action;
    marker.pose.orientation.w = 1;
    marker.scale = {1, 1, 1};
    marker.color = kBoneColour;
    marker.texture.header.frame_id = textOf("");
    for (char** text : {&marker.texture_resource, &marker.texture.format, &marker.text, &marker.mesh_resource,
                        &marker.mesh_file.filename})
        *text = textOf("");
    markers_.push_back(marker);
    bytes_ += kMarkerBytes;
    return markers_.back();
}

void MarkerPart::forgetAll(int64_t stamp_ns) {
    add(0, kDeleteAll, stamp_ns);
}

void MarkerPart::remove(uint32_t leaf, int64_t stamp_ns) {
    add(leaf, kDelete, stamp_ns);
}

void MarkerPart::show(const NodeMesh& mesh, int64_t stamp_ns) {
    std::vector<Point>& points = points_.emplace_back();
    points.reserve(mesh.indices.size());
    for (const uint32_t index : mesh.indices) points.push_back(pointOf(mesh, index));
    bytes_ += points.size() * sizeof(Point);
    pointAt(add(mesh.leaf, kAdd, stamp_ns).points, points);
}

const MarkerArray& MarkerPart::message() noexcept {
    pointAt(message_.markers, markers_);
    return message_;
}

void BoneMarkers::clear() {
    shown_.clear();
    untold_.clear();
    is_cleared_ = true;
}

void BoneMarkers::take(NodeMesh&& mesh) {
    const uint32_t leaf = mesh.leaf;
    untold_.insert(leaf);
    if (mesh.isEmpty())
        shown_.erase(leaf);
    else
        shown_.insert_or_assign(leaf, std::move(mesh));
}

void BoneMarkers::tellAnew() {
    for (const auto& [leaf, mesh] : shown_) untold_.insert(leaf);
}

bool BoneMarkers::takePart(MarkerPart& part, int64_t stamp_ns) {
    if (!hasUntold()) return false;
    if (std::exchange(is_cleared_, false)) part.forgetAll(stamp_ns);
    while (!untold_.empty()) {
        const uint32_t leaf = *untold_.begin();
        const auto found = shown_.find(leaf);
        if (found != shown_.end() && part.bytes() > kMarkerBytes &&
            part.bytes() + bytesOf(found->second) > kPartBytes)
            break;
        untold_.erase(untold_.begin());
        if (found == shown_.end())
            part.remove(leaf, stamp_ns);
        else
            part.show(found->second, stamp_ns);
    }
    return true;
}

}  // namespace bonemill::ros2
