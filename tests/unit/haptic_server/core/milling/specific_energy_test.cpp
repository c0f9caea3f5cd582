#include "haptic_server/core/milling/specific_energy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

constexpr Density kIso = 20000;
constexpr int kDense = 60000, kLoose = 30000;

// The bone gets denser along x in steps and has a label on its upper half.
std::shared_ptr<const BoneProperties> properties(VoxelVolume& volume) {
    test::forEachVoxel(test::wholeBox(volume), [&](int i, int j, int k) {
        volume.set(i, j, k, Density(i < 4 ? 5000 : i < 8 ? kLoose : kDense));
    });
    return std::make_shared<const BoneProperties>(volume, [](const Eigen::Vector3i& v) {
        return MaterialId(v.z() >= 6 ? 2 : v.z() >= 4 ? 1 : 0);
    });
}

class SpecificEnergyTest : public testing::Test {
  protected:
    SpecificEnergyTest() : volume_(test::boxGeometry({12, 8, 8}), kIso) {
        config_ = {
            .reference = 0.4e9, .reference_density = 50000, .exponent = 1.5, .materials = {{}, {}, {}}};
        config_.materials[2].specific_energy = 3e9;
        properties_ = properties(volume_);
    }
    double byDensity(double density) const { return 0.4e9 * std::pow(density / 50000, 1.5); }

    VoxelVolume volume_;
    SpecificEnergyConfig config_;
    std::shared_ptr<const BoneProperties> properties_;
};

TEST_F(SpecificEnergyTest, IsAPowerOfTheDensityThatTheDensestCornerHad) {
    SpecificEnergy u(config_, properties_, kIso);
    EXPECT_NEAR(u.ofCell({5, 2, 1}) / byDensity(kLoose), 1, 1e-4);
    EXPECT_NEAR(u.ofCell({7, 2, 1}) / byDensity(kDense), 1, 1e-4);
    EXPECT_NEAR(u.ofCell({3, 2, 1}) / byDensity(kLoose), 1, 1e-4);
    EXPECT_NEAR(u.ofCell({9, 2, 4}) / byDensity(kDense), 1, 1e-4);  // a material that says nothing of it
}

TEST_F(SpecificEnergyTest, IsTheMaterialsOwnWhereItHasOne) {
    SpecificEnergy u(config_, properties_, kIso);
    EXPECT_EQ(u.ofCell({5, 2, 6}), 3e9);
    EXPECT_EQ(u.ofCell({9, 2, 6}), 3e9);
}

TEST_F(SpecificEnergyTest, IsTheReferencesWhereThereWasNoBone) {
    SpecificEnergy u(config_, properties_, kIso);
    EXPECT_EQ(u.ofCell({1, 2, 1}), 0.4e9);
    EXPECT_EQ(u.ofCell({-9, 2, 100}), 0.4e9);
    EXPECT_EQ(SpecificEnergy(config_, nullptr, kIso).ofCell({9, 2, 1}), 0.4e9);
}

TEST_F(SpecificEnergyTest, LastsWhenTheBoneGoes) {
    SpecificEnergy u(config_, properties_, kIso);
    const double before = u.ofCell({9, 2, 1});
    test::forEachVoxel(test::wholeBox(volume_), [&](int i, int j, int k) { volume_.set(i, j, k, 0); });
    EXPECT_EQ(u.ofCell({9, 2, 1}), before);
    EXPECT_EQ(SpecificEnergy(config_, properties_, kIso).ofCell({9, 2, 1}), before) << "nothing remembered";
}

}  // namespace
}  // namespace bonemill
