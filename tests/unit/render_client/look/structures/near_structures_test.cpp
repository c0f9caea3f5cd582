// What bone knows of the structures below its surface, sample by sample.
#include "render_client/look/structures/near_structures.h"

#include <gtest/gtest.h>

#include "tests/unit/render_client/look/structures/two_balls.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using test::kWarning;

const std::map<uint32_t, Eigen::Vector3f> kColours = {{3, {1, 0, 0}}, {7, {0, 0.4f, 1}}};

// Calls visit(place in V, sample).
template <class Visit>
void forEachSample(const NearStructures& near, Visit&& visit) {
    ASSERT_EQ(near.samples.size(), size_t(near.size.prod()));
    size_t place = 0;
    for (int k = 0; k < near.size.z(); ++k)
        for (int j = 0; j < near.size.y(); ++j)
            for (int i = 0; i < near.size.x(); ++i)
                visit(
                    (near.first_V + near.step * Eigen::Vector3f(float(i), float(j), float(k))).cast<double>(),
                    near.samples[place++]);
}

double toNear(const Vector3d& p) {
    return (p - test::kNear).norm() - test::kNearRadius;
}
double toFar(const Vector3d& p) {
    return (p - test::kFar).norm() - test::kFarRadius;
}

// Between samples the distance is trilinear, as the graphics card takes it.
TEST(NearStructures, TellDistanceAndColourOfTheNext) {
    const NearStructures near = nearStructures(test::twoBalls(), kColours, kWarning);
    EXPECT_LE(near.size.prod(), NearStructures::kMaxSamples);
    int reached = 0;
    forEachSample(near, [&](const Vector3d& p, const std::array<uint8_t, 4>& sample) {
        const double expected = std::clamp(std::min(toNear(p), toFar(p)), 0.0, kWarning);
        EXPECT_NEAR(sample[3] / 255.0 * kWarning, expected, kWarning / 255 + 1e-5);
        if (expected >= kWarning) return;
        ++reached;
        const Eigen::Vector3f& colour = kColours.at(toNear(p) < toFar(p) ? 3 : 7);
        if (std::abs(toNear(p) - toFar(p)) < 5e-5) return;
        for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(sample[c] / 255.0, double(colour[Eigen::Index(c)]), 0.003);
    });
    EXPECT_GT(reached, 1000);
    EXPECT_TRUE(nearStructures({}, kColours, kWarning).samples.empty());
    EXPECT_TRUE(nearStructures(test::twoBalls(), {}, kWarning).samples.empty());
}

TEST(NearStructures, LeaveOutWhatIsNotShown) {
    const NearStructures near = nearStructures(test::twoBalls(), {{7, {0, 0.4f, 1}}}, kWarning);
    forEachSample(near, [&](const Vector3d& p, const std::array<uint8_t, 4>& sample) {
        EXPECT_NEAR(sample[3] / 255.0 * kWarning, std::clamp(toFar(p), 0.0, kWarning), kWarning / 255 + 1e-5);
    });
}

TEST(NearStructures, AreBoundedHoweverLargeAStructureIs) {
    for (const Vector3d& size :
         {Vector3d(1e5, 1e-3, 1e-3), Vector3d(1e5, 1e5, 1e-3), Vector3d(1e-9, 1e-9, 1e-9)}) {
        NodeMesh mesh = test::ballStructure(3, Vector3d::Zero(), 1);
        mesh.step = (size / 65535).cast<float>();
        StructureSet structures;
        structures.set(mesh, kWarning);
        const NearStructures near = nearStructures(structures, kColours, kWarning);
        EXPECT_LE(near.size.cast<int64_t>().prod(), NearStructures::kMaxSamples) << size.transpose();
        EXPECT_LE(near.size.maxCoeff(), NearStructures::kMaxPerAxis) << size.transpose();
        EXPECT_EQ(near.samples.size(), size_t(near.size.prod()));
    }
}

// Halves with each 0.42 mm, begins with the most and is gone at the reach, without a step.
TEST(NearStructures, ShineThroughThinBoneOnly) {
    EXPECT_FLOAT_EQ(shineThrough(0), kMostShine);
    EXPECT_FLOAT_EQ(shineThrough(-1e-3f), kMostShine);
    EXPECT_EQ(shineThrough(kShineReach), 0);
    EXPECT_EQ(shineThrough(1), 0);
    EXPECT_NEAR(shineThrough(0.5e-3f), 0.31, 0.01);
    EXPECT_NEAR(shineThrough(1e-3f), 0.12, 0.01);
    for (float d = 0; d < kShineReach; d += 1e-5f) {
        EXPECT_GT(shineThrough(d), shineThrough(d + 1e-5f));
        EXPECT_LT(shineThrough(d) - shineThrough(d + 1e-5f), 0.02f);
    }
}

}  // namespace
}  // namespace bonemill
