// Compares pictures of milled bone with those in the repository, and checks what milling must not change.
#include <gtest/gtest.h>

#include "render_client/look/offscreen/osmesa_context.h"
#include "tests/gl/altered_shaders.h"
#include "tests/gl/golden.h"
#include "tests/gl/milled_scene.h"

namespace bonemill {
namespace {

constexpr int kMilledWidth = 480, kMilledHeight = 300;

class MilledPictures : public testing::Test {
  protected:
    MilledPictures() : context_(kMilledWidth, kMilledHeight) {}

    Picture draw(const GlApi& gl, const std::vector<NodeMesh>& nodes, bool has_layers, double distance = 0) {
        RenderScene scene(gl);
        scene.settings().show_hud = false;
        topics::SceneInfo info = test::milledInfo();
        if (has_layers) test::addLayers(info);
        if (protects_core_) info.mutable_materials(1)->set_is_protected(true);
        test::setVector(test::kCavityCenter, info.mutable_camera()->mutable_target_m());
        info.mutable_camera()->set_has_target(distance > 0);
        info.mutable_camera()->set_distance_m(distance);
        scene.setSceneInfo(info);
        for (const NodeMesh& node : nodes) scene.setNode(node);
        scene.setConnection(Connection::kLive);
        scene.draw(kMilledWidth, kMilledHeight, 1);
        return context_.read();
    }

    OsmesaContext context_;
    bool protects_core_ = false;
};

TEST_F(MilledPictures, FreshBone) {
    EXPECT_EQ(test::goldenProblem(draw(context_.gl(), test::freshBlock(false), false), "milled"), "");
}

TEST_F(MilledPictures, FreshBoneOfMaterialsNearby) {
    const Picture picture = draw(context_.gl(), test::freshBlock(true), true, 0.011);
    EXPECT_EQ(test::goldenProblem(picture, "milled_near"), "");
}

TEST_F(MilledPictures, AProtectedStructureThatWasCutIsRed) {
    protects_core_ = true;
    EXPECT_EQ(test::goldenProblem(draw(context_.gl(), test::freshBlock(true), true), "milled_structure"), "");
}

// The block's right side is whole, and as it is without milled bits.
TEST_F(MilledPictures, WholeBoneLooksAsItDid) {
    const Picture before = draw(context_.gl(), test::milledBlock(), false);
    const Picture fresh = draw(context_.gl(), test::freshBlock(false), false);
    int different = 0, same = 0;
    for (int y = 0; y < kMilledHeight; ++y)
        for (int x = 0; x < kMilledWidth; ++x) {
            const bool is_same = before.at(x, y) == fresh.at(x, y);
            const bool is_right = x > kMilledWidth / 2 + 100;
            if (is_right) EXPECT_TRUE(is_same) << x << ' ' << y;
            ++(is_same ? same : different);
        }
    EXPECT_GT(different, 2000);
    EXPECT_GT(same, different);
}

TEST_F(MilledPictures, WhatIsMissingIsSeen) {
    const test::Alteration kMissing[] = {{"milled = material > 127.5 ? 1.0 : 0.0;", "milled = 0.0;"},
                                         {"return scratched * relief;", "return 0.0;"},
                                         {"texelFetch(palette, ivec2(int(material), 0), 0)",
                                          "texelFetch(palette, ivec2(int(material) & 127, 0), 0)"}};
    for (const test::Alteration& missing : kMissing) {
        const GlApi altered = test::alterShaders(context_.gl(), {missing});
        const Picture picture = draw(altered, test::freshBlock(true), true, 0.011);
        EXPECT_GT(test::alterationsDone(), 0) << "the shaders have changed: " << missing.what;
        EXPECT_TRUE(test::compare(picture, test::readGolden("milled_near")).isVisible()) << missing.what;
    }
}

}  // namespace
}  // namespace bonemill
