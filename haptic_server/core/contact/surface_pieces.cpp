#include "haptic_server/core/contact/surface_pieces.h"

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
    : into_tool_(Pose{}, Eigen::Vector3d::Zero()), waiting_(room), next_(room), finished_(room) {
    first_.fill(kNone);
}

void SurfacePieces::start(const ToolField& tool, const Pose& X_VT, const Eigen::Vector3d& origin_V,
                          double margin, double fine_within, double spacing) noexcept {
    tool_ = &tool;
    into_tool_ = IntoTool<float>(X_VT, origin_V);
    R_TV_ = X_VT.rotation.conjugate().toRotationMatrix().cast<float>();
    margin_ = float(margin);
    fine_within_ = float(fine_within);
    per_spacing_squared_ = float(1 / (spacing * spacing));
    first_.fill(kNone);
    first_free_ = kNone;
    used_ = 0;
    finished_count_ = count_ = 0;
    fresh_count_ = 0;
}

bool SurfacePieces::add(const Vector3f corners[3], float sag, uint32_t patch, uint8_t level) noexcept {
    if (count_ + size_t(fresh_count_) >= finished_.size()) return false;
    const Vector3f across = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const float twice_area = across.norm();
    if (!(twice_area > 0)) return true;
    SurfacePiece& piece = fresh_[fresh_count_++];
    std::copy_n(corners, 3, piece.corner.begin());
    piece.area = twice_area / 2;
    piece.normal_T = R_TV_ * (across / twice_area);
    piece.patch = patch;
    piece.level = level;
    findLongestEdge(piece);
    piece.bend = sag / piece.longest_squared;
    if (fresh_count_ == kFresh) sort();
    return true;
}

// Drops those of the new pieces that the tool cannot reach.
void SurfacePieces::sort() noexcept {
    // No point of a triangle is farther from its centroid than two thirds of its longest edge.
    constexpr float kReach = 2.0f / 3;
    alignas(64) float x[kFresh], y[kFresh], z[kFresh], nearest[kFresh];
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
        if (fresh_[i].nearest < margin_ && count_ < finished_.size()) keep(fresh_[i]);
    }
    fresh_count_ = 0;
}

// Returns the first of the levels, from coarse to fine, at which the piece is too long.
int SurfacePieces::levelToCut(const SurfacePiece& piece) const noexcept {
    const float times = piece.longest_squared * per_spacing_squared_;
    if (!(times > 1)) return kFinished;  // nor is a piece cut that has no length left
    const int level = std::min(std::ilogb(times), kLevels - 1);
    if (piece.level != PatchMemory::kNew && piece.level > level) return kFinished;
    const float enough = shortEnough(*tool_, piece.nearest);
    return piece.nearest < fine_within_ || piece.longest_squared > enough * enough ? level : kFinished;
}

void SurfacePieces::keep(const SurfacePiece& piece) noexcept {
    ++count_;
    const int level = levelToCut(piece);
    if (level == kFinished) return finish(piece);
    const uint32_t place = first_free_ != kNone ? first_free_ : used_++;
    if (place == first_free_) first_free_ = next_[place];
    waiting_[place] = piece;
    next_[place] = std::exchange(first_[size_t(level)], place);
}

void SurfacePieces::finish(const SurfacePiece& piece) noexcept {
    finished_[finished_count_++] = {piece.centroid(), piece.area, piece.nearest, piece.patch};
}

void SurfacePieces::halve(const SurfacePiece& piece) noexcept {
    if (fresh_count_ + 2 > kFresh) sort();
    const auto& ends = kEdge[piece.longest_edge];
    const Vector3f middle = (piece.corner[ends[0]] + piece.corner[ends[1]]) / 2;
    for (const size_t moved : {ends[1], ends[0]}) {
        SurfacePiece& half = fresh_[fresh_count_++];
        half = piece;
        half.area = piece.area / 2;
        half.corner[moved] = middle;
        findLongestEdge(half);
    }
}

// Cuts the pieces of this level until none is left there; without room those of new patches stay as they are.
void SurfacePieces::cutAll(int level, bool has_room) noexcept {
    while (first_[size_t(level)] != kNone) {
        while (first_[size_t(level)] != kNone) {
            const uint32_t place = take(level);
            const SurfacePiece& piece = waiting_[place];
            if ((piece.level == PatchMemory::kNew && !has_room) ||
                count_ + size_t(fresh_count_) >= finished_.size()) {
                finish(piece);
                is_coarse_ = true;
            } else {
                halve(piece);
                --count_;
            }
            free(place);
        }
        sort();
    }
}

uint8_t SurfacePieces::cut(size_t most_of_new, size_t most) noexcept {
    sort();
    is_coarse_ = false;
    int level_of_new = kLevels, level = kLevels - 1;
    bool has_room = true;
    for (; level >= 0 && count_ <= most; --level) {
        has_room = has_room && 2 * count_ <= most_of_new;
        if (has_room) level_of_new = level;
        cutAll(level, has_room);
    }
    for (; level >= 0; --level)
        while (first_[size_t(level)] != kNone) {
            finish(waiting_[take(level)]);
            is_coarse_ = true;
        }
    return uint8_t(level_of_new);
}

}  // namespace bonemill
