// Takes volumes that no scanner should deliver: whatever comes out is finite and within the limits.
#include <random>

#include "tests/stability/case_test.h"
#include "tests/stability/drive.h"
#include "tests/stability/hard_scenes.h"
#include "tests/support/whole_densities.h"

namespace bonemill::test {
namespace {

const VolumeGeometry kCube = boxOf(Eigen::Vector3d::Constant(4e-3));
const Eigen::Vector3d kCentre = Eigen::Vector3d::Constant(2e-3);

template <class DensityOf>
VoxelVolume filled(DensityOf&& density_of) {
    VoxelVolume volume(kCube, kTestIso);
    for (int k = 0; k < volume.dims().z(); ++k)
        for (int j = 0; j < volume.dims().y(); ++j)
            for (int i = 0; i < volume.dims().x(); ++i) volume.set(i, j, k, density_of(i, j, k));
    return volume;
}

// The burr is dragged through the volume along a spiral, turning. Returns the worst force over its limit, or
// NaN if anything is not finite.
double drag(VoxelVolume volume, const Variant& variant) {
    Scene scene(std::move(volume), burr(), variant);
    const HandLimitsConfig& most = scene.config.hand;
    Stepper stepper(scene);
    double worst = 0;
    uint32_t contacts = 0;
    for (int n = 0; n < 1000; ++n) {
        const double s = n / 1000.0;
        const Eigen::Vector3d p =
            kCentre + Eigen::Vector3d(2e-3 * std::cos(20 * s), 2e-3 * std::sin(20 * s), 6e-3 * (0.5 - s));
        stepper.step({p, expRotation({1.5 * s, -2.5 * s, 1 * s})});
        if (!stepper.isFinite()) return kNan;
        const Wrench& wrench = stepper.wrenchOnHand();
        worst =
            std::max({worst, wrench.force.norm() / most.max_force, wrench.torque.norm() / most.max_torque});
        contacts = std::max(contacts, stepper.record().contacts);
    }
    return contacts > 0 ? worst : kNan;  // it must have met something
}

double noise(const Variant& variant) {
    std::mt19937 random(1);
    return drag(filled([&](int, int, int) { return Density(random() & 0xffff); }), variant);
}

double dust(const Variant& variant) {
    std::mt19937 random(2);
    return drag(filled([&](int, int, int) { return random() % 50 ? Density(0) : kMaxDensity; }), variant);
}

// Central differences see no gradient anywhere, yet every edge crosses the surface.
double chessboard(const Variant& variant) {
    return drag(filled([](int i, int j, int k) { return (i + j + k) % 2 ? kMaxDensity : Density(0); }),
                variant);
}

// Everything is exactly at the iso-value: surface is only at the volume's border.
double flat(const Variant& variant) {
    return drag(filled([](int, int, int) { return kTestIso; }), variant);
}

// A ball lies in a CT in which one voxel of five is NaN or infinite.
double notANumber(const Variant& variant) {
    std::mt19937 random(3);
    RawVolume raw;
    raw.geometry = kCube;
    std::vector<float> values;
    for (int k = 0; k < kCube.dims.z(); ++k)
        for (int j = 0; j < kCube.dims.y(); ++j)
            for (int i = 0; i < kCube.dims.x(); ++i) {
                const double r = (kVoxel * Eigen::Vector3d(i, j, k) - kCentre).norm();
                const float hu = float(std::clamp(1000 + 2e6 * (1.5e-3 - r), -1000.0, 3000.0));
                const uint32_t kind = random() % 15;
                values.push_back(kind == 0   ? std::numeric_limits<float>::quiet_NaN()
                                 : kind == 1 ? std::numeric_limits<float>::infinity()
                                 : kind == 2 ? -std::numeric_limits<float>::infinity()
                                             : hu);
            }
    raw.values.append(std::move(values));
    return drag(densify(raw, DensityWindow{-1000, 3000, 600}), variant);
}

// A plate of 14 × 14 mm lies on a plane of 0.125 mm voxels, with one contact per voxel face.
double manyContacts(const Variant& variant) {
    constexpr double kHalf = 7e-3, kThick = 1e-3, kPlaneTop = 1.05e-3;
    const auto plate = [=](const Eigen::Vector3d& p) {
        const Eigen::Vector3d q = p.cwiseAbs() - Eigen::Vector3d(kHalf, kHalf, kThick);
        return q.cwiseMax(0).norm() + std::min(0.0, q.maxCoeff());
    };
    const Eigen::Vector3d middle(8e-3, 8e-3, kPlaneTop);
    Scene scene(bodyVolume(boxOf({16e-3, 16e-3, 2e-3}), halfSpace(middle, Eigen::Vector3d::UnitZ())),
                {gridOf(plate, {kHalf, kHalf, kThick}, 0.5e-3), {}, kThick}, variant);
    Stepper stepper(scene);
    uint32_t contacts = 0;
    double worst = 0;
    for (int n = 0; n < 60; ++n) {
        stepper.step(upright(middle + Eigen::Vector3d(0, 0, kThick + 0.05e-3 - n * 5e-6)));
        if (!stepper.isFinite()) return kNan;
        contacts = std::max(contacts, stepper.record().contacts);
        worst = worseOf(worst, stepper.wrenchOnHand().force.norm() / scene.config.hand.max_force);
    }
    const uint32_t s = uint32_t(scene.config.accuracy.shell_factor);
    const double wanted = 1e4 / (s * s);
    return contacts >= wanted ? worst : kNan;
}

const std::vector<StabilityCase> kBadVolumeCases{
    {"random_noise_ct", "of_limit", 1 + 1e-9, noise, {}, {"all_felt", "all_effects"}},
    {"single_voxel_dust", "of_limit", 1 + 1e-9, dust, {}, {"all_felt", "all_effects"}},
    {"zero_gradient_chessboard", "of_limit", 1 + 1e-9, chessboard, {}},
    {"zero_gradient_flat", "of_limit", 1 + 1e-9, flat, {}},
    {"nan_in_ct", "of_limit", 1 + 1e-9, notANumber, {}, {"all_felt", "all_effects"}},
    {"ten_thousand_contacts", "of_limit", 1 + 1e-9, manyContacts, {}, {"all_felt", "all_effects"}},
};
BONEMILL_STABILITY_CASES(BadVolume, kBadVolumeCases);

}  // namespace
}  // namespace bonemill::test
