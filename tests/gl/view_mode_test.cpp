// Ways of looking, checked against what geometry says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "render_client/camera/endoscope.h"
#include "render_client/offscreen/osmesa_context.h"
#include "tests/gl/milled_scene.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr int kWidth = 360;
constexpr int kHeight = 270;
constexpr double kRadius = 0.005;
const Vector3d kCenter(0.008, 0.008, 0.008);

const std::vector<NodeMesh>& sphereNodes() {
    static const std::vector<NodeMesh> nodes =
        test::meshBody(65, 2.5e-4, [](const Vector3d& p) { return (p - kCenter).norm() - kRadius; });
    return nodes;
}

struct Pixel {
    double x = 0, y = 0;  // from the upper left
};

// Where a point (W) appears.
Pixel project(const Camera& camera, const Vector3d& p_W, int width, int height) {
    const Vector3d p_C = camera.R_WC.transpose() * (p_W - camera.eye);
    const double pixels = height / (2 * camera.halfTangent() * -p_C.z());
    return {width / 2.0 + (p_C.x() + camera.shift * p_C.z()) * pixels, height / 2.0 - p_C.y() * pixels};
}

// The line of sight through a pixel's centre (W).
Vector3d sight(const Camera& camera, int x, int y) {
    const double right = (2 * (x + 0.5) / kWidth - 1) * camera.halfTangent() * kWidth / kHeight;
    const double up = (1 - 2 * (y + 0.5) / kHeight) * camera.halfTangent();
    return (camera.R_WC * Vector3d(right, up, -1)).normalized();
}

// Distance along the line of sight to the sphere; nothing when it misses, or only grazes it.
std::optional<double> hitSphere(const Vector3d& eye, const Vector3d& direction) {
    const double along = direction.dot(kCenter - eye);
    const double squared = kRadius * kRadius - (kCenter - eye).squaredNorm() + along * along;
    if (squared < 0.04 * kRadius * kRadius) return std::nullopt;
    return along - std::sqrt(squared);
}

class ViewMode : public testing::Test {
  protected:
    ViewMode() : context_(kWidth, kHeight) { freshScene(); }
    void freshScene() {
        scene_.reset();
        scene_ = std::make_unique<RenderScene>(context_.gl());
        scene_->settings().show_hud = false;
    }
    Picture draw() {
        scene_->draw(kWidth, kHeight, 1);
        return context_.read();
    }
    void showSphere(const std::vector<NodeMesh>& nodes = sphereNodes()) {
        const Vector3d half = Vector3d::Constant(kRadius);
        scene_->setSceneInfo(test::makeSceneInfo("sphere", kCenter - half, kCenter + half));
        for (const NodeMesh& node : nodes) scene_->setNode(node);
    }
    void lookFromTheLeft() {
        scene_->setViewOverrides({.target = {}, .distance = {}, .azimuth = M_PI / 2, .elevation = 0.0});
    }

    OsmesaContext context_;
    std::unique_ptr<RenderScene> scene_;
};

size_t countDifferent(const Picture& a, const Picture& b) {
    size_t count = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            const auto p = a.at(x, y), q = b.at(x, y);
            count += std::abs(p[0] - q[0]) + std::abs(p[1] - q[1]) + std::abs(p[2] - q[2]) > 6;
        }
    return count;
}

double redness(const std::array<int, 3>& rgb) {
    return double(rgb[0]) / std::max(1, rgb[1]);
}

// The plane x = 0.6 of the box cuts the disc of radius r·sqrt(1 - 0.2²) out of the sphere; the eye looks
// straight at it.
TEST_F(ViewMode, TheCapCoversTheDiscThatGeometrySays) {
    lookFromTheLeft();
    showSphere();
    scene_->settings().cuts[0] = {true, 0.6, false};
    const Picture cut = draw();
    const Camera camera = scene_->camera().view();
    const double plane_x = kCenter.x() + 0.2 * kRadius;
    const double disc = kRadius * std::sqrt(1 - 0.2 * 0.2);
    const Vector3d middle(plane_x, kCenter.y(), kCenter.z());
    const Pixel center = project(camera, middle, kWidth, kHeight);
    const Pixel rim = project(camera, middle + Vector3d(0, 0, disc), kWidth, kHeight);
    const double radius = center.y - rim.y;
    ASSERT_GT(radius, 60);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const double from_center = std::hypot(x + 0.5 - center.x, y + 0.5 - center.y);
            if (from_center < radius - 2) {
                ASSERT_GT(redness(cut.at(x, y)), 1.17) << "cut bone at " << x << " " << y;
                const auto point = scene_->pick(x, y);
                ASSERT_TRUE(point);
                ASSERT_NEAR(point->x(), plane_x, 2e-6);
            }
        }
    scene_->settings().cuts[0].is_on = false;
    const Picture whole = draw();
    EXPECT_LT(redness(whole.at(int(center.x), int(center.y))), 1.10) << "ivory is not the cut's colour";
}

TEST_F(ViewMode, AFlippedCutHidesTheOtherSide) {
    lookFromTheLeft();
    showSphere();
    scene_->settings().cuts[0] = {true, 0.6, true};  // all below is hidden: the near part is left
    draw();
    const auto near_part = scene_->pick(kWidth / 2, kHeight / 2);
    ASSERT_TRUE(near_part);
    EXPECT_NEAR(near_part->x(), kCenter.x() + kRadius, 5e-6);
    scene_->setViewOverrides({.target = {}, .distance = {}, .azimuth = -M_PI / 2, .elevation = 0.0});
    draw();
    const auto cap = scene_->pick(kWidth / 2, kHeight / 2);
    ASSERT_TRUE(cap);
    EXPECT_NEAR(cap->x(), kCenter.x() + 0.2 * kRadius, 2e-6);
}

// The volume's axes are not the world's: a plane across W's x, whatever V is.
TEST_F(ViewMode, CutsAreAcrossTheWorldsAxes) {
    const Vector3d half = Vector3d::Constant(kRadius);
    topics::SceneInfo info = test::makeSceneInfo("turned sphere", kCenter - half, kCenter + half);
    const Pose X_WV{{0.02, -0.01, 0.03}, expRotation({0.5, -0.3, 0.9})};
    test::setVector(X_WV.position, info.mutable_p_wv_m());
    test::setQuaternion(X_WV.rotation, info.mutable_q_wv());
    lookFromTheLeft();
    scene_->setSceneInfo(info);
    for (const NodeMesh& node : sphereNodes()) scene_->setNode(node);
    scene_->settings().cuts[0] = {true, 0.5, false};  // the turned box' middle is the sphere's
    draw();
    const auto cap = scene_->pick(kWidth / 2, kHeight / 2);
    ASSERT_TRUE(cap);
    EXPECT_LT((*cap - X_WV * kCenter).norm(), scene_->camera().view().metresPerPixel(kHeight));
    EXPECT_NEAR(cap->x(), (X_WV * kCenter).x(), 2e-6);
}

TEST_F(ViewMode, ThreeCutsLeaveOneCorner) {
    showSphere();
    scene_->setViewOverrides({.target = {}, .distance = {}, .azimuth = M_PI * 3 / 4, .elevation = 0.6});
    for (CutPlane& cut : scene_->settings().cuts) cut = {true, 0.5, false};
    draw();
    size_t on_planes = 0;
    for (int y = 0; y < kHeight; y += 3)
        for (int x = 0; x < kWidth; x += 3) {
            const auto p = scene_->pick(x, y);
            if (!p) continue;
            const Vector3d beyond = *p - kCenter;
            ASSERT_LT(beyond.maxCoeff(), 1e-5) << "beyond a cut";
            on_planes += beyond.maxCoeff() > -1e-5;
        }
    EXPECT_GT(on_planes, 500u);
}

// The surface of a bone that the scan's border leaves open is not closed by a cut elsewhere.
TEST_F(ViewMode, AnOpenBorderGetsNoCap) {
    const auto nodes = test::meshBody(
        65, 2.5e-4, [](const Vector3d& p) { return std::hypot(p.x() - 0.008, p.y() - 0.008) - 0.003; });
    scene_->setSceneInfo(test::makeSceneInfo("open rod", {0.005, 0.005, 0}, {0.011, 0.011, 0.016}));
    for (const NodeMesh& node : nodes) scene_->setNode(node);
    scene_->setViewOverrides({.target = {}, .distance = {}, .azimuth = 0.2, .elevation = 1.2});
    const Picture open = draw();
    const auto inside = scene_->pick(kWidth / 2, kHeight / 2);
    ASSERT_TRUE(inside);
    scene_->settings().cuts[2] = {true, 1.0, false};
    scene_->settings().cuts[2].position = 0.5;
    draw();
    size_t caps = 0;
    for (int y = 0; y < kHeight; y += 2)
        for (int x = 0; x < kWidth; x += 2) {
            const auto p = scene_->pick(x, y);
            caps += p && std::abs(p->z() - 0.008) < 1e-5;
        }
    EXPECT_GT(caps, 200u) << "the cut in the middle of the rod has one";
    scene_->settings().cuts[2].is_on = false;
    EXPECT_EQ(draw(), open);
}

TEST_F(ViewMode, TheToolIsNotCut) {
    test::showMilledBlock(*scene_);
    const topics::ToolState nowhere;
    scene_->settings().cuts[1] = {true, 0.5, true};  // hides the front, where the tool is
    const Picture with_tool = draw();
    scene_->setToolState(nowhere);
    EXPECT_GT(countDifferent(with_tool, draw()), 500u);
}

TEST_F(ViewMode, PickHitsTheSphereWhereTheLineOfSightMeetsIt) {
    showSphere();
    draw();
    const Camera camera = scene_->camera().view();
    size_t hits = 0;
    for (int y = 5; y < kHeight; y += 20)
        for (int x = 5; x < kWidth; x += 20) {
            const Vector3d direction = sight(camera, x, y);
            const auto distance = hitSphere(camera.eye, direction);
            if (!distance) continue;
            const auto picked = scene_->pick(x, y);
            ASSERT_TRUE(picked) << x << " " << y;
            ASSERT_LT((*picked - camera.eye).normalized().cross(direction).norm(), 1e-6);
            // A multisampled depth is that of one sample, up to half a pixel off.
            ASSERT_NEAR((*picked - kCenter).norm(), kRadius, camera.metresPerPixel(kHeight) / 2)
                << x << " " << y;
            ASSERT_NEAR((*picked - camera.eye).norm(), *distance, 0.04 * kRadius) << x << " " << y;
            ++hits;
        }
    EXPECT_GT(hits, 40u);
}

TEST_F(ViewMode, PickFindsNothingOverTheBackgroundOutsideAndInStereo) {
    EXPECT_FALSE(scene_->pick(10, 10)) << "before the first picture";
    showSphere();
    draw();
    EXPECT_TRUE(scene_->pick(kWidth / 2, kHeight / 2));
    EXPECT_FALSE(scene_->pick(1, 1));
    EXPECT_FALSE(scene_->pick(-1, 5));
    EXPECT_FALSE(scene_->pick(kWidth, 5));
    EXPECT_FALSE(scene_->pick(5, kHeight));
    for (const StereoMode mode : {StereoMode::kSideBySide, StereoMode::kAnaglyph}) {
        scene_->settings().stereo = mode;
        draw();
        EXPECT_FALSE(scene_->pick(kWidth / 2, kHeight / 2));
    }
}

TEST_F(ViewMode, SignsAreNotPicked) {
    showSphere();
    draw();
    const auto bare = scene_->pick(kWidth / 2, kHeight / 2);
    topics::Viewer instructor = test::makeWatcher("I", topics::Viewer::INSTRUCTOR, 60);
    test::setVector(*bare, instructor.mutable_pointer_m());
    scene_->setWatchers({instructor});
    draw();
    EXPECT_EQ(*scene_->pick(kWidth / 2, kHeight / 2), *bare);
}

TEST_F(ViewMode, TransparentBoneShowsTheToolInside) {
    test::showMilledBlock(*scene_);
    // From behind: the whole block lies between the eye and the burr.
    scene_->setViewOverrides({.target = {}, .distance = {}, .azimuth = M_PI, .elevation = 0.0});
    const auto effect_of_the_glow = [&] {
        scene_->setToolState(test::makeToolState(test::toolInCavity(), test::toolInCavity(), 0));
        const Picture idle = draw();
        scene_->setToolState(test::makeToolState(test::toolInCavity(), test::toolInCavity(), 1));
        return countDifferent(idle, draw());
    };
    EXPECT_EQ(effect_of_the_glow(), 0u);
    scene_->settings().is_transparent = true;
    EXPECT_GT(effect_of_the_glow(), 300u);
}

TEST_F(ViewMode, TransparencyDoesNotDependOnTheOrderOfArrival) {
    scene_->settings().is_transparent = true;
    scene_->settings().cuts[0] = {true, 0.6, false};
    test::showMilledBlock(*scene_);
    const Picture picture = draw();
    freshScene();
    scene_->settings().is_transparent = true;
    scene_->settings().cuts[0] = {true, 0.6, false};
    std::vector<NodeMesh> nodes = test::milledBlock();
    std::reverse(nodes.begin(), nodes.end());
    for (NodeMesh& node : nodes) {
        std::rotate(node.indices.begin(), node.indices.begin() + 3, node.indices.end());
        scene_->setNode(node);
    }
    test::showMilledBlock(*scene_);
    for (const NodeMesh& node : nodes) scene_->setNode(node);
    EXPECT_EQ(draw(), picture);
}

TEST_F(ViewMode, TheHalvesOfSideBySideAreTheEyesPictures) {
    test::showMilledBlock(*scene_);
    scene_->settings().stereo = StereoMode::kSideBySide;
    draw();
    const StereoPair eyes = stereoPair(scene_->camera().view());
    const double apart = (eyes.right.eye - eyes.left.eye).norm();
    EXPECT_NEAR(apart, scene_->camera().distance / 30, 1e-9);
    const Vector3d target = scene_->camera().target;
    const Vector3d nearer = target + 0.3 * (eyes.left.eye - target);
    const int half = kWidth / 2;
    EXPECT_NEAR(project(eyes.left, target, half, kHeight).x, half / 2.0, 1e-9) << "no parallax at the target";
    EXPECT_NEAR(project(eyes.right, target, half, kHeight).x, half / 2.0, 1e-9);
    EXPECT_GT(project(eyes.left, nearer, half, kHeight).x, project(eyes.right, nearer, half, kHeight).x)
        << "what is nearer comes out of the screen";
}

// A red picture's worth of brightness from the left eye, green and blue from the right one.
TEST_F(ViewMode, TheAnaglyphTakesRedFromTheLeftAndTheRestFromTheRight) {
    test::showMilledBlock(*scene_);
    scene_->settings().stereo = StereoMode::kAnaglyph;
    const Picture anaglyph = draw();
    // The eyes' own pictures: the same size comes from side-by-side in a window of twice the width.
    scene_.reset();
    const OsmesaContext wide(2 * kWidth, kHeight);
    RenderScene scene(wide.gl());
    scene.settings().show_hud = false;
    scene.settings().stereo = StereoMode::kSideBySide;
    test::showMilledBlock(scene);
    scene.draw(2 * kWidth, kHeight, 1);
    const Picture eyes = wide.read();
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const auto left = eyes.at(x, y), right = eyes.at(kWidth + x, y), both = anaglyph.at(x, y);
            ASSERT_NEAR(both[0], 0.299 * left[0] + 0.587 * left[1] + 0.114 * left[2], 1.01) << x << " " << y;
            ASSERT_EQ(both[1], right[1]) << x << " " << y;
            ASSERT_EQ(both[2], right[2]) << x << " " << y;
        }
}

TEST_F(ViewMode, TheEndoscopeSeesTheCavity) {
    test::showMilledBlock(*scene_);
    Pose X_WT = test::toolInCavity();
    X_WT.position += 0.0022 * (X_WT.rotation * Vector3d::UnitY());  // a little out of it
    scene_->setToolState(test::makeToolState(X_WT, X_WT, 0));
    scene_->settings().camera = CameraMode::kEndoscope;
    draw();
    size_t on_the_cavity = 0, seen = 0;
    for (int y = 0; y < kHeight; y += 3)
        for (int x = 0; x < kWidth; x += 3) {
            const auto p = scene_->pick(x, y);
            seen += p.has_value();
            on_the_cavity += p && std::abs((*p - test::kCavityCenter).norm() - test::kCavityRadius) < 6e-5;
        }
    EXPECT_GT(on_the_cavity, 500u) << "of " << seen;
}

TEST_F(ViewMode, TheEndoscopeLooksAlongTheToolPastTheBurr) {
    const Pose X_WT = test::toolInCavity();
    const Camera camera = endoscopeCamera(X_WT, test::kBurrRadius);
    const Vector3d ahead = X_WT.rotation * -Vector3d::UnitY();
    EXPECT_GT(camera.forward().dot(ahead), std::cos(0.2));
    EXPECT_GT(camera.R_WC.col(1).dot(X_WT.rotation * Vector3d::UnitZ()), 0.9);
    EXPECT_NEAR(camera.R_WC.determinant(), 1, 1e-9);
    const Pixel burr = project(camera, X_WT.position, kWidth, kHeight);
    EXPECT_NEAR(burr.x, kWidth / 2.0, 1e-6);
    EXPECT_GT(burr.y, kHeight / 2.0) << "below the middle";
    EXPECT_LT(burr.y, kHeight);
}

TEST_F(ViewMode, WithoutAToolTheEndoscopeFallsBackToTheOrbit) {
    showSphere();
    const Picture orbit = draw();
    scene_->settings().camera = CameraMode::kEndoscope;
    EXPECT_EQ(draw(), orbit);
}

TEST_F(ViewMode, NoArrowForNoForce) {
    test::showMilledBlock(*scene_);
    const auto effect_of = [&](const Vector3d& force) {
        topics::ToolState tool = test::makeToolState(test::toolInCavity(), test::toolInCavity(), 1);
        test::setVector(force, tool.mutable_force_n());
        scene_->setToolState(tool);
        scene_->settings().show_force = false;
        const Picture without = draw();
        scene_->settings().show_force = true;
        return countDifferent(without, draw());
    };
    const Vector3d up = Vector3d(0.1, 0, 1).normalized();
    EXPECT_EQ(effect_of(0.04 * up), 0u);
    const size_t small = effect_of(0.2 * up), large = effect_of(20 * up);
    EXPECT_GT(small, 40u);
    EXPECT_GT(large, 2 * small);
    EXPECT_EQ(effect_of({std::nan(""), 0, 0}), 0u);
}

TEST_F(ViewMode, TheArrowTurnsFromGreenToRed) {
    EXPECT_EQ(forceLook(0.049).length, 0);
    double last = 0;
    for (const double force : {0.05, 0.2, 1.0, 5.0, 20.0}) {
        EXPECT_GT(forceLook(force).length, last);
        last = forceLook(force).length;
    }
    EXPECT_EQ(forceLook(100).length, last) << "never out of the picture";
    EXPECT_GT(forceLook(0.2).colour.y(), 2 * forceLook(0.2).colour.x());
    EXPECT_GT(forceLook(20).colour.x(), 2 * forceLook(20).colour.y());
}

TEST_F(ViewMode, OnlyInstructorsPointAndAlsoFromBehindBone) {
    showSphere();
    const Picture bare = draw();
    topics::Viewer viewer = test::makeWatcher("", topics::Viewer::INSTRUCTOR, 60);
    const Vector3d towards_eye = scene_->camera().towardsEye();
    const auto effect_at = [&](const Vector3d& p) {
        test::setVector(p, viewer.mutable_pointer_m());
        scene_->setWatchers({viewer});
        const Picture picture = draw();
        int strongest = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                strongest = std::max(strongest, std::abs(picture.at(x, y)[1] - bare.at(x, y)[1]));
        return strongest;
    };
    const int visible = effect_at(kCenter + kRadius * towards_eye);
    const int hidden = effect_at(kCenter - kRadius * towards_eye);
    EXPECT_GT(hidden, 15);
    EXPECT_GT(visible, 2 * hidden);
    viewer.set_role(topics::Viewer::OPERATOR);
    EXPECT_EQ(effect_at(kCenter + kRadius * towards_eye), 0);
}

TEST_F(ViewMode, ANewToolOfTheSameSceneKeepsTheView) {
    topics::SceneInfo info = test::milledInfo();
    info.set_revision(1);
    test::showMilledBlock(*scene_);
    scene_->setSceneInfo(info);
    draw();
    scene_->camera().orbit(0.3, 0.1);
    const double azimuth = scene_->camera().azimuth;
    const Picture first = draw();
    topics::SceneInfo other = info;
    other.set_revision(2);
    other.set_burr_radius_m(0.0016);
    *other.mutable_tool() = test::makeToolMesh(0.0016, 4e-4, 0.014);
    scene_->setSceneInfo(other);
    const Picture second = draw();
    EXPECT_DOUBLE_EQ(scene_->camera().azimuth, azimuth);
    EXPECT_GT(countDifferent(first, second), 500u);
    scene_->setSceneInfo(info);  // comes late
    EXPECT_EQ(draw(), second);
}

TEST_F(ViewMode, OnlyWhatIsSetGoesToTheGpu) {
    showSphere();
    const uint64_t nodes = scene_->uploads().nodes, bytes = scene_->uploads().bytes;
    EXPECT_EQ(nodes, sphereNodes().size());
    draw();
    draw();
    EXPECT_EQ(scene_->uploads().nodes, nodes) << "drawing sends nothing";
    const NodeMesh& changed = sphereNodes().front();
    scene_->setNode(changed);
    EXPECT_EQ(scene_->uploads().nodes, nodes + 1);
    EXPECT_EQ(scene_->uploads().bytes - bytes,
              changed.vertices.size() * sizeof(PackedVertex) + changed.indices.size() * sizeof(uint32_t));
    NodeMesh emptied;
    emptied.leaf = changed.leaf;
    scene_->setNode(emptied);
    EXPECT_EQ(scene_->uploads().nodes, nodes + 1);
}

// 64 steps per voxel instead of thousands: at most half a step, 1/128 voxel, off.
TEST_F(ViewMode, ACoarseQuantisationLooksTheSame) {
    showSphere();
    const Picture fine = draw();
    constexpr float kCoarseStep = 2.5e-4f / 64;
    std::vector<NodeMesh> coarse = sphereNodes();
    for (NodeMesh& node : coarse) {
        const Eigen::Vector3f factor = node.step / kCoarseStep;
        ASSERT_LT(factor.maxCoeff(), 0.2f) << "it is coarser";
        for (PackedVertex& v : node.vertices) {
            v.x = uint16_t(std::lround(float(v.x) * factor.x()));
            v.y = uint16_t(std::lround(float(v.y) * factor.y()));
            v.z = uint16_t(std::lround(float(v.z) * factor.z()));
        }
        node.step.setConstant(kCoarseStep);
    }
    freshScene();
    showSphere(coarse);
    EXPECT_LT(countDifferent(fine, draw()), 300u);
}

}  // namespace
}  // namespace bonemill
