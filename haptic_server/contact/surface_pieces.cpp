#include "haptic_server/contact/surface_pieces.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

using Eigen::Vector3f;

constexpr size_t kEdge[3][2] = {{0, 1}, {1, 2}, {2, 0}};  // which corners it joins

void findLongestEdge(SurfacePiece& piece) noexcept {
    piece.longest_squared = -1;
    for (uint8_t edge = 0; edge < 3; ++edge) {
        const float squared = (piece.corner[kEdge[edge][1]] - piece.corner[kEdge[edge][0]]).squaredNorm();
        if (squared > piece.longest_squared) piece.longest_squared = squared, piece.longest_edge = edge;
    }
}

}  // namespace

SurfacePieces::SurfacePieces(size_t room)
    : into_tool_(Pose{}, Eigen::Vector3d::Zero()), pieces_(room), next_(room) {}

void SurfacePieces::start(const ToolField& tool, const Pose& X_VT, const Eigen::Vector3d& origin_V,
                          double margin, double fine_within) noexcept {
    tool_ = &tool;
    into_tool_ = IntoTool<float>(X_VT, origin_V);
    R_TV_ = X_VT.rotation.conjugate().toRotationMatrix().cast<float>();
    margin_ = float(margin);
    fine_within_ = float(fine_within);
    count_ = next_count_ = 0;
    fresh_count_ = 0;
}

bool SurfacePieces::add(const Vector3f corners[3], float sag, uint32_t patch, uint8_t level) noexcept {
    if (next_count_ + size_t(fresh_count_) >= next_.size()) return false;
    const Vector3f across = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const float twice_area = across.norm();
    if (!(twice_area > 0)) return true;
    SurfacePiece piece{};
    std::copy_n(corners, 3, piece.corner.begin());
    piece.area = twice_area / 2;
    piece.normal_T = R_TV_ * (across / twice_area);
    piece.patch = patch;
    piece.level = level;
    findLongestEdge(piece);
    piece.bend = sag / piece.longest_squared;
    put(piece);
    return true;
}

// Takes a new piece, whose distance is not known yet.
void SurfacePieces::put(const SurfacePiece& piece) noexcept {
    fresh_[fresh_count_] = piece;
    if (++fresh_count_ == PointBatch<float>::kCapacity) sort();
}

// Drops those of the new pieces that the tool cannot reach.
void SurfacePieces::sort() noexcept {
    // No point of a triangle is farther from its centroid than two thirds of its longest edge.
    constexpr float kReach = 2.0f / 3;
    alignas(64) float x[PointBatch<float>::kCapacity], y[PointBatch<float>::kCapacity],
        z[PointBatch<float>::kCapacity], nearest[PointBatch<float>::kCapacity];
    PieceBatch batch;
    for (int i = 0; i < fresh_count_; ++i) {
        const SurfacePiece& piece = fresh_[i];
        const Vector3f center = piece.centroid();
        x[i] = center.x(), y[i] = center.y(), z[i] = center.z();
        batch.nx[i] = piece.normal_T.x(), batch.ny[i] = piece.normal_T.y(), batch.nz[i] = piece.normal_T.z();
        batch.reach[i] = kReach * std::sqrt(piece.longest_squared);
    }
    into_tool_.fill(batch.center, x, y, z, fresh_count_);
    tool_->nearest(batch, nearest);
    point_tests_ += size_t(fresh_count_);
    for (int i = 0; i < fresh_count_; ++i) {
        fresh_[i].nearest = nearest[i] - fresh_[i].bend * fresh_[i].longest_squared;
        if (fresh_[i].nearest < margin_ && next_count_ < next_.size()) next_[next_count_++] = fresh_[i];
    }
    fresh_count_ = 0;
}

bool SurfacePieces::isCoarse(const SurfacePiece& piece, const Round& round) const noexcept {
    if (piece.longest_squared <= round.longest_squared) return false;
    if (piece.level == PatchMemory::kNew ? !round.has_room : piece.level > round.level) return false;
    const float enough = shortEnough(*tool_, piece.nearest);
    return piece.nearest < fine_within_ || piece.longest_squared > enough * enough;
}

void SurfacePieces::halve(const SurfacePiece& piece) noexcept {
    const auto& ends = kEdge[piece.longest_edge];
    const Vector3f middle = (piece.corner[ends[0]] + piece.corner[ends[1]]) / 2;
    for (const size_t moved : {ends[1], ends[0]}) {
        SurfacePiece half = piece;
        half.area = piece.area / 2;
        half.corner[moved] = middle;
        findLongestEdge(half);
        put(half);
    }
}

// False: no piece was too long, or there was no room.
bool SurfacePieces::cutOnce(const Round& round) noexcept {
    bool has_cut = false;
    next_count_ = 0;
    for (size_t n = 0; n < count_; ++n) {
        const size_t at_least = next_count_ + size_t(fresh_count_) + (count_ - n);
        if (isCoarse(pieces_[n], round) && at_least < next_.size()) {
            halve(pieces_[n]);
            has_cut = true;
        } else {
            next_[next_count_++] = pieces_[n];
        }
    }
    takeNext();
    return has_cut;
}

void SurfacePieces::takeNext() noexcept {
    sort();
    std::swap(pieces_, next_);
    count_ = std::exchange(next_count_, 0);
}

uint8_t SurfacePieces::cut(double spacing, size_t most) noexcept {
    constexpr float kFinerSquared = 0.5f;
    takeNext();
    float longest = 0;
    for (size_t n = 0; n < count_; ++n) longest = std::max(longest, pieces_[n].longest_squared);
    Round round{float(spacing * spacing), 0, true};
    for (; round.longest_squared < longest; round.longest_squared /= kFinerSquared) ++round.level;
    int level_of_new = round.level;
    while (round.level > 0 && count_ <= 4 * most) {
        round.longest_squared *= kFinerSquared;
        --round.level;
        round.has_room = round.has_room && 2 * count_ <= most;
        if (round.has_room) level_of_new = round.level;
        while (cutOnce(round)) {
        }
    }
    return uint8_t(std::min<int>(level_of_new, PatchMemory::kNew - 1));
}

}  // namespace bonemill
