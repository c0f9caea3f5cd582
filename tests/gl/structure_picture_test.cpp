// Compares pictures of protected structures with those in the repository, proves that a missing one is seen,
// and checks what names and quick drawing must do.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "render_client/look/offscreen/osmesa_context.h"
#include "tests/gl/altered_shaders.h"
#include "tests/gl/golden.h"
#include "tests/gl/milled_scene.h"
#include "tests/support/structure_shapes.h"

namespace bonemill {
namespace {

constexpr int kStructureWidth = 480, kStructureHeight = 300;
constexpr uint32_t kNerve = 1, kSinus = 2;
constexpr double kStructureWarning = 2.5e-3;
// The nerve lies in the floor of the cavity, the sinus behind whole bone.
const Eigen::Vector3d kNerveCenter = test::kCavityCenter + Eigen::Vector3d(-0.0008, 0.0016, -0.0006);
const Eigen::Vector3d kSinusCenter = test::kBlockCenter + Eigen::Vector3d(-0.0022, -0.0022, -0.0022);

int mostDifference(const Picture& a, const Picture& b) {
    int most = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int n = 0; n < 3 * a.width(); ++n) most = std::max(most, std::abs(a.row(y)[n] - b.row(y)[n]));
    return most;
}

class StructurePictures : public testing::Test {
  protected:
    StructurePictures() : context_(kStructureWidth, kStructureHeight) { begin(context_.gl()); }

    void begin(const GlApi& gl) {
        scene_.reset();
        scene_ = std::make_unique<RenderScene>(gl);
        scene_->settings().show_hud = false;
        scene_->settings().show_force = false;
        scene_->settings().structures.fill(StructureMode::kThroughBone);
        topics::SceneInfo info = test::milledInfo();
        for (const char* name : {"facial nerve", "sigmoid sinus"}) {
            info.add_materials()->set_name(name);
            info.mutable_materials()->rbegin()->set_is_protected(true);
        }
        scene_->setSceneInfo(info);
        for (const NodeMesh& node : test::milledBlock()) scene_->setNode(node);
        scene_->setConnection(Connection::kLive);
    }
    void showNerve() {
        scene_->setStructure(test::ballStructure(kNerve, kNerveCenter, 0.0012), kStructureWarning);
    }
    void showSinus() {
        scene_->setStructure(test::ballStructure(kSinus, kSinusCenter, 0.0016), kStructureWarning);
    }
    void showBoth() {
        showNerve();
        showSinus();
    }
    // The burr's surface is so far from the nerve, on the way out of the cavity.
    void putBurr(double distance) {
        const Eigen::Vector3d out = Eigen::Vector3d(0.25, -0.6, 0.8).normalized();
        Pose X_WT = test::toolInCavity();
        X_WT.position = kNerveCenter + (0.0012 + test::kBurrRadius + distance) * out;
        scene_->setToolState(test::makeToolState(X_WT, X_WT, 1));
    }
    Picture draw() {
        scene_->draw(kStructureWidth, kStructureHeight, 0.75f);
        return context_.read();
    }
    static bool isGolden(const Picture& picture, const std::string& name) {
        return !test::compare(picture, test::readGolden(name)).isVisible();
    }
    template <class Prepare>
    void expectAlterationSeen(const std::string& golden, const test::Alteration& alteration,
                              Prepare&& prepare) {
        const GlApi altered = test::alterShaders(context_.gl(), {alteration});
        begin(altered);
        prepare();
        const Picture picture = draw();
        EXPECT_GT(test::alterationsDone(), 0) << "the shaders have changed: " << alteration.what;
        EXPECT_FALSE(isGolden(picture, golden)) << golden << " with altered " << alteration.what;
        scene_.reset();
    }
    // The middle of a structure in the picture, pixels.
    std::pair<int, int> pixelOf(const Eigen::Vector3d& p_W) const {
        const Camera camera = scene_->viewCamera();
        const Eigen::Vector3d p_C = camera.R_WC.transpose() * (p_W - camera.eye_W);
        const double pixels = kStructureHeight / (2 * camera.halfTangent() * -p_C.z());
        return {int(kStructureWidth / 2.0 + p_C.x() * pixels),
                int(kStructureHeight / 2.0 - p_C.y() * pixels)};
    }
    std::string nameOver(const Eigen::Vector3d& p_W) const {
        const auto [x, y] = pixelOf(p_W);
        return scene_->structureAt(x, y);
    }

    OsmesaContext context_;
    std::unique_ptr<RenderScene> scene_;
};

TEST_F(StructurePictures, BehindBoneAndExposed) {
    showBoth();
    EXPECT_EQ(test::goldenProblem(draw(), "structures"), "");
}

// The tool's shadow moves over them.
TEST_F(StructurePictures, KeptOnesAreThoseThatAreDrawnWhole) {
    for (const StructureMode mode : {StructureMode::kExposedOnly, StructureMode::kThroughBone}) {
        showBoth();
        scene_->settings().structures.fill(mode);
        for (int n = 0; n < 6; ++n) {
            putBurr(3e-4 * n);
            const Picture kept = draw();
            scene_->drawWholeNext();
            EXPECT_EQ(mostDifference(kept, draw()), 0) << n;
        }
    }
}

TEST_F(StructurePictures, OnlyWhereExposed) {
    showBoth();
    scene_->settings().structures.fill(StructureMode::kExposedOnly);
    EXPECT_EQ(test::goldenProblem(draw(), "structures_exposed"), "");
}

// What is blue makes bone blue that is thin over it, the more the thinner, and none that is thick.
TEST_F(StructurePictures, WhatLiesUnderThinBoneShinesThrough) {
    scene_->settings().structures.fill(StructureMode::kExposedOnly);
    const Picture without = draw();
    const Eigen::Vector3d outwards = Eigen::Vector3d(-0.5, -0.8, -0.3).normalized();
    const Eigen::Vector3d top = test::kBlockCenter + test::kBlockRadius * outwards;
    const auto blueOver = [&](double cover) {
        constexpr double kRadius = 0.0015;
        scene_->clearStructures();
        scene_->setStructure(test::ballStructure(kSinus, top - (kRadius + cover) * outwards, kRadius),
                             kStructureWarning);
        const auto [x, y] = pixelOf(top);
        const auto now = draw().at(x, y), before = without.at(x, y);
        return double(now[2]) / now[0] - double(before[2]) / before[0];
    };
    const double thin = blueOver(0.3e-3), thicker = blueOver(0.8e-3);
    EXPECT_GT(thin, 0.2);
    EXPECT_GT(thicker, 0.02);
    EXPECT_LT(thicker, 0.5 * thin);
    EXPECT_EQ(blueOver(2.3e-3), 0);
}

// The nerve lies open and its picture moves; the sinus is behind bone, and nothing is drawn for it.
TEST_F(StructurePictures, WhatLiesOpenMovesWithThePulse) {
    topics::SceneInfo info = test::milledInfo();
    for (const char* name : {"facial nerve", "sigmoid sinus"}) info.add_materials()->set_name(name);
    info.set_epoch(8);
    const auto mostChange = [&](const std::string& pulsating, Quality quality) {
        auto& pulse = *info.mutable_viewer_effects()->mutable_pulse();
        pulse.Clear();
        pulse.add_material(pulsating);
        info.set_revision(info.revision() + 1);
        scene_->setSceneInfo(info);
        scene_->settings().quality = quality;
        scene_->settings().structures.fill(StructureMode::kExposedOnly);
        showBoth();
        const Picture first = draw();
        int most = 0;
        for (int picture = 0; picture < 12; ++picture) {
            scene_->advance(0.1);
            most = std::max(most, mostDifference(draw(), first));
        }
        return most;
    };
    for (const Quality quality : {Quality::kFull, Quality::kQuick}) {
        EXPECT_GT(mostChange("facial nerve", quality), 12) << int(quality);
        EXPECT_EQ(mostChange("sigmoid sinus", quality), 0) << int(quality);
    }
}

// The burr pressed the nerve here, and elsewhere cut it.
TEST_F(StructurePictures, WhatWasTouchedIsRed) {
    topics::SceneInfo info = test::milledInfo();
    info.add_materials()->set_name("facial nerve");
    info.mutable_materials(0)->set_is_protected(true);
    info.mutable_viewer_effects()->mutable_bruising();
    info.set_epoch(7);
    scene_->setSceneInfo(info);
    showNerve();
    uint64_t tick = 0;
    const auto touch = [&](const Eigen::Vector3d& contact, uint32_t events) {
        Pose X_WT = test::toolInCavity();
        X_WT.position = contact - Eigen::Vector3d(0, test::kBurrRadius, 0);
        topics::ToolState tool = test::makeToolState(X_WT, X_WT, 1);
        tool.set_epoch(7);
        tool.set_tick(++tick);
        test::setVector(Eigen::Vector3d(0, -2, 0), tool.mutable_force_n());
        tool.mutable_effects()->set_events(events);
        tool.mutable_effects()->set_protected_force_n(2);
        scene_->setToolState(tool);
    };
    const Eigen::Vector3d away(0, -0.006, 0.002), pressed = kNerveCenter + Eigen::Vector3d(5e-4, -1e-3, 3e-4);
    const auto colourThere = [&] {
        touch(kNerveCenter + away, 0);
        draw();                                            // from then on the camera is known
        for (int n = 0; n < 8; ++n) scene_->advance(0.1);  // the film is drawn anew only now and then
        const auto [x, y] = pixelOf(pressed);
        return draw().at(x, y);
    };
    const auto whole = colourThere();
    touch(pressed, topics::EffectState::PROTECTED_TOUCHED);
    const auto red = colourThere();
    EXPECT_LT(red[1], 0.6 * whole[1]);
    EXPECT_GT(red[0], 0.6 * whole[0]);
    touch(pressed, topics::EffectState::PROTECTED_DAMAGED);
    const auto dark = colourThere();
    EXPECT_LT(dark[0], 0.8 * red[0]);
    scene_->settings().hides_effects.fill(true);
    EXPECT_EQ(colourThere(), whole);
}

TEST_F(StructurePictures, Thickness) {
    showBoth();
    scene_->settings().show_thickness = true;
    scene_->settings().show_hud = true;
    EXPECT_EQ(test::goldenProblem(draw(), "structures_thickness"), "");
}

TEST_F(StructurePictures, DistanceLineOfABurrThatIsNear) {
    showBoth();
    putBurr(1.2e-3);
    scene_->settings().show_hud = true;
    EXPECT_EQ(test::goldenProblem(draw(), "structures_distance"), "");
}

TEST_F(StructurePictures, CutAndTransparentAndStereo) {
    showBoth();
    scene_->settings().cuts[0] = {true, 0.36, false};
    scene_->setViewWish({.target_W = {}, .distance = {}, .azimuth = 0.9, .elevation = {}});
    EXPECT_EQ(test::goldenProblem(draw(), "structures_cut"), "");
    scene_->settings().cuts[0].is_on = false;
    scene_->settings().is_transparent = true;
    EXPECT_EQ(test::goldenProblem(draw(), "structures_transparent"), "");
    scene_->settings().is_transparent = false;
    scene_->settings().stereo = StereoMode::kSideBySide;
    EXPECT_EQ(test::goldenProblem(draw(), "structures_stereo"), "");
}

TEST_F(StructurePictures, TheComparisonSeesAMissingOne) {
    showNerve();
    EXPECT_FALSE(isGolden(draw(), "structures")) << "no sinus";
    scene_->clearStructures();
    showSinus();
    EXPECT_FALSE(isGolden(draw(), "structures")) << "no nerve";
    EXPECT_FALSE(isGolden(draw(), "structures_exposed"));
    scene_->settings().show_thickness = true;
    EXPECT_FALSE(isGolden(draw(), "structures_thickness")) << "no nerve under the bone";
    expectAlterationSeen("structures", {"if (is_behind) {", "if (is_behind) { discard;"},
                         [&] { showBoth(); });
    expectAlterationSeen("structures_exposed",
                         {"if (!gl_FrontFacing) {", "if (!gl_FrontFacing || !is_behind) {"}, [&] {
                             showBoth();
                             scene_->settings().structures.fill(StructureMode::kExposedOnly);
                         });
    expectAlterationSeen("structures_thickness", {"textureLod(near_structures, at, 0.0)", "vec4(1.0)"}, [&] {
        showBoth();
        scene_->settings().show_thickness = true;
        scene_->settings().show_hud = true;
    });
}

TEST_F(StructurePictures, WhatIsOffLeavesNoTrace) {
    const Picture without = draw();
    showBoth();
    EXPECT_FALSE(draw() == without);
    scene_->settings().structures.fill(StructureMode::kOff);
    EXPECT_TRUE(draw() == without) << "off";
    scene_->settings().structures.fill(StructureMode::kThroughBone);
    scene_->clearStructures();
    EXPECT_TRUE(draw() == without) << "another scene";
}

// The burr comes near, so that structures light up step by step, and goes.
TEST_F(StructurePictures, QuickIsTheOneThatIsDrawnWhole) {
    scene_->settings().quality = Quality::kQuick;
    draw();
    showBoth();
    for (int n = 0; n < 14; ++n) {
        putBurr(4e-3 - 5e-4 * (n < 8 ? n : 14 - n));
        if (n == 3) scene_->settings().structures[kSinus] = StructureMode::kOff;
        if (n == 5) scene_->settings().show_thickness = true;
        if (n == 9) scene_->settings().structures[kSinus] = StructureMode::kThroughBone;
        if (n == 11) scene_->settings().show_thickness = false;
        if (n == 12) scene_->clearStructures();
        const Picture kept = draw();
        scene_->drawWholeNext();
        EXPECT_TRUE(kept == draw()) << "picture " << n;
    }
}

TEST_F(StructurePictures, NamesAreToldOfWhatIsSeen) {
    EXPECT_EQ(nameOver(kSinusCenter), "") << "before the first picture";
    showBoth();
    draw();
    EXPECT_EQ(nameOver(kSinusCenter), "sigmoid sinus");
    EXPECT_EQ(nameOver(kNerveCenter), "facial nerve");
    EXPECT_EQ(nameOver(test::kBlockCenter + Eigen::Vector3d(0, 0, 0.004)), "") << "bone alone";
    EXPECT_EQ(scene_->structureAt(-1, 5), "");
    EXPECT_EQ(scene_->structureAt(5, kStructureHeight), "");
    scene_->settings().structures.fill(StructureMode::kExposedOnly);
    draw();
    EXPECT_EQ(nameOver(kSinusCenter), "") << "behind bone";
    EXPECT_EQ(nameOver(kNerveCenter), "facial nerve") << "exposed";
    scene_->settings().structures[kNerve] = StructureMode::kOff;
    draw();
    EXPECT_EQ(nameOver(kNerveCenter), "");
}

TEST_F(StructurePictures, TheMouseAndAnInstructorsPointerTellNames) {
    showBoth();
    const Picture without = draw();
    scene_->setMouse(pixelOf(kSinusCenter));
    EXPECT_FALSE(draw() == without);
    scene_->setMouse(pixelOf(test::kBlockCenter + Eigen::Vector3d(0, 0, 0.004)));
    EXPECT_TRUE(draw() == without);
    topics::Viewer instructor = test::makeWatcher("Dr. Berg", topics::Viewer::INSTRUCTOR, 60);
    const auto [x, y] = pixelOf(kSinusCenter);
    test::setVector(*scene_->pick(x, y), instructor.mutable_pointer_m());
    scene_->setWatchers({instructor});
    const Picture named = draw();
    scene_->settings().structures.fill(StructureMode::kOff);
    scene_->clearStructures();
    EXPECT_FALSE(draw() == named);
}

}  // namespace
}  // namespace bonemill
