// Only what changed is drawn: the picture must be the one that is drawn whole.
#include <gtest/gtest.h>

#include <random>

#include "render_client/look/offscreen/osmesa_context.h"
#include "render_client/look/render_scene/render_scene.h"
#include "tests/gl/milling_session.h"
#include "tests/gl/synthetic_scene.h"

namespace bonemill {
namespace {

constexpr int kKeptWidth = 320, kKeptHeight = 240;
constexpr double kBallRadius = 0.005;
const Eigen::Vector3d kBallCenter(0.008, 0.008, 0.008);

std::vector<NodeMesh> ball(double radius) {
    return test::meshBody(65, 2.5e-4,
                          [=](const Eigen::Vector3d& p) { return (p - kBallCenter).norm() - radius; });
}

class KeptPicture : public testing::TestWithParam<Quality> {
  protected:
    KeptPicture() : context_(kKeptWidth, kKeptHeight), scene_(context_.gl()) {
        const Eigen::Vector3d half = Eigen::Vector3d::Constant(kBallRadius);
        topics::SceneInfo info = test::makeSceneInfo("ball", kBallCenter - half, kBallCenter + half);
        *info.mutable_tool() = test::makeToolMesh(1e-3, 4e-4, 0.006);
        info.set_burr_radius_m(1e-3);
        scene_.setSceneInfo(info);
        scene_.settings().quality = GetParam();
        scene_.settings().show_hud = false;
        for (const NodeMesh& node : large_) scene_.setNode(node);
        moveTool();
    }
    void moveTool() {
        std::uniform_real_distribution<double> place(-0.006, 0.006);
        const auto somewhere = [&] {
            return Eigen::Vector3d(place(random_), place(random_), place(random_));
        };
        Pose X_WT;
        X_WT.position = kBallCenter + somewhere();
        X_WT.rotation = expRotation(300 * somewhere());
        Pose device = X_WT;
        if (random_() % 2) device.position += 0.2 * somewhere();
        topics::ToolState tool = test::makeToolState(X_WT, device, random_() % 3);
        test::setVector(500 * somewhere(), tool.mutable_force_n());
        scene_.setToolState(tool);
    }
    void point() {
        topics::Viewer instructor;
        instructor.set_role(topics::Viewer::INSTRUCTOR);
        for (int axis = 0; axis < 3; ++axis)
            instructor.add_pointer_m(kBallCenter[axis] + 1e-3 * (random_() % 7));
        scene_.setWatchers({instructor});
    }
    // Some nodes become those of the smaller ball, some those of the larger one, some go.
    void changeNodes() {
        for (int n = 0; n < 2; ++n) changeNode();
    }
    void changeNode() {
        const std::vector<NodeMesh>& nodes = random_() % 2 ? large_ : small_;
        const NodeMesh& node = nodes[random_() % nodes.size()];
        scene_.setNode(random_() % 4 ? node : test::emptyNode(node.leaf));
    }
    Picture draw() {
        scene_.draw(kKeptWidth, kKeptHeight, 1);
        return context_.read();
    }
    void expectWhole(const std::string& when) {
        const Picture kept = draw();
        scene_.drawWholeNext();
        const Picture whole = draw();
        EXPECT_TRUE(kept == whole) << when << ": " << difference(kept, whole);
    }

    static std::string difference(const Picture& kept, const Picture& whole) {
        int count = 0, most = 0;
        PixelBox around;
        for (int y = 0; y < kKeptHeight; ++y)
            for (int x = 0; x < kKeptWidth; ++x) {
                int off = 0;
                for (size_t i = 0; i < 3; ++i)
                    off = std::max(off, std::abs(kept.at(x, y)[i] - whole.at(x, y)[i]));
                if (off == 0) continue;
                ++count;
                most = std::max(most, off);
                around = around.joined({x, y, x + 1, y + 1});
            }
        return std::to_string(count) + " pixels by up to " + std::to_string(most) + ", around " +
               std::to_string(around.x0) + " " + std::to_string(around.y0) + " to " +
               std::to_string(around.x1) + " " + std::to_string(around.y1);
    }

    OsmesaContext context_;
    RenderScene scene_;
    std::mt19937 random_{7};
    const std::vector<NodeMesh> large_ = ball(kBallRadius), small_ = ball(0.9 * kBallRadius);
};

TEST_P(KeptPicture, IsTheOneThatIsDrawnWhole) {
    draw();
    for (int frame = 0; frame < 40; ++frame) {
        if (frame % 3) changeNodes();
        if (frame % 4) moveTool();
        if (frame % 5 == 0) point();
        expectWhole("frame " + std::to_string(frame));
    }
}

TEST_P(KeptPicture, FollowsTheViewToo) {
    draw();
    scene_.camera().orbit(0.4, 0.1);
    expectWhole("orbit");
    scene_.settings().cuts[0] = {true, 0.4, false};
    expectWhole("a cut");
    changeNodes();
    expectWhole("a changed node of cut bone");
    scene_.settings().is_transparent = true;
    expectWhole("transparent");
    moveTool();
    changeNodes();
    expectWhole("transparent, changed");
    scene_.settings().is_transparent = false;
    expectWhole("opaque again");
    scene_.settings().stereo = StereoMode::kAnaglyph;
    changeNodes();
    expectWhole("anaglyph");
    scene_.settings().stereo = StereoMode::kOff;
    scene_.settings().camera = CameraMode::kEndoscope;
    expectWhole("endoscope");
    changeNodes();
    moveTool();
    expectWhole("endoscope, moved");
    scene_.settings().camera = CameraMode::kMicroscope;
    scene_.settings().has_depth_of_field = true;
    expectWhole("microscope");
    changeNodes();
    moveTool();
    expectWhole("microscope, moved");
    scene_.clearNodes();
    expectWhole("no bone");
}

TEST_P(KeptPicture, SeesThatOnlyAMaterialChanged) {
    topics::SceneInfo info =
        test::makeSceneInfo("ball", kBallCenter.array() - kBallRadius, kBallCenter.array() + kBallRadius);
    for (int n = 0; n < 3; ++n) info.add_materials()->mutable_color()->set_red(0.3 * n);
    scene_.setSceneInfo(info);
    draw();
    for (int frame = 0; frame < 12; ++frame) {
        NodeMesh node = large_[random_() % large_.size()];
        if (frame % 3) node.materials.assign(node.vertices.size(), uint8_t(random_() % 5));
        if (frame % 3 == 2) node.materials[random_() % node.materials.size()] = 2;
        scene_.setNode(node);
        expectWhole("frame " + std::to_string(frame));
    }
    info.clear_materials();
    scene_.setSceneInfo(info);
    expectWhole("no colours");
}

TEST_P(KeptPicture, DrawsOnlyTheBoneThatMayHaveChanged) {
    draw();
    EXPECT_EQ(scene_.trianglesDrawn(), scene_.triangleCount());
    changeNode();
    draw();
    EXPECT_GT(scene_.trianglesDrawn(), 0u);
    EXPECT_LT(scene_.trianglesDrawn(), scene_.triangleCount() / 2);
}

TEST_P(KeptPicture, DrawsNoMoreForTheFirstChangeOfANodeThanForTheNext) {
    draw();
    const auto drawnFor = [this](const NodeMesh& mesh) {
        scene_.setNode(mesh);
        draw();
        return scene_.trianglesDrawn();
    };
    NodeMesh milled = large_[0];
    milled.indices.resize(milled.indices.size() - 3);
    const size_t first = drawnFor(milled);
    EXPECT_EQ(first + 1, drawnFor(large_[0])) << "the triangle that went and what is around it";
}

// A shadow falls far from what casts it, and water, blood and dust come and go.
TEST_P(KeptPicture, IsTheOneThatIsDrawnWholeWhileABurrMills) {
    scene::Effects wish;
    wish.mutable_bone_dust();
    wish.mutable_irrigation();
    wish.mutable_bleeding()->set_delay_s(0);
    wish.mutable_bleeding()->set_seep_per_s(2);
    wish.mutable_browning();
    wish.mutable_burr_spin();
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(kBallRadius);
    topics::SceneInfo info = test::makeSceneInfo("milled ball", kBallCenter - half, kBallCenter + half);
    *info.mutable_tool() = test::makeToolMesh(1e-3, 4e-4, 0.006);
    info.set_burr_radius_m(1e-3);
    *info.mutable_viewer_effects() = wish;
    scene_.setSceneInfo(info);
    VolumeGeometry geometry;
    geometry.dims.setConstant(65);
    geometry.spacing.setConstant(2.5e-4);
    test::MillingSession session(
        test::MillingSession::makeVolume(
            geometry, [](const Eigen::Vector3d& p) { return (p - kBallCenter).norm() - kBallRadius; }),
        1e-3);
    session.show(scene_);
    draw();
    int state = 0;
    session.after_state = [&] {
        scene_.advance(test::MillingSession::kPeriod);
        if (++state % 4 == 0) expectWhole("state " + std::to_string(state));
    };
    const Pose start = test::toolAt(kBallCenter + Eigen::Vector3d(-3e-3, -4.4e-3, 1e-3), {-0.4, -0.6, 0.6});
    Pose end = start;
    end.position += Eigen::Vector3d(6e-3, 0, -2e-3);
    session.stroke(scene_, start, end, 1, {.spin_speed = 1500});
    session.wait(scene_, end, 0.5, {.spin_speed = 0, .is_pedal_down = false});
}

INSTANTIATE_TEST_SUITE_P(Both, KeptPicture, testing::Values(Quality::kQuick, Quality::kFull),
                         [](const auto& param) { return param.param == Quality::kQuick ? "Quick" : "Full"; });

TEST_P(KeptPicture, QuickLooksLikeFullButForShadowAndEdges) {
    scene_.settings().quality = Quality::kQuick;
    const Picture quick = draw();
    scene_.settings().quality = Quality::kFull;
    const Picture full = draw();
    size_t far_off = 0;
    for (int y = 0; y < kKeptHeight; ++y)
        for (int x = 0; x < kKeptWidth; ++x) {
            const auto a = quick.at(x, y), b = full.at(x, y);
            far_off += std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) > 60;
        }
    EXPECT_GT(far_off, 0u);
    EXPECT_LT(far_off, size_t(kKeptWidth * kKeptHeight / 8));
}

}  // namespace
}  // namespace bonemill
