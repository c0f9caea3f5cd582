#include "haptic_server/volume/import/small_pieces.h"

#include <algorithm>
#include <vector>

namespace bonemill {
namespace {

using RunId = uint32_t;  // no volume has 2^32 runs: kMaxVoxels is 2^31

// A run is the bone voxels begin .. end - 1 of a row along x.
struct Run {
    int32_t begin, end;

    uint32_t length() const noexcept { return uint32_t(end - begin); }
    bool touches(const Run& other) const noexcept { return begin < other.end && other.begin < end; }
};

struct Row {
    int j, k;
    RunId first, last;  // runs first .. last - 1
};

// Holds all bone of a volume as runs, row by row.
class BoneRuns {
  public:
    explicit BoneRuns(const VoxelVolume& volume) : dims_(volume.dims()) {
        for (int k = 0; k < dims_.z(); ++k)
            for (int j = 0; j < dims_.y(); ++j) {
                first_of_row_.push_back(RunId(runs_.size()));
                addRow(volume, j, k);
            }
        first_of_row_.push_back(RunId(runs_.size()));
    }

    size_t size() const noexcept { return runs_.size(); }
    const Run& operator[](RunId run) const noexcept { return runs_[run]; }
    Row row(int j, int k) const noexcept {
        const size_t n = size_t(j) + size_t(dims_.y()) * size_t(k);
        return {j, k, first_of_row_[n], first_of_row_[n + 1]};
    }
    template <class Visit>
    void forEachRow(Visit&& visit) const {
        for (int k = 0; k < dims_.z(); ++k)
            for (int j = 0; j < dims_.y(); ++j) visit(row(j, k));
    }

  private:
    void addRow(const VoxelVolume& volume, int j, int k) {
        bool was_bone = false;
        for (int i = 0; i <= dims_.x(); ++i) {  // the border of air ends the last run
            const bool is_bone = volume.at(i, j, k) >= volume.iso();
            if (is_bone && !was_bone) runs_.push_back({i, i});
            if (!is_bone && was_bone) runs_.back().end = i;
            was_bone = is_bone;
        }
    }

    Eigen::Vector3i dims_;
    std::vector<Run> runs_;
    std::vector<RunId> first_of_row_;
};

// Finds which runs are connected (union-find). A piece is named by the first of its runs.
class Pieces {
  public:
    explicit Pieces(const BoneRuns& runs) : runs_(runs), parent_(runs.size()), voxels_(runs.size()) {
        for (RunId run = 0; run < runs.size(); ++run) parent_[run] = run;
        runs.forEachRow([&](const Row& row) {
            if (row.j > 0) joinRows(row, runs.row(row.j - 1, row.k));
            if (row.k > 0) joinRows(row, runs.row(row.j, row.k - 1));
        });
        for (RunId run = 0; run < runs.size(); ++run) voxels_[pieceOf(run)] += runs[run].length();
    }

    RunId pieceOf(RunId run) noexcept {
        while (parent_[run] != run) run = parent_[run] = parent_[parent_[run]];
        return run;
    }
    uint32_t voxelsOf(RunId piece) const noexcept { return voxels_[piece]; }

  private:
    // Goes along both rows at once: the run that ends first can touch nothing further.
    void joinRows(Row a, Row b) {
        while (a.first < a.last && b.first < b.last) {
            if (runs_[a.first].touches(runs_[b.first])) join(a.first, b.first);
            ++(runs_[a.first].end < runs_[b.first].end ? a : b).first;
        }
    }
    void join(RunId a, RunId b) noexcept {
        a = pieceOf(a);
        b = pieceOf(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

    const BoneRuns& runs_;
    std::vector<RunId> parent_;
    std::vector<uint32_t> voxels_;  // of the piece that the run names
};

}  // namespace

PieceCount removeSmallPieces(VoxelVolume& volume, uint32_t smallest_piece_voxels) {
    PieceCount count;
    if (smallest_piece_voxels <= 1) return count;
    const BoneRuns runs(volume);
    Pieces pieces(runs);
    runs.forEachRow([&](const Row& row) {
        for (RunId run = row.first; run < row.last; ++run) {
            const RunId piece = pieces.pieceOf(run);
            const bool is_small = pieces.voxelsOf(piece) < smallest_piece_voxels;
            if (piece == run) ++(is_small ? count.pieces_removed : count.pieces_kept);
            if (!is_small) continue;
            count.voxels_removed += runs[run].length();
            for (int i = runs[run].begin; i < runs[run].end; ++i)
                volume.set(i, row.j, row.k, Density(volume.iso() - 1));
        }
    });
    return count;
}

}  // namespace bonemill
