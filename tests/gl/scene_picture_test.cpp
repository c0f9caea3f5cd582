// Looks at pixels of the scene, drawn off screen by the very code of the window.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>

#include "render_client/hand/controls/key_table.h"
#include "render_client/look/offscreen/osmesa_context.h"
#include "render_client/look/render_scene/render_scene.h"
#include "tests/gl/synthetic_scene.h"

namespace bonemill {
namespace {

using test::makeSceneInfo;
using test::makeStatus;
using test::makeToolMesh;
using test::makeToolState;
using test::meshBody;

constexpr int kWidth = 480;
constexpr int kHeight = 360;
constexpr double kRadius = 0.005;
const Eigen::Vector3d kCenter(0.008, 0.008, 0.008);

const std::vector<NodeMesh>& sphereNodes() {
    static const std::vector<NodeMesh> nodes =
        meshBody(65, 2.5e-4, [](const Eigen::Vector3d& p) { return (p - kCenter).norm() - kRadius; });
    return nodes;
}

topics::SceneInfo sphereInfo() {
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(kRadius);
    return makeSceneInfo("sphere", kCenter - half, kCenter + half);
}

class ScenePicture : public testing::Test {
  protected:
    ScenePicture() : context_(kWidth, kHeight), scene_(std::make_unique<RenderScene>(context_.gl())) {
        scene_->settings().show_hud = false;
    }
    Picture draw() {
        scene_->draw(kWidth, kHeight, 1);
        return context_.read();
    }
    void showSphere() {
        scene_->setSceneInfo(sphereInfo());
        for (const NodeMesh& node : sphereNodes()) scene_->setNode(node);
    }
    void freshScene() {
        scene_.reset();
        scene_ = std::make_unique<RenderScene>(context_.gl());
        scene_->settings().show_hud = false;
    }

    OsmesaContext context_;
    std::unique_ptr<RenderScene> scene_;
};

int brightness(const Picture& picture, int x, int y) {
    const auto rgb = picture.at(x, y);
    return rgb[0] + rgb[1] + rgb[2];
}

bool differs(const Picture& a, const Picture& b, int x, int y) {
    const auto p = a.at(x, y), q = b.at(x, y);
    return std::abs(p[0] - q[0]) + std::abs(p[1] - q[1]) + std::abs(p[2] - q[2]) > 6;
}

void halvePositions(NodeMesh& node) {
    for (PackedVertex& v : node.vertices) {
        v.x /= 2;
        v.y /= 2;
        v.z /= 2;
    }
}

size_t countDifferent(const Picture& a, const Picture& b) {
    size_t count = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) count += differs(a, b, x, y);
    return count;
}

TEST_F(ScenePicture, EveryTriangleIsKeptAndDrawn) {
    size_t expected = 0;
    for (const NodeMesh& node : sphereNodes()) expected += node.indices.size() / 3;
    ASSERT_GT(expected, 1000u);
    showSphere();
    EXPECT_EQ(scene_->nodeCount(), sphereNodes().size());
    EXPECT_EQ(scene_->triangleCount(), expected);
    draw();
    EXPECT_EQ(scene_->trianglesDrawn(), expected);
}

// The outline of a sphere of radius r at distance d has the angular radius asin(r / d).
TEST_F(ScenePicture, TheSphereCoversItsCircleAndNothingElse) {
    scene_->setSceneInfo(sphereInfo());
    const Picture empty = draw();
    showSphere();
    const Picture picture = draw();
    const double distance = scene_->camera().distance;
    const double tangent = std::tan(std::asin(kRadius / distance)) / std::tan(OrbitCamera::kFieldOfView / 2);
    const double radius = tangent * kHeight / 2;
    ASSERT_GT(radius, 50);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const double from_center = std::hypot(x + 0.5 - kWidth / 2.0, y + 0.5 - kHeight / 2.0);
            if (from_center > radius + 1.5) {
                ASSERT_EQ(picture.at(x, y), empty.at(x, y)) << x << " " << y;
            } else if (from_center < radius - 2.5) {
                ASSERT_TRUE(differs(picture, empty, x, y)) << x << " " << y;
            }
        }
    EXPECT_GT(brightness(picture, kWidth / 2, kHeight / 2), 350) << "the centre is lit";
    EXPECT_GT(picture.at(kWidth / 2, kHeight / 2)[0], picture.at(kWidth / 2, kHeight / 2)[2])
        << "ivory is warm";
}

TEST_F(ScenePicture, LightComesFromTheUpperLeft) {
    showSphere();
    const Picture picture = draw();
    EXPECT_GT(brightness(picture, kWidth / 2 - 60, kHeight / 2 - 60),
              brightness(picture, kWidth / 2 + 60, kHeight / 2 + 60) + 100);
}

// Positions are dequantised in the shader: twice the step and half the number describe the same points.
TEST_F(ScenePicture, QuantisationIsUndone) {
    showSphere();
    const Picture picture = draw();
    freshScene();
    scene_->setSceneInfo(sphereInfo());
    for (NodeMesh node : sphereNodes()) {
        halvePositions(node);
        scene_->setNode(node);
    }
    EXPECT_GT(countDifferent(draw(), picture), 10000u) << "half the size";
    for (NodeMesh node : sphereNodes()) {
        halvePositions(node);
        node.step *= 2;
        scene_->setNode(node);
    }
    EXPECT_LT(countDifferent(draw(), picture), 100u);
}

TEST_F(ScenePicture, TheOrderOfArrivalDoesNotMatter) {
    showSphere();
    scene_->setStatus(makeStatus());
    scene_->settings().show_hud = true;
    const Picture early = draw();

    freshScene();
    scene_->settings().show_hud = true;
    scene_->setStatus(makeStatus());
    std::vector<NodeMesh> nodes = sphereNodes();
    scene_->setNode(nodes[3]);  // and comes again later
    std::reverse(nodes.begin(), nodes.end());
    std::rotate(nodes.begin(), nodes.begin() + long(nodes.size() / 3), nodes.end());
    for (const NodeMesh& node : nodes) scene_->setNode(node);
    draw();
    scene_->setSceneInfo(sphereInfo());
    EXPECT_EQ(draw(), early);
}

TEST_F(ScenePicture, ARemovedNodeIsGone) {
    scene_->setSceneInfo(sphereInfo());
    const Picture empty = draw();
    showSphere();
    const Picture whole = draw();
    const Eigen::Vector3f towards_eye = scene_->camera().towardsEye_W().cast<float>();
    const auto nearest = std::max_element(sphereNodes().begin(), sphereNodes().end(),
                                          [&](const NodeMesh& a, const NodeMesh& b) {
                                              return towards_eye.dot(a.origin) < towards_eye.dot(b.origin);
                                          });
    scene_->setNode(test::emptyNode(nearest->leaf));
    EXPECT_EQ(scene_->nodeCount(), sphereNodes().size() - 1);
    EXPECT_GT(countDifferent(draw(), whole), 100u);
    for (const NodeMesh& node : sphereNodes()) scene_->setNode(test::emptyNode(node.leaf));
    EXPECT_EQ(draw(), empty);
    showSphere();
    scene_->clearNodes();
    EXPECT_EQ(draw(), empty);
}

TEST_F(ScenePicture, TheVolumesPoseMovesTheBone) {
    showSphere();
    const Picture picture = draw();
    topics::SceneInfo moved = sphereInfo();
    moved.set_name("moved");
    const Eigen::Vector3d shift(0.1, -0.2, 0.05);
    test::setVector(shift, moved.mutable_p_wv_m());
    scene_->setSceneInfo(moved);
    const Eigen::Vector3d old_target = kCenter;
    const Picture followed = draw();
    EXPECT_TRUE(scene_->camera().target_W.isApprox(old_target + shift, 1e-6));
    EXPECT_LT(countDifferent(picture, followed), 50u) << "the first view follows the bone";
    scene_->camera().target_W = old_target;
    EXPECT_GT(countDifferent(picture, draw()), 10000u);
}

TEST_F(ScenePicture, TheToolIsDrawnAndGlowsWhileMilling) {
    topics::SceneInfo info = sphereInfo();
    *info.mutable_tool() = makeToolMesh(1e-3, 5e-4, 0.02);
    info.set_burr_radius_m(1e-3);
    scene_->setSceneInfo(info);
    const Picture empty = draw();
    Pose X_WT;
    X_WT.position = kCenter;
    X_WT.rotation = rotationBetween(Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ());
    scene_->setToolState(makeToolState(X_WT, X_WT, 0));
    const Picture idle = draw();
    EXPECT_GT(countDifferent(empty, idle), 1000u);
    scene_->setToolState(makeToolState(X_WT, X_WT, 1));
    const Picture milling = draw();
    const auto before = idle.at(kWidth / 2 + 10, kHeight / 2),
               after = milling.at(kWidth / 2 + 10, kHeight / 2);
    EXPECT_GT(after[0] - after[2], before[0] - before[2] + 30) << "the burr turns orange";
    scene_->setToolState(makeToolState(X_WT, X_WT, 2));
    EXPECT_GT(countDifferent(milling, draw()), 200u) << "adding looks different";
}

TEST_F(ScenePicture, TheGhostShowsOnlyADevicePoseThatDiffersVisibly) {
    topics::SceneInfo info = sphereInfo();
    *info.mutable_tool() = makeToolMesh(1e-3, 5e-4, 0.02);
    info.set_burr_radius_m(1e-3);
    scene_->setSceneInfo(info);
    Pose X_WT;
    X_WT.position = kCenter;
    scene_->setToolState(makeToolState(X_WT, X_WT, 0));
    const Picture alone = draw();
    Pose device = X_WT;
    device.position.x() += 5e-5;
    scene_->setToolState(makeToolState(X_WT, device, 0));
    EXPECT_EQ(draw(), alone);
    device.position.x() += 2e-3;
    scene_->setToolState(makeToolState(X_WT, device, 0));
    EXPECT_GT(countDifferent(draw(), alone), 500u);
}

TEST_F(ScenePicture, AnExpertsGhostIsOfAnotherColourThanTheHands) {
    topics::SceneInfo info = sphereInfo();
    *info.mutable_tool() = makeToolMesh(1e-3, 5e-4, 0.02);
    info.set_burr_radius_m(1e-3);
    scene_->setSceneInfo(info);
    Pose X_WT, other;
    X_WT.position = other.position = kCenter;
    other.position.x() += 3e-3;
    scene_->setToolState(makeToolState(X_WT, other, 0));
    const Picture with_hand = draw();
    topics::ToolState with_expert = makeToolState(X_WT, X_WT, 0);
    test::setVector(other.position, with_expert.mutable_p_wt_expert_m());
    test::setQuaternion(other.rotation, with_expert.mutable_q_wt_expert());
    scene_->setToolState(with_expert);
    EXPECT_GT(countDifferent(draw(), with_hand), 500u);
    scene_->setToolState(makeToolState(X_WT, X_WT, 0));
    const Picture alone = draw();
    EXPECT_GT(countDifferent(with_hand, alone), 500u);
    with_expert.clear_p_wt_expert_m(), with_expert.clear_q_wt_expert();
    scene_->setToolState(with_expert);
    EXPECT_EQ(draw(), alone);
}

TEST_F(ScenePicture, HudTextChangesPixelsAndOnlyInItsPanel) {
    showSphere();
    const Picture bare = draw();
    scene_->settings().show_hud = scene_->settings().show_details = true;
    scene_->setStatus(makeStatus());
    const Picture with_hud = draw();
    EXPECT_GT(countDifferent(bare, with_hud), 5000u);
    topics::Status status = makeStatus();
    status.set_rate_hz(123.4);
    scene_->setStatus(status);
    const Picture other_rate = draw();
    const size_t changed = countDifferent(with_hud, other_rate);
    EXPECT_GT(changed, 20u);
    EXPECT_LT(changed, 1500u);
}

TEST_F(ScenePicture, TheHelpPageFitsThePicture) {
    const std::array<int, 3> sizes[] = {{1280, 800, 1}, {640, 800, 1}, {640, 400, 1},
                                        {1280, 800, 2}, {480, 360, 1}, {480, 300, 1}};
    for (const auto& [width, height, ui_scale] : sizes) {
        scene_.reset();
        OsmesaContext context(width, height);
        RenderScene scene(context.gl());
        scene.setHelp(helpGroups(HelpFor::kLooking));
        const auto draw = [&, w = width, h = height, scale = ui_scale] {
            scene.draw(w, h, float(scale));
            return context.read();
        };
        const Picture without = draw();
        scene.settings().show_help = true;
        const Picture with_help = draw();
        size_t inside = 0, at_the_edge = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const bool is_edge = x == 0 || y == 0 || x == width - 1 || y == height - 1;
                if (with_help.at(x, y) != without.at(x, y)) ++(is_edge ? at_the_edge : inside);
            }
        EXPECT_GT(inside, size_t(width) * size_t(height) / 5) << width << "x" << height << " " << ui_scale;
        EXPECT_EQ(at_the_edge, 0u) << width << "x" << height << " " << ui_scale;
    }
}

TEST_F(ScenePicture, ANoticeIsAtTheBottomUntilItIsTakenAway) {
    showSphere();
    scene_->settings().show_hud = true;
    const Picture without = draw();
    scene_->setNotice(HudNotice{"accuracy fast: done", HudTone::kGood});
    const Picture with_notice = draw();
    size_t at_the_bottom = 0, elsewhere = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            if (with_notice.at(x, y) != without.at(x, y)) ++(y > kHeight - 60 ? at_the_bottom : elsewhere);
    EXPECT_GT(at_the_bottom, 500u);
    EXPECT_EQ(elsewhere, 0u);
    scene_->setNotice(std::nullopt);
    EXPECT_EQ(draw(), without);
}

TEST_F(ScenePicture, ViewOverridesWinOverTheScene) {
    topics::SceneInfo info = sphereInfo();
    info.mutable_camera()->set_azimuth_rad(0.3);
    info.mutable_camera()->set_elevation_rad(0.2);
    info.mutable_camera()->set_distance_m(0.07);
    scene_->setSceneInfo(info);
    draw();
    EXPECT_DOUBLE_EQ(scene_->camera().azimuth, 0.3);
    EXPECT_DOUBLE_EQ(scene_->camera().distance, 0.07);
    EXPECT_TRUE(scene_->camera().target_W.isApprox(kCenter, 1e-9));
    scene_->setViewWish(
        {.target_W = Eigen::Vector3d(1, 2, 3), .distance = {}, .azimuth = 1.0, .elevation = {}});
    draw();
    EXPECT_DOUBLE_EQ(scene_->camera().azimuth, 1.0);
    EXPECT_DOUBLE_EQ(scene_->camera().elevation, 0.2);
    EXPECT_EQ(scene_->camera().target_W, Eigen::Vector3d(1, 2, 3));
    scene_->camera().orbit(0.5, 0.5);
    scene_->resetView();
    draw();
    EXPECT_DOUBLE_EQ(scene_->camera().azimuth, 1.0);
}

TEST_F(ScenePicture, MessagesThatContradictThemselvesAreRefused) {
    NodeMesh node = sphereNodes().front();
    node.indices[0] = uint32_t(node.vertices.size());
    EXPECT_THROW(scene_->setNode(node), std::invalid_argument);
    topics::SceneInfo info = sphereInfo();
    info.mutable_tool()->add_vertices_m(1);
    EXPECT_THROW(scene_->setSceneInfo(info), std::invalid_argument);
    info = sphereInfo();
    info.clear_q_wv();
    EXPECT_THROW(scene_->setSceneInfo(info), std::invalid_argument);
    info = sphereInfo();
    *info.mutable_tool() = makeToolMesh(1e-3, 5e-4, 0.02);
    info.mutable_tool()->set_indices(0, 1000000);
    EXPECT_THROW(scene_->setSceneInfo(info), std::invalid_argument);
    draw();
}

TEST_F(ScenePicture, AnotherSizeIsDrawnWhole) {
    showSphere();
    scene_->settings().show_hud = true;
    draw();
    scene_->draw(200, 150, 0.7f);
    scene_->draw(kWidth, kHeight, 1);
    const Picture again = context_.read();
    EXPECT_EQ(again, draw());
}

}  // namespace
}  // namespace bonemill
