// The bone's surface in pieces of a size that a peer can replace: the octree's nodes, sorted into a grid over
// the bone. A piece changes when one of its nodes does. For one thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <unordered_map>

#include "common/geometry/node_mesh.h"
#include "common/igtl_wire/igtl_port.h"
#include "proto/topics.pb.h"
#include "render_client/link/subscribe/scene_model.h"

namespace bonemill::igtl {

class BonePieces {
  public:
    static constexpr int kPerAxis = 4, kCount = kPerAxis * kPerAxis * kPerAxis;

    // Where the bone lies: another place than before sorts and places everything anew.
    void place(const topics::SceneInfo& info);
    void apply(SceneModel::Changes&& changes);

    // It counts up with each change; 0: there never was anything in it.
    uint32_t revision(int piece) const { return pieces_[size_t(piece)].revision; }
    // POLYDATA "bonemill_bone_NN": the piece as it is now, in RAS. It is made once for all who want it at a
    // time. There is a place.
    Blob frame(int piece, int64_t unix_ns);

  private:
    struct Piece {
        std::set<uint32_t> leaves;
        uint32_t revision = 0;
        uint32_t made_revision = 0;
        std::weak_ptr<const std::string> made;
    };
    struct Node {
        NodeMesh mesh;
        size_t piece;
    };
    size_t pieceOf(const Eigen::Vector3d& p_V) const;
    void put(NodeMesh&& mesh);
    void remove(uint32_t leaf);
    void sortAnew();

    std::optional<Pose> X_WV_;
    Eigen::Vector3d low_V_ = Eigen::Vector3d::Zero(), high_V_ = Eigen::Vector3d::Zero();
    std::unordered_map<uint32_t, Node> nodes_;
    std::array<Piece, kCount> pieces_;
};

Pose poseOf(const google::protobuf::RepeatedField<double>& p_m,
            const google::protobuf::RepeatedField<double>& q);

}  // namespace bonemill::igtl
