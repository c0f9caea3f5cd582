// Computes how far each voxel of a box is from the nearest marked one, and by that the distance field of the
// protected structures of a scan: exact Euclidean distances between the voxels' centres, by one pass of lower
// envelopes of parabolas per axis (Felzenszwalb and Huttenlocher 2012).
//
// It is not for the tick: it allocates 7 bytes per voxel of the box. One thread at a time may use an object.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "haptic_server/core/volume/bone_properties.h"
#include "haptic_server/core/volume/distance_field.h"

namespace bonemill {

class DistanceTransform {
  public:
    // `spacing` is that of the voxels, in m.
    DistanceTransform(const IndexBox& box, const Eigen::Vector3d& spacing);

    // mark(voxel) is its material, or kNoMaterial for a voxel that is not marked.
    template <class Mark>
    void run(Mark&& mark) {
        size_t at = 0;
        forEachIndex(box_, [&](const Eigen::Vector3i& voxel) {
            id_[at] = mark(voxel);
            squared_[at] = id_[at] == kNoMaterial ? kNone : 0.0f;
            ++at;
        });
        for (int axis = 0; axis < 3; ++axis) runAxis(axis);
    }

    // In m, less half a voxel in the direction of the way, so that 0 lies on the marked voxels' faces; 0 in a
    // marked voxel, infinite where none is marked.
    double distance(const Eigen::Vector3i& voxel) const;
    MaterialId nearest(const Eigen::Vector3i& voxel) const { return id_[indexOf(voxel)]; }

  private:
    static constexpr float kNone = std::numeric_limits<float>::infinity();
    struct NearestVoxel {
        float squared = kNone;  // m², between centres
        MaterialId id = kNoMaterial;
    };

    size_t indexOf(const Eigen::Vector3i& voxel) const {
        const Eigen::Vector3i at = voxel - box_.min;
        return size_t(at.x()) + size_t(size_.x()) * (size_t(at.y()) + size_t(size_.y()) * size_t(at.z()));
    }
    void runAxis(int axis);
    void runLine(size_t start, size_t stride, int count, double step, bool is_z);

    IndexBox box_;
    Eigen::Vector3d spacing_;
    Eigen::Vector3i size_;
    std::vector<float> squared_;
    std::vector<MaterialId> id_;
    std::vector<int16_t> along_z_;  // voxels, from the nearest one
    std::vector<NearestVoxel> line_;
    std::vector<int> hull_;
    std::vector<double> from_;
};

// The work goes on in slabs of N voxels, with what lies within reach of them.
inline constexpr int64_t kVoxelsAtOnce = 20 << 20;

// The distances are those of DistanceTransform. It is for start-up only, and allocates at most some 300 MB at
// a time, or for a long reach what lies within it of a slab as thick. The field is null if no voxel is of a
// protected material. `reach` is in m and > 0. Throws UserError if it has more voxels than that: neither time
// nor memory would be bounded by the scan's.
std::unique_ptr<DistanceField> protectedDistance(const BoneProperties& properties,
                                                 const MaterialTable& materials,
                                                 const Eigen::Vector3d& spacing, double reach,
                                                 int64_t voxels_at_once = kVoxelsAtOnce);

}  // namespace bonemill
