#include "haptic_server/cases/phantom/vertebra_phantom.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "common/base/units.h"
#include "haptic_server/cases/phantom/lattice_noise.h"
#include "haptic_server/cases/phantom/spline_shapes.h"
#include "haptic_server/core/volume/index_box.h"

namespace bonemill {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

// All shapes are in mm; those on both sides are of the left side (x > 0).

double roundedCut(double solid, double cut, double fillet) {
    return -blend(-solid, cut, fillet);
}

// The cross-section of the body lies between ellipse and box.
double superellipse(const Vector2d& p, const Vector2d& half_axes) {
    constexpr double kExponent = 2.4;
    const Eigen::Array2d scaled = p.cwiseQuotient(half_axes).array().abs();
    const double size = std::pow(scaled.pow(kExponent).sum(), 1 / kExponent);
    if (size < 1e-9) return -half_axes.minCoeff();
    const Eigen::Array2d gradient = (scaled / size).pow(kExponent - 1) / half_axes.array();
    return (size - 1) / gradient.matrix().norm();
}

constexpr double kBodyHalfHeight = 14.5;

double body(const Vector3d& p, double half_width) {
    const double up = std::min(std::abs(p.z()) / kBodyHalfHeight, 1.0);
    const Vector2d half_axes = Vector2d(half_width, 17) * (0.91 + 0.09 * up * up);  // a waist
    const double side = superellipse(p.head<2>(), half_axes);
    const double off_axis = std::min(p.head<2>().cwiseQuotient(Vector2d(half_width, 17)).squaredNorm(), 1.0);
    const double end_plate = std::abs(p.z()) - (kBodyHalfHeight - 1.5 * (1 - off_axis));  // hollow
    return -blend(-side, -end_plate, 2);
}

const Vector2d kCanalMiddle(0, 24), kCanalHalfAxes(12, 8.5);

double canal(const Vector3d& p) {
    return ellipsoidal<Vector2d>(p.head<2>() - kCanalMiddle, kCanalHalfAxes);
}

// The shell is thin on the body and thick on the arch.
double onArch(const Vector3d& p) {
    return smoothStep(12, 22, p.y());
}

}  // namespace

// Makes the bone, both sides at once: but for its texture it is symmetric about x = 0.
class VertebraShapes {
  public:
    explicit VertebraShapes(const VertebraKind& kind) : VertebraShapes(Measures(kind)) {}

    double bone(const Vector3d& p) const {
        return roundedCut(blend(body(p, is_.body_half_width), arch(p), 3), canal(p), 1);
    }
    double shell(const Vector3d& p) const { return is_.shell * (0.8 + 0.7 * onArch(p)); }
    double corticalHu(const Vector3d& p) const { return 1350 + 400 * onArch(p); }
    // The marrow spaces are a little over a millimetre wide.
    double trabecularHu(const Vector3d& p) const {
        constexpr double kLattice = 1.2;
        return is_.core * (kTrabecularLowHu +
                           (kTrabecularHighHu - kTrabecularLowHu) * smoothNoise(p + is_.texture, kLattice));
    }

  private:
    // A limb has an elliptic cross-section from a to b: half axes (level, upright) at both ends, ends
    // rounded.
    struct Limb {
        Vector3d a, b;
        Vector2d half_axes_a, half_axes_b;

        double distance(const Vector3d& p) const {
            const Vector3d along = (b - a).normalized(), level = along.cross(Vector3d::UnitZ()).normalized(),
                           upright = level.cross(along);
            const double length = (b - a).norm(), s = (p - a).dot(along), inside = std::clamp(s, 0.0, length);
            const Vector2d half = half_axes_a + (half_axes_b - half_axes_a) * (inside / length);
            const Vector3d local((p - a).dot(level), (p - a).dot(upright), s - inside);
            return ellipsoidal<Vector3d>(local, {half.x(), half.y(), half.minCoeff()});
        }
    };

    // What differs from one vertebra to the next.
    struct Measures {
        explicit Measures(const VertebraKind& kind) : seed_(kind.seed) {
            using enum VertebraKind::Pedicles;
            pedicle_half_width = 5;
            if (kind.pedicles != kWide) pedicle_half_width = kind.pedicles == kMiddle ? 3.75 : 3;
            pedicle_half_width *= 1 + varied(0.04);
            pedicle_half_height = 7.25 * (1 + varied(0.06));
            body_half_width = 22.5 * (1 + varied(0.05));
            lamina = 1 + varied(0.08);
            for (Vector3d* moved : {&transverse_end, &spinous_end, &superior_end, &inferior_end})
                *moved = {varied(1.5), varied(1.5), varied(2)};
            spinous_end.x() = 0;  // There is only one.
            texture = {varied(1e3), varied(1e3), varied(1e3)};
            if (kind.is_porous) shell = core = 0.65;
        }

        double pedicle_half_width, pedicle_half_height, body_half_width, lamina;
        Vector3d transverse_end, spinous_end, superior_end, inferior_end, texture;
        double shell = 1, core = 1;

      private:
        // Even between -spread and spread.
        double varied(double spread) {
            return seed_ == 0 ? 0 : spread * (2 * unitOf(splitMix64(seed_ * 64 + next_++)) - 1);
        }
        uint64_t seed_, next_ = 0;
    };

    explicit VertebraShapes(const Measures& is) : is_(is) {}

    double arch(const Vector3d& p) const {
        constexpr double kFillet = 3;
        const Vector3d q(std::abs(p.x()), p.y(), p.z());
        double shape = blend(pedicle_.distance(q), lamina_.distance(q), kFillet);
        shape = blend(shape, superior_process_.distance(q), kFillet);
        shape = blend(shape, inferior_process_.distance(q), kFillet);
        shape = blend(shape, transverse_process_.distance(q), kFillet);
        return blend(shape, spinous_process_.distance(q), kFillet);
    }

    Measures is_;
    Limb pedicle_{{14.4, 9, 4.5},
                  {18.4, 31, 4.5},
                  {is_.pedicle_half_width, is_.pedicle_half_height},
                  {is_.pedicle_half_width, is_.pedicle_half_height}};
    Limb lamina_{{18, 30, 2.5}, {1, 36.2, -5}, {3.2 * is_.lamina, 6.5}, {3.2 * is_.lamina, 10}};
    Limb superior_process_{
        {18, 30.5, 4}, Vector3d(20.5, 29.5, 18) + is_.superior_end, {4.5, 4.5}, {4.5, 5.5}};
    Limb inferior_process_{
        {13.5, 34.5, -4}, Vector3d(12.5, 36.5, -21) + is_.inferior_end, {4.5, 4.5}, {4.5, 5}};
    Limb transverse_process_{{20, 28, 4}, Vector3d(45.2, 32, 6) + is_.transverse_end, {3, 6}, {2.3, 4}};
    Limb spinous_process_{{0, 37, -4}, Vector3d(0, 66, -8) + is_.spinous_end, {3.2, 9}, {3.5, 8}};
};

namespace {

// Makes what lies around the bone.
class SoftParts {
  public:
    VertebraTissue at(const Vector3d& p) const {
        if (left_root_.contains(p)) return VertebraTissue::kLeftRoot;
        if (left_root_.contains({-p.x(), p.y(), p.z()})) return VertebraTissue::kRightRoot;
        if (ellipsoidal<Vector2d>(p.head<2>() - Vector2d(0, 23.5), {7.5, 6}) < 0)
            return VertebraTissue::kDuralSac;
        const bool is_vessel = aorta_.contains(p) || segmental_.contains({std::abs(p.x()), p.y(), p.z()});
        return is_vessel ? VertebraTissue::kVessel : VertebraTissue::kFat;
    }

  private:
    // It leaves the sac above, follows the pedicle's inner wall, and leaves the canal under it.
    SplineTube left_root_{
        {{5.5, 24, 13}, {8.6, 23.6, 4}, {11, 22.5, -4}, {15, 20.5, -7.8}, {22, 17, -12}, {30, 11, -20}}, 2.0};
    SplineTube aorta_{{{9, -27, -40}, {9, -27.5, 0}, {9, -27, 40}}, 8.5};
    // It runs from the aorta round the body's waist.
    SplineTube segmental_{{{8, -19.2, -1}, {14, -16.2, -1}, {20, -9.5, -1}, {22.7, 0, -1}, {21.5, 8, -1.5}},
                          1.2};
};

// This is the share of what begins at depth 0 (mm, growing inwards) where edges are soft over `blur`.
double softStep(double depth, double blur) {
    return smoothStep(-blur / 2, blur / 2, depth);
}

constexpr double kVertebraBlurVoxels = 2.5;

struct Voxel {
    float hu;
    VertebraTissue tissue;
};

Voxel voxelAt(const VertebraShapes& shapes, const Vector3d& p, double depth, double blur,
              const SoftParts& soft) {
    const double share = softStep(depth, blur);
    const VertebraTissue around = share < 1 ? soft.at(p) : VertebraTissue::kFat;
    const double around_hu = around == VertebraTissue::kFat ? kFatHu : kSoftHu;
    if (share <= 0) return {float(around_hu), around};
    const double core = softStep(depth - shapes.shell(p), blur);
    const double bone_hu = (1 - core) * shapes.corticalHu(p) + (core > 0 ? core * shapes.trabecularHu(p) : 0);
    const double hu = std::round(around_hu + share * (bone_hu - around_hu));
    if (hu < kBoneHu) return {float(hu), around};
    return {float(hu), depth < shapes.shell(p) ? VertebraTissue::kCortical : VertebraTissue::kTrabecular};
}

// Cubes of voxels that the bone's surface surely does not come near need no distance per voxel.
class DepthMap {
  public:
    DepthMap(const VertebraShapes& shapes, const VolumeGeometry& geometry)
        : shapes_(shapes), geometry_(geometry) {
        const Eigen::Array3i cubes = (geometry.dims.array() + kEdge - 1) / kEdge;
        const double reach = kMargin * (geometry.spacing * kEdge / 2).norm() * kPerMillimetre;
        forEachIndex({Eigen::Vector3i::Zero(), cubes - 1}, [&](const Eigen::Vector3i& cube) {
            const Vector3d middle = cube.cast<double>().array() * kEdge + (kEdge - 1) / 2.0;
            is_far_.push_back(-shapes.bone(pointOf(middle)) < -reach - kFar);
        });
        cubes_ = cubes;
    }
    Vector3d pointOf(const Vector3d& index) const {
        return geometry_.X_WV * geometry_.spacing.cwiseProduct(index) * kPerMillimetre;
    }
    double depth(int i, int j, int k, const Vector3d& p) const {
        const int cube = i / kEdge + cubes_.x() * (j / kEdge + cubes_.y() * (k / kEdge));
        return is_far_[size_t(cube)] ? -kFar : -shapes_.bone(p);
    }

  private:
    static constexpr int kEdge = 8;
    static constexpr double kMargin = 1.5;  // how much faster than distance bone() may change
    static constexpr double kFar = 3;

    const VertebraShapes& shapes_;
    VolumeGeometry geometry_;
    Eigen::Array3i cubes_;
    std::vector<bool> is_far_;
};

}  // namespace

Vertebra::Vertebra(const VertebraKind& kind) : shapes_(std::make_unique<VertebraShapes>(kind)) {}
Vertebra::~Vertebra() = default;

double Vertebra::distance(const Vector3d& p_W) const noexcept {
    return shapes_->bone(p_W * kPerMillimetre) / kPerMillimetre;
}

double Vertebra::corticalThickness(const Vector3d& p_W) const noexcept {
    return shapes_->shell(p_W * kPerMillimetre) / kPerMillimetre;
}

VolumeGeometry Vertebra::grid(double voxel_size) const {
    const Vector3d low = Vector3d(-50, -38, -28) * kMillimetre, high = Vector3d(50, 72, 27) * kMillimetre;
    VolumeGeometry geometry;
    geometry.dims = ((high - low) / voxel_size).array().ceil().cast<int>() + 1;
    geometry.spacing.setConstant(voxel_size);
    geometry.X_WV.position = low;
    return geometry;
}

VertebraScan Vertebra::scan(const VolumeGeometry& geometry) const {
    VertebraScan scan;
    scan.ct.geometry = geometry;
    scan.ct.is_hounsfield = true;
    scan.ct.description = "vertebra phantom";
    scan.ct.values.reserve(geometry.voxelCount());
    scan.labels.reserve(geometry.voxelCount());
    const DepthMap map(*shapes_, geometry);
    const SoftParts soft;
    const double blur = kVertebraBlurVoxels * geometry.spacing.maxCoeff() * kPerMillimetre;
    std::vector<float> row;
    for (int k = 0; k < geometry.dims.z(); ++k)
        for (int j = 0; j < geometry.dims.y(); ++j) {
            row.clear();
            for (int i = 0; i < geometry.dims.x(); ++i) {
                const Vector3d p = map.pointOf(Vector3d(i, j, k));
                const Voxel voxel = voxelAt(*shapes_, p, map.depth(i, j, k, p), blur, soft);
                row.push_back(voxel.hu);
                scan.labels.push_back(uint8_t(voxel.tissue));
            }
            scan.ct.values.append(std::span<const float>(row));
        }
    return scan;
}

}  // namespace bonemill
