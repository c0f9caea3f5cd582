// Parts of Foxglove's messages. Thread-safe; they allocate.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "common/geometry/node_mesh.h"
#include "common/geometry/pose.h"
#include "proto/foxglove.pb.h"
#include "proto/panels.pb.h"

namespace bonemill {

// Of a tick's pose, q is w, x, y, z: its numbers become the message's, bit for bit.
foxglove::PoseInFrame poseInWorld(uint64_t stamp_ns, const double (&p)[3], const double (&q)[4]);
void addTransform(uint64_t stamp_ns, const std::string& parent, const std::string& child, const Pose& pose,
                  foxglove::FrameTransforms* out);

void setTime(uint64_t stamp_ns, google::protobuf::Timestamp* out);
void setPose(const Pose& pose, foxglove::Pose* out);

struct Rgb {
    double red, green, blue;
};
void setColor(const Rgb& rgb, foxglove::Color* out);

// A new entity that stands until another one of its id comes.
foxglove::SceneEntity* addEntity(uint64_t stamp_ns, const std::string& frame, const std::string& id,
                                 foxglove::SceneUpdate* out);
// The surface of one node, in V.
void addNode(const NodeMesh& mesh, const Rgb& color, foxglove::SceneEntity* out);
// From `at` along the force (N), so that a newton is 5 mm, and no longer than 10 N.
void addForceArrow(const Eigen::Vector3d& at, const Eigen::Vector3d& force, foxglove::SceneEntity* out);

}  // namespace bonemill
