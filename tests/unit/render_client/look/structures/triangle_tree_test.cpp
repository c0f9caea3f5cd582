#include "render_client/look/structures/triangle_tree.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/structure_shapes.h"

namespace bonemill {
namespace {

using Eigen::Vector3f;

const Eigen::Vector3d kBall(0.01, 0.02, 0.03);
constexpr double kBallRadius = 0.004;
constexpr float kFacets = 1e-5f;  // m, between the ball and its triangles

const TriangleTree& ballTree() {
    static const TriangleTree tree(test::ballStructure(1, kBall, kBallRadius));
    return tree;
}

class Places {
  public:
    Vector3f next() { return Vector3f(part_(random_), part_(random_), part_(random_)); }

  private:
    std::mt19937 random_{5};
    std::uniform_real_distribution<float> part_{-1, 1};
};

TEST(TriangleTree, NearestIsThatOfTheBallInsideAndOutside) {
    Places places;
    for (int n = 0; n < 2000; ++n) {
        const Vector3f r = 0.01f * places.next(), p = kBall.cast<float>() + r;
        if (r.norm() < 1e-4f) continue;  // all of the ball is about as near
        const auto place = ballTree().nearest(p);
        ASSERT_TRUE(place);
        EXPECT_NEAR(place->distance, r.norm() - float(kBallRadius), kFacets);
        EXPECT_NEAR((place->p_V - p).norm(), std::abs(place->distance), 1e-7f);
        EXPECT_NEAR((place->p_V - kBall.cast<float>()).norm(), float(kBallRadius), kFacets);
        const float beyond = std::abs(place->distance) + 1e-6f, before = std::abs(place->distance) - 1e-6f;
        EXPECT_TRUE(ballTree().nearest(p, beyond));
        EXPECT_FALSE(before > 0 && ballTree().nearest(p, before));
    }
}

TEST(TriangleTree, ARayMeetsTheBallWhereGeometrySays) {
    Places places;
    int hits = 0;
    for (int n = 0; n < 2000; ++n) {
        const Vector3f from = kBall.cast<float>() + 0.02f * places.next().normalized();
        const Vector3f direction = 3 * (kBall.cast<float>() + 0.006f * places.next() - from).normalized();
        const Vector3f along = direction.normalized(), to = kBall.cast<float>() - from;
        const float aside = (to - to.dot(along) * along).norm();
        const auto hit = ballTree().firstHit(from, direction);
        if (aside > float(kBallRadius)) {
            EXPECT_FALSE(hit);
        } else if (aside < 0.95f * float(kBallRadius)) {
            const float half = std::sqrt(float(kBallRadius * kBallRadius) - aside * aside);
            ASSERT_TRUE(hit);
            EXPECT_NEAR(3 * *hit, to.dot(along) - half, 5 * kFacets);
            EXPECT_FALSE(ballTree().firstHit(from, direction, *hit));
            ++hits;
        }
    }
    EXPECT_GT(hits, 300);
    EXPECT_FALSE(ballTree().firstHit(kBall.cast<float>() + Vector3f(0, 0, 0.01f), Vector3f::UnitZ()))
        << "behind";
}

TEST(TriangleTree, WithoutTrianglesThereIsNothing) {
    const TriangleTree empty{NodeMesh{}};
    EXPECT_FALSE(empty.nearest(Vector3f::Zero()));
    EXPECT_FALSE(empty.firstHit(Vector3f::Zero(), Vector3f::UnitX()));
    EXPECT_TRUE(empty.box().isEmpty());
}

}  // namespace
}  // namespace bonemill
