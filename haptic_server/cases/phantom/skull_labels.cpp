#include "haptic_server/cases/phantom/skull_labels.h"

#include "common/base/units.h"
#include "haptic_server/cases/phantom/spline_shapes.h"
#include "haptic_server/core/volume/index_box.h"

namespace bonemill {
namespace {

// All lengths are in mm in W: x to the left, y to the back, z up.

// Runs from the transverse sinus down the corner between petrous bone and skull, then under the labyrinth to
// the jugular bulb.
SplineTube sigmoidSinus() {
    return {{{176.5, 177, 48.5},
             {179.5, 170, 47},
             {179.5, 164.5, 44},
             {178.5, 160.5, 39},
             {177.5, 158.5, 34},
             {175, 156, 30},
             {172, 154, 26.5},
             {167, 152.5, 25},
             {160, 150.5, 25.5},
             {156, 145.5, 26},
             {158, 139, 25}},
            4.5};
}

// Runs along tympanic segment, second genu below the lateral semicircular canal, mastoid segment
// and stylomastoid foramen.
SplineTube facialNerve() {
    return {{{160.5, 131.5, 38},
             {163.5, 135, 37},
             {166.5, 137.5, 35},
             {168.5, 138.5, 31},
             {169.5, 138.5, 26},
             {170.5, 137.5, 21.5},
             {171.5, 135.5, 18}},
            1.0};
}

// The dura of the middle fossa lies on the roof of tympanic cavity and mastoid cells, rising to the side.
SplineSheet duraOfMiddleFossa() {
    SplineSheet::Lattice lattice;
    lattice.low = {160, 128};
    lattice.spacing = {8, 6};
    lattice.heights = {{42.5, 39.5, 39.5, 44},
                       {44.5, 44, 43, 45.5},
                       {46.5, 46.5, 46, 48.5},
                       {45.5, 45, 45.5, 48},
                       {43, 43.5, 45.5, 49}};
    return {lattice, 2};  // thick enough for slices 1.5 mm apart
}

}  // namespace

std::vector<uint8_t> skullLabels(const VolumeGeometry& geometry) {
    const SplineTube sinus = sigmoidSinus(), nerve = facialNerve();
    const SplineSheet dura = duraOfMiddleFossa();
    std::vector<uint8_t> labels;
    labels.reserve(geometry.voxelCount());
    const auto labelAt = [&](const Eigen::Vector3d& p_mm) {
        if (nerve.contains(p_mm)) return SkullLabel::kFacialNerve;
        if (sinus.contains(p_mm)) return SkullLabel::kSigmoidSinus;
        return dura.contains(p_mm) ? SkullLabel::kDura : SkullLabel::kNone;
    };
    forEachIndex({Eigen::Vector3i::Zero(), geometry.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
        const Eigen::Vector3d p_V = geometry.spacing.cwiseProduct(v.cast<double>());
        labels.push_back(uint8_t(labelAt(geometry.X_WV * p_V * kPerMillimetre)));
    });
    return labels;
}

}  // namespace bonemill
