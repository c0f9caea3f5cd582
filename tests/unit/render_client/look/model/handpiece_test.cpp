#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>

#include "render_client/look/model/tool_mesh.h"

namespace bonemill {
namespace {

constexpr ShaftEnd kShaft{0.016f, 0.0008f};
constexpr topics::SceneInfo::Handpiece kKinds[] = {
    topics::SceneInfo::STRAIGHT, topics::SceneInfo::CONTRA_ANGLE, topics::SceneInfo::DRILL_GUIDE};

Eigen::Vector3f vertex(const google::protobuf::RepeatedField<float>& list, uint32_t n) {
    return {list[int(3 * n)], list[int(3 * n + 1)], list[int(3 * n + 2)]};
}

// A ball and a shaft along +y, as rings.
topics::TriangleMesh stick(float shaft_radius, float length) {
    topics::TriangleMesh tool;
    const auto add = [&](float x, float y) {
        for (const float v : {x, y, 0.0f}) tool.add_vertices_m(v);
    };
    add(0.001f, 0);
    add(0, -0.001f);
    add(shaft_radius, 0.9f * length);
    add(shaft_radius, length);
    return tool;
}

TEST(Handpiece, ItBeginsAtTheShaftsEnd) {
    const auto shaft = shaftEndOf(stick(0.0005f, 0.02f));
    ASSERT_TRUE(shaft);
    EXPECT_FLOAT_EQ(shaft->y, 0.02f);
    EXPECT_FLOAT_EQ(shaft->radius, 0.0005f);
    EXPECT_FALSE(shaftEndOf(stick(0.015f, 0.02f))) << "that is no shaft";
    EXPECT_FALSE(shaftEndOf({}));
}

TEST(Handpiece, ItHidesNothingInFrontOfTheShaftsEnd) {
    for (const auto kind : kKinds) {
        const topics::TriangleMesh mesh = makeHandpiece(kind, kShaft);
        ASSERT_GT(mesh.indices_size(), 0);
        for (uint32_t n = 0; n < uint32_t(mesh.vertices_m_size()) / 3; ++n) {
            const Eigen::Vector3f p = vertex(mesh.vertices_m(), n);
            const float from_axis = std::hypot(p.x(), p.z());
            if (kind == topics::SceneInfo::DRILL_GUIDE && p.y() > 0.6f * kShaft.y) {
                EXPECT_GT(p.y() + from_axis, 0.6f * kShaft.y);  // its sleeve stands around the rear part
            } else {
                EXPECT_GT(p.y(), kShaft.y - 1e-3f) << "kind " << kind;
            }
        }
    }
    EXPECT_EQ(makeHandpiece(topics::SceneInfo::NO_HANDPIECE, kShaft).indices_size(), 0);
}

TEST(Handpiece, ASleeveLeavesTheShaftFree) {
    const topics::TriangleMesh mesh = makeHandpiece(topics::SceneInfo::DRILL_GUIDE, kShaft);
    for (uint32_t n = 0; n < uint32_t(mesh.vertices_m_size()) / 3; ++n) {
        const Eigen::Vector3f p = vertex(mesh.vertices_m(), n);
        if (p.y() < 0.85f * kShaft.y) {
            EXPECT_GT(std::hypot(p.x(), p.z()), kShaft.radius);
        }
    }
}

TEST(Handpiece, ATubesNormalsPointOutwardsAndHaveUnitLength) {
    topics::TriangleMesh mesh;
    addTube({{{0, 0, 0}, 0}, {{0, 0, 0}, 2}, {{0, 5, -1}, 2}, {{0, 9, -4}, 3}, {{0, 9, -4}, 0}}, &mesh);
    for (uint32_t n = 0; n < uint32_t(mesh.vertices_m_size()) / 3; ++n)
        EXPECT_NEAR(vertex(mesh.normals(), n).norm(), 1, 1e-5);
    for (int i = 0; i < mesh.indices_size(); i += 3) {
        const uint32_t a = mesh.indices(i), b = mesh.indices(i + 1), c = mesh.indices(i + 2);
        const Eigen::Vector3f p = vertex(mesh.vertices_m(), a);
        const Eigen::Vector3f across =
            (vertex(mesh.vertices_m(), b) - p).cross(vertex(mesh.vertices_m(), c) - p);
        if (across.norm() < 1e-6f) continue;  // at the closed ends
        EXPECT_GT(across.dot(vertex(mesh.normals(), a)), 0) << "triangle " << i / 3;
    }
}

// Each edge of a closed surface has a triangle on both sides; places that coincide count as one.
TEST(Handpiece, AClosedTubeHasNoHoles) {
    topics::TriangleMesh mesh;
    addTube({{{0, 0, 0}, 0}, {{0, 0, 0}, 2}, {{0, 5, -1}, 2}, {{0, 9, -4}, 0}}, &mesh);
    using Key = std::array<int, 3>;
    const auto key = [&](uint32_t n) {
        const Eigen::Vector3i p = (1e3f * vertex(mesh.vertices_m(), n)).array().round().cast<int>();
        return Key{p.x(), p.y(), p.z()};
    };
    std::map<std::pair<Key, Key>, int> edges;
    for (int i = 0; i < mesh.indices_size(); i += 3)
        for (int side = 0; side < 3; ++side) {
            const Key from = key(mesh.indices(i + side)), to = key(mesh.indices(i + (side + 1) % 3));
            if (from == to) continue;
            ++edges[{from, to}];
            --edges[{to, from}];
        }
    for (const auto& [edge, count] : edges) EXPECT_EQ(count, 0);
}

}  // namespace
}  // namespace bonemill
