// Compares one picture per way of looking with those in the repository, and proves that the comparison sees
// what matters.
#include "tests/gl/golden.h"

#include <gtest/gtest.h>

#include <memory>

#include "render_client/hand/controls/key_table.h"
#include "render_client/look/offscreen/osmesa_context.h"
#include "tests/gl/altered_shaders.h"
#include "tests/gl/milled_scene.h"

namespace bonemill {
namespace {

using test::Alteration;

constexpr int kGoldenWidth = 480;
constexpr int kGoldenHeight = 300;
constexpr float kUiScale = 0.75f;

class Golden : public testing::Test {
  protected:
    Golden() : context_(kGoldenWidth, kGoldenHeight) { begin(context_.gl()); }

    void begin(const GlApi& gl) {
        scene_.reset();
        scene_ = std::make_unique<RenderScene>(gl);
        scene_->settings().show_hud = false;
        scene_->settings().show_force = false;
    }
    Picture draw() {
        scene_->draw(kGoldenWidth, kGoldenHeight, kUiScale);
        return context_.read();
    }
    Picture drawMilledBlock() {
        test::showMilledBlock(*scene_);
        return draw();
    }
    void cut(size_t axis, double position, bool is_flipped) {
        scene_->settings().cuts[axis] = {true, position, is_flipped};
    }
    void lookThroughTheCut() {
        cut(0, 0.45, false);
        scene_->setViewWish({.target_W = {}, .distance = {}, .azimuth = 0.9, .elevation = {}});
    }

    // Draws what `prepare` sets up with altered shaders, and expects the comparison to see it.
    template <class Prepare>
    void expectSeen(const std::string& golden, const std::vector<Alteration>& alterations,
                    Prepare&& prepare) {
        const GlApi altered = test::alterShaders(context_.gl(), alterations);
        begin(altered);
        prepare();
        const Picture broken = drawMilledBlock();
        const test::PictureDifference difference = test::compare(broken, test::readGolden(golden));
        EXPECT_TRUE(difference.isVisible())
            << golden << " without " << alterations.front().what << ": only " << difference.bad_part;
        EXPECT_GT(test::alterationsDone(), 0) << "the shaders have changed: " << alterations.front().what;
        scene_.reset();
    }

    void prepareShadow() { scene_->settings().quality = Quality::kQuick; }
    static Pose toolBeforeBone() {
        Pose X_WT = test::toolInCavity();
        X_WT.position = test::kBlockCenter + Eigen::Vector3d(-0.0022, -0.0062, 0.0032);
        return X_WT;
    }
    // Draws the same with an altered shader.
    void expectUnlike(const std::string& golden, const Alteration& alteration) {
        const GlApi altered = test::alterShaders(context_.gl(), {alteration});
        begin(altered);
        prepareShadow();
        test::showMilledBlock(*scene_);
        scene_->setToolState(test::makeToolState(toolBeforeBone(), toolBeforeBone(), 0));
        EXPECT_TRUE(test::compare(draw(), test::readGolden(golden)).isVisible());
        EXPECT_GT(test::alterationsDone(), 0) << "the shaders have changed: " << alteration.what;
        scene_.reset();
    }

    OsmesaContext context_;
    std::unique_ptr<RenderScene> scene_;
};

TEST_F(Golden, Plain) {
    EXPECT_EQ(test::goldenProblem(drawMilledBlock(), "plain"), "");
}

TEST_F(Golden, OneCut) {
    lookThroughTheCut();
    EXPECT_EQ(test::goldenProblem(drawMilledBlock(), "cut"), "");
}

TEST_F(Golden, TwoCuts) {
    lookThroughTheCut();
    cut(2, 0.62, false);
    EXPECT_EQ(test::goldenProblem(drawMilledBlock(), "two_cuts"), "");
}

TEST_F(Golden, Transparent) {
    scene_->settings().is_transparent = true;
    EXPECT_EQ(test::goldenProblem(drawMilledBlock(), "transparent"), "");
}

TEST_F(Golden, TransparentAndCut) {
    lookThroughTheCut();
    scene_->settings().is_transparent = true;
    EXPECT_EQ(test::goldenProblem(drawMilledBlock(), "transparent_cut"), "");
}

TEST_F(Golden, SideBySide) {
    scene_->settings().stereo = StereoMode::kSideBySide;
    EXPECT_EQ(test::goldenProblem(drawMilledBlock(), "side_by_side"), "");
}

TEST_F(Golden, Anaglyph) {
    scene_->settings().stereo = StereoMode::kAnaglyph;
    EXPECT_EQ(test::goldenProblem(drawMilledBlock(), "anaglyph"), "");
}

TEST_F(Golden, Endoscope) {
    scene_->settings().camera = CameraMode::kEndoscope;
    EXPECT_EQ(test::goldenProblem(drawMilledBlock(), "endoscope"), "");
}

TEST_F(Golden, Microscope) {
    scene_->settings().camera = CameraMode::kMicroscope;
    EXPECT_EQ(test::goldenProblem(drawMilledBlock(), "microscope"), "");
}

TEST_F(Golden, MicroscopeWithDepthOfField) {
    scene_->settings().camera = CameraMode::kMicroscope;
    scene_->settings().has_depth_of_field = true;
    EXPECT_EQ(test::goldenProblem(drawMilledBlock(), "microscope_blurred"), "");
    EXPECT_TRUE(
        test::compare(test::readGolden("microscope"), test::readGolden("microscope_blurred")).isVisible());
}

// The burr hangs before the bone, between it and the light.
TEST_F(Golden, QuickDrawingHasAShadowOfTheTool) {
    prepareShadow();
    drawMilledBlock();
    scene_->setToolState(test::makeToolState(toolBeforeBone(), toolBeforeBone(), 0));
    EXPECT_EQ(test::goldenProblem(draw(), "quick_shadow"), "");
    expectUnlike("quick_shadow",
                 {"smoothstep(0.4, 1.0, ray / reach)", "smoothstep(-2.0, -1.0, ray / reach)"});
}

TEST_F(Golden, Handpieces) {
    for (const auto& [kind, name] : {std::pair(topics::SceneInfo::STRAIGHT, "handpiece_straight"),
                                     std::pair(topics::SceneInfo::CONTRA_ANGLE, "handpiece_contra_angle"),
                                     std::pair(topics::SceneInfo::DRILL_GUIDE, "handpiece_drill_guide")}) {
        begin(context_.gl());
        scene_->setViewWish({.target_W = {}, .distance = 0.12, .azimuth = -1.0, .elevation = {}});
        topics::SceneInfo info = test::milledInfo();
        info.set_handpiece(kind);
        test::showMilledBlock(*scene_);
        info.set_revision(1);
        scene_->setSceneInfo(info);
        EXPECT_EQ(test::goldenProblem(draw(), name), "");
        scene_->settings().show_handpiece = false;
        EXPECT_TRUE(test::compare(draw(), test::readGolden(name)).isVisible());
    }
}

TEST_F(Golden, OrientationMarkerOfAVolumeWithoutPatient) {
    scene_->settings().show_hud = true;
    topics::SceneInfo info = test::milledInfo();
    info.set_lacks_patient_axes(true);
    scene_->setSceneInfo(info);
    EXPECT_EQ(test::goldenProblem(draw(), "volume_axes"), "");
}

TEST_F(Golden, ArrowAndPointer) {
    scene_->settings().show_force = true;
    topics::Viewer instructor = test::makeWatcher("Dr. Berg", topics::Viewer::INSTRUCTOR, 60);
    const Eigen::Vector3d on_surface =
        test::kBlockCenter + test::kBlockRadius * Eigen::Vector3d(-0.35, -0.75, 0.56).normalized();
    test::setVector(on_surface, instructor.mutable_pointer_m());
    topics::Viewer behind = instructor;
    behind.set_name("Dr. Lund");
    test::setVector(test::kBlockCenter + Eigen::Vector3d(0.001, 0.004, -0.002), behind.mutable_pointer_m());
    scene_->setWatchers({instructor, behind});
    test::showMilledBlock(*scene_);
    topics::ToolState tool = test::makeToolState(test::toolInCavity(), test::toolInCavity(), 1);
    test::setVector({-1.2, -2.5, 0.6}, tool.mutable_force_n());
    scene_->setToolState(tool);
    EXPECT_EQ(test::goldenProblem(draw(), "arrow_pointer"), "");
}

TEST_F(Golden, HudWithWatchers) {
    scene_->settings().show_hud = true;
    scene_->settings().show_watchers = true;
    topics::Status status = test::makeStatus();
    status.set_session_s(3723);
    status.set_is_milling_paused(true);
    scene_->setStatus(status);
    std::vector<topics::Viewer> watchers = {test::makeWatcher("Anna", topics::Viewer::OPERATOR, 60)};
    for (int i = 1; i <= 10; ++i)
        watchers.push_back(test::makeWatcher("student " + std::to_string(i), topics::Viewer::VIEWER, 30));
    watchers[2].set_is_complete(false);
    scene_->setWatchers(watchers);
    scene_->setFrameRate(59.6);
    EXPECT_EQ(test::goldenProblem(drawMilledBlock(), "hud"), "");
}

TEST_F(Golden, Materials) {
    topics::SceneInfo info = test::milledInfo();
    test::addLayers(info);
    scene_->setSceneInfo(info);
    for (const NodeMesh& node : test::layeredBlock()) scene_->setNode(node);
    scene_->setToolState(test::makeToolState(test::toolInCavity(), test::toolInCavity(), 1));
    EXPECT_EQ(test::goldenProblem(draw(), "materials"), "");
}

TEST_F(Golden, ZonesOfATask) {
    topics::SceneInfo info = test::milledInfo();
    for (const auto& [red, green, blue] :
         {std::array{0.30, 0.72, 0.35}, {0.95, 0.85, 0.25}, {0.90, 0.35, 0.15}}) {
        scene::Color& colour = *info.add_materials()->mutable_color();
        colour.set_red(red), colour.set_green(green), colour.set_blue(blue);
    }
    scene_->setSceneInfo(info);
    for (const NodeMesh& node : test::zonedBlock()) scene_->setNode(node);
    EXPECT_EQ(test::goldenProblem(draw(), "zones"), "");
    EXPECT_TRUE(test::compare(draw(), test::readGolden("plain")).isVisible());
}

// Without colours in the scene the same vertices are plain bone.
TEST_F(Golden, MaterialsWithoutColoursArePlainBone) {
    topics::SceneInfo info = test::milledInfo();
    info.add_materials()->set_name("enamel");
    scene_->setSceneInfo(info);
    for (const NodeMesh& node : test::layeredBlock()) scene_->setNode(node);
    scene_->setToolState(test::makeToolState(test::toolInCavity(), test::toolInCavity(), 1));
    EXPECT_EQ(test::goldenProblem(draw(), "plain"), "");
}

TEST(GoldenFigures, OfEffectsWithAnAlert) {
    const OsmesaContext context(640, 480);
    RenderScene scene(context.gl());
    scene.settings().show_details = true;
    topics::SceneInfo info = test::milledInfo();
    info.add_materials()->set_name("facial nerve");
    scene.setSceneInfo(info);
    for (const NodeMesh& node : test::milledBlock()) scene.setNode(node);
    scene.setConnection(Connection::kLive);
    scene.setStatus(test::makeStatus());
    scene.setToolState(
        test::toolWithEveryEffect(topics::EffectState::NEAR_PROTECTED | topics::EffectState::TOO_HOT));
    scene.setNotice(HudNotice{"Picture saved", HudTone::kGood});
    scene.draw(640, 480, kUiScale);
    EXPECT_EQ(test::goldenProblem(context.read(), "effects_hud"), "");
}

TEST_F(Golden, AnAlertIsShownWithoutFiguresToo) {
    topics::ToolState tool = test::makeToolState(test::toolInCavity(), test::toolInCavity(), 1);
    tool.set_tick(1);
    tool.mutable_effects()->set_events(topics::EffectState::PROTECTED_TOUCHED);
    test::showMilledBlock(*scene_);
    scene_->setToolState(tool);
    const Picture picture = draw();
    EXPECT_TRUE(test::compare(picture, test::readGolden("plain")).isVisible());
    EXPECT_GT(picture.at(1, kGoldenHeight / 2)[0], 150) << "a red border";
    EXPECT_LT(picture.at(1, kGoldenHeight / 2)[2], 120);
}

TEST_F(Golden, TheComparisonSeesAMissingColour) {
    const GlApi altered =
        test::alterShaders(context_.gl(), {{"+ point.material.rgb", "+ 0.9 * point.material.rrr"}});
    begin(altered);
    topics::SceneInfo info = test::milledInfo();
    test::addLayers(info);
    scene_->setSceneInfo(info);
    for (const NodeMesh& node : test::layeredBlock()) scene_->setNode(node);
    EXPECT_TRUE(test::compare(draw(), test::readGolden("materials")).isVisible());
    EXPECT_GT(test::alterationsDone(), 0);
    scene_.reset();
}

TEST_F(Golden, HelpPage) {
    scene_->settings().show_hud = true;
    scene_->settings().show_help = true;
    scene_->setHelp(helpGroups(HelpFor::kLooking));
    EXPECT_EQ(test::goldenProblem(drawMilledBlock(), "help"), "");
}

TEST(GoldenFiles, WritingOneIsNoPass) {
    const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "bonemill_written.png";
    Picture picture(3, 2);
    picture.row(1)[4] = 200;
    const std::string message = test::writeGolden(picture, path);
    EXPECT_NE(message.find("written, look at it"), std::string::npos) << message;
    EXPECT_NE(message.find(path.string()), std::string::npos) << message;
    EXPECT_EQ(test::readPng(path), picture);
    std::filesystem::remove(path);
}

TEST_F(Golden, TheComparisonSeesAMissingLight) {
    expectSeen("plain", {{"vec3(1.00, 0.94, 0.85) * 2.35", "vec3(0.0)"}}, [] {});
}

TEST_F(Golden, TheComparisonSeesAMissingShadow) {
    expectSeen("plain", {{"return has_shadow ? sum / 9.0 : 1.0;", "return 1.0;"}}, [] {});
}

TEST_F(Golden, TheComparisonSeesMissingOcclusion) {
    expectSeen("endoscope", {{"float occlusion = sum / weights;", "float occlusion = 1.0;"}},
               [this] { scene_->settings().camera = CameraMode::kEndoscope; });
}

TEST_F(Golden, TheComparisonSeesAMissingRoundField) {
    expectSeen("microscope", {{"if (field_radius > 0.0) shaded =", "if (field_radius > 1e9) shaded ="}},
               [this] { scene_->settings().camera = CameraMode::kMicroscope; });
}

TEST_F(Golden, TheComparisonSeesAnEndoscopeWithoutItsLightsFalloff) {
    expectSeen("endoscope", {{"if (light_reach <= 0.0) return light_strength;", "return 1.0;"}},
               [this] { scene_->settings().camera = CameraMode::kEndoscope; });
}

TEST_F(Golden, TheComparisonSeesTurnedNormalsInTheShader) {
    expectSeen("plain", {{"octahedralOf(normalize(n_C))", "octahedralOf(-normalize(n_C))"}}, [] {});
}

TEST_F(Golden, TheComparisonSeesACutWithoutItsCap) {
    expectSeen("cut",
               {{"vec3 p_C = entry.depth * entry.ray;",
                 "vec3 p_C = entry.depth * entry.ray; if (entry.depth > 0.0) discard;"}},
               [this] { lookThroughTheCut(); });
}

TEST_F(Golden, TheComparisonSeesATransparentCutWithoutItsCap) {
    expectSeen("transparent_cut",
               {{"vec3 p_C = entry.depth * entry.ray;",
                 "vec3 p_C = entry.depth * entry.ray; if (entry.depth > 0.0) discard;"}},
               [this] {
                   lookThroughTheCut();
                   scene_->settings().is_transparent = true;
               });
}

TEST_F(Golden, TheComparisonSeesAMissingLayer) {
    expectSeen(
        "transparent",
        {{"return point.inside ? inside_colour : albedo;", "if (point.inside) discard; return albedo;"}},
        [this] { scene_->settings().is_transparent = true; });
}

TEST_F(Golden, TheComparisonSeesMirroredNormalsOfTheMeshes) {
    test::showMilledBlock(*scene_);
    for (NodeMesh node : test::milledBlock()) {
        for (PackedVertex& v : node.vertices) {
            const OctahedralNormal turned = encodeNormal(-decodeNormal(v.octahedral_u, v.octahedral_v));
            v.octahedral_u = turned.u;
            v.octahedral_v = turned.v;
        }
        scene_->setNode(node);
    }
    EXPECT_TRUE(test::compare(draw(), test::readGolden("plain")).isVisible());
}

// No antialiasing at all is more than what another Mesa version may do differently.
TEST_F(Golden, TheComparisonPassesOtherAntialiasing) {
    const GlApi coarse = test::withoutAntialiasing(context_.gl());
    begin(coarse);
    const Picture picture = drawMilledBlock();
    EXPECT_NE(picture, test::readGolden("plain"));
    const test::PictureDifference difference = test::compare(picture, test::readGolden("plain"));
    EXPECT_FALSE(difference.isVisible()) << difference.bad_part;
    scene_.reset();
}

TEST_F(Golden, APictureOfAnotherSizeDiffers) {
    EXPECT_TRUE(test::compare(Picture(10, 10), Picture(10, 11)).isVisible());
}

}  // namespace
}  // namespace bonemill
