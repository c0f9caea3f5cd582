#include "render_client/peers/igtl_session/bone_pieces.h"

#include <algorithm>
#include <utility>

#include "common/igtl_wire/igtl_messages.h"
#include "render_client/peers/igtl_session/patient_axes.h"

namespace bonemill::igtl {
namespace {

Eigen::Vector3d vectorOf(const google::protobuf::RepeatedField<double>& numbers) {
    return {numbers[0], numbers[1], numbers[2]};
}

void add(const NodeMesh& mesh, const Eigen::Isometry3d& ras_of_V, Surface& surface) {
    const auto first = uint32_t(surface.points.size());
    for (const PackedVertex& vertex : mesh.vertices) {
        const Eigen::Vector3d p_V = positionOf(mesh, vertex).cast<double>();
        surface.points.push_back((ras_of_V * (p_V * kPerMillimetre)).cast<float>());
        const Eigen::Vector3f normal_V = decodeNormal(vertex.octahedral_u, vertex.octahedral_v);
        surface.normals.push_back((ras_of_V.linear() * normal_V.cast<double>()).cast<float>());
    }
    for (const uint32_t index : mesh.indices) surface.triangles.push_back(first + index);
}

}  // namespace

Pose poseOf(const google::protobuf::RepeatedField<double>& p_m,
            const google::protobuf::RepeatedField<double>& q) {
    return {vectorOf(p_m), Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
}

void BonePieces::place(const topics::SceneInfo& info) {
    const Pose X_WV = poseOf(info.p_wv_m(), info.q_wv());
    const Eigen::Vector3d low = vectorOf(info.bone_min_m()), high = vectorOf(info.bone_max_m());
    if (X_WV_ && X_WV_->position == X_WV.position && X_WV_->rotation.coeffs() == X_WV.rotation.coeffs() &&
        low == low_V_ && high == high_V_)
        return;
    X_WV_ = X_WV;
    low_V_ = low;
    high_V_ = high;
    sortAnew();
}

void BonePieces::sortAnew() {
    for (Piece& piece : pieces_) {
        piece.revision += !piece.leaves.empty();
        piece.leaves.clear();
    }
    for (auto& [leaf, node] : nodes_) {
        node.piece = pieceOf(node.mesh.origin.cast<double>());
        pieces_[node.piece].leaves.insert(leaf);
        ++pieces_[node.piece].revision;
    }
}

size_t BonePieces::pieceOf(const Eigen::Vector3d& p_V) const {
    size_t piece = 0;
    for (int axis = 2; axis >= 0; --axis) {
        const double size = std::max(high_V_[axis] - low_V_[axis], 1e-9);
        const double part = (p_V[axis] - low_V_[axis]) / size * kPerAxis;
        piece = piece * kPerAxis + size_t(std::clamp(part, 0.0, kPerAxis - 1.0));
    }
    return piece;
}

void BonePieces::apply(SceneModel::Changes&& changes) {
    if (changes.is_cleared) {
        nodes_.clear();
        sortAnew();
    }
    for (SceneModel::Change& change : changes.nodes)
        change.mesh.isEmpty() ? remove(change.mesh.leaf) : put(std::move(change.mesh));
}

// A node stays in the piece where it was first seen.
void BonePieces::put(NodeMesh&& mesh) {
    const uint32_t leaf = mesh.leaf;
    const auto known = nodes_.find(leaf);
    const size_t piece = known == nodes_.end() ? pieceOf(mesh.origin.cast<double>()) : known->second.piece;
    pieces_[piece].leaves.insert(leaf);
    ++pieces_[piece].revision;
    nodes_[leaf] = {std::move(mesh), piece};
}

void BonePieces::remove(uint32_t leaf) {
    const auto known = nodes_.find(leaf);
    if (known == nodes_.end()) return;
    Piece& piece = pieces_[known->second.piece];
    piece.leaves.erase(leaf);
    ++piece.revision;
    nodes_.erase(known);
}

Blob BonePieces::frame(int number, int64_t unix_ns) {
    Piece& piece = pieces_[size_t(number)];
    if (Blob made = piece.made.lock(); made && piece.made_revision == piece.revision) return made;
    Surface surface;
    for (const uint32_t leaf : piece.leaves) add(nodes_.at(leaf).mesh, rasOf(*X_WV_), surface);
    const std::string digits = std::to_string(number);
    const std::string name = "bonemill_bone_" + std::string(2 - digits.size(), '0') + digits;
    Blob made = std::make_shared<const std::string>(surfaceFrame(name, unix_ns, surface));
    piece.made = made;
    piece.made_revision = piece.revision;
    return made;
}

}  // namespace bonemill::igtl
