#include "haptic_server/scans/find_bone/bone_pieces.h"

#include <algorithm>
#include <numeric>

#include "common/base/units.h"
#include "common/text/printed_text.h"

namespace bonemill {
namespace {

using RunId = uint32_t;  // no volume has 2^32 runs: kMaxVoxels is 2^31

}  // namespace

std::string volumeText(double cubic_metres) {
    const double cubic_mm = cubic_metres * kPerCubicMillimetre;
    return printed(cubic_mm < 100 ? "%.3g mm^3" : "%.0f mm^3", cubic_mm);
}

std::string edgesText(const Eigen::Vector3d& edges) {
    return printed("%.4g x %.4g x %.4g", edges.x(), edges.y(), edges.z());
}

IndexBox boneBox(const VoxelVolume& volume) {
    IndexBox box;
    volume.forEachOwnedPart({Eigen::Vector3i::Zero(), volume.dims().array() - 1},
                            [&](const IndexBox& part, size_t) {
                                if (volume.uniformDensity(part.min) == 0) return;
                                forEachIndex(part, [&](const Eigen::Vector3i& v) {
                                    if (volume.at(v.x(), v.y(), v.z()) >= volume.iso()) box.include(v);
                                });
                            });
    return box;
}

Eigen::AlignedBox3d placesOf(const IndexBox& voxels, const Eigen::Vector3d& spacing) {
    if (voxels.isEmpty()) return {};
    return {spacing.cwiseProduct(voxels.min.cast<double>()), spacing.cwiseProduct(voxels.max.cast<double>())};
}

// Holds all bone of a volume as runs, row by row.
class BonePieces::Runs {
  public:
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

    explicit Runs(const VoxelVolume& volume) : dims_(volume.dims()) {
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

namespace {

// Finds which runs are connected (union-find). A piece is named by the first of its runs.
template <class Runs>
class Connected {
    using Row = typename Runs::Row;

  public:
    explicit Connected(const Runs& runs) : runs_(runs), parent_(runs.size()) {
        std::iota(parent_.begin(), parent_.end(), 0u);
        runs.forEachRow([&](const Row& row) {
            if (row.j > 0) joinRows(row, runs.row(row.j - 1, row.k));
            if (row.k > 0) joinRows(row, runs.row(row.j, row.k - 1));
        });
    }

    RunId firstOf(RunId run) noexcept {
        while (parent_[run] != run) run = parent_[run] = parent_[parent_[run]];
        return run;
    }

  private:
    // Goes along both rows at once: the run that ends first can touch nothing further.
    void joinRows(Row a, Row b) {
        while (a.first < a.last && b.first < b.last) {
            if (runs_[a.first].touches(runs_[b.first])) join(a.first, b.first);
            ++(runs_[a.first].end < runs_[b.first].end ? a : b).first;
        }
    }
    void join(RunId a, RunId b) noexcept {
        a = firstOf(a);
        b = firstOf(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

    const Runs& runs_;
    std::vector<RunId> parent_;
};

template <class Run, class Row>
void add(BonePiece& piece, const Run& run, const Row& row) {
    piece.voxels += run.length();
    piece.box.include(IndexBox{{run.begin, row.j, row.k}, {run.end - 1, row.j, row.k}});
    piece.middle += double(run.length()) * Eigen::Vector3d((run.begin + run.end - 1) / 2.0, row.j, row.k);
}

}  // namespace

BonePieces::BonePieces(const VoxelVolume& volume)
    : runs_(std::make_unique<Runs>(volume)), piece_of_run_(runs_->size()) {
    Connected connected(*runs_);
    runs_->forEachRow([&](const Runs::Row& row) {
        for (RunId run = row.first; run < row.last; ++run) {
            const RunId first = connected.firstOf(run);
            if (first == run) pieces_.emplace_back();
            piece_of_run_[run] = first == run ? uint32_t(pieces_.size() - 1) : piece_of_run_[first];
            add(pieces_[piece_of_run_[run]], (*runs_)[run], row);
        }
    });
    for (BonePiece& piece : pieces_) piece.middle /= double(piece.voxels);
    std::vector<uint32_t> order(pieces_.size()), place(pieces_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, std::greater{}, [&](uint32_t n) { return pieces_[n].voxels; });
    std::vector<BonePiece> sorted;
    for (const uint32_t n : order) {
        place[n] = uint32_t(sorted.size());
        sorted.push_back(pieces_[n]);
    }
    pieces_ = std::move(sorted);
    for (uint32_t& piece : piece_of_run_) piece = place[piece];
}

BonePieces::~BonePieces() = default;

std::vector<bool> BonePieces::touching(const IndexBox& box) const {
    std::vector<bool> touches(pieces_.size());
    for (int k = box.min.z(); k <= box.max.z(); ++k)
        for (int j = box.min.y(); j <= box.max.y(); ++j) {
            const Runs::Row row = runs_->row(j, k);
            for (RunId run = row.first; run < row.last; ++run)
                if ((*runs_)[run].touches({box.min.x(), box.max.x() + 1})) touches[piece_of_run_[run]] = true;
        }
    return touches;
}

void BonePieces::forEachRun(const SeeRun& see) const {
    runs_->forEachRow([&](const Runs::Row& row) {
        for (RunId run = row.first; run < row.last; ++run)
            see(piece_of_run_[run], {(*runs_)[run].begin, row.j, row.k}, int((*runs_)[run].length()));
    });
}

uint64_t BonePieces::drop(VoxelVolume& volume, const std::vector<bool>& is_dropped, const See& see) const {
    uint64_t dropped = 0;
    forEachRun([&](size_t piece, const Eigen::Vector3i& first, int length) {
        if (!is_dropped[piece]) return;
        dropped += uint64_t(length);
        for (int i = first.x(); i < first.x() + length; ++i) {
            volume.set(i, first.y(), first.z(), Density(volume.iso() - 1));
            if (see) see({i, first.y(), first.z()});
        }
    });
    return dropped;
}

std::string textOf(const BonePiece& piece, size_t number, const VolumeGeometry& geometry) {
    const Eigen::Vector3d at = geometry.X_WV * piece.middle.cwiseProduct(geometry.spacing) * kPerMillimetre;
    const Eigen::Vector3d size =
        geometry.spacing.cwiseProduct(
            (piece.box.max - piece.box.min + Eigen::Vector3i::Ones()).cast<double>()) *
        kPerMillimetre;
    return printed("piece %zu: %llu voxels, %s, %.0f x %.0f x %.0f mm around (%.1f, %.1f, %.1f) mm", number,
                   static_cast<unsigned long long>(piece.voxels),
                   volumeText(double(piece.voxels) * geometry.spacing.prod()).c_str(), size.x(), size.y(),
                   size.z(), at.x(), at.y(), at.z());
}

uint64_t removeSmallPieces(VoxelVolume& volume, uint32_t smallest_piece_voxels) {
    if (smallest_piece_voxels <= 1) return 0;
    const BonePieces pieces(volume);
    std::vector<bool> is_small;
    for (const BonePiece& piece : pieces.list()) is_small.push_back(piece.voxels < smallest_piece_voxels);
    return pieces.drop(volume, is_small);
}

}  // namespace bonemill
