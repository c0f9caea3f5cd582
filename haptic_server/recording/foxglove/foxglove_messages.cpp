#include "haptic_server/recording/foxglove/foxglove_messages.h"

#include <algorithm>

#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr double kArrowPerNewton = 5e-3, kLongestArrow = 50e-3;  // m
constexpr Rgb kForceColor{0.9, 0.2, 0.15};

void setVector(const double (&v)[3], foxglove::Vector3* out) {
    out->set_x(v[0]), out->set_y(v[1]), out->set_z(v[2]);
}

void setQuaternion(const double (&wxyz)[4], foxglove::Quaternion* out) {
    out->set_w(wxyz[0]), out->set_x(wxyz[1]), out->set_y(wxyz[2]), out->set_z(wxyz[3]);
}

void setVector(const Eigen::Vector3d& v, foxglove::Vector3* out) {
    setVector({v.x(), v.y(), v.z()}, out);
}

void setQuaternion(const Eigen::Quaterniond& q, foxglove::Quaternion* out) {
    setQuaternion({q.w(), q.x(), q.y(), q.z()}, out);
}

}  // namespace

void setTime(uint64_t stamp_ns, google::protobuf::Timestamp* out) {
    out->set_seconds(int64_t(stamp_ns / kNsPerSecond));
    out->set_nanos(int32_t(stamp_ns % kNsPerSecond));
}

void setPose(const Pose& pose, foxglove::Pose* out) {
    setVector(pose.position, out->mutable_position());
    setQuaternion(pose.rotation, out->mutable_orientation());
}

void setColor(const Rgb& rgb, foxglove::Color* out) {
    out->set_r(rgb.red), out->set_g(rgb.green), out->set_b(rgb.blue), out->set_a(1);
}

foxglove::PoseInFrame poseInWorld(uint64_t stamp_ns, const double (&p)[3], const double (&q)[4]) {
    foxglove::PoseInFrame message;
    setTime(stamp_ns, message.mutable_timestamp());
    message.set_frame_id("W");
    setVector(p, message.mutable_pose()->mutable_position());
    setQuaternion(q, message.mutable_pose()->mutable_orientation());
    return message;
}

void addTransform(uint64_t stamp_ns, const std::string& parent, const std::string& child, const Pose& pose,
                  foxglove::FrameTransforms* out) {
    foxglove::FrameTransform* const transform = out->add_transforms();
    setTime(stamp_ns, transform->mutable_timestamp());
    transform->set_parent_frame_id(parent);
    transform->set_child_frame_id(child);
    setVector(pose.position, transform->mutable_translation());
    setQuaternion(pose.rotation, transform->mutable_rotation());
}

foxglove::SceneEntity* addEntity(uint64_t stamp_ns, const std::string& frame, const std::string& id,
                                 foxglove::SceneUpdate* out) {
    foxglove::SceneEntity* const entity = out->add_entities();
    setTime(stamp_ns, entity->mutable_timestamp());
    entity->mutable_lifetime();  // 0: for good
    entity->set_frame_id(frame);
    entity->set_id(id);
    entity->set_frame_locked(true);
    return entity;
}

// Its origin is the list's pose, so that the points are short numbers, which pack well.
void addNode(const NodeMesh& mesh, const Rgb& color, foxglove::SceneEntity* out) {
    foxglove::TriangleListPrimitive* const list = out->add_triangles();
    setPose({mesh.origin.cast<double>(), Eigen::Quaterniond::Identity()}, list->mutable_pose());
    setColor(color, list->mutable_color());
    list->mutable_points()->Reserve(int(mesh.vertices.size()));
    for (const PackedVertex& vertex : mesh.vertices) {
        const Eigen::Vector3f p = mesh.step.cwiseProduct(Eigen::Vector3f(vertex.x, vertex.y, vertex.z));
        foxglove::Point3* const point = list->add_points();
        point->set_x(double(p.x())), point->set_y(double(p.y())), point->set_z(double(p.z()));
    }
    list->mutable_indices()->Add(mesh.indices.begin(), mesh.indices.end());
}

void addForceArrow(const Eigen::Vector3d& at, const Eigen::Vector3d& force, foxglove::SceneEntity* out) {
    foxglove::ArrowPrimitive* const arrow = out->add_arrows();
    const double length = std::min(kLongestArrow, force.norm() * kArrowPerNewton);
    setPose({at, rotationBetween(Eigen::Vector3d::UnitX(), force)}, arrow->mutable_pose());
    arrow->set_shaft_length(0.75 * length);
    arrow->set_head_length(0.25 * length);
    arrow->set_shaft_diameter(0.04 * kLongestArrow);
    arrow->set_head_diameter(0.08 * kLongestArrow);
    setColor(kForceColor, arrow->mutable_color());
}

}  // namespace bonemill
