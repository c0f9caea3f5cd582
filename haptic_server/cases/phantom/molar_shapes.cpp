#include "haptic_server/cases/phantom/molar_shapes.h"

#include <limits>

#include "common/base/units.h"
#include "haptic_server/cases/phantom/lattice_noise.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

// The middle of the tooth's crown in its own frame, and what lies around it.
const Vector3d kCrownMiddle(0, 0, 14.6);
const Eigen::AlignedBox3d kToothBox(Vector3d(-6.5, -6.5, 0), Vector3d(6.5, 6.5, 20));

double depthOf(ThirdMolarKind::Impaction impaction) {
    using enum ThirdMolarKind::Impaction;
    return impaction == kShallow ? -0.7 : impaction == kMiddle ? 1.5 : 4.0;
}
double gapOf(ThirdMolarKind::Nerve nerve) {
    using enum ThirdMolarKind::Nerve;
    return nerve == kFar ? 3.0 : nerve == kNear ? 1.2 : 0.3;
}

PlacedTooth impacted(double scale, double tilt, double depth) {
    PlacedTooth tooth(scale, tilt, {0.6, 6.2, 0});
    tooth.move({0, 0, -depth - tooth.highest()});
    return tooth;
}

// It comes down from the ramus, passes under the roots, and goes on forwards.
std::vector<Vector3d> canalPath(const Vector3d& under, double aside) {
    return {{-1.5, 26, under.z() + 9},
            {-1 + aside / 2, under.y() + 6, under.z() + 2.2},
            under,
            {aside, under.y() - 7, under.z() - 0.6},
            {0.5, -6, under.z() - 1.2},
            {1, -18, under.z() - 1}};
}

// A limb of round section about a straight line.
double limb(const Vector3d& p, const Vector3d& a, const Vector3d& b, double radius) {
    const Vector3d along = b - a;
    const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (p - a - t * along).norm() - radius;
}

}  // namespace

const Eigen::AlignedBox3d& jawBlock() {
    static const Eigen::AlignedBox3d kBlock(Vector3d(-10, -13, -27), Vector3d(10, 21, 9));
    return kBlock;
}

PlacedTooth::PlacedTooth(double scale, double tilt, const Vector3d& crown)
    : scale_(scale),
      turn_(Eigen::AngleAxisd(tilt, Vector3d::UnitX()) * Eigen::AngleAxisd(kTurn / 4, Vector3d::UnitZ())),
      crown_(crown),
      lowest_(0, 0, std::numeric_limits<double>::infinity()),
      highest_(-std::numeric_limits<double>::infinity()) {
    constexpr double kStep = 0.4;
    const Eigen::Vector3i steps = (kToothBox.sizes() / kStep).cast<int>();
    for (int k = 0; k <= steps.z(); ++k)
        for (int j = 0; j <= steps.y(); ++j)
            for (int i = 0; i <= steps.x(); ++i) {
                const Vector3d local = kToothBox.min() + kStep * Vector3d(i, j, k);
                if (soundTooth(local * kMillimetre).outer > 0) continue;
                const Vector3d p = crown_ + scale_ * (turn_ * (local - kCrownMiddle));
                highest_ = std::max(highest_, p.z());
                if (p.z() < lowest_.z()) lowest_ = p;
            }
}

SoundTooth PlacedTooth::at(const Vector3d& p) const noexcept {
    const Vector3d local = kCrownMiddle + turn_.conjugate() * (p - crown_) / scale_;
    const double away = kToothBox.exteriorDistance(local);
    constexpr double kFar = 2;
    if (away > kFar) return {away * scale_, away * scale_, away * scale_};
    const SoundTooth tooth = soundTooth(local * kMillimetre);
    const double factor = scale_ * kPerMillimetre;
    return {tooth.outer * factor, tooth.enamel * factor, tooth.pulp * factor};
}

void PlacedTooth::move(const Vector3d& by) noexcept {
    crown_ += by;
    lowest_ += by;
    highest_ += by.z();
}

MolarShapes::Measures::Measures(uint64_t seed) {
    uint64_t state = splitMix64(seed);
    const auto in = [&](double low, double high) {
        state = splitMix64(state);
        return low + (high - low) * unitOf(state);
    };
    tilt = in(30, 42) * kDegree;
    scale = in(0.86, 0.94);
    half_width = in(7.2, 8.2);
    nerve_aside = in(-1.2, 0.6);
    nerve_radius = in(0.95, 1.15);
    buccal = in(2.0, 2.8);
    lingual = in(1.0, 1.5);
}

MolarShapes::MolarShapes(const ThirdMolarKind& kind) : MolarShapes(kind, Measures(kind.seed)) {}

MolarShapes::MolarShapes(const ThirdMolarKind& kind, const Measures& measures)
    : measures_(measures),
      second_(0.95, 0, {0.3, -5.6, 4.2}),
      third_(impacted(measures.scale, measures.tilt, depthOf(kind.impaction))),
      nerve_radius_(measures.nerve_radius),
      canal_(canalPath(third_.lowest() + Vector3d(measures.nerve_aside - third_.lowest().x(), 0,
                                                  -gapOf(kind.nerve) - measures.nerve_radius),
                       measures.nerve_aside),
             kCanalRadius) {}

double MolarShapes::jaw(const Vector3d& p) const noexcept {
    // The body's section lies between ellipse and box; the front edge of the ramus rises behind, with the
    // oblique line on the cheek's side.
    constexpr double kExponent = 3, kHalfHeight = 13;
    const Eigen::Array2d scaled = Eigen::Array2d(p.x() - 0.3, p.z() + kHalfHeight).abs() /
                                  Eigen::Array2d(measures_.half_width, kHalfHeight);
    const double size = std::pow(scaled.pow(kExponent).sum(), 1 / kExponent);
    const double body = (size - 1) * measures_.half_width;
    const double ramus = limb(p, {2.5, 14, -7}, {3.5, 30, 12}, 5.5);
    const double ridge = limb(p, {5.5, -2, -8}, {5.5, 18, -2}, 3.4);
    return blend(blend(body, ramus, 5), ridge, 3);
}

double MolarShapes::cortex(const Vector3d& p) const noexcept {
    return measures_.lingual + (measures_.buccal - measures_.lingual) * smoothStep(-4, 4, p.x());
}

bool MolarShapes::isLingual(const Vector3d& p) const noexcept {
    const double depth = -jaw(p);
    return depth > 0 && depth < cortex(p) && p.x() < -0.55 * measures_.half_width && p.z() < -1 &&
           p.z() > -16;
}

}  // namespace bonemill
