#include "haptic_server/cases/phantom/tooth_phantom.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "common/base/units.h"
#include "haptic_server/cases/phantom/lattice_noise.h"
#include "haptic_server/cases/phantom/spline_shapes.h"
#include "haptic_server/core/volume/index_box.h"

namespace bonemill {
namespace {

// All shapes are in mm; sizes follow textbook mean values of a lower molar (crown 11 x 10.5 mm, whole length
// about 19 mm).
constexpr double kNeckZ = 11.5;      // cemento-enamel junction
constexpr double kFurcationZ = 9.0;  // where the root trunk splits
constexpr double kRootTipZ = 0.55;
constexpr double kReach = 6.5;     // nothing of the tooth lies further from its axis,
constexpr double kHighest = 20.0;  // or higher

double square(double x) {
    return x * x;
}

double ellipsoid(const Eigen::Vector3d& p, const Eigen::Vector3d& centre, const Eigen::Vector3d& half_axes) {
    return ((p - centre).cwiseQuotient(half_axes).norm() - 1) * half_axes.minCoeff();
}

// The chewing surface has four cusps, a fissure along the row of teeth and one across.
double occlusalHeight(double x, double y) {
    double z = 17.0;
    for (const double cx : {-2.5, 2.5})
        for (const double cy : {-2.4, 2.4}) {
            const double height = cx < 0 && cy < 0 ? 2.6 : 2.3;
            z += height * std::exp(-(square((x - cx) / 1.7) + square((y - cy) / 1.6)));
        }
    z -= 0.7 * std::exp(-square((y - 0.15 * std::sin(1.4 * x)) / 0.3)) * smoothStep(5.0, 3.6, std::abs(x));
    z -= 0.6 * std::exp(-square((x - 0.3) / 0.3)) * smoothStep(4.6, 3.0, std::abs(y));
    return z;
}

double crownSide(const Eigen::Vector3d& p) {
    constexpr double kExponent = 2.7;
    const double up = p.z() - 14.6;
    const double sum = std::pow(std::abs(p.x()) / 5.5, kExponent) +
                       std::pow(std::abs(p.y()) / 5.25, kExponent) +
                       std::pow(std::abs(up) / (up > 0 ? 7.0 : 5.6), kExponent);
    return (std::pow(sum, 1 / kExponent) - 1) * 5.0;
}

double crown(const Eigen::Vector3d& p) {
    const double top = (p.z() - occlusalHeight(p.x(), p.y())) * 0.7;  // slopes near 1: height to distance
    return -blend(-crownSide(p), -top, 0.8);
}

// There are two roots in the row of teeth; side is -1 (mesial) or +1 (distal). They lean apart and bend
// at their ends.
double rootAxisX(double side, double z) {
    const double down = std::max(kFurcationZ + 1.0 - z, 0.0);
    return side * (2.0 + 0.11 * down) - 0.012 * down * down;
}

double root(const Eigen::Vector3d& p, double side) {
    const double above_tip = p.z() - kRootTipZ - (side > 0 ? 0.4 : 0.0);
    if (above_tip <= 0) return std::hypot(above_tip, p.x() - rootAxisX(side, p.z()), p.y());
    const double round_tip = std::min(std::sqrt(above_tip / 1.2), 1.0);
    const double rx = (0.75 + 0.13 * above_tip) * round_tip, ry = (1.25 + 0.26 * above_tip) * round_tip;
    const double x = (p.x() - rootAxisX(side, p.z())) / rx, y = p.y() / ry;
    return (std::hypot(x, y) - 1) * std::min(rx, ry);
}

double trunk(const Eigen::Vector3d& p) {
    return ellipsoid(p, {0, 0, kNeckZ}, {4.5, 4.3, 3.2});
}

double rootPart(const Eigen::Vector3d& p) {
    const double ceiling = p.z() - (kNeckZ + 1.5);  // roots end inside the crown
    const double roots = std::min(std::max(root(p, -1), ceiling), std::max(root(p, 1), ceiling));
    return blend(roots, trunk(p), 1.0);
}

double outerShape(const Eigen::Vector3d& p) {
    return blend(crown(p), rootPart(p), 0.6);
}

// The thickness grows from nothing at the neck to 1.9 mm under the cusps.
double enamelThickness(double z) {
    return 1.3 * smoothStep(kNeckZ - 0.2, kNeckZ + 4, z) + 0.6 * smoothStep(15, 18, z);
}

double canal(const Eigen::Vector3d& p, double side, double y_offset) {
    const double z = std::clamp(p.z(), kRootTipZ + 0.9, kNeckZ - 0.5);
    const double spread = y_offset * smoothStep(kNeckZ, 6, z);
    const double radius = 0.2 + 0.03 * (z - kRootTipZ);
    const Eigen::Vector3d axis_point(rootAxisX(side, z) * (0.85 + 0.15 * smoothStep(kNeckZ, 7, z)), spread,
                                     z);
    return (p - axis_point).norm() - radius;
}

double pulp(const Eigen::Vector3d& p) {
    double shape = ellipsoid(p, {0, 0, 11.6}, {2.5, 2.0, 1.5});
    for (const double x : {-1.5, 1.5})
        for (const double y : {-1.2, 1.2})
            shape = blend(shape, ellipsoid(p, {x, y, 12.9}, {0.55, 0.5, 1.2}), 0.5);
    shape = blend(shape, canal(p, -1, -1.0), 0.4);  // two canals in the mesial root, one in the distal
    shape = blend(shape, canal(p, -1, 1.0), 0.4);
    return blend(shape, canal(p, 1, 0.0), 0.4);
}

// The caries starts in the fissure and undermines the enamel.
double caries(const Eigen::Vector3d& p) {
    return ellipsoid(p, {0.9, 0.1, 15.9}, {1.6, 1.3, 1.5});
}

ToothTissue tissueAt(const Eigen::Vector3d& p_mm) {
    const double outer = outerShape(p_mm);
    if (outer > 0) return ToothTissue::kAir;
    if (pulp(p_mm) < 0) return ToothTissue::kPulp;
    if (caries(p_mm) < 0) return ToothTissue::kCaries;
    return -outer < enamelThickness(p_mm.z()) ? ToothTissue::kEnamel : ToothTissue::kDentine;
}

constexpr double kToothBlurVoxels = 1.5;
constexpr int kSamplesPerAxis = 4;

double meanHu(const VolumeGeometry& geometry, const Eigen::Vector3d& index) {
    double sum = 0;
    for (int s = 0; s < kSamplesPerAxis * kSamplesPerAxis * kSamplesPerAxis; ++s) {
        const Eigen::Vector3i cell(s % kSamplesPerAxis, s / kSamplesPerAxis % kSamplesPerAxis,
                                   s / (kSamplesPerAxis * kSamplesPerAxis));
        const Eigen::Vector3d offset =
            ((cell.cast<double>().array() + 0.5) / kSamplesPerAxis - 0.5).matrix() * kToothBlurVoxels;
        sum += kToothHu[int(toothTissue(geometry.X_WV * geometry.spacing.cwiseProduct(index + offset)))];
    }
    return sum / (kSamplesPerAxis * kSamplesPerAxis * kSamplesPerAxis);
}

// It is the sum of four uniform numbers, scaled to variance 1: close to Gaussian, bounded, and
// exact arithmetic only.
double noise(uint64_t seed, uint64_t index) {
    const uint64_t bits = splitMix64(seed * 0x9e3779b97f4a7c15u + index);
    double sum = 0;
    for (int part = 0; part < 4; ++part) sum += (double(bits >> (16 * part) & 0xffff) + 0.5) / 65536 - 0.5;
    return sum * std::sqrt(3.0);
}

// Holds the tissue at the centres of all voxels and of one layer around them.
class TissueMap {
  public:
    explicit TissueMap(const VolumeGeometry& geometry) : size_(geometry.dims.array() + 2) {
        tissue_.reserve(size_t(size_.x()) * size_t(size_.y()) * size_t(size_.z()));
        forEachIndex({Eigen::Vector3i::Constant(-1), geometry.dims}, [&](const Eigen::Vector3i& v) {
            tissue_.push_back(toothTissue(geometry.X_WV * geometry.spacing.cwiseProduct(v.cast<double>())));
        });
    }
    ToothTissue at(int i, int j, int k) const {
        return tissue_[size_t(i + 1) +
                       size_t(size_.x()) * (size_t(j + 1) + size_t(size_.y()) * size_t(k + 1))];
    }
    bool isUniformAround(int i, int j, int k) const {
        for (int n = 0; n < 27; ++n)
            if (at(i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1) != at(i, j, k)) return false;
        return true;
    }

  private:
    Eigen::Vector3i size_;
    std::vector<ToothTissue> tissue_;
};

}  // namespace

ToothTissue toothTissue(const Eigen::Vector3d& p_W) noexcept {
    const Eigen::Vector3d p_mm = p_W * kPerMillimetre;
    const bool is_far = p_mm.head<2>().cwiseAbs().maxCoeff() > kReach || p_mm.z() < 0 || p_mm.z() > kHighest;
    return is_far ? ToothTissue::kAir : tissueAt(p_mm);
}

SoundTooth soundTooth(const Eigen::Vector3d& p_W) noexcept {
    const Eigen::Vector3d p_mm = p_W * kPerMillimetre;
    const double outer = outerShape(p_mm);
    return {outer * kMillimetre, (-outer - enamelThickness(p_mm.z())) * kMillimetre,
            pulp(p_mm) * kMillimetre};
}

VolumeGeometry toothGrid() {
    VolumeGeometry geometry;
    geometry.dims = {256, 256, 161};
    geometry.spacing.setConstant(0.125e-3);
    geometry.X_WV.position = {-127.5 * 0.125e-3, -127.5 * 0.125e-3, 0};
    return geometry;
}

RawVolume scanTooth(const VolumeGeometry& geometry, const ToothScan& scan) {
    RawVolume raw;
    raw.geometry = geometry;
    raw.is_hounsfield = true;
    raw.description = "tooth phantom";
    raw.values.reserve(geometry.voxelCount());
    const TissueMap tissues(geometry);
    std::vector<float> row;
    for (int k = 0; k < geometry.dims.z(); ++k)
        for (int j = 0; j < geometry.dims.y(); ++j) {
            for (int i = 0; i < geometry.dims.x(); ++i) {
                const double hu = tissues.isUniformAround(i, j, k)
                                      ? kToothHu[int(tissues.at(i, j, k))]
                                      : meanHu(geometry, Eigen::Vector3d(i, j, k));
                const size_t n = raw.values.size() + size_t(i);
                row.push_back(float(std::round(hu + scan.noise_hu * noise(scan.seed, n))));
            }
            raw.values.append(std::span<const float>(row));
            row.clear();
        }
    return raw;
}

}  // namespace bonemill
