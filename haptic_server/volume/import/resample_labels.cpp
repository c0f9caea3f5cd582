#include "haptic_server/volume/import/resample_labels.h"

#include <array>
#include <span>
#include <vector>

#include "common/user_error.h"
#include "haptic_server/volume/import/index_map.h"

namespace bonemill {
namespace {

constexpr double kSamePlace = 0.01;  // voxels: headers round

template <class Samples>
class LabelReader {
  public:
    LabelReader(Samples samples, const Eigen::Vector3i& dims) : samples_(samples), dims_(dims) {}

    bool isInside(const Eigen::Vector3d& at) const {
        return (at.array() > -0.5 - kSamePlace).all() &&
               (at.array() < dims_.cast<double>().array() - 0.5 + kSamePlace).all();
    }
    double nearest(const Eigen::Vector3i& v) const {
        const Eigen::Vector3i in = v.cwiseMax(0).cwiseMin(dims_ - Eigen::Vector3i::Ones());
        return double(samples_[size_t(in.x()) +
                               size_t(dims_.x()) * (size_t(in.y()) + size_t(dims_.y()) * size_t(in.z()))]);
    }
    double ofLargestShare(const Eigen::Vector3d& at) const {
        const Eigen::Vector3i low = at.array().floor().cast<int>();
        const Eigen::Vector3d t = at - low.cast<double>();
        std::array<double, 8> label{}, share{};
        for (int corner = 0; corner < 8; ++corner) {
            const Eigen::Vector3i bit(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
            label[size_t(corner)] = nearest(low + bit);
            share[size_t(corner)] =
                (bit.x() ? t.x() : 1 - t.x()) * (bit.y() ? t.y() : 1 - t.y()) * (bit.z() ? t.z() : 1 - t.z());
        }
        double best = label[0], best_share = -1;
        for (size_t n = 0; n < 8; ++n) {
            double all = 0;
            for (size_t m = 0; m < 8; ++m) all += label[m] == label[n] ? share[m] : 0;
            if (all < best_share || (all == best_share && label[n] < best)) continue;
            best = label[n];
            best_share = all;
        }
        return best;
    }

  private:
    Samples samples_;
    Eigen::Vector3i dims_;
};

}  // namespace

ResampledLabels resampleLabels(const RawVolume& labels, const VolumeGeometry& grid,
                               const std::string& label_file) {
    if (const ValueRange& range = labels.values.range(); !range.are_integers || range.non_finite > 0)
        throw UserError(label_file +
                        " holds values that are no whole numbers: labels are needed, not a scan");
    const Eigen::Affine3d map = indexMap(grid, labels.geometry);
    ResampledLabels out;
    out.is_exact = true;
    out.labels.geometry = grid;
    out.labels.values.reserve(grid.voxelCount());
    size_t covered = 0;
    labels.values.visit([&](auto samples) {
        const LabelReader reader(samples, labels.geometry.dims);
        std::vector<float> slice;
        for (int k = 0; k < grid.dims.z(); ++k, slice.clear()) {
            for (int j = 0; j < grid.dims.y(); ++j)
                for (int i = 0; i < grid.dims.x(); ++i) {
                    const Eigen::Vector3d at = map * Eigen::Vector3d(i, j, k);
                    const bool is_inside = reader.isInside(at);
                    const Eigen::Vector3i voxel = at.array().round().cast<int>();
                    const bool is_voxel = (at - voxel.cast<double>()).cwiseAbs().maxCoeff() < kSamePlace;
                    covered += is_inside;
                    out.is_exact = out.is_exact && is_inside && is_voxel;
                    slice.push_back(float(!is_inside ? 0
                                          : is_voxel ? reader.nearest(voxel)
                                                     : reader.ofLargestShare(at)));
                }
            out.labels.values.append(std::span<const float>(slice));
        }
    });
    out.covered = double(covered) / double(grid.voxelCount());
    if (covered == 0) throw UserError(label_file + " lies beside the volume: none of its voxels is in there");
    return out;
}

}  // namespace bonemill
