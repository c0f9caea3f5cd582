// Checks what pictures show of the scan: panes with slices, and grey values on the faces of cuts.
#include <gtest/gtest.h>

#include <memory>

#include "render_client/look/offscreen/osmesa_context.h"
#include "render_client/look/slices/slice_image.h"
#include "tests/gl/altered_shaders.h"
#include "tests/gl/golden.h"
#include "tests/gl/scanned_block.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using test::Alteration;

constexpr int kCtWidth = 640, kCtHeight = 420;

class CtPicture : public testing::Test {
  protected:
    CtPicture() : context_(kCtWidth, kCtHeight) { begin(context_.gl()); }

    void begin(const GlApi& gl) {
        scene_.reset();
        scene_ = std::make_unique<RenderScene>(gl);
        scene_->settings().show_hud = false;
        scene_->settings().show_force = false;
    }
    Picture draw() {
        scene_->draw(kCtWidth, kCtHeight, 0.75f);
        return context_.read();
    }
    // Draws the milled block with that scan behind it.
    Picture drawScanned(const test::ScanParts& parts = {}) {
        if (!scene_->hasSceneInfo()) test::showMilledBlock(*scene_);
        DensityStore& store = scene_->densities();
        store.setGrid(test::blockGrid());
        for (uint32_t brick = 0; brick < uint32_t(brickCount(test::blockGrid())); ++brick)
            store.put(brick, test::blockBrick(brick, parts));
        return draw();
    }
    void cutOpen() {
        scene_->settings().cuts[0] = {true, 0.45, false};
        scene_->setViewWish({.target_W = {}, .distance = {}, .azimuth = 0.9, .elevation = {}});
    }
    void showPanes() { scene_->settings().slices.are_shown = true; }

    // Expects the comparison to see what is wrong in this picture.
    void expectSeen(const Picture& broken, const std::string& golden) {
        const test::PictureDifference difference = test::compare(broken, test::readGolden(golden));
        EXPECT_TRUE(difference.isVisible()) << golden << ": only " << difference.bad_part;
    }
    template <class Prepare>
    void expectAlterationSeen(const Alteration& alteration, const std::string& golden, Prepare&& prepare) {
        const GlApi altered = test::alterShaders(context_.gl(), {alteration});
        begin(altered);
        prepare();
        const Picture broken = drawScanned();
        expectSeen(broken, golden);
        EXPECT_GT(test::alterationsDone(), 0) << "the shaders have changed: " << alteration.what;
        scene_.reset();
    }

    OsmesaContext context_;
    std::unique_ptr<RenderScene> scene_;
};

TEST_F(CtPicture, CutFace) {
    cutOpen();
    EXPECT_EQ(test::goldenProblem(drawScanned(), "ct_cut"), "");
}

TEST_F(CtPicture, Panes) {
    showPanes();
    EXPECT_EQ(test::goldenProblem(drawScanned(), "ct_panes"), "");
}

TEST_F(CtPicture, PanesScrolledAndLarger) {
    showPanes();
    scene_->settings().slices.zoom = 2.5;
    scene_->settings().slices.positions[2] = test::kBlockCenter.z() - 0.002;
    scene_->settings().slices.window = GreyWindow{1200, 1500};
    EXPECT_EQ(test::goldenProblem(drawScanned(), "ct_panes_larger"), "");
}

TEST_F(CtPicture, TheComparisonSeesAMissingStructure) {
    test::ScanParts without;
    without.has_canal = false;
    showPanes();
    expectSeen(drawScanned(without), "ct_panes");
    begin(context_.gl());
    cutOpen();
    expectSeen(drawScanned(without), "ct_cut");
}

TEST_F(CtPicture, TheComparisonSeesWhatWasMilled) {
    test::ScanParts as_scanned;
    as_scanned.is_milled = false;
    showPanes();
    expectSeen(drawScanned(as_scanned), "ct_panes");
}

TEST_F(CtPicture, TheComparisonSeesAnotherWindow) {
    for (const char* const golden : {"ct_panes", "ct_cut"}) {
        begin(context_.gl());
        std::string(golden) == "ct_cut" ? cutOpen() : showPanes();
        GreyWindow window = startWindow(test::blockGrid());
        window.level += window.width / 8;
        scene_->settings().slices.window = window;
        expectSeen(drawScanned(), golden);
    }
}

TEST_F(CtPicture, TheComparisonSeesAMirroredPane) {
    expectAlterationSeen({"vec2(uv.x, 1.0 - uv.y) * size", "vec2(1.0 - uv.x, 1.0 - uv.y) * size"}, "ct_panes",
                         [this] { showPanes(); });
    expectAlterationSeen({"vec2(uv.x, 1.0 - uv.y) * size", "uv * size"}, "ct_panes", [this] { showPanes(); });
}

TEST_F(CtPicture, TheComparisonSeesAMirroredOrMissingFace) {
    expectAlterationSeen({"* vec4(p_M, 1.0)).xy", "* vec4(p_M, 1.0)).yx"}, "ct_cut", [this] { cutOpen(); });
    expectAlterationSeen({"smoothstep(0.0, 0.5, ct.g)", "0.0"}, "ct_cut", [this] { cutOpen(); });
}

// Each pixel of the face is the grey of the bone's density there.
TEST_F(CtPicture, TheFaceShowsTheDensityOfThePlace) {
    cutOpen();
    scene_->settings().cuts[2] = {true, 0.7, false};
    scene_->settings().quality = Quality::kQuick;  // without shadow
    drawScanned();
    scene_->setToolState({});
    const Picture picture = draw();
    const DensitySampler sampler(scene_->densities());
    const GreyWindow window = startWindow(test::blockGrid());
    int compared = 0, wrong = 0;
    for (int y = 0; y < kCtHeight; y += 2)
        for (int x = 0; x < kCtWidth; x += 2) {
            const auto p = scene_->pick(x, y);
            const double depth = test::milledBlockDistance(p.value_or(Vector3d::Zero()));
            const double x_cut = test::kBlockCenter.x() - 0.1 * test::kBlockRadius;
            const double z_cut = test::kBlockCenter.z() + 0.4 * test::kBlockRadius;
            if (!p || depth > -1.2e-3) continue;  // near walls the occlusion darkens
            if (std::abs(p->x() - x_cut) > 2e-5 && std::abs(p->z() - z_cut) > 2e-5) continue;
            ++compared;
            const double grey = 255 * greyOf(window, valueOf(test::blockGrid(), sampler.at(*p).present));
            const auto rgb = picture.at(x, y);
            wrong += std::abs(rgb[0] - grey) > 6 || rgb[0] != rgb[1] || rgb[1] != rgb[2];
        }
    EXPECT_GT(compared, 1000);
    EXPECT_LT(wrong, compared / 50);
}

// The cavity of the block is milled; its outside is the scan's own surface, also of nodes that changed.
TEST_F(CtPicture, MilledWallsShowWhatTheScanMeasured) {
    const auto drawMilled = [&] {
        test::showMilledBlock(*scene_);
        for (NodeMesh node : test::milledBlock()) {
            node.revision = 2;
            scene_->setNode(node);
        }
        scene_->setToolState({});
        return drawScanned();
    };
    scene_->settings().slices.ct = CtShown::kOnCutsAndMilled;
    const Picture milled = drawMilled();
    EXPECT_EQ(test::goldenProblem(milled, "ct_milled"), "");
    EXPECT_FALSE(scene_->densities().wanted().empty());
    scene_->settings().slices.ct = CtShown::kOnCuts;
    expectSeen(draw(), "ct_milled");
    EXPECT_TRUE(scene_->densities().wanted().empty());
    begin(context_.gl());
    scene_->settings().slices.ct = CtShown::kOnCutsAndMilled;
    scene_->settings().slices.window = GreyWindow{1500, 1200};
    expectSeen(drawMilled(), "ct_milled");
}

TEST_F(CtPicture, CutsHaveTheColoursOfMaterials) {
    const auto drawLayered = [&] {
        topics::SceneInfo info = test::milledInfo();
        test::addLayers(info);
        scene_->setSceneInfo(info);
        for (const NodeMesh& node : test::layeredBlock()) scene_->setNode(node);
        scene_->setConnection(Connection::kLive);
        cutOpen();
        scene_->settings().cuts[2] = {true, 0.7, false};
        return drawScanned();
    };
    scene_->settings().slices.ct = CtShown::kMaterialsOnCuts;
    const Picture coloured = drawLayered();
    EXPECT_EQ(test::goldenProblem(coloured, "ct_materials"), "");
    scene_->settings().slices.ct = CtShown::kOnCuts;
    const Picture grey = draw();
    EXPECT_TRUE(test::compare(coloured, grey).isVisible());
    scene_->settings().slices.ct = CtShown::kMaterialsOnCuts;
    EXPECT_TRUE(draw() == coloured) << "there and back";
    topics::SceneInfo plain = test::milledInfo();
    plain.set_revision(2);
    scene_->setSceneInfo(plain);
    EXPECT_TRUE(test::compare(coloured, draw()).isVisible()) << "without colours cuts are of plain bone";
}

TEST_F(CtPicture, WhatIsNotShownIsNotWanted) {
    test::showMilledBlock(*scene_);
    DensityStore& store = scene_->densities();
    store.setGrid(test::blockGrid());
    SliceSettings& slices = scene_->settings().slices;
    draw();
    EXPECT_TRUE(store.wanted().empty());
    cutOpen();
    draw();
    const size_t face = store.wanted().size();
    EXPECT_GT(face, 4u);
    EXPECT_LT(face, size_t(brickCount(test::blockGrid())));
    slices.ct = CtShown::kNowhere;
    draw();
    EXPECT_TRUE(store.wanted().empty());
    slices.are_shown = true;
    draw();
    EXPECT_GT(store.wanted().size(), face);
    scene_->settings().stereo = StereoMode::kSideBySide;
    draw();
    EXPECT_TRUE(store.wanted().empty()) << "no panes there";
    scene_->settings().stereo = StereoMode::kOff;
    slices.are_shown = false;
    draw();
    EXPECT_TRUE(store.wanted().empty());
}

TEST_F(CtPicture, ThePanesLeaveTheViewItsPicks) {
    showPanes();
    drawScanned();
    const int view_width = scene_->viewWidth(kCtWidth, kCtHeight);
    EXPECT_LT(view_width, kCtWidth);
    EXPECT_TRUE(scene_->pick(view_width / 2, kCtHeight / 2)) << "the bone is in the middle of what is left";
    EXPECT_FALSE(scene_->pick(kCtWidth - 20, kCtHeight / 2));
}

// Quick quality keeps what did not change: the picture must be the one that is drawn whole.
TEST_F(CtPicture, QuickDrawingFollowsBricksAndWindow) {
    cutOpen();
    scene_->settings().quality = Quality::kQuick;
    test::showMilledBlock(*scene_);
    DensityStore& store = scene_->densities();
    store.setGrid(test::blockGrid());
    const auto expectWhole = [&](const std::string& when) {
        const Picture kept = draw();
        scene_->drawWholeNext();
        EXPECT_TRUE(kept == draw()) << when;
        return kept;
    };
    Picture before = expectWhole("nothing is there yet");
    const auto expectAnother = [&](const std::string& when) {
        const Picture now = expectWhole(when);
        EXPECT_FALSE(now == before) << when;
        before = now;
    };
    const std::vector<uint32_t> wanted = store.wanted();
    for (const size_t n : {size_t(0), wanted.size() / 2}) {
        store.put(wanted[n], test::blockBrick(wanted[n], {}));
        expectAnother("a brick");
    }
    for (const uint32_t brick : wanted) store.put(brick, test::blockBrick(brick, {}));
    expectAnother("all bricks");
    DensityBrick milled = test::blockBrick(wanted[0], {});
    for (uint16_t& density : milled.present) density = uint16_t(density / 2);
    milled.revision = 2;
    store.put(wanted[0], milled);
    expectAnother("a brick of other densities");
    scene_->settings().slices.window = GreyWindow{900, 400};
    expectAnother("another window");
    scene_->settings().cuts[0].position = 0.4;
    expectAnother("another plane");
    for (NodeMesh node : test::milledBlock()) {
        node.revision = 2;
        scene_->setNode(node);
    }
    scene_->settings().slices.ct = CtShown::kOnCutsAndMilled;
    expectWhole("milled nodes, not all of whose bricks are there");
    for (uint32_t brick = 0; brick < uint32_t(brickCount(test::blockGrid())); ++brick)
        store.put(brick, test::blockBrick(brick, {}));
    before = draw();
    scene_->settings().slices.window = GreyWindow{2500, 700};
    expectAnother("milled nodes in another window");
    scene_->settings().slices.ct = CtShown::kNowhere;
    expectAnother("plain");
    scene_->settings().slices.ct = CtShown::kMaterialsOnCuts;
    expectAnother("materials");
    store.put(wanted[0], test::blockBrick(wanted[0], {}));
    expectWhole("the same brick again");
    store.clear();
    scene_->settings().slices.ct = CtShown::kOnCuts;
    expectWhole("no scan");
}

TEST_F(CtPicture, WithoutAScanNothingIsAnotherThanBefore) {
    cutOpen();
    test::showMilledBlock(*scene_);
    const Picture plain = draw();
    scene_->densities().setGrid(test::blockGrid());
    EXPECT_TRUE(draw() == plain) << "no brick is there yet";
    scene_->settings().slices.are_shown = true;
    scene_->densities().clear();
    draw();
    EXPECT_TRUE(scene_->densities().wanted().empty());
}

}  // namespace
}  // namespace bonemill
