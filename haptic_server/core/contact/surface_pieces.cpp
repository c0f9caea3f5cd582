#include "haptic_server/core/contact/surface_pieces.h"

#include "haptic_server/core/contact/cell_corners.h"
#include "haptic_server/core/volume/marching_cubes_table.h"

namespace bonemill {
SurfacePieces::SurfacePieces(size_t room)
    : into_tool_(Pose{}, Eigen::Vector3d::Zero()), cases_(packedCubeTriangles()), room_(room) {
    for (auto* values : {&nx_, &ny_, &nz_, &sag_, &bend_, &area_, &longest_, &nearest_})
        values->resize(room + kCellLanes);
    for (auto& values : corner_) values.resize(room + kCellLanes);
    for (auto* values : {&cell_, &finest_, &edge_, &triangle_, &next_}) values->resize(room + kCellLanes);
    patch_.resize(room);
    finished_.resize(room);
    first_.fill(kNone);
}

PieceArrays SurfacePieces::pieces() noexcept {
    PieceArrays arrays;
    for (size_t n = 0; n < 9; ++n) arrays.corner[n] = corner_[n].data();
    arrays.area = area_.data(), arrays.longest = longest_.data();
    arrays.edge = edge_.data(), arrays.triangle = triangle_.data();
    return arrays;
}

// From this one on, with their first pieces behind all others.
SurfaceTriangles SurfacePieces::triangles(size_t from) noexcept {
    SurfaceTriangles arrays;
    for (size_t n = 0; n < 9; ++n) arrays.corner[n] = &corner_[n][used_];
    arrays.area = &area_[used_];
    arrays.nx = &nx_[from], arrays.ny = &ny_[from], arrays.nz = &nz_[from], arrays.bend = &bend_[from],
    arrays.sag = &sag_[from];
    arrays.cell = &cell_[from], arrays.finest = &finest_[from];
    return arrays;
}

void SurfacePieces::start(const ToolField& tool, const Pose& X_VT, const Eigen::Vector3d& origin_V,
                          double margin, double fine_within, double spacing) noexcept {
    tool_ = &tool;
    into_tool_ = IntoTool<float>(X_VT, origin_V);
    R_TV_ = X_VT.rotation.conjugate().toRotationMatrix().cast<float>();
    origin_ = origin_V;
    rules_ = {.margin = float(margin),
              .fine_within = float(fine_within),
              .length_per_distance = kLengthPerDistance,
              .longest_enough = float(tool.thinnestRadius()),
              .per_spacing_squared = float(1 / (spacing * spacing))};
    first_.fill(kNone);
    used_ = listed_count_ = finished_count_ = count_ = triangle_count_ = 0;
    cells_.take();
    is_full_ = false;
}

void SurfacePieces::add(const VoxelVolume& volume, const Eigen::Vector3i& cell, uint32_t patch,
                        uint8_t level) noexcept {
    const CellCorners corners = readCorners(volume, cell);
    const int inside = corners.inside();
    if (inside == 0 || inside == 255) return;
    const auto n = size_t(cells_.count());
    cells_.add(corners, inside);
    const Eigen::Vector3f at = (cell.cast<double>().cwiseProduct(volume.spacing()) - origin_).cast<float>();
    cell_x_[n] = at.x(), cell_y_[n] = at.y(), cell_z_[n] = at.z();
    cell_patch_[n] = patch;
    cell_level_[n] = level == PatchMemory::kNew ? kNone : int(level);
    if (cells_.isFull()) makeTriangles(volume);
}

// Of the cells that wait. What there is no room for is left out.
void SurfacePieces::makeTriangles(const VoxelVolume& volume) noexcept {
    const CellArrays cells = cells_.take();
    if (cells.count == 0) return;
    if (!hasRoomFor(size_t(cells.count * kTrianglesPerCell))) {
        is_full_ = true;
        return;
    }
    CellPlaces places{.x = cell_x_, .y = cell_y_, .z = cell_z_, .steps = {}, .R_TV = {}, .most_sag = {}};
    for (int axis = 0; axis < 3; ++axis) places.steps[axis] = float(volume.spacing()[axis]);
    for (int i = 0; i < 9; ++i) places.R_TV[i] = R_TV_(i / 3, i % 3);
    places.most_sag = float(kMostSag * volume.spacing().minCoeff());
    const int made = kernels().cell_triangles(cells, cases_.data(), places, triangles(triangle_count_));
    const size_t first = used_;
    for (int n = 0; n < made; ++n, ++triangle_count_) {
        const auto cell = size_t(cell_[triangle_count_]);
        finest_[triangle_count_] = cell_level_[cell];
        patch_[triangle_count_] = cell_patch_[cell];
        triangle_[first + size_t(n)] = int(triangle_count_);
    }
    used_ += size_t(made);
    for (int n = 0; n < made; n += kBatch) {
        const int count = std::min(kBatch, made - n);
        sort(int(first) + n, count);
    }
}

// Finds out which of these new pieces wait to be cut, and drops those that the tool cannot reach. There is
// nothing between `gap` and `behind_gap`.
void SurfacePieces::sort(int first, int count, int gap, int behind_gap) noexcept {
    alignas(64) float x[kBatch], y[kBatch], z[kBatch], sag[kBatch], triangle_sag[kBatch];
    alignas(64) float centroids[kBatch], nearest[kBatch];
    alignas(64) int finest[kBatch], level[kBatch];
    PieceBatch batch;
    const MeasuredPieces measured{x,        y,        z,   batch.reach,  batch.nx,
                                  batch.ny, batch.nz, sag, triangle_sag, finest};
    kernels().measure_pieces(pieces(), triangles(), first, count, measured);
    into_tool_.fill(batch.center, x, y, z, count);
    tool_->nearest(batch, centroids, nearest);
    point_tests_ += size_t(count);
    kernels().level_pieces(rules_, &longest_[size_t(first)], measured, centroids, count, nearest, level);
    if (gap != kNone)
        for (int i = gap; i < behind_gap; ++i) level[i] = kPieceDropped;
    // Which it is cannot be foreseen: branches would be dear.
    int waiting[kBatch], finished[kBatch], waiting_count = 0, done_count = 0, dropped_count = 0;
    for (int i = 0; i < count; ++i) {
        waiting[waiting_count] = finished[done_count] = i;
        waiting_count += level[i] < kPieceLevels;
        done_count += level[i] == kPieceFinished;
        dropped_count += level[i] == kPieceDropped;
    }
    count_ += size_t(count - dropped_count);
    finished_count_ += size_t(count - dropped_count - waiting_count);
    for (int n = 0; n < waiting_count; ++n) {
        const int i = waiting[n];
        nearest_[size_t(first + i)] = nearest[i];
        next_[size_t(first + i)] = std::exchange(first_[size_t(level[i])], first + i);
    }
    SurfacePiece* out = &finished_[listed_count_];
    for (int n = 0; n < done_count; ++n) {
        const int i = finished[n];
        const auto piece = size_t(first + i);
        *out++ = {{x[i], y[i], z[i]}, area_[piece], nearest[i], patchOf(piece)};
    }
    listed_count_ += size_t(done_count);
}

// It is cut no further.
void SurfacePieces::finish(int piece) noexcept {
    const auto n = size_t(piece);
    const auto middle = [&](size_t axis) {
        return (corner_[axis][n] + corner_[axis + 3][n] + corner_[axis + 6][n]) / 3;
    };
    finished_[listed_count_++] = {{middle(0), middle(1), middle(2)}, area_[n], nearest_[n], patchOf(n)};
    ++finished_count_;
}

// Takes pieces of this level off the list; those of new patches, for which there is no room, stay as they
// are.
int SurfacePieces::takeSome(int level, bool has_room, int (&which)[kBatch / 2]) noexcept {
    int& first = first_[size_t(level)];
    int count = 0;
    while (first != kNone && count < kBatch / 2) {
        const int piece = std::exchange(first, next_[size_t(first)]);
        if (!has_room && finest_[size_t(triangle_[size_t(piece)])] == kNone) {
            finish(piece);
            is_coarse_ = true;
        } else {
            which[count++] = piece;
        }
    }
    return count;
}

void SurfacePieces::finishAll(int level) noexcept {
    for (int& first = first_[size_t(level)]; first != kNone; is_coarse_ = true)
        finish(std::exchange(first, next_[size_t(first)]));
}

// Cuts the pieces of this level until none is left there.
void SurfacePieces::cutAll(int level, bool has_room) noexcept {
    alignas(64) int which[kBatch / 2] = {};
    while (first_[size_t(level)] != kNone) {
        if (!hasRoomFor(kBatch)) {
            is_full_ = true;
            return finishAll(level);
        }
        const int count = takeSome(level, has_room, which);
        if (count == 0) continue;
        const int to = int(used_), padded = kernels().halve_pieces(pieces(), which, count, to);
        used_ += size_t(2 * padded);
        count_ -= size_t(count);
        sort(to, padded + count, count, padded);
    }
}

uint8_t SurfacePieces::cut(const VoxelVolume& volume, size_t most_of_new, size_t most) noexcept {
    makeTriangles(volume);
    is_coarse_ = false;
    int level_of_new = kPieceLevels, level = kPieceLevels - 1;
    bool has_room = true;
    for (; level >= 0 && count_ <= most; --level) {
        has_room = has_room && 2 * count_ <= most_of_new;
        if (has_room) level_of_new = level;
        cutAll(level, has_room);
    }
    for (; level >= 0; --level) finishAll(level);
    return uint8_t(level_of_new);
}

}  // namespace bonemill
