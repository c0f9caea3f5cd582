// What is kept from gathering to gathering changes nothing of what is found.
#include "haptic_server/core/contact/near_shell.h"

#include <gtest/gtest.h>

#include "haptic_server/core/contact/gradient_contact.h"
#include "tests/support/contact_scene.h"

namespace bonemill {
namespace {

using namespace test;
using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kMargin = 20e-6;
constexpr GradientContactConfig kConfig;
const std::vector<ToolShape> kThinBurrAndShaft = {SphereShape{{0, 0, 0}, 0.6e-3},
                                                  CapsuleShape{{0, 0, 0}, {0, 8e-3, 0}, 0.5e-3}};

// A ball in leaves of 16³ cells, and a burr in its surface.
class NearShellTest : public testing::TestWithParam<ToolDistance> {
  protected:
    double random(double most) { return std::uniform_real_distribution<double>(-most, most)(random_); }
    Vector3d randomVector(double most) {
        const double x = random(most), y = random(most), z = random(most);
        return {x, y, z};
    }
    // The burr goes on by so much, m, straight for a while, but not far from the surface.
    void move(double step) {
        if (steps_++ % 60 == 0) heading_ = randomVector(1).normalized(), turns_ = !turns_;
        X_VT_ = X_VT_.incremented(step * heading_, turns_ ? randomVector(100 * step) : Vector3d::Zero());
        const Vector3d from_middle = X_VT_.position - kMiddle;
        X_VT_.position = kMiddle + from_middle.normalized() * std::clamp(from_middle.norm(), 2.0e-3, 2.6e-3);
    }
    // One of the voxels near the burr's middle is not bone any more.
    void cut() {
        const Vector3i voxel = (X_VT_.position + randomVector(0.5e-3))
                                   .array()
                                   .unaryExpr([](double p) { return std::round(p / kVoxel); })
                                   .matrix()
                                   .cast<int>();
        scene_.bone.volume.set(voxel.x(), voxel.y(), voxel.z(), 0);
        const IndexBox box{voxel, voxel};
        scene_.bone.lattice.refreshRanges(scene_.bone.volume, box, -1);
        ASSERT_TRUE(scene_.bone.shell.refresh(scene_.bone.volume, scene_.bone.lattice, {&box, 1}));
    }
    const ToolField& tool() { return scene_.tool.field({.tool_distance = GetParam()}); }
    // A grid knows of some points that the tool cannot touch only that they are beyond some distance: those
    // may be candidates by one way alone, and cutting them takes room from others.
    AccuracySettings settings() const {
        AccuracySettings settings{.tool_distance = GetParam()};
        if (GetParam() == ToolDistance::kGrid) settings.sample_spacing = 0;
        return settings;
    }
    // Gathers by both at this margin, and expects the same, here and wherever the tool comes within it;
    // returns how many points touch.
    uint32_t compare(double margin) {
        anew_.forgetNear();
        EXPECT_TRUE(kept_.gather(scene_.view(settings()), tool(), X_VT_, margin) &&
                    anew_.gather(scene_.view(settings()), tool(), X_VT_, margin));
        if (GetParam() == ToolDistance::kAnalytic) {
            EXPECT_EQ(kept_.candidateCount(), anew_.candidateCount());
        }
        const Pose moved{X_VT_.position + margin * randomVector(1).normalized(), X_VT_.rotation};
        expectSameAt(moved);
        return expectSameAt(X_VT_);
    }
    uint32_t expectSameAt(const Pose& X_VT) {
        const GradientContactResult kept = kept_.evaluate<float>(tool(), X_VT),
                                    anew = anew_.evaluate<float>(tool(), X_VT);
        EXPECT_EQ(kept.contacts, anew.contacts);
        EXPECT_EQ(kept.term.energy, anew.term.energy);
        EXPECT_EQ(kept.term.wrench.force, anew.term.wrench.force);
        EXPECT_EQ(kept.term.wrench.torque, anew.term.wrench.torque);
        return anew.contacts;
    }

    static constexpr double kVoxel = 0.1e-3;
    const Vector3d kMiddle = Vector3d::Constant(2.4e-3);
    ContactScene scene_{cubeGeometry(49, kVoxel), sphereAt(kMiddle, 1.7e-3), kThinBurrAndShaft};
    GradientContact kept_{kConfig}, anew_{kConfig};
    Pose X_VT_{kMiddle + Vector3d(0, 0, 2.2e-3), expRotation({M_PI / 2, 0, 0})};  // shaft upright
    Vector3d heading_ = Vector3d::Zero();
    int steps_ = 0;
    bool turns_ = true;
    std::mt19937 random_{17};
};

TEST_P(NearShellTest, FindsWhatIsFoundWithoutIt) {
    int touching = 0;
    for (int n = 0; n < 3000 && !HasFailure(); ++n) {
        move(n % 100 == 99 ? 0.5e-3 : n % 10 == 9 ? 30e-6 : 6e-6);
        if (n % 7 == 6) cut();
        touching += compare(kMargin) > 0;
        if (n % 5 == 4) compare(10 * kMargin);
    }
    EXPECT_GT(touching, 500);
}

TEST_P(NearShellTest, AToolThatGrowsComesNearer) {
    GrowingField growing;
    growing.setWhole(tool());
    int touching = 0;
    for (int n = 0; n < 100 && !HasFailure(); ++n) {
        growing.setOffset(0.3e-3 - n * 3e-6);
        kept_.noteGrowth(3e-6);
        anew_.forgetNear();
        ASSERT_TRUE(kept_.gather(scene_.view(settings()), growing, X_VT_, kMargin) &&
                    anew_.gather(scene_.view(settings()), growing, X_VT_, kMargin));
        ASSERT_EQ(kept_.candidateCount(), anew_.candidateCount());
        touching += kept_.evaluate<float>(growing, X_VT_).contacts > 0;
    }
    EXPECT_GT(touching, 10);
}

TEST_P(NearShellTest, AnotherToolOrShellIsNoticed) {
    const ContactScene other(cubeGeometry(49, kVoxel), sphereAt(kMiddle, 1.75e-3),
                             {SphereShape{{0, 0, 0}, 0.7e-3}});
    int touching = 0;
    for (int n = 0; n < 60 && !HasFailure(); ++n) {
        const ContactScene& bone = n / 10 % 2 == 0 ? scene_ : other;
        const ToolField& field = (n / 15 % 2 == 0 ? scene_ : other).tool.field({.tool_distance = GetParam()});
        anew_.forgetNear();
        ASSERT_TRUE(kept_.gather(bone.view(settings()), field, X_VT_, kMargin) &&
                    anew_.gather(bone.view(settings()), field, X_VT_, kMargin));
        ASSERT_EQ(kept_.candidateCount(), anew_.candidateCount()) << n;
        const GradientContactResult kept = kept_.evaluate<float>(field, X_VT_);
        ASSERT_EQ(kept.term.energy, anew_.evaluate<float>(field, X_VT_).term.energy) << n;
        touching += kept.contacts > 0;
    }
    EXPECT_GT(touching, 10);
}

// Counted as what it would be without copies, so that a tick has time for as much with them.
TEST_P(NearShellTest, CountsWhatItSaves) {
    size_t kept = 0, anew = 0;
    for (int n = 0; n < 200; ++n) {
        X_VT_.position += 5e-6 * Vector3d(n % 100 < 50 ? 1 : -1, 0, 0);
        anew_.forgetNear();
        kept_.gather(scene_.view(settings()), tool(), X_VT_, kMargin);
        anew_.gather(scene_.view(settings()), tool(), X_VT_, kMargin);
        kept += kept_.takePointTests(), anew += anew_.takePointTests();
    }
    EXPECT_GT(double(kept), 0.95 * double(anew));
    EXPECT_LT(double(kept), 1.5 * double(anew));
}

// A hand that works goes some millimetres in a second.
TEST(NearShell, HasAFewOfThePoints) {
    const Vector3d middle = Vector3d::Constant(1.6e-3);
    const ContactScene scene(cubeGeometry(33, 0.1e-3), sphereAt(middle, 1.2e-3), kThinBurrAndShaft);
    NearShell near(10'000);
    size_t points = 0, most = 0, gatherings = 0;
    for (int n = 0; n < 300; ++n) {
        const Pose X_VT{middle + Vector3d(n * 2e-6, 0, 1.75e-3), expRotation({M_PI / 2, 0, 0})};
        near.begin({scene.bone.shell, 0, scene.tool.field({}), X_VT, kMargin, 0.1e-3});
        size_t given = 0;
        for (LeafId leaf = 0; leaf < scene.bone.lattice.leafCount(); ++leaf)
            near.forEachBlock(leaf, [&](const ShellBlock&, uint32_t count) { given += count; });
        near.end();
        if (n < 20) continue;  // the copies are made by and by
        points += given, ++gatherings;
        most = std::max(most, given);
    }
    EXPECT_LT(points, gatherings * scene.bone.shell.pointCount(0) / 10);
    EXPECT_LT(most, scene.bone.shell.pointCount(0) / 5);
    EXPECT_GT(points, gatherings * 10);
}

INSTANTIATE_TEST_SUITE_P(Distances, NearShellTest,
                         testing::Values(ToolDistance::kAnalytic, ToolDistance::kGrid));

// Without room it gives the shell's own blocks.
TEST(NearShell, WithoutRoomNothingIsMissing) {
    const Vector3d middle = Vector3d::Constant(1.6e-3);
    const ContactScene scene(cubeGeometry(33, 0.1e-3), sphereAt(middle, 1.2e-3), kThinBurrAndShaft);
    const ToolField& tool = scene.tool.field({});
    NearShell near(0);
    const Pose X_VT{middle, Eigen::Quaterniond::Identity()};
    for (int n = 0; n < 3; ++n) {
        near.begin({scene.bone.shell, 0, tool, X_VT, kMargin, 2e-3});  // all of it is near
        size_t points = 0;
        for (LeafId leaf = 0; leaf < scene.bone.lattice.leafCount(); ++leaf)
            near.forEachBlock(leaf, [&](const ShellBlock&, uint32_t count) { points += count; });
        near.end();
        EXPECT_EQ(points, scene.bone.shell.pointCount(0));
    }
}

}  // namespace
}  // namespace bonemill
