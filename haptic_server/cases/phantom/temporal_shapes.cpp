#include "haptic_server/cases/phantom/temporal_shapes.h"

#include <limits>

#include "common/base/units.h"
#include "haptic_server/cases/phantom/lattice_noise.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

// The seed's numbers, drawn one after the other.
class Drawing {
  public:
    explicit Drawing(uint64_t seed) : state_(splitMix64(seed)) {}
    double in(double low, double high) {
        state_ = splitMix64(state_);
        return low + (high - low) * unitOf(state_);
    }

  private:
    uint64_t state_;
};

double antrumSize(TemporalBoneKind::Pneumatisation pneumatisation) {
    using enum TemporalBoneKind::Pneumatisation;
    return pneumatisation == kWell ? 1.05 : pneumatisation == kPoor ? 0.85 : 0.62;
}

double both(double a, double b, double fillet) {
    return -blend(-a, -b, fillet);  // the smooth intersection
}

double ovoid(const Vector3d& p, const Vector3d& centre, const Vector3d& half_axes) {
    return ellipsoidal<Vector3d>(p - centre, half_axes);
}

double hump(double x, double width) {
    return std::exp(-(x / width) * (x / width));
}

// Far away the distance to the tube's box is enough.
double tubeDistance(const SplineTube& tube, const Vector3d& p) {
    constexpr double kFar = 6.5;
    const double away = tube.box().exteriorDistance(p);
    return away > kFar ? away : tube.signedDistance(p);
}

// It leads from `from` round an arc in the plane of u and v to `to`; angles in degrees from u towards v.
SplineTube arcTube(const Vector3d& from, const Vector3d& centre, const Vector3d& u, const Vector3d& v,
                   double radius, double first_deg, double last_deg, const Vector3d& to, double lumen) {
    constexpr int kPoints = 8;
    std::vector<Vector3d> points{from};
    for (int n = 0; n < kPoints; ++n) {
        const double angle = (first_deg + (last_deg - first_deg) * n / (kPoints - 1)) * kDegree;
        points.push_back(centre + radius * (std::cos(angle) * u + std::sin(angle) * v));
    }
    points.push_back(to);
    return {points, lumen};
}

const Vector3d kVestibule(-22.9, -4.3, -4.8);
constexpr double kLumen = 0.5;  // radius of a bony semicircular canal

// The bony canals' arcs have radii of 2.3 (lateral), 3.2 (superior) and 3.1 mm (posterior): Spoor and
// Zonneveld, Yearbook of Physical Anthropology 41:211, 1998. They stand nearly at right angles (Della
// Santina et al., JARO 6:191, 2005), the lateral one with its front 25 degrees up.
SplineTube lateralCanal() {
    const double c = std::cos(25 * kDegree), s = std::sin(25 * kDegree);
    return arcTube({-22.4, -3.4, -3.4}, {-21.3, -0.8, -1.0}, Vector3d::UnitX(), {0, c, -s}, 2.3, -105, 125,
                   {-23.4, -2.6, -3.6}, kLumen);
}
SplineTube superiorCanal() {
    return arcTube({-22.7, -4.6, -3.4}, {-24.4, -2.6, 0.2}, Vector3d(1, -1, 0).normalized(),
                   Vector3d::UnitZ(), 3.2, -25, 185, {-26.4, -0.7, -1.2}, kLumen);
}
SplineTube posteriorCanal() {
    return arcTube({-26.4, -0.7, -1.2}, {-24.6, 1.9, -3.4}, Vector3d(1, 1, 0).normalized(), Vector3d::UnitZ(),
                   3.1, 140, -150, {-24.1, -3.2, -5.6}, kLumen);
}

// Two and a half turns about an axis that leaves the meatus to the front and side.
SplineTube cochlea() {
    const Vector3d axis = Vector3d(0.64, -0.76, -0.1).normalized(),
                   u = (Vector3d::UnitZ() - axis.z() * axis).normalized(), v = axis.cross(u);
    constexpr int kPoints = 26;
    std::vector<Vector3d> points;
    for (int n = 0; n <= kPoints; ++n) {
        const double part = double(n) / kPoints, angle = 2.5 * kTurn * part - 2.2;
        const double radius = 3.1 - 2.2 * part;
        points.push_back(Vector3d(-23.7, -9.3, -6.6) + 2.9 * part * axis +
                         radius * (std::cos(angle) * u + std::sin(angle) * v));
    }
    return {points, 0.65};
}

std::vector<Vector3d> sinusPath(const TemporalMeasures& m, const Vector3d& bulb) {
    const Vector3d shift(-m.sinus_deep, -m.sinus_forward, 0);
    std::vector<Vector3d> path{{-15.5, 30, 3.5},   {-11.6, 24, 1},   {-9.8, 18.2, -4.5},
                               {-10.8, 16.8, -10}, {-15, 16.2, -15}, {-21.5, 12, -17.2}};
    for (size_t n = 1; n < 5; ++n) path[n] += shift;
    path.push_back({-25.4, 4.6, std::min(bulb.z() + 0.5, -16.0)});
    path.push_back(bulb);
    return path;
}

// Labyrinthine, tympanic and mastoid part, 2.9, 12 and 16 mm long (U-HRCT of 47 healthy persons,
// doi:10.15953/j.ctta.2026.163); the mastoid part lies 3.7 mm behind the ear canal at the umbo's level
// (Merati et al., Surg Radiol Anat 43:145, 2021).
std::vector<Vector3d> nervePath(double back) {
    return {{-33, -5.4, -1.4},           {-29.5, -6, -1.2},
            {-26.9, -6.9, -0.8},         {-25.2, -9.0, 0.1},
            {-22.3, -7.2, -1.2},         {-19.9, -4.3, -2.4},
            {-18.5, -1.0, -2.9},         {-18.0, 0.8 + back / 4, -4.2},
            {-17.4, 1.7 + back / 2, -8}, {-16.7, 2.3 + back, -13},
            {-16.1, 2.7 + back, -19},    {-15.4, 2.0 + back, -29}};
}

Vector3d bulbOf(const TemporalBoneKind& kind, const TemporalMeasures& m) {
    return {-26, -0.5, -17 + m.bulb_up + (kind.has_high_jugular ? 4 : 0)};
}
constexpr double kBulbRadius = 4.3;

// The drum leans outwards above and behind.
const Vector3d kUmbo(-16.4, -6.7, -6.2), kOutwards = Vector3d(0.87, -0.25, -0.42).normalized();
constexpr double kDrumHalf = 0.12;

}  // namespace

TemporalMeasures::TemporalMeasures(const TemporalBoneKind& kind) {
    Drawing draw(kind.seed);
    sinus_forward = draw.in(-1.5, 1.5);
    sinus_deep = draw.in(-0.6, 1.0);
    sinus_radius = draw.in(3.6, 4.4);
    tegmen_up = draw.in(-0.3, 1.0);
    bulb_up = draw.in(-1, 0.6);
    tip_down = draw.in(-1.5, 1.5);
    nerve_back = draw.in(-0.5, 0.5);
    nerve_radius = draw.in(0.6, 0.75);
    canal_turn = draw.in(-3, 3) * kDegree;
    ear_canal_radius = draw.in(3.6, 4.1);
    antrum_size = draw.in(0.92, 1.1) * antrumSize(kind.pneumatisation);
    cortex = draw.in(1.5, 2.3);
    sinus_plate = draw.in(0.6, 0.95);
    tegmen_plate = draw.in(0.6, 1.1);
    for (double& phase : wave_phase) phase = draw.in(0, kTurn);
    low_dura = kind.has_low_dura ? 3 : 0;
}

double TemporalShapes::waves(const Vector3d& p) const noexcept {
    const Vector3d& phase = measures_.wave_phase;
    return (std::sin(0.45 * p.x() + 0.3 * p.y() + phase.x()) +
            std::sin(0.5 * p.y() - 0.35 * p.z() + phase.y()) +
            std::sin(0.4 * p.z() + 0.42 * p.x() + phase.z())) /
           3;
}

const Eigen::AlignedBox3d& temporalBlock() {
    static const Eigen::AlignedBox3d kBlock(Vector3d(-32, -14, -28), Vector3d(4, 26, 11));
    return kBlock;
}

TemporalShapes::TemporalShapes(const TemporalBoneKind& kind)
    : measures_(kind),
      bulb_(bulbOf(kind, measures_)),
      sinus_(sinusPath(measures_, bulb_), measures_.sinus_radius),
      vein_({bulb_, {-26, -1.5, -23}, {-25.5, -2.5, -34}}, 3.8),
      nerve_(nervePath(measures_.nerve_back), measures_.nerve_radius),
      carotid_({{-26, -8.5, -34}, {-26, -10, -20}, {-27.2, -11.6, -14.5}, {-31, -14.5, -12}}, 2.5),
      meatus_({{-27.2, -6.3, -2.9}, {-30, -5.8, -2.9}, {-36, -4.6, -2.9}}, 2.0),
      ear_canal_({{9, -5, -3.6}, {0, -5.2, -4.2}, {-8, -6.2, -4.9}, {-17, -7, -6.2}},
                 measures_.ear_canal_radius),
      canals_{lateralCanal(), superiorCanal(), posteriorCanal(),
              SplineTube({{-26.4, -0.7, -1.2}, {-25.2, -2.1, -2.8}, {-24, -3.4, -4}}, kLumen + 0.1)},
      cochlea_(cochlea()),
      ossicle_limbs_{
          SplineTube({{-16, -7.1, -1.0}, {-16.4, -7.1, -3}, {-16.7, -6.8, -6}}, 0.42),
          SplineTube({{-16.1, -4.6, -0.3}, {-15.7, -2.6, -0.2}, {-15.4, -0.9, -0.4}}, 0.62),
          SplineTube({{-16.2, -4.6, -0.6}, {-16.9, -4.4, -2.8}, {-17.4, -4.4, -4.9}, {-18.2, -4.4, -5}},
                     0.42),
          SplineTube({{-18.1, -4.4, -5}, {-19.2, -5.3, -5}, {-20.5, -5.4, -4.9}}, 0.25),
          SplineTube({{-18.1, -4.4, -5}, {-19.2, -3.5, -5}, {-20.5, -3.4, -4.9}}, 0.25)},
      aditus_({{-16.2, -3, 0.4}, {-15.4, 0.4, 0.6}, {-14, 4, 0.4}}, 2.0) {}

double TemporalShapes::sideOf(double y, double z) const noexcept {
    const double back = std::max(y - 5, 0.0), up = std::max(z - 2, 0.0), front = std::max(-y - 3, 0.0);
    const double zygoma = 2.2 * hump(z - 4, 2.5) * smoothStep(0, -8, y);
    return -0.014 * back * back - 0.03 * up * up - 0.01 * front * front + zygoma +
           1.6 * hump(y - 10, 9) * hump(z + 9, 13);
}

double TemporalShapes::tegmenAt(double x, double y) const noexcept {
    const double arcuate = 0.9 * hump(std::hypot(x + 24.4, y + 2.6), 3.7);
    return 5.2 + measures_.tegmen_up + arcuate + 0.8 * waves({x, y, 0}) * smoothStep(-21, -16, x) -
           measures_.low_dura * smoothStep(-19.5, -15.5, x);
}

double TemporalShapes::outer(const Vector3d& p) const noexcept {
    const double lateral = 0.9 * (p.x() - sideOf(p.y(), p.z())) + 0.4 * waves(p);
    const double beside = smoothStep(-14, -8, p.x()) * (1 - smoothStep(12, 22, p.y()));
    const double base = -19.5 - 2.5 * smoothStep(4, 10, p.y()) + 7.5 * beside;
    double shape = both(lateral, 0.8 * (base - p.z()), 3);
    // The mastoid process, and the tympanic bone around the ear canal.
    const double half = 13 + measures_.tip_down / 2;
    shape = blend(shape, ovoid(p, {-5.6, 8.5, -0.5 - half}, {7.4, 9.5, half}), 4);
    const double tympanic = std::max(tubeDistance(ear_canal_, p) - 2.0, lateral);
    shape = blend(shape, tympanic, 2);
    // The jaw's joint lies in front of the ear canal.
    const double joint = both(both(p.y() + 11.4, -19 - p.x(), 3), p.z() + 0.5, 4);
    return both(shape, -joint, 1.5);
}

double TemporalShapes::cranium(const Vector3d& p) const noexcept {
    static const Vector3d kOnPetrous(-13, 16, -4), kBackwards = Vector3d(-0.62, 0.78, 0.25).normalized();
    const double side = p.x() - sideOf(p.y(), p.z());
    const double middle = both(0.95 * (tegmenAt(p.x(), p.y()) - p.z()), side + 3.6, 4);
    const double behind = both(kBackwards.dot(kOnPetrous - p) + 0.5 * waves(p), side + 6.2, 3);
    const double posterior = both(behind, -18.2 - p.z(), 3);
    return std::min(middle, posterior);
}

double TemporalShapes::sinus(const Vector3d& p) const noexcept {
    const double bulb = (p - bulb_).norm() - kBulbRadius;
    return blend(blend(tubeDistance(sinus_, p), bulb, 1.5), tubeDistance(vein_, p), 1);
}

Vector3d TemporalShapes::turned(const Vector3d& p) const noexcept {
    return kVestibule + Eigen::AngleAxisd(measures_.canal_turn, Vector3d::UnitZ()) * (p - kVestibule);
}

double TemporalShapes::canals(const Vector3d& p) const noexcept {
    const Vector3d q = turned(p);
    double nearest = std::numeric_limits<double>::infinity();
    for (const SplineTube& canal : canals_) nearest = std::min(nearest, tubeDistance(canal, q));
    return nearest;
}

double TemporalShapes::innerEar(const Vector3d& p) const noexcept {
    return std::min(ovoid(p, kVestibule, {1.9, 2.6, 1.8}), tubeDistance(cochlea_, p));
}

double TemporalShapes::ossicles(const Vector3d& p) const noexcept {
    const double malleus = ovoid(p, {-16, -7.2, -0.1}, {1.15, 1.2, 1.3});
    const double incus = ovoid(p, {-16.2, -5.1, -0.2}, {1.0, 1.3, 1.25});
    const double footplate = ovoid(p, {-20.6, -4.4, -4.9}, {0.25, 1.45, 0.75});
    double shape = std::min(malleus, incus);
    for (const SplineTube& limb : ossicle_limbs_) shape = blend(shape, tubeDistance(limb, p), 0.4);
    return std::min(shape, footplate);
}

double TemporalShapes::middleEar(const Vector3d& p) const noexcept {
    const double tympanum = ovoid(p, {-17.6, -6.6, -5.6}, {3.0, 4.6, 6.2});
    const double attic = ovoid(p, {-16.2, -5.4, 0.2}, {2.7, 4.8, 3.3});
    const double window = (p - Vector3d(-19.6, -4.4, -4.9)).norm() - 1.5;  // the oval window's niche
    return std::min(blend(tympanum, attic, 1.5), window);
}

double TemporalShapes::antrum(const Vector3d& p) const noexcept {
    const double size = measures_.antrum_size;
    const double antrum = ovoid(p, {-13.9, 5.2, 0}, Vector3d(3.5, 5.2, 4.3) * size);
    return blend(antrum, tubeDistance(aditus_, p), 2);
}

double TemporalShapes::distance(TemporalShape shape, const Vector3d& p) const noexcept {
    const auto to_drum = [&] { return kOutwards.dot(p - kUmbo); };
    switch (shape) {
        case TemporalShape::kBlock: {
            const Vector3d beyond = (temporalBlock().min() - p).cwiseMax(p - temporalBlock().max());
            return beyond.maxCoeff();
        }
        case TemporalShape::kOuter:
            return outer(p);
        case TemporalShape::kCranium:
            return cranium(p);
        case TemporalShape::kSinus:
            return sinus(p);
        case TemporalShape::kNerve:
            return tubeDistance(nerve_, p);
        case TemporalShape::kCanals:
            return canals(p);
        case TemporalShape::kInnerEar:
            return innerEar(p);
        case TemporalShape::kOssicles:
            return ossicles(p);
        case TemporalShape::kEarCanal:
            return std::max(tubeDistance(ear_canal_, p), -to_drum());
        case TemporalShape::kDrum:
            return std::max(tubeDistance(ear_canal_, p) - 0.5, std::abs(to_drum()) - kDrumHalf);
        case TemporalShape::kMiddleEar:
            return middleEar(p);
        case TemporalShape::kAntrum:
            return antrum(p);
        case TemporalShape::kCarotid:
            return tubeDistance(carotid_, p);
        case TemporalShape::kMeatus:
            return tubeDistance(meatus_, p);
        case TemporalShape::kCount:
            break;
    }
    return std::numeric_limits<double>::infinity();
}

TemporalDistances TemporalShapes::distances(const Vector3d& p) const noexcept {
    TemporalDistances all;
    for (size_t n = 0; n < kTemporalShapes; ++n) all[n] = distance(TemporalShape(n), p);
    return all;
}

}  // namespace bonemill
