#include "haptic_server/cases/phantom/third_molar_phantom.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "common/base/units.h"
#include "common/process/work_ahead.h"
#include "haptic_server/cases/phantom/lattice_noise.h"
#include "haptic_server/cases/phantom/molar_shapes.h"
#include "haptic_server/cases/phantom/sided_grid.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr double kSurroundingHu = -1000, kTissueHu = 40;  // the piece is cleaned of gum and muscle
constexpr double kCompactLowHu = 1500, kCompactHighHu = 1800, kSpongeLowHu = 250, kSpongeHighHu = 650;
constexpr double kCanalWallHu = 1200;
constexpr double kLigament = 0.25, kFollicle = 0.6, kCanalWall = 0.4;
constexpr double kMolarBlurVoxels = 2.5;

Vector3d toLeftJaw(const ThirdMolarKind& kind, const Vector3d& p_W) {
    const Vector3d p = p_W * kPerMillimetre;
    return kind.is_right ? Vector3d(-p.x(), p.y(), p.z()) : p;
}

struct MolarVoxel {
    double hu;
    MolarTissue tissue;
};

class MolarVoxels {
  public:
    MolarVoxels(const MolarShapes& shapes, double blur) : shapes_(shapes), blur_(blur) {}

    // What is drawn later covers what was drawn before it.
    MolarVoxel at(const Vector3d& p) const {
        const double outside = jawBlock().exteriorDistance(p);
        if (outside > 0) return {kSurroundingHu, MolarTissue::kNone};
        const double depth = -shapes_.jaw(p), canal = shapes_.canal(p);
        const SoundTooth second = shapes_.secondMolar(p), third = shapes_.thirdMolar(p);
        double hu = mixed(kSurroundingHu, boneHu(p, depth), share(depth));
        hu = mixed(hu, std::max(hu, kCanalWallHu), share(kCanalWall - canal));
        hu = mixed(hu, kTissueHu, share(-canal));
        if (depth > -blur_) {
            const double crown = smoothStep(0.3, -0.3, third.enamel);
            hu = mixed(hu, kTissueHu,
                       share(kLigament + (kFollicle - kLigament) * crown - third.outer) * share(depth));
            hu = mixed(hu, kTissueHu, share(kLigament - second.outer) * share(depth));
        }
        hu = mixed(hu, toothHu(second), share(-second.outer));
        hu = mixed(hu, toothHu(third), share(-third.outer));
        return {hu, tissueOf(p, second, third)};
    }

  private:
    double share(double depth) const { return std::clamp(0.5 + depth / blur_, 0.0, 1.0); }
    static double mixed(double from, double to, double share) { return from + share * (to - from); }

    double boneHu(const Vector3d& p, double depth) const {
        const double compact = kCompactLowHu + (kCompactHighHu - kCompactLowHu) * smoothNoise(p, 3);
        const double sponge = kSpongeLowHu + (kSpongeHighHu - kSpongeLowHu) * smoothNoise(p, 1.1);
        return mixed(compact, sponge, smoothStep(-0.3, 0.3, depth - shapes_.cortex(p)));
    }
    double toothHu(const SoundTooth& tooth) const {
        const double dentine = kToothHu[int(ToothTissue::kDentine)];
        const double solid = mixed(dentine, kToothHu[int(ToothTissue::kEnamel)], share(-tooth.enamel));
        return mixed(solid, kToothHu[int(ToothTissue::kPulp)], share(-tooth.pulp));
    }
    MolarTissue tissueOf(const Vector3d& p, const SoundTooth& second, const SoundTooth& third) const {
        if (third.outer < 0)
            return third.pulp < 0     ? MolarTissue::kPulp
                   : third.enamel < 0 ? MolarTissue::kEnamel
                                      : MolarTissue::kDentine;
        if (second.outer < 0) return MolarTissue::kSecondMolar;
        if (shapes_.nerve(p) < 0) return MolarTissue::kNerve;
        return shapes_.isLingual(p) ? MolarTissue::kLingualPlate : MolarTissue::kNone;
    }

    const MolarShapes& shapes_;
    double blur_;
};

}  // namespace

ThirdMolar::ThirdMolar(const ThirdMolarKind& kind)
    : kind_(kind), shapes_(std::make_unique<MolarShapes>(kind)) {}
ThirdMolar::~ThirdMolar() = default;

VolumeGeometry ThirdMolar::grid(double voxel_size) const {
    return sidedGrid(jawBlock(), voxel_size, kind_.is_right);
}

MolarScan ThirdMolar::scan(const VolumeGeometry& geometry) const {
    struct Slice {
        std::vector<int16_t> hu;
        std::vector<uint8_t> labels;
    };
    MolarScan scan;
    scan.ct.geometry = geometry;
    scan.ct.is_hounsfield = true;
    scan.ct.description = "third molar phantom";
    scan.ct.values.reserve(geometry.voxelCount());
    scan.labels.reserve(geometry.voxelCount());
    const MolarVoxels voxels(*shapes_, kMolarBlurVoxels * geometry.spacing.maxCoeff() * kPerMillimetre);
    std::vector<int> slices(size_t(geometry.dims.z()));
    std::iota(slices.begin(), slices.end(), 0);
    workAhead(
        slices,
        [&](int k) {
            Slice slice;
            for (int j = 0; j < geometry.dims.y(); ++j)
                for (int i = 0; i < geometry.dims.x(); ++i) {
                    const Vector3d p_W = geometry.X_WV * geometry.spacing.cwiseProduct(Vector3d(i, j, k));
                    const MolarVoxel voxel = voxels.at(toLeftJaw(kind_, p_W));
                    slice.hu.push_back(int16_t(std::lround(voxel.hu)));
                    slice.labels.push_back(uint8_t(voxel.tissue));
                }
            return slice;
        },
        [&](int, Slice&& slice) {
            scan.ct.values.append(std::span<const int16_t>(slice.hu));
            scan.labels.insert(scan.labels.end(), slice.labels.begin(), slice.labels.end());
        });
    return scan;
}

double ThirdMolar::nerveDistance(const Vector3d& p_W) const noexcept {
    return shapes_->nerve(toLeftJaw(kind_, p_W)) * kMillimetre;
}
double ThirdMolar::thirdMolarDistance(const Vector3d& p_W) const noexcept {
    return shapes_->thirdMolar(toLeftJaw(kind_, p_W)).outer * kMillimetre;
}
double ThirdMolar::secondMolarDistance(const Vector3d& p_W) const noexcept {
    return shapes_->secondMolar(toLeftJaw(kind_, p_W)).outer * kMillimetre;
}
double ThirdMolar::jawDistance(const Vector3d& p_W) const noexcept {
    return shapes_->jaw(toLeftJaw(kind_, p_W)) * kMillimetre;
}

}  // namespace bonemill
