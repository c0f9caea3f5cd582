#include "render_client/look/visual_effects/bone_surface.h"

#include <gtest/gtest.h>

#include <random>

namespace bonemill {
namespace {

// Vertices of leaves of 4 mm, 20 to a side.
TEST(BoneSurface, FindsTheNearestVertexOfAllLeaves) {
    std::mt19937 random(3);
    constexpr float kSide = 4e-3f;
    BoneSurface surface;
    std::vector<Eigen::Vector3f> all;
    for (uint32_t leaf = 0; leaf < 1000; ++leaf) {
        NodeMesh mesh;
        mesh.leaf = leaf;
        mesh.origin = kSide * Eigen::Vector3f(float(leaf % 10), float(leaf / 10 % 10), float(leaf / 100));
        mesh.step.setConstant(kSide / 1000);
        for (int n = 0; n < 8; ++n) {
            PackedVertex vertex{};
            vertex.x = uint16_t(random() % 1000);
            vertex.y = uint16_t(random() % 1000);
            vertex.z = uint16_t(random() % 1000);
            mesh.vertices.push_back(vertex);
            all.push_back(mesh.origin +
                          mesh.step.cwiseProduct(Eigen::Vector3f(vertex.x, vertex.y, vertex.z)));
        }
        mesh.indices = {0, 1, 2};
        surface.set(mesh);
    }
    std::uniform_real_distribution<float> place(0, 10 * kSide);
    const auto somewhere = [&] { return Eigen::Vector3f(place(random), place(random), place(random)); };
    int found_count = 0;
    for (int n = 0; n < 2000; ++n) {
        if (n % 20 == 0) surface.focusOn(somewhere());
        const Eigen::Vector3f p = somewhere();
        if (!surface.isInFocus(p)) continue;
        const float reach = n % 2 ? 6e-4f : 3e-3f;
        float nearest = reach;
        for (const Eigen::Vector3f& vertex : all) nearest = std::min(nearest, (vertex - p).norm());
        const auto found = surface.nearest(p, reach);
        ASSERT_EQ(found.has_value(), nearest < reach);
        if (found) {
            EXPECT_NEAR((found->p_V - p).norm(), nearest, 1e-7f);
        }
        found_count += found.has_value();
    }
    EXPECT_GT(found_count, 100);
}

}  // namespace
}  // namespace bonemill
